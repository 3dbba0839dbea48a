#!/bin/sh
# `make help` prints tools/make-help.txt: the page lists every phony target and no others, and fits
# 100 columns. "always" is not a target for users.
export LC_ALL=C
bad=0
page=tools/make-help.txt
targets=$(make -npq 2>/dev/null | sed -n 's/^\.PHONY: //p' | tr ' ' '\n' | grep -vx always |
    sort -u)
named=$(sed -n 's/^  \([a-z].*\)$/\1/p' $page | sed 's/   *.*//; s/(or nothing)//' |
    tr ', ' '\n\n' |
    grep . | sort -u)
[ -n "$targets" ] || { echo "make: tells no phony targets"; bad=1; }
for t in $targets; do
    echo "$named" | grep -qxF -- "$t" || { echo "$page: no line for the target $t"; bad=1; }
done
for t in $named; do
    echo "$targets" | grep -qxF -- "$t" || { echo "$page: there is no target $t"; bad=1; }
done
awk -v f=$page 'length($0) > 100 { print f ":" NR ": more than 100 columns"; bad = 1 }
    END { exit bad }' $page || bad=1
exit $bad
