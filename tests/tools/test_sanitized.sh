#!/bin/sh
# test_sanitized.sh - ted4enc, ted4eval and ted4scene, built with the address and the undefined
# behaviour sanitizer in a folder of their own, make scenes, train on them and judge the files. The
# trainings are short, and together they exercise every decision of training: a write outside an
# array, which may crash on other machines, ends them. The number of anchors is never a multiple of
# a block's lanes. Prints lines as a cmocka program does; run by `make test` from the project's
# root.
# SPDX-License-Identifier: BSD-2-Clause
set -u
. tests/support/speak.sh
need sanitized ted4enc
grep -q __asan_init "$TED4_BUILD/ted4enc" && { skip sanitized "all is sanitized"; exit 0; }
# clang warns of loops that it does not vectorise, and it vectorises none whose accesses it checks.
flags='-fsanitize=address,undefined -fno-sanitize-recover=all -Wno-pass-failed'
build=$TED4_BUILD/sanitized
unset ASAN_OPTIONS UBSAN_OPTIONS

# works COMMAND...: whether a sanitized program that does nothing, run by this command, always ends.
# Older runtimes crash or never end if the kernel happens to map something where their shadow memory
# has to lie; also under ptrace or a limit of memory.
echo 'int main(void) { return 0; }' >"$out/nothing.c"
# shellcheck disable=SC2086 # several flags
${CC:-cc} $flags "$out/nothing.c" -o "$out/nothing" 2>"$out/said" ||
    { skip sanitized "no sanitizers: $(tail -n 1 "$out/said")"; exit 0; }
works() {
    for i in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20; do
        timeout 10 "$@" "$out/nothing" >"$out/said" 2>&1 || return 1
    done
}
fixed=
works env || { fixed='setarch -R'; works $fixed; } ||
    { skip sanitized "sanitized programs do not run here: $(head -n 1 "$out/said")"; exit 0; }
run() { timeout 300 $fixed "$@" >>"$out/said" 2>&1; }

cores=$(env -u OMP_NUM_THREADS -u OMP_THREAD_LIMIT nproc 2>/dev/null || echo 2)
MAKEFLAGS='' make -s "-j$cores" B="$build" OPT=-O1 CFLAGS="$flags" LDFLAGS="$flags" \
    "$build/ted4enc" "$build/ted4eval" "$build/ted4scene" >"$out/said" 2>&1 ||
    { fail build "$(tail -n 20 "$out/said")"; exit 1; }

# train NAME SCENE SCENE'S_OPTIONS [OPTION...]: makes a scene, trains on it, and judges its held-out
# pictures.
train() {
    name=$1 scene=$2 shape=$3; shift 3
    file=$out/$name.ted4
    : >"$out/said"
    run "$build/ted4scene" $scene -o "$out/$name" --size 48x32 $shape -j 1 &&
        run "$build/ted4enc" "$out/$name" -o "$file" --preset draft --seed 1 -j 2 -q \
            --set init_anchors=150 --set max_anchors=260 --set offsets=4 --set feature=8 \
            --set phi=4 --set bank_dim=8 --set deform_width=8 --set head_width=12 \
            --set hyper_width=16 --set ar_width=8 --set slices=2 "$@" &&
        run "$build/ted4eval" "$file" "$out/$name" --align -q
    status=$?
    if [ $status -eq 0 ]; then ok "$name"; else fail "$name" "$status: $(cat "$out/said")"; fi
}
train capacity pop '--frames 4 --cameras 5' --iterations 200,300
train poses shaken '--frames 4 --cameras 6' --iterations 600,50 --capacity fixed --set probe=0
train relay relay '--frames 24' --iterations 600,50 --capacity fixed --set probe=0
train batch tints '--frames 4 --cameras 5' --iterations 300,50 --set batch=3 --set motion=3
exit $bad
