#!/bin/sh
# test_spec_html.sh - the specification as HTML (tests/spec/html.sh): every link has a target, and a
# link without one is reported. Prints lines as a cmocka program does; run by `make test` from the
# project's root. Needs pandoc (make deps-dev).
# SPDX-License-Identifier: BSD-2-Clause
set -u
export LC_ALL=C
. tests/support/speak.sh
command -v pandoc >/dev/null || { skip spec_html "there is no pandoc"; exit 0; }

expect pages 0 "$out/html/index.html" sh tests/spec/html.sh "$out/html"
check rules "$out/html/03-conformance.html" 'id="R-BIT-001"' 'id="s3.1"'
check figure "$out/html/01-scope.html" 'src="data-flow.svg"'
check figure_there "$out/html/data-flow.svg" 'Tier R'

mkdir -p "$out/copy/tests"
cp -R spec CHANGELOG.md "$out/copy/"
cp -R tests/spec "$out/copy/tests/"
echo 'See [there](21-nowhere.md) and [here](04-notation.md#nothing). ![A](figure.svg)' \
    >>"$out/copy/spec/errata.md"
lost() { (cd "$out/copy" && sh tests/spec/html.sh html); }
expect lost 1 'no page 21-nowhere.html' lost
check lost_too "$out/said" 'no anchor 04-notation.html#nothing' 'no figure figure.svg'
exit $bad
