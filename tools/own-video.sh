#!/bin/sh
# own-video.sh - makes a SCENE for ted4enc from your own footage; doc/own-video.md says how to film,
# and what can go wrong. One video is of a moving camera; FPS of its frames are taken per second (an
# environment variable; default 6). Several are clips of fixed cameras, one each, that start at the
# same time. Needs ffmpeg and colmap (Debian).
# SPDX-License-Identifier: BSD-2-Clause
set -u
export LC_ALL=C QT_QPA_PLATFORM=offscreen
die() { echo "own-video.sh: $*" >&2; exit 3; }
stem() { b=$(basename "$1"); printf '%s\n' "${b%.*}"; } # a clip's name without its extension
# The lowest rate that all times of a clip fit, and the mean rate; 0: unknown.
rates() {
    ffprobe -v error -select_streams v:0 -show_entries stream=r_frame_rate,avg_frame_rate \
        -of default=nw=1 "$1" </dev/null | awk -F'[=/]' '
            { of[$1] = NF == 2 ? $2 + 0 : $3 + 0 > 0 ? $2 / $3 : 0 }
            END { printf "%.17g\t%.17g", of["r_frame_rate"], of["avg_frame_rate"] }'
}
pasted() { # the name as a shell reads it
    case $1 in
    *[!A-Za-z0-9_./=+-]*) printf '%s\n' "$1" | sed "s/'/'\\\\''/g; s/^/'/; s/\$/'/" ;;
    *) printf '%s\n' "$1" ;;
    esac
}
try() { "$@" </dev/null >>"$out/log" 2>&1 || die "$1 $2 failed: the end of $out/log says why"; }

[ $# -ge 2 ] || die "usage: own-video.sh FOLDER VIDEO, or own-video.sh FOLDER CLIP CLIP..."
# No name may look like an option, a protocol of ffmpeg, or an assignment of awk, or end a line or a
# column of the lists below.
for v; do
    shift
    case $v in *[[:cntrl:]]*) die "a name has a line break, a tab or the like" ;; esac
    case $v in /* | ./* | ../*) ;; *) v=./$v ;; esac
    set -- "$@" "$v"
done
out=$1; shift
for p in ffmpeg ffprobe colmap; do command -v $p >/dev/null ||
    die "there is no program $p (Debian: apt-get install --no-install-recommends ffmpeg colmap)";
    done
for v; do [ -f "$v" ] || die "$v: no such file"; done
case ${FPS:=6} in *[!0-9./]*) false ;; *[1-9]*) ;; *) false ;; esac ||
    die "FPS=$FPS: expected frames per second, as 6 or 2.5"
[ -z "$(ls -A "$out" 2>/dev/null)" ] || die "$out: not empty"
work=$out/poses                             # COLMAP's pictures and database
[ $# -gt 1 ] || work=$out
mkdir -p "$work/images" "$work/models" "$work/sparse" || die "$out: cannot be made"

if [ $# -eq 1 ]; then
    one=1
    try ffmpeg -i "$1" -vf "fps=$FPS" -q:v 2 \
        "$(printf '%s\n' "$out" | sed 's/%/%%/g')/images/%05d.jpg"
else
    one=0
    for v; do
        name=$(stem "$v")
        [ ! -e "$work/images/$name.png" ] || die "$v: another clip is called $name, too"
        try ffmpeg -i "$v" -frames:v 1 -update 1 "$work/images/$name.png"
        ln -L "$v" "$out/" 2>/dev/null || cp "$v" "$out/" || die "$v: cannot be copied to $out"
        rate=$(rates "$v")
        [ "${rate#*	}" != 0 ] || die "$v: no frame rate"
        printf '%s\t%s\n' "$rate" "$v" >>"$work/rates" || die "$work/rates: cannot be written"
    done
    # A difference of half a frame in a thousand may pass.
    awk -F '\t' 'function differ(a, b) { return a - b > b / 2000 || b - a > b / 2000 }
        NR == 1 { first = $3; rate = $1 }
        { what = "" }
        differ($2, $1) {
            what = sprintf("its frame rate varies: %.5g per second on average, not %.5g", $2, $1) }
        what == "" && differ($2, rate) {
            what = sprintf("%.5g frames per second, but %s has %.5g", $2, first, rate) }
        what != "" { bad = 1; print "own-video.sh: warning: " $3 ": " what }
        END { if (bad) print "own-video.sh: such clips lose synchrony; convert each with" \
            " ffmpeg -i CLIP -r 30 NEW.mp4, and begin again" }' "$work/rates" >&2
    rate=$(awk 'NR == 1 { print $2 }' "$work/rates")
fi
n=$(ls "$work/images" | wc -l)
[ "$n" -gt 1 ] || die "$1: $n picture$([ "$n" -eq 1 ] || echo s) at FPS=$FPS"
match=exhaustive_matcher
[ "$n" -le 80 ] || match=sequential_matcher
echo "own-video.sh: $n pictures; looking for their poses ($match; $out/log)"
# Newer versions call the two options of the GPU --FeatureExtraction and --FeatureMatching.use_gpu.
kind=Sift
colmap feature_extractor -h 2>&1 | grep -q -e --FeatureExtraction.use_gpu && kind=Feature
try colmap feature_extractor --database_path "$work/db" --image_path "$work/images" \
    --ImageReader.single_camera $one --${kind}Extraction.use_gpu 0
try colmap $match --database_path "$work/db" --${kind}Matching.use_gpu 0
colmap mapper --database_path "$work/db" --image_path "$work/images" --output_path "$work/models" \
    --Mapper.min_model_size 3 </dev/null >>"$out/log" 2>&1
largest=$(ls -S "$work/models"/*/images.bin 2>/dev/null | head -n 1)
[ -n "$largest" ] || die \
    "COLMAP found no poses: did the camera move, or do the clips see enough of the same? (doc/own-video.md)"
mv "${largest%/images.bin}" "$work/sparse/0" || die "$work/sparse/0: cannot be written"
posed=$(od -An -tu4 -N4 "$work/sparse/0/images.bin" | tr -d ' ')
echo "own-video.sh: $posed of $n pictures have poses"

if [ $one = 0 ]; then
    [ "$posed" = "$n" ] || echo "own-video.sh: clips without a pose are left out of cams.json" >&2
    try colmap model_converter --input_path "$work/sparse/0" --output_path "$work/sparse" \
        --output_type TXT
    try colmap model_converter --input_path "$work/sparse/0" --output_path "$out/points3d.ply" \
        --output_type PLY
    for v; do printf '%s.png\t%s\n' "$(stem "$v")" "$(basename "$v")"; done \
        >"$work/clips" || die "$work/clips: cannot be written"
    awk -v rate="$rate" -f "$(dirname "$0")/cams.awk" "$work/clips" "$work/sparse/cameras.txt" \
        "$work/sparse/images.txt" >"$out/cams.json" || die "$out/cams.json: cannot be written"
fi
rm -rf "$work/models" "$work/db" "$work/rates"
[ $one = 0 ] || echo "own-video.sh: $out does not state its frame rate: use ted4enc --fps $FPS"
echo "own-video.sh: $out is a SCENE: ted4enc --check $(pasted "$out")"
