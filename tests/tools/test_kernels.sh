#!/bin/sh
# test_kernels.sh - one program runs on any machine of a kind: TED4_KERNEL selects the kernels,
# kernels that this machine does not have are refused, every level decodes to the same scene, and
# code that is compiled once uses no instruction that only some machines have. Prints lines as a
# cmocka program does; run by `make test` from the project's root.
# SPDX-License-Identifier: BSD-2-Clause
set -u
export LC_ALL=C
. tests/support/speak.sh
programs="ted4dec ted4info ted4enc ted4edit ted4eval ted4scene ted4tolerance"
need kernels $programs ted4conf
stream=conformance/vectors/content/CNT-pop-0.002.ted4

for program in ted4dec ted4enc ted4info; do
    expect "unknown_level_$program" 3 'TED4_KERNEL=v9: this machine has plain' \
        env TED4_KERNEL=v9 "$TED4_BUILD/$program" $stream
done
# Which kernels are in use is not what it says then.
for program in $programs; do
    expect "unknown_level_version_$program" 3 "$program: TED4_KERNEL=v9: this machine has plain" \
        env TED4_KERNEL=v9 "$TED4_BUILD/$program" --version
done
expect unknown_level_version_ted4conf 3 "ted4conf run: TED4_KERNEL=v9: this machine has plain" \
    env TED4_KERNEL=v9 "$TED4_BUILD/ted4conf" run --version
expect unknown_level_contract 3 'ted4dec: TED4_KERNEL=v9: this machine has plain' \
    env TED4_KERNEL=v9 "$TED4_BUILD/ted4dec" --ted4-run $stream --tiers T1
expect second_no_value 3 'ted4conf: --second: bad value TED4_KERNEL; expected NAME=VALUE' \
    "$TED4_BUILD/ted4conf" run --decoder "$TED4_BUILD/ted4dec" --second TED4_KERNEL \
    --list conformance/lists/few.txt
levels=$(TED4_KERNEL=v9 "$TED4_BUILD/ted4dec" $stream 2>&1 | sed -n 's/.*this machine has //p')
for level in $levels; do
    expect "named_$level" 0 "(specification 1.0 and draft 1.1), kernels $level" \
        env TED4_KERNEL="$level" "$TED4_BUILD/ted4enc" --version
    TED4_KERNEL=$level "$TED4_BUILD/ted4dec" $stream --hash --frames 0:4 >"$out/$level" 2>&1 ||
        fail "hash_$level" "status $?"
    if cmp -s "$out/plain" "$out/$level"; then
        ok "hash_$level"
    else
        fail "hash_$level" "not that of plain"
    fi
done

# Code for this machine alone may have been requested, or be the compiler's default.
if grep -q -e -march= "$TED4_BUILD/how" ||
    ${CC:-cc} -dM -E -x c /dev/null 2>/dev/null | grep -q __AVX__; then
    skip compiled_once "this build is for machines like this one"
elif [ "$(uname -m)" = x86_64 ] && command -v objdump >/dev/null; then
    objdump -d --no-show-raw-insn "$TED4_BUILD"/libted4*.a | awk '
        / file format / { member = $1 }
        member ~ /\.v[34]\.o:$|_(avx2|avx512|vnni|avxvnni)\.o:$/ { next }
        { seen++ }
        /[ \t]v[a-z0-9]+ .*%[xyz]mm|[ \t](sar|shl|shr|ror)x / { found[member] = 1 }
        END { for (m in found) print m; print seen > "/dev/stderr" }' >"$out/found" 2>"$out/once"
    if [ "$(cat "$out/once")" -gt 10000 ] && [ ! -s "$out/found" ]; then
        ok compiled_once
    else
        fail compiled_once "$(cat "$out/found")"
    fi
else
    skip compiled_once "there is no objdump, or this is no x86-64"
fi
exit $bad
