#!/bin/sh
# read/findings.def has a line for every verdict of status.def; each rule of a line names that error
# in annex G; and the rules of advice exist.
export LC_ALL=C
bad=0
def=ref-decoder/read/findings.def
sed -n 's/^TED4_STATUS(\([A-Z_]*\), *"\([^"]*\)".*/\1 \2/p' ref-decoder/base/status.def |
    while read -r name id; do
    rules=$(sed -n "s/^TED4_FINDING_ERROR($name, *\(.*\))$/\1/p" $def | tr -d '",')
    [ -n "$rules" ] || { echo "$def: no line for $name"; exit 1; }
    for r in $rules; do
        grep "^| $r |" spec/annex-g-rules.md | grep -qF "\`$id\`" ||
            { echo "$def: $r does not name $id"; exit 1; }
    done || exit 1
done || bad=1
for r in $(grep -o 'R-[A-Z]*-[0-9]*' $def | sort -u); do
    grep -q "^| $r |" spec/annex-g-rules.md || { echo "$def: no rule $r"; bad=1; }
done
[ "$(grep -c '^TED4_FINDING_ERROR' $def)" = \
    "$(grep -c '^TED4_STATUS' ref-decoder/base/status.def)" ] ||
    { echo "$def: not one line for each verdict"; bad=1; }
exit $bad
