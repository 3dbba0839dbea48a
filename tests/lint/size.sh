#!/bin/sh
# C files have at most 600 lines, and unique names, except those of player/ and doc/, which are
# compiled by themselves. Files of shell, awk and Python, which say more per line, have at most 400.
# Functions have at most 60 lines everywhere.
export LC_ALL=C
bad=0
folders='ref-decoder ref-encoder conformance tests fuzz bench tools'
for f in $(find $folders player doc python .ci -type d -name node_modules -prune -o -type f \
    \( -name '*.[ch]' -o -name '*.sh' -o -name '*.awk' -o -name '*.py' \) -print) .ci/run; do
    case $f in *.[ch]) most=600 ;; *) most=400 ;; esac
    awk -v f="$f" -v most=$most '
        function over(line, n) {
            if (n <= 60) return
            print f ":" line ": function of " n " lines"
            bad = 1
        }
        f ~ /\.[ch]$/ ? /^[{]/ : f !~ /\.py$/ && /^[^ #}].*[{]$/ { start = NR }
        f !~ /\.py$/ && /^}/ { if (start) over(start, NR - start); start = 0 }
        f ~ /\.py$/ && NF {
            match($0, /^ */)
            if (start && RLENGTH <= depth) { over(start, last - start); start = 0 }
            if (!start && $1 == "def") { start = NR; depth = RLENGTH }
            last = NR
        }
        END {
            if (start) over(start, last - start)
            if (NR > most) { print f ": " NR " lines"; bad = 1 }
            exit bad
        }' "$f" || bad=1
done
twice=$(find $folders -name '*.[ch]' -exec basename {} \; | sort | uniq -d)
[ -n "$twice" ] && { echo "file names used twice: $twice"; bad=1; }
exit $bad
