#!/bin/sh
# Branches of norm/ and read/ that the published vectors take, by gcov: both outcomes of every condition. Needs a build with --coverage whose decoder has gone
# through the suite (make conformance-branches does both).
#     conformance/branches.sh BUILD      prints every branch outcome not taken and not excluded, then totals; fails below 99 %
# The validator (read/collect*.c, advise*.c, validate.c) is asked about every vector, too (replay --validate).
# Excluded are the source lines in conformance/branches-excluded.txt: only a failing allocation or a caller's mistake can reach them; tests do.
export LC_ALL=C
build=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for o in "$build"/ref-decoder/norm/*.o "$build"/ref-decoder/read/*.o; do
    gcov -b -c -p -o "$(dirname "$o")" "$o" >/dev/null 2>&1
    for g in *.gcov; do
        case $g in
        ref-decoder#norm#*|ref-decoder#read#*) cat "$g" >>"$work/all" ;;
        esac
    done
    rm -f ./*.gcov
done
awk -v excluded=conformance/branches-excluded.txt '
    BEGIN { while ((getline line < excluded) > 0) if (line !~ /^#/ && line != "") {
                i = index(line, ": "); j = index(line, " | "); skip[substr(line, 1, i - 1) SUBSEP substr(line, i + 2, j - i - 2)] = 1 } }
    /^ *-: *0:Source:/ { file = $0; sub(/.*Source:/, "", file); next }
    /^ *[-#=0-9*]+: *[0-9]+:/ { split($0, f, ":"); line = f[2] + 0; text = $0; sub(/^[^:]*:[^:]*:/, "", text); gsub(/^[ \t]+|[ \t]+$/, "", text)
                                source[file, line] = text; n = 0; next }
    /^branch/ { key = file SUBSEP line SUBSEP n++; seen[key] = 1; if ($3 != "executed" && $4 + 0 > 0) taken[key] = 1 }
    END {
        for (key in seen) {
            split(key, p, SUBSEP)
            if ((p[1], source[p[1], p[2]]) in skip) {
                used[p[1], source[p[1], p[2]]] = 1
                if (!(key in taken)) { out++; continue }
            }
            total++
            if (key in taken) good++
            else missed[p[1] ":" p[2]] = p[1] ":" p[2] ": " source[p[1], p[2]]
        }
        for (m in missed) print missed[m] | "sort -V"
        close("sort -V")
        for (s in skip) if (!(s in used)) { split(s, p, SUBSEP); print "excluded, but not there: " p[1] ": " p[2]; stale = 1 }
        printf "%d of %d branch outcomes taken: %.2f %%; %d more are excluded\n", good, total, 100 * good / total, out
        exit stale || good < 0.99 * total
    }' "$work/all"
