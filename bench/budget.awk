# budget.awk - bytes of a file by kind of syntax element, from one line of `ted4info --budget --json`, joined by commas:
#     header,nete,netr,bank,positions,masks,feature,scaling,offset,phi,tau,frame
# header: HEAD. masks: temporal and offset masks with their probabilities. frame: everything that frames chunks, tiles and the file. Their sum is the file.
# SPDX-License-Identifier: BSD-2-Clause

function kind(chunk, element) {
    if (element == "frame" || chunk == "file" || chunk == "ENDS" || element == "tile_index" || element == "size")
        return "frame"
    if (chunk != "TILE")
        return chunk
    sub(/_substream.*/, "", element)
    return element ~ /_prob$/ ? "mask" : element
}

function text(line, name) {
    sub(".*\"" name "\":\"", "", line)
    sub(/".*/, "", line)
    return line
}

{
    n = split($0, part, /[{]"chunk"/)
    for (i = 2; i <= n; i++) {
        size = part[i]
        sub(/.*"bytes":/, "", size)
        sum[kind(text("\"chunk\"" part[i], "chunk"), text(part[i], "element"))] += size
        all += size
    }
}
END {
    m = split("HEAD NETE NETR BANK POSN mask feature scaling offset phi tau frame", name, " ")
    for (i = 1; i <= m; i++) {
        printf "%s%d", (i > 1 ? "," : ""), sum[name[i]]
        all -= sum[name[i]]
    }
    print ""
    if (all != 0) {
        print "budget.awk: an element without a column" >"/dev/stderr"
        exit 1
    }
}
