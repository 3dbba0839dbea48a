#!/bin/sh
# README.md is short: at most 6,000 bytes, with the commands of demo and tests in its first 25
# lines, a picture and a chart. In all Markdown files, relative links lead to files, and to
# headings, that exist; spec_text.sh looks at spec/.
export LC_ALL=C
bad=0
# Without a repository, a copy of the tree is all there is.
pages=$(if [ "$(git rev-parse --show-prefix 2>/dev/null)" = '' ] &&
    git ls-files --cached --others --exclude-standard 2>/dev/null | grep -qx README.md; then
    git ls-files --cached --others --exclude-standard '*.md'
else
    find . -type d \( -name '.?*' -o -name node_modules -o -name 'build*' -o -name out \) -prune \
        -o -name '*.md' -print | sed 's|^\./||'
fi | grep -vE '^(spec|shared)/' | sort -u)

[ "$(wc -c <README.md)" -le 6000 ] || { echo "README.md: more than 6,000 bytes"; bad=1; }
for command in 'make deps demo' 'make deps test'; do
    head -n 25 README.md | grep -q "^    $command\( \|\$\)" ||
        { echo "README.md: no '$command' in the first 25 lines"; bad=1; }
done
images=$(grep -oE '!\[[^]]*\]\([^)]+\)' README.md | sed 's/.*](//; s/)$//')
echo "$images" | grep -qE '\.(jpe?g|png)$' || { echo "README.md: no picture"; bad=1; }
echo "$images" | grep -qE '\.svg$' || { echo "README.md: no chart"; bad=1; }
[ "$(ls -l doc/*.jpg doc/*.png 2>/dev/null | awk '{ n += $5 } END { print n + 0 }')" -le 150000 \
    ] || { echo "doc: pictures of more than 150,000 bytes"; bad=1; }

# anchors FILE: prints the names that its headings have in links.
anchors() {
    sed -n 's/^##* //p' "$1" | tr 'A-Z ' 'a-z-' | sed 's/[^a-z0-9_-]//g'
}
for f in $pages; do
    [ -f "$f" ] || continue
    for l in $(grep -oE '\]\([^) ]+' "$f" | sed 's/^](//' | grep -v '://' | sort -u); do
        to=${l%%#*}
        case $l in \#*) file=$f ;; *) file=$(dirname "$f")/$to ;; esac
        if [ ! -e "$file" ]; then
            echo "$f: link to $l, which does not exist"; bad=1
        else
            case $l in *\#*) anchors "$file" | grep -qxF -- "${l#*#}" ||
                { echo "$f: link to $l, which is no heading"; bad=1; } ;; esac
        fi
    done
done
exit $bad
