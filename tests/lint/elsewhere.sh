#!/bin/sh
# The tests that conformance/rules-elsewhere.txt and branches-excluded.txt name exist.
export LC_ALL=C
bad=0
for f in $(grep -ohE '\b(tests|fuzz|ref-decoder|ref-encoder|player)/[A-Za-z0-9_./-]+\.[a-z]+' \
    conformance/rules-elsewhere.txt conformance/branches-excluded.txt | sort -u); do
    [ -f "$f" ] || { echo "conformance: $f is named, but does not exist"; bad=1; }
done
exit $bad
