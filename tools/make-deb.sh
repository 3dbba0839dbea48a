#!/bin/sh
# make-deb.sh FOLDER - builds the Debian packages of the last commit in a copy below FOLDER, which
# is made anew, and leaves them there. It needs dpkg-dev, debhelper and what debian/control names,
# and downloads nothing. The environment variable MAINTAINER, "NAME <ADDRESS>", replaces the
# maintainer in debian/control and the name that signs the last entry of the changelog.
# SPDX-License-Identifier: BSD-2-Clause
set -eu
folder=$1
complain() { echo "make-deb.sh: $1" >&2; exit 1; }
command -v dh >/dev/null || complain "there is no debhelper (make deps-deb)"
git rev-parse --verify -q HEAD >/dev/null || complain "this is no git repository with a commit"
copy=$folder/ted4-$(sed -n '1s/.*(\(.*\)).*/\1/p' debian/changelog)
rm -rf "$folder"
mkdir -p "$copy"
git archive HEAD | tar -x -C "$copy"
cd "$copy"
if [ -n "${MAINTAINER:-}" ]; then
    case $MAINTAINER in
    *[\|\&\\]*) complain "MAINTAINER: no |, & or backslash, please" ;;
    *" <"*@*">") ;;
    *) complain "MAINTAINER: expected NAME <ADDRESS>" ;;
    esac
    sed -i "s|^Maintainer: .*|Maintainer: $MAINTAINER|" debian/control
    sed -i "1,/^ -- /s|^ -- .*>  | -- $MAINTAINER  |" debian/changelog
fi
# Variables of the make that calls this script must not reach the make in the copy.
env -u MAKEFLAGS -u MAKEOVERRIDES -u MFLAGS -u CFLAGS -u LDFLAGS \
    dpkg-buildpackage -us -uc -Jauto
cd ..
rm -rf "${copy##*/}"
if command -v lintian >/dev/null; then
    lintian --allow-root --fail-on error,warning ./*.changes
else
    echo "make-deb.sh: lintian: skipped, it is not here"
fi
