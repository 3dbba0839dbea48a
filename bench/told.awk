# told.awk - what the log of a training (JSON lines of ted4enc) foretold, against what came:
#     awk -v whole=SECONDS -f told.awk LOG    low,high,psnr,bytes
# low, high: the smallest and the largest estimate of the whole training's time, from a tenth of it on, as parts of the time that it took; psnr, bytes: of the last
# line that has them.
# SPDX-License-Identifier: BSD-2-Clause

function number(name,    v) {
    v = $0
    if (!sub(".*\"" name "\":", "", v))
        return ""
    sub(/[,}].*/, "", v)
    return v
}

# Other lines tell of an event.
/"left":/ {
    psnr = number("psnr")
    bytes = number("bytes")
    now = number("seconds")
    left = number("left")
    if (now < whole / 10 || left < 0)
        next
    part = (now + left) / whole
    if (low == "" || part < low)
        low = part
    if (part > high)
        high = part
}

END {
    if (low == "")
        printf ",,%s,%s\n", psnr, bytes
    else
        printf "%.3f,%.3f,%s,%s\n", low, high, psnr, bytes
}
