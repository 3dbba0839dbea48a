#!/bin/sh
# test_sanitized.sh - ted4enc, ted4eval and ted4scene, built with the address and the undefined
# behaviour sanitizer in a folder of their own, make scenes, train on them and judge the files. The
# trainings are short, and together they go through everything that training decides: writes
# outside an array, which other machines may answer with a crash, end them. The number of anchors is
# never a multiple of a block's lanes. Prints lines as a cmocka program does; run by `make test`
# from the project's root.
# SPDX-License-Identifier: BSD-2-Clause
set -u
. tests/support/speak.sh
need sanitized ted4enc
grep -q __asan_init "$TED4_BUILD/ted4enc" && { skip sanitized "all is sanitized"; exit 0; }
flags='-fsanitize=address,undefined -fno-sanitize-recover=all'
build=$TED4_BUILD/sanitized
MAKEFLAGS='' make -s "-j$(nproc)" B="$build" OPT=-O1 CFLAGS="$flags" LDFLAGS="$flags" \
    "$build/ted4enc" "$build/ted4eval" "$build/ted4scene" >"$out/said" 2>&1 ||
    { fail build "$(tail -n 20 "$out/said")"; exit 1; }

# train NAME SCENE SCENE'S_OPTIONS [OPTION...]: a scene, a training of it, its held-out pictures.
train() {
    name=$1 scene=$2 shape=$3; shift 3
    file=$out/$name.ted4
    "$build/ted4scene" $scene -o "$out/$name" --size 48x32 $shape -j 1 >"$out/said" 2>&1 &&
        "$build/ted4enc" "$out/$name" -o "$file" --preset draft --seed 1 -j 2 -q \
            --set init_anchors=150 --set max_anchors=260 --set offsets=4 --set feature=8 \
            --set phi=4 --set bank_dim=8 --set deform_width=8 --set head_width=12 \
            --set hyper_width=16 --set ar_width=8 --set slices=2 "$@" >>"$out/said" 2>&1 &&
        "$build/ted4eval" "$file" "$out/$name" --align -q >>"$out/said" 2>&1
    status=$?
    if [ $status -eq 0 ]; then ok "$name"; else fail "$name" "$status: $(cat "$out/said")"; fi
}
train capacity pop '--frames 4 --cameras 5' --iterations 200,300
train poses shaken '--frames 4 --cameras 6' --iterations 600,50 --capacity fixed --set probe=0
train relay relay '--frames 24' --iterations 600,50 --capacity fixed --set probe=0
train batch tints '--frames 4 --cameras 5' --iterations 300,50 --set batch=3 --set motion=3
exit $bad
