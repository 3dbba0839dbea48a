#!/bin/sh
# Every section of the specification that the code cites exists as a heading.
bad=0
for n in $(grep -rhoE '\bspec [0-9]+(\.[0-9]+)*' ref-decoder ref-encoder conformance tests fuzz --include='*.[ch]' | sed 's/spec //' | sort -u); do
    grep -qE "^#+ $(echo "$n" | sed 's/\./\\./g')( |\$)" spec/*.md || { echo "spec $n: cited, but no such heading"; bad=1; }
done
exit $bad
