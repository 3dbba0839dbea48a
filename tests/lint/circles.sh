#!/bin/sh
# Calls within ref-encoder/train lead only downwards. Its floors are named here, lowest first;
# folders of one floor, joined by +, do not call each other. No circle of calls has more than two
# files, there or in any other folder of sources.
export LC_ALL=C
bad=0
python3 tests/lint/circles.py ref-encoder/train \
    math,model,splat+raster+loss+rate+pose,state,densify+resize,monitor,step,search,. || bad=1
for folder in ref-decoder/base ref-decoder/norm ref-decoder/kernel ref-decoder/read \
    ref-decoder/render ref-decoder/tool ref-encoder/data ref-encoder/eval ref-encoder/write \
    ref-encoder/kernel ref-encoder/tool conformance/tool fuzz bench tools/scene; do
    python3 tests/lint/circles.py $folder || bad=1
done
exit $bad
