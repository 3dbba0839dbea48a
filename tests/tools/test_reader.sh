#!/bin/sh
# test_reader.sh - the second decoder: its unit tests, some vectors of the suite through the runner,
# and random and damaged files compared with ted4dec. Prints lines as a cmocka program does; run by
# `make test` from the project's root. TED4_BUILD: the build folder.
# SPDX-License-Identifier: BSD-2-Clause
here=conformance/reader
. tests/support/speak.sh
need reader python3 ted4conf ted4dec
build=$TED4_BUILD
export PYTHONDONTWRITEBYTECODE=1
for name in unit vectors agreement; do
    case $name in
    unit) python3 -m unittest discover -q -s $here 2>&1 ;;
    vectors) "$build/ted4conf" run --once -q --timeout 120 --list conformance/lists/few.txt \
        --decoder "python3 $here/reader.py" ;;
    agreement) python3 $here/compare.py --keep "$build/tests" --decoder "$build/ted4dec" \
        --seeds 2000:2006 --broken 8 ;;
    esac
    status=$?
    if [ $status -eq 0 ]; then ok "reader $name"; else fail "reader $name" "status $status"; fi
done
exit $bad
