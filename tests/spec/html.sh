#!/bin/sh
# html.sh FOLDER - writes the specification as HTML, one page per file, in reading order. Needs
# pandoc.
# SPDX-License-Identifier: BSD-2-Clause
set -e
export LC_ALL=C
out=$1
mkdir -p "$out"
cp spec/html/style.css spec/rules.json spec/errors.json spec/*.svg "$out/"
SPEC_RULES=$out/rules.txt
export SPEC_RULES
grep -oE '^\*\*R-[A-Z]{3}-[0-9]{3}\*\*' spec/*.md |
    sed 's|^spec/\(.*\)\.md:\*\*\(.*\)\*\*$|\2 \1.html|' >"$SPEC_RULES"
files="README $(sed -n 's/^| \[[^]]*\](\([^)]*\)\.md) .*/\1/p' spec/README.md) errata"
before=
for f in $files; do
    after=$(echo "$files" | tr ' ' '\n' | awk -v f="$f" 'seen { print; exit } $0 == f { seen = 1 }')
    page=$f
    [ "$f" = README ] && page=index
    title=$(sed -n 's/^# //p' "spec/$f.md" | head -1)
    pandoc -f gfm -t html5 --no-highlight --template=spec/html/page.html \
        --lua-filter=spec/html/anchors.lua -M pagetitle="$title" \
        ${before:+-V before="$before.html"} ${after:+-V after="$after.html"} -o "$out/$page.html" \
        "spec/$f.md"
    before=$page
done
pandoc -f gfm -t html5 --no-highlight --template=spec/html/page.html \
    --lua-filter=spec/html/anchors.lua -M pagetitle=Changelog -o "$out/CHANGELOG.html" CHANGELOG.md
# Every link within the pages leads to a page, and to an anchor where it names one; figures exist.
bad=0
for figure in $(grep -ohE 'src="[^":]+"' "$out"/*.html | sed 's/src="//; s/"$//' | sort -u); do
    [ -f "$out/$figure" ] || { echo "no figure $figure"; bad=1; }
done
for link in $(grep -ohE 'href="[^":]+"' "$out"/*.html | sed 's/href="//; s/"$//' | sort -u); do
    file=${link%%#*}
    case $link in \#*) continue ;; esac
    [ -f "$out/$file" ] || { echo "no page $file"; bad=1; continue; }
    case $link in *\#*) grep -q "id=\"${link#*#}\"" "$out/$file" ||
        { echo "no anchor $link"; bad=1; } ;; esac
done
[ $bad -eq 0 ] &&
    echo "$(echo "$files" | wc -w) pages, $(wc -l <"$SPEC_RULES") rules: $out/index.html"
exit $bad
