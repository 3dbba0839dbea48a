# head.awk - turns the table of spec 6.1 into C, one line a row:
#     ELEMENT(name, count, width, signed, low, high, has_condition, condition, level bound)
#     REAL(name, count, bounded)
# for integers, and for binary32 numbers: within 2^-20 .. 2^10 where bounded, else any legal one.
# A condition of the table reads elements through the pointer h. A row that cannot be understood
# ends the run with status 1.
# SPDX-License-Identifier: BSD-2-Clause
BEGIN { FS = " *\\| *" }
/^\| element \| type \| range \| when/ { table = 1; next }
table && !/^\|/ { exit bad }
table && /^\| [a-z]/ {
    gsub(/\\\|/, "\001")
    $0 = $0
    name = $2; count = "1"; type = $3; range = $4; when = $5; bound = "NONE"
    gsub(/\001/, "|", when)
    if (match(name, /\[.*\]/)) {
        count = substr(name, RSTART + 1, RLENGTH - 2)
        name = substr(name, 1, RSTART - 1)
        if (count !~ /^[0-9]+$/)
            count = "h->" count
    }
    if (match($6, /level bound [a-z_]+/))
        bound = substr($6, RSTART + 12, RLENGTH - 12)
    has = when != ""
    gsub(/[a-z_]+/, "h->&", when)
    width = substr(type, 2) / 8
    if (type == "f32" && (range == "2^-20 .. 2^10" || range == "R-CNV-001"))
        printf "REAL(%s, %s, %d)\n", name, count, (range != "R-CNV-001")
    else if (type ~ /^[ui](8|16|32)$/ && range ~ /^-?[0-9]+ \.\. [0-9]+$/) {
        split(range, r, " \\.\\. ")
        printf "ELEMENT(%s, %s, %d, %d, %s, %s, %d, %s, %s)\n", name, count, width, \
            (type ~ /^i/), r[1], r[2], has, (has ? when : 1), bound
    } else {
        print "head.awk: cannot read: " $0 > "/dev/stderr"
        bad = 1
    }
}
