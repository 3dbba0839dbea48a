# sources.awk - C sources without comments and spacing, so that a hash of them changes only where
# the program may. Comments are the block ones; quoted text is kept as it is.
# SPDX-License-Identifier: BSD-2-Clause

FNR == 1 { comment = 0 }
{
    line = $0
    out = ""
    while (line != "") {
        if (comment) {
            at = index(line, "*/")
            if (at == 0)
                break
            line = substr(line, at + 2)
            comment = 0
        } else if (match(line, /"([^"\\]|\\.)*"|'([^'\\]|\\.)*'|\/\*/)) {
            word = substr(line, RSTART, RLENGTH)
            code = substr(line, 1, RSTART - 1)
            gsub(/[ \t]+/, "", code)
            comment = word == "/*"
            out = out code (comment ? "" : word)
            line = substr(line, RSTART + RLENGTH)
        } else {
            gsub(/[ \t]+/, "", line)
            out = out line
            line = ""
        }
    }
    if (out != "")
        print out
}
