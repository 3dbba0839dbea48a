#!/bin/sh
# The text of the specification: links between its files have targets, cited sections exist, the
# README's table lists all chapters and annexes, no line names an absolute path or a host, and no
# shift in printed code requires the reader to know its precedence.
export LC_ALL=C
bad=0
for l in $(grep -ohE '\]\([^)#]+' spec/*.md | sed 's/](//' | sort -u); do
    [ -e "spec/$l" ] || { echo "spec: link to $l, which does not exist"; bad=1; }
done
for f in spec/[0-9]*.md spec/annex-*.md spec/errata.md; do
    grep -q "($(basename "$f"))" spec/README.md ||
        { echo "$f: not in the table of spec/README.md"; bad=1; }
done
headings=$(sed -nE 's/^#+ (Annex )?([0-9A-N][0-9.]*)( .*)?$/\2/p' spec/[0-9]*.md spec/annex-*.md)
for n in $(grep -ohE '\b([1-9][0-9]?\.[0-9]+|[A-N]\.[0-9]+)\)' spec/[0-9]*.md spec/annex-[c-n]*.md \
    spec/README.md | tr -d ')' | sort -u); do
    echo "$headings" | grep -qxF "$n" ||
        { echo "spec: section $n is cited, but no such heading"; bad=1; }
done
grep -nE '(^|[^][:alnum:]._)<])/[A-Za-z]|://' spec/*.md &&
    { echo "spec: names an absolute path or a host"; bad=1; }
for f in spec/*.md; do
    [ "$(grep -c '^```' "$f")" = "$(( $(grep -c '^```' "$f") / 2 * 2 ))" ] ||
        { echo "$f: a code block is not closed"; bad=1; }
done
# Printed code (4.5): a shift next to a mask is in parentheses.
awk '
    FNR == 1 || /^```/ { code = /^```c$/ }
    code && /(<<|>>) [^()&|^,;]* [&|^] / {
        print FILENAME ":" FNR ": a shift and a mask without parentheses"
        bad = 1
    }
    END { exit bad }' spec/*.md || bad=1
exit $bad
