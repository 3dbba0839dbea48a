#!/bin/sh
# Which folder may include which. A folder may always include itself, its own files by their bare
# names. Folders are named from ref-decoder or ref-encoder. In angle brackets are only headers of
# the system and of libraries, which are not checked.
export LC_ALL=C
rooms_1="train/math"
rooms_2="$rooms_1 train/model"
rooms_3="$rooms_2 train/splat train/raster train/loss train/rate train/pose"
rooms_4="$rooms_3 train/state"
rooms_5="$rooms_4 train/densify train/resize"
rooms_6="$rooms_5 train/monitor"
rooms_7="$rooms_6 train/step"
rooms_8="$rooms_7 train/search"
training="$rooms_8 train/train.h"
# The files, anywhere, that may start a thread.
starts=tool/thread_start.h
# What a signal removes, of programs and of the videos that they unpack.
leftovers=tool/leftovers.h
commons="$starts $leftovers $training"
allow="
ref-decoder                 base
ref-decoder/base            base ted4.h
ref-decoder/norm            base norm ted4.h
ref-decoder/kernel          base norm kernel ted4.h
ref-decoder/recon           base norm recon kernel ted4.h
ref-decoder/read            base norm read kernel ted4.h
ref-decoder/render          base render ted4.h
ref-decoder/tool            base render tool $starts ted4.h
ref-encoder/math            math
ref-encoder/kernel          base render kernel
ref-encoder/data            base math data $starts $leftovers
ref-encoder/eval            base eval
ref-encoder/write           base norm math write kernel ted4.h
ref-encoder/train/math      base norm recon render math kernel
ref-encoder/train/model     base norm recon render math data kernel write $rooms_1 ted4.h
ref-encoder/train/splat     base norm recon render math kernel $rooms_2
ref-encoder/train/raster    base norm recon render math $rooms_2
ref-encoder/train/loss      base norm recon render math data $rooms_2
ref-encoder/train/rate      base norm recon render math kernel $rooms_2
ref-encoder/train/pose      base norm render math data $rooms_2
ref-encoder/train/state     base norm recon data $rooms_3
ref-encoder/train/densify   render math $rooms_4
ref-encoder/train/resize    norm math $rooms_4
ref-encoder/train/monitor   math $rooms_5
ref-encoder/train/step      base norm recon math kernel write $rooms_6
ref-encoder/train/search    math write $rooms_7
ref-encoder/train           $training
ref-encoder/mpi             tool train/state
ref-encoder/tool            base norm render math data eval kernel write tool $commons ted4.h
"
bad=0
for f in $(find ref-decoder ref-encoder -name '*.[ch]'); do
    folder=$(dirname "$f")
    may=$(echo "$allow" | awk -v d="$folder" '$1 == d { $1 = ""; print }')
    for i in $(sed -n 's/^[[:space:]]*#[[:space:]]*include[[:space:]]*<\(.*\)>.*/\1/p' "$f"); do
        for where in ref-decoder ref-encoder "$folder" .; do
            [ ! -f "$where/$i" ] || { echo "$f: $i is in angle brackets"; bad=1; break; }
        done
    done
    for i in $(sed -n 's/^[[:space:]]*#[[:space:]]*include[[:space:]]*"\(.*\)".*/\1/p' "$f"); do
        case $i in
        train/*/*) to=${i%/*} ;;
        train/* | $starts | $leftovers) to=$i ;;
        */*) to=${i%%/*} ;;
        *) [ -f "$folder/$i" ] && continue; to=$i ;;
        esac
        case " $may " in
        *" $to "*) ;;
        *) echo "$f: may not include $i"; bad=1 ;;
        esac
    done
done
exit $bad
