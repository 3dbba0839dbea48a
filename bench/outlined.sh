#!/bin/sh
# outlined.sh - measures how well an object is reproduced in held-out pictures, where cameras move
# and frame differences therefore do not show it: PSNR over all pixels within outlines that were
# drawn by hand. Prints one JSON line, as zoo_masks does.
# Usage, from anywhere:  bench/outlined.sh FILE.ted4 SCENE OUTLINES DOWNSCALE
#     OUTLINES   a line "WIDTH HEIGHT", the size of the pictures; then a line for each held-out
#                picture, its name without suffix and the corners of a polygon: "00005 x,y x,y ..."
#     DOWNSCALE  as ted4eval --downscale
# Needs ImageMagick (convert), ted4eval and zoo_masks. Environment: TED4_BUILD (build).
# SPDX-License-Identifier: BSD-2-Clause
set -eu
LC_ALL=C; export LC_ALL
here=$(dirname "$0")/..
build=${TED4_BUILD:-$here/build}
[ $# = 4 ] || { sed -n '2,/^# SPDX/{/^# SPDX/!s/^# \{0,1\}//p}' "$0"; exit 3; }
file=$1 scene=$2 outlines=$3 down=$4
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$build/ted4eval" "$file" "$scene" --anyway --downscale "$down" --images "$work/pictures" -v \
    2>"$work/views" >"$work/said" || { status=$?; cat "$work/views" >&2; exit $status; }
mkdir -p "$work/scene/truth/masks"
{
    read -r width height
    while read -r name corners; do
        mask=$work/scene/truth/masks/$name.png
        convert -size "$((width / down))x$((height / down))" xc:black +antialias -fill white \
            -draw "scale $(echo "$down" | awk '{ print 1 / $1 "," 1 / $1 }') polygon $corners" \
            "$mask"
    done
} <"$outlines"
# The pictures of the scene, as if they lay beside the masks.
sed -n "s|^[^ ]*/\([^/ ]* frame \)|$work/scene/\1|p" "$work/views" >"$work/named"
"$build/bench/zoo_masks" "$work/scene" "$work/pictures" <"$work/named"
