#!/bin/sh
# test_probe.sh - spec 12.2, R-DEC-006: the probe does not claim class X if it is compiled with any
# option that permits inexact arithmetic; compiled as the Makefile does, and in the compiler's own
# dialect (where binary16 arithmetic makes FLT_EVAL_METHOD 16), it does. Prints lines as a cmocka
# program does; run by `make test` from the project's root.
# SPDX-License-Identifier: BSD-2-Clause
set -u
. tests/support/speak.sh
strict=$(sed -n 's/^STRICT *= *//p' Makefile)
cat >"$out/claim.c" <<'C'
#include "ted4.h"
int main(void)
{
    return ted4_recon_class_x();
}
C

# claims EXPECTED NAME FLAGS...: checks whether the build claims class X.
claims() {
    expected=$1 name=$2
    shift 2
    # shellcheck disable=SC2086 # several flags
    ${CC:-cc} -O2 $strict "$@" -Iref-decoder "$out/claim.c" ref-decoder/recon/probe.c \
        -lm -o "$out/claim" 2>"$out/err" ||
        { fail "$name" "$(cat "$out/err")"; return; }
    "$out/claim"
    claim=$?
    if [ "$claim" -eq "$expected" ]; then ok "$name";
    else fail "$name" "claim $claim, expected $expected"; fi
}

claims 1 as_the_makefile_says -std=c11
claims 1 own_dialect -std=gnu17 -march=native
claims 0 finite_math_only -ffinite-math-only
claims 0 reciprocal_math -freciprocal-math
claims 0 no_signed_zeros -fno-signed-zeros
claims 0 unsafe_math -funsafe-math-optimizations
claims 0 fast_math -ffast-math
exit $bad
