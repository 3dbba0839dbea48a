#!/bin/sh
# Calls within ref-encoder/train lead downwards only. Its floors are named here, lowest first;
# folders of one floor, joined by +, do not call each other. No circle of calls has more than two
# files.
exec python3 tests/lint/circles.py ref-encoder/train \
    math,model,splat+raster+loss+rate,state,densify+resize,step,search,.
