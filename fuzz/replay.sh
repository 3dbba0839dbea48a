#!/bin/sh
# replay.sh - runs every harness over its seeds and its regressions: fuzz/replay.sh PROGRAM, where
# PROGRAM is a build of main.c.
# SPDX-License-Identifier: BSD-2-Clause
set -eu
sed -n 's/^FUZZ(\([a-z_0-9]*\), \([a-z_0-9]*\),.*/\1 \2/p' fuzz/list.def |
while read -r name seeds; do
    old=fuzz/regressions/$name
    [ -d "$old" ] || old=
    "$1" "$name" "fuzz/corpus/$seeds" $old
done
