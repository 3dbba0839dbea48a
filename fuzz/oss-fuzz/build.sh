#!/bin/bash -eu
# build.sh - OSS-Fuzz: builds every harness with the engine and the sanitizer that the environment
# names ($CC, $CXX, $CFLAGS, $LIB_FUZZING_ENGINE, $SANITIZER), with its seeds, regressions,
# dictionary and options, into $OUT. Libraries are linked statically, since the machine that fuzzes
# has none of them.
# SPDX-License-Identifier: BSD-2-Clause
static='-Wl,-Bstatic -lpng -ljpeg -ljansson -lxxhash -lz -Wl,-Bdynamic -lm'
left_out=' '
flags=$CFLAGS
if [ "$SANITIZER" = memory ]; then
    left_out=' colmap transforms calibration hypernerf npy image camera_list '
    flags="$CFLAGS -DXXH_INLINE_ALL"
    make B=build-oss CC="$CC" OPT=-O1 CFLAGS="$flags" build-oss/fuzz/msan_zlib.o
    static="build-oss/fuzz/msan_zlib.o $static"
    static="-Wl,--wrap=inflate,--wrap=compress2,--wrap=uncompress2 $static"
fi
# checkpoint needs the whole trainer, whose vector code is built for the build machine.
left_out="$left_out checkpoint "

sed -n 's/^FUZZ(\([a-z_0-9]*\), \([a-z_0-9]*\),.*/\1 \2/p' fuzz/list.def |
while read -r name seeds; do
    case $left_out in *" $name "*) continue ;; esac
    target=build-oss/fuzz/fuzz_$name
    # The engine takes the place of libFuzzer's own main; OpenMP is not used by what is linked here.
    make B=build-oss CC="$CC" LD_FUZZ="$CXX" OPT=-O1 CFLAGS="$flags" \
        FUZZ_ENGINE="$LIB_FUZZING_ENGINE" LIBS="$static" "$target" </dev/null
    cp "$target" "$OUT/"
    cp fuzz/oss-fuzz/default.options "$OUT/fuzz_$name.options"
    case $seeds in
    knobs | ted4 | recon) cp fuzz/ted4.dict "$OUT/fuzz_$name.dict" ;;
    *) cp fuzz/scene.dict "$OUT/fuzz_$name.dict" ;;
    esac
    zip -q -j -r "$OUT/fuzz_${name}_seed_corpus.zip" "fuzz/corpus/$seeds" \
        $([ -d "fuzz/regressions/$name" ] && echo "fuzz/regressions/$name")
done
