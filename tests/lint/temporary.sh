#!/bin/sh
# Tests create their files below $TMPDIR (tests/support/temporary.h), so that they can run where
# /tmp is small or belongs to somebody else.
export LC_ALL=C
grep -rn '"/tmp/' tests fuzz bench conformance --include='*.[ch]' |
    sed 's/$/   (use temporary.h)/' | grep . && exit 1
exit 0
