#!/bin/sh
# debian/changelog has the version of ref-decoder/ted4.h ("~dev" sorts before the release), the
# files that debian/*.docs and *.examples name exist, and no line of a description has more than 80
# columns, which `make deb` refuses (lintian: extended-description-line-too-long).
export LC_ALL=C
bad=0
version=$(sed -n 's/^#define TED4_VERSION *"\(.*\)"$/\1/p' ref-decoder/ted4.h | sed 's/-dev/~dev/')
debian=$(sed -n '1s/.*(\(.*\)).*/\1/p' debian/changelog)
[ "$version" = "$debian" ] ||
    { echo "debian/changelog: version $debian, but ted4.h has $version"; bad=1; }
for f in $(cat debian/*.docs debian/*.examples); do
    [ -e "$f" ] || { echo "debian: $f is named, but does not exist"; bad=1; }
done
awk '/^Description:/ { text = 1; next }
    !/^ / { text = 0 }
    text && length($0) > 80 { print FILENAME ":" FNR ": " length($0) " columns"; bad = 1 }
    END { exit bad }' debian/control || bad=1
exit $bad
