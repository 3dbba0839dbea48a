#!/bin/sh
# debian/changelog has the version of ref-decoder/ted4.h ("~dev" sorts before the release), and the
# files that debian/*.docs and *.examples name exist.
export LC_ALL=C
bad=0
version=$(sed -n 's/^#define TED4_VERSION *"\(.*\)"$/\1/p' ref-decoder/ted4.h | sed 's/-dev/~dev/')
debian=$(sed -n '1s/.*(\(.*\)).*/\1/p' debian/changelog)
[ "$version" = "$debian" ] ||
    { echo "debian/changelog: version $debian, but ted4.h has $version"; bad=1; }
for f in $(cat debian/*.docs debian/*.examples); do
    [ -e "$f" ] || { echo "debian: $f is named, but does not exist"; bad=1; }
done
exit $bad
