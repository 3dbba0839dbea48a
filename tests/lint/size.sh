#!/bin/sh
# Files of at most 600 lines (generated tables aside), functions of at most 60, and unique file names.
bad=0
for f in $(find ref-decoder ref-encoder conformance tests fuzz bench -name '*.[ch]'); do
    case $f in */tables.c) continue ;; esac
    awk -v f="$f" '
        /^{/ { start = NR }
        /^}/ { if (start && NR - start > 60) { print f ":" start ": function of " NR - start " lines"; bad = 1 } start = 0 }
        END { if (NR > 600) { print f ": " NR " lines"; bad = 1 } exit bad }' "$f" || bad=1
done
twice=$(find ref-decoder ref-encoder conformance tests fuzz bench -name '*.[ch]' -exec basename {} \; | sort | uniq -d)
[ -n "$twice" ] && { echo "file names used twice: $twice"; bad=1; }
exit $bad
