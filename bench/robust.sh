#!/bin/sh
# robust.sh - what the decoder, built with AddressSanitizer and UBSan, says of a file cut short and
# of one with a changed byte (bench/robust.c).
# Usage, from the project root:  bench/robust.sh FILE.ted4 [SEED]
# Ends with 1 when something is decoded that must be refused; a sanitizer's report ends it too.
# SPDX-License-Identifier: BSD-2-Clause
set -eu
san='-fsanitize=address,undefined'
make -s B=build-asan OPT=-O1 CFLAGS="$san -fno-sanitize-recover=all" LDFLAGS="$san" \
    build-asan/bench/robust
echo "$(basename "$1"): $(wc -c <"$1") bytes"
echo
exec build-asan/bench/robust "$@"
