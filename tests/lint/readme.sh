#!/bin/sh
# README.md is short: at most 6,000 bytes, with the commands of demo and tests in its first 25
# lines, a picture and a chart. In it, in doc/ and in the READMEs of folders with code, relative
# links lead to files, and to headings, that exist.
export LC_ALL=C
bad=0
pages="README.md $(echo doc/*.md) ref-decoder/README.md ref-encoder/README.md tests/README.md
bench/README.md"

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
    [ -f "$f" ] || { echo "$f: is not there"; bad=1; continue; }
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
