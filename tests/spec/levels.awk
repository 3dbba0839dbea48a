# levels.awk - turns the table of spec 13.1 into C: LEVEL(level, n_anchors, n_offsets, frames,
# values, products, file_bytes, symbols_a_byte)
# SPDX-License-Identifier: BSD-2-Clause
BEGIN { FS = " *\\| *" }
/^\| level \| n_anchors/ { table = 1; next }
table && !/^\|/ { exit }
table && /^\| [0-9]/ {
    line = "LEVEL(" $2
    for (i = 3; i <= 9; i++) {
        v = $i == "-" ? "UINT64_MAX" : $i
        if (v ~ /^2\^[0-9]+$/)
            v = "(uint64_t)1 << " substr(v, 3)
        line = line ", " v
    }
    print line ")"
}
