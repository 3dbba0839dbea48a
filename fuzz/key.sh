#!/bin/sh
# key.sh NAME BUILD - the key of a harness's rows in runs.csv: a hash of the sources that it links
# (fuzz.mk), and of its own; comments and spacing do not count, nor do the writers of seeds. BUILD
# is the folder of a build, for sources generated from the specification. Run from the project root.
# SPDX-License-Identifier: BSD-2-Clause
set -eu
name=$1 build=$2
case " $(make -s fuzz-scenes) $name" in
*" $name "*)     more='ref-encoder/data ref-decoder/tool' ;;
*checkpoint)     more='ref-encoder/data ref-encoder/train ref-encoder/kernel ref-encoder/eval
                     ref-decoder/render' ;;
*" cams")        more=ref-decoder/tool ;;
*decode_chunked) more=ref-decoder/tool/read_file.c ;;
*two_decoders)   more="tests/support/spec_tiers.h tests/spec/names.h $build/inc" ;;
*)               more= ;;
esac
# shellcheck disable=SC2086 # several folders
{
    find ref-decoder/base ref-decoder/norm ref-decoder/read ref-decoder/kernel \
        ref-decoder/recon ref-encoder/write $more \
        tests/support/random_scene.h tests/support/random_source.h tests/support/recon_ref.h \
        tests/support/spec_model.h -name '*.[ch]' -o -name '*.def' -o -name '*.inc'
    find fuzz -name '*.[ch]' ! -name 'fz_*' ! -name '*corpus*' -o -name "fz_$name.c"
} | LC_ALL=C sort | xargs awk -f bench/sources.awk | sha256sum | cut -c1-12
