#!/bin/sh
# spec/rules.json and spec/errors.json, for programs, are made from the same sources as annex G and
# the table of chapter 14, and agree with them. `sh tests/lint/spec_json.sh print rules|errors`
# prints one of them.
export LC_ALL=C
print_json() {
    which=$1
    set -- -v spec="$(sed -n 's/^#define TED4_SPEC_VERSION *"\(.*\)"$/\1/p' ref-decoder/ted4.h)"
    case $which in
    rules) awk "$@" -v json=1 -f tests/spec/rules.awk spec/[0-9]*.md spec/annex-[e-f]*.md \
        spec/annex-[j-m]*.md ;;
    errors) awk "$@" -f tests/spec/errors.awk spec/annex-g-rules.md ref-decoder/base/status.def ;;
    esac
}
if [ "$1" = print ]; then print_json "$2"; exit 0; fi
bad=0
for which in rules errors; do
    print_json $which | cmp -s - spec/$which.json ||
        { echo "spec/$which.json is not what its sources say: make spec-annexes"; bad=1; }
done
# The rows of annex G, and of 14.3, made again from the JSON files.
rows_of_rules() {
    sed -n 's/^,*{"id":"\([^"]*\)","file":"[^"]*","section":"\([^"]*\)","binds":"\([^"]*\)","word":"\([^"]*\)","errors":\[\([^]]*\)\].*/| \1 | \2 | \3 | \4 | \5 |/p' \
        spec/rules.json | sed 's/","/` `/g; s/"/`/g'
}
rows_of_errors() {
    sed -n 's/^,*{"id":"\([^"]*\)","result":"[a-z]*","section":"\([^"]*\)","text":"\([^"]*\)".*/| `\1` | \2 | \3 |/p' spec/errors.json
}
[ "$(rows_of_rules)" = "$(grep '^| R-' spec/annex-g-rules.md)" ] ||
    { echo "spec/rules.json differs from annex G"; bad=1; }
[ "$(rows_of_errors)" = "$(grep '^| `[a-z]*\.[a-z-]*` | [0-9]' spec/14-errors.md)" ] ||
    { echo "spec/errors.json differs from the table of 14.3"; bad=1; }
exit $bad
