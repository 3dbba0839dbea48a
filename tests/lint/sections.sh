#!/bin/sh
# Every section and annex of the specification that any file cites exists as a heading: "spec
# 9.2, 9.4", "spec 5 to 10", "spec J.1", "annex D.1", "chapter 14".
export LC_ALL=C
bad=0
headings=$(sed -nE 's/^#+ (Annex )?([0-9A-N][0-9.]*)( .*)?$/\2/p' spec/[0-9]*.md spec/annex-*.md)
number='([A-N]|[1-9][0-9]*)(\.[0-9]+)*\b'
cited="\b([Ss]pec|[Aa]nnex(es)?|[Cc]hapters?) $number((,| to| and|, and) $number)*"
for n in $(grep -rhoE "$cited" ref-decoder ref-encoder conformance tests fuzz bench tools doc \
    player python .ci Makefile README.md SECURITY.md CHANGELOG.md --exclude-dir=node_modules \
    --include='*.[ch]' --include='*.def' --include='*.sh' --include='*.awk' --include='*.sed' \
    --include='*.py' --include='*.js' --include='*.mjs' --include='*.ts' --include='*.mk' \
    --include='*.md' --include='*.txt' --include='*.list' --include=Makefile |
    grep -oE "\b$number" | sort -u); do
    echo "$headings" | grep -qxF "$n" && continue
    files=$(grep -rlE "\b([Ss]pec|[Aa]nnex|[Cc]hapter) $n" ref-* conformance tests fuzz bench \
        tools doc player python *.md Makefile | head -n 3 | tr '\n' ' ')
    echo "spec $n: cited, but no such heading: $files"
    bad=1
done
exit $bad
