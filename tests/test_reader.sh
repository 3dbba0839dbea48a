#!/bin/sh
# test_reader.sh - the second decoder: its unit tests, a few vectors of the suite through the runner, drawn and broken streams side by side with
# ted4dec. Speaks as cmocka programs do; run by `make test` from the project's root. TED4_BUILD: the build folder.
# SPDX-License-Identifier: BSD-2-Clause
here=conformance/reader
build=${TED4_BUILD:-build}
export PYTHONDONTWRITEBYTECODE=1
bad=0
for name in unit vectors agreement; do
    if ! command -v python3 >/dev/null; then
        echo "[  SKIPPED ] reader $name"
        echo "skipped: there is no python3"
        continue
    fi
    case $name in
    unit) python3 -m unittest discover -q -s $here 2>&1 ;;
    vectors) "$build/ted4conf" run --once -q --timeout 120 --list conformance/lists/few.txt --decoder "python3 $PWD/$here/reader.py" ;;
    agreement) python3 $here/compare.py --keep "$build/tests" --decoder "$build/ted4dec" --seeds 2000:2006 --broken 8 ;;
    esac
    if [ $? -eq 0 ]; then echo "[       OK ] reader $name"; else echo "[  FAILED  ] reader $name"; bad=1; fi
done
exit $bad
