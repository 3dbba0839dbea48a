#!/bin/sh
# Rules of the specification: each is defined once, with key words of BCP 14; every rule that a file
# quotes exists; rules name the identifiers of status.def, all of them and no others; annex G is
# current. `sh tests/lint/spec_rules.sh print` prints annex G.
export LC_ALL=C
index() {
    awk -f tests/spec/rules.awk spec/[0-9]*.md spec/annex-[e-f]*.md spec/annex-[j-m]*.md
}
if [ "$1" = print ]; then index; exit 0; fi
bad=0
index | cmp -s - spec/annex-g-rules.md ||
    { echo "spec/annex-g-rules.md is not what the rules say: make spec-annexes"; bad=1; }
rules=$(sed -n 's/^| \(R-[A-Z]*-[0-9]*\) .*/\1/p' spec/annex-g-rules.md | sort)
for r in $(echo "$rules" | uniq -d); do echo "$r: defined twice"; bad=1; done
for r in $(awk -F' *\\| *' '$5 == "none" { print $2 }' spec/annex-g-rules.md); do
    echo "$r: no MUST, SHOULD or MAY"; bad=1
done
quoted=$(grep -rhoE 'R-[A-Z]{3}-[0-9]{3}' --include='*.[ch]' --include='*.md' --include='*.py' \
    --include='*.sh' --include='*.def' --include='*.json' --include='*.txt' \
    spec ref-decoder ref-encoder tests fuzz bench conformance doc README.md 2>/dev/null | sort -u)
for r in $quoted; do
    echo "$rules" | grep -qx "$r" || { echo "$r: quoted, but no such rule"; bad=1; }
done
known=$(sed -n 's/^TED4_STATUS([^"]*"\([^"]*\)".*/\1/p' ref-decoder/base/status.def | sort)
named=$(grep '^| R-' spec/annex-g-rules.md | grep -oE '`[a-z]+\.[a-z-]+`' | tr -d '`' | sort -u)
for e in $known; do echo "$named" | grep -qx -- "$e" ||
    { echo "$e: in status.def, but no rule names it"; bad=1; }; done
for e in $named; do echo "$known" | grep -qx -- "$e" ||
    { echo "$e: named by a rule, but not in status.def"; bad=1; }; done
exit $bad
