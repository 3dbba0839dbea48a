#!/bin/sh
# test_scene_program.sh - the command line of ted4scene: wrong values are reported with their option
# and what is expected; scenes without test cameras load; and a run that is stopped leaves no
# unfinished file. Prints lines as a cmocka program does; run by `make test` from the project's
# root.
# SPDX-License-Identifier: BSD-2-Clause
set -u
. tests/support/speak.sh
need scene_program ted4scene ted4enc

# wrong OPTION VALUE EXPECTED
wrong() {
    expect "wrong $1 $2" 3 "ted4scene: $1: bad value $2; expected $3" \
        "$TED4_BUILD/ted4scene" still -o "$out/none" "$1" "$2"
}
wrong --size 7x7 "a size from 8x8 to 4096x4096"
wrong --size 16 "a size from 8x8 to 4096x4096"
wrong --size 16x4097 "a size from 8x8 to 4096x4096"
wrong --frames 0 "a whole number from 1 to 1000"
wrong --cameras 1001 "a whole number from 1 to 1000"
wrong --test-cameras -1 "a whole number from 0 to 1000"
wrong --hold 1 "0, or a whole number from 2 to 1000"
wrong --threads 1025 "a whole number from 1 to 1024"
wrong --seed 4294967296 "a whole number from 0 to 4294967295"
wrong --pose-error nan "a number from 0 to 10"
wrong --tint 3 "a number from 0 to 2"
wrong --layout nerf \
    "blender, nerfstudio, colmap, colmap-text, hypernerf, neu3d, calibration or llff"
wrong --background sky "room, white, black or transparent"
wrong --points 7 "surface, box10, none, random or sfm"
wrong --unit 0 "a number from 1e-06 to 1e+06"
wrong --up x "y or z"
wrong --centre 1 "X,Y, both from 0 to 1"
wrong --alpha 1 "straight or premultiplied"
wrong --png 8 "16, grey, palette or interlaced"
wrong --jpeg 1 "baseline or progressive"
wrong --paths x "plain, ext or folder"
wrong --split x "val, train-only or times"
wrong --missing -1 "a whole number from 0 to 1000000"
expect frames_of_turns 3 "ted4scene: --frames: not with --turns, where each camera has a time" \
    "$TED4_BUILD/ted4scene" toys -o "$out/none" --turns --frames 4
for kinds in "--png 16 --jpeg baseline" "--jpeg progressive --png grey"; do
    # shellcheck disable=SC2086 # $kinds is a list of options
    expect "$kinds" 3 "ted4scene: --jpeg: not with --png: all pictures are of one kind" \
        "$TED4_BUILD/ted4scene" still -o "$out/none" --size 16x16 $kinds
done
if [ ! -e "$out/none" ]; then ok nothing_made; else fail nothing_made "a folder"; fi

# No empty list is written. In Neu3D the first camera is held out, even if it is the only one.
for layout in blender nerfstudio colmap colmap-text hypernerf calibration llff; do
    for split in "" "--split val" "--split times --hold 2"; do
        case $layout:$split in *:|blender:*|nerfstudio:*) ;; *) continue ;; esac
        # shellcheck disable=SC2086 # $split is a list of options
        "$TED4_BUILD/ted4scene" still -o "$out/$layout" --cameras 2 --test-cameras 0 --frames 1 \
            --size 16x16 -j 1 --layout $layout -f $split
        expect "no test cameras $layout $split" 0 "pictures    " "$TED4_BUILD/ted4enc" --check \
            "$out/$layout"
    done
done
# The first turn is that of a training camera.
for layout in blender nerfstudio hypernerf; do
    for split in "" "--split val" "--split times --hold 4"; do
        case $layout:$split in hypernerf:*val) continue ;; esac
        # shellcheck disable=SC2086 # $split is a list of options
        "$TED4_BUILD/ted4scene" relay -o "$out/turns" --frames 1 --size 16x16 -j 1 \
            --layout $layout -f $split
        expect "no test turns $layout $split" 0 "pictures    1 train, 0 test" \
            "$TED4_BUILD/ted4enc" --check "$out/turns"
        rm -r "$out/turns"
    done
done

# A video of which only the beginning was written is none, whatever the status of ffmpeg.
mkdir "$out/bin"
cat >"$out/bin/ffmpeg" <<'END'
#!/bin/sh
for last; do :; done
printf '\000\000\000\010ftyp' >"${last#file:}"
END
chmod +x "$out/bin/ffmpeg"
expect half_video 3 'cam02.mp4: the program ffmpeg cannot make it' env PATH="$out/bin:$PATH" \
    "$TED4_BUILD/ted4scene" still -o "$out/half" --size 16x16 --layout neu3d --video
if [ -z "$(find "$out/half" -name '*.mp4*' -o -name '*.part')" ]; then ok half_video_left
else fail half_video_left "a file of ffmpeg stayed"; fi
# No part of the folder's name is the number of a picture, or a protocol, for ffmpeg.
cat >"$out/bin/ffmpeg" <<'END'
#!/bin/sh
for last; do :; done
echo "$*" >"${last#file:}.words"
printf '\000\000\000\010ftyp\000\000\000\011moovM\000\000\000\011mdatM' >"${last#file:}"
END
bin=$(cd "$TED4_BUILD" && pwd)
(cd "$out" && PATH="$out/bin:$PATH" "$bin/ted4scene" still -o "50%d a:b" --size 16x16 \
    --cameras 1 --layout neu3d --video)
cat "$out/50%d a:b/"cam00.*.words >"$out/words"
check names "$out/words" "-i file:50%%d a:b/cam00/images/%04d.png " " file:50%d a:b/cam00."
if [ -f "$out/50%d a:b/cam00.mp4" ]; then ok named_video; else fail named_video "no video"; fi

# A run is stopped as soon as its first picture has a name.
for kind in "--background room --jpeg baseline" "--background transparent --png 16" \
    "--background room"; do
    folder="$out/stopped"
    rm -rf "$folder"
    # shellcheck disable=SC2086 # $kind is a list of options
    "$TED4_BUILD/ted4scene" toys -o "$folder" --size 1024x768 --frames 40 -j 2 $kind &
    writer=$!
    while [ -z "$(find "$folder" -name 'r_*' 2>/dev/null)" ] && kill -0 $writer 2>/dev/null; do
        sleep 0.01
    done
    kill $writer
    wait $writer
    status=$?
    unfinished=
    for f in "$folder"/* "$folder"/*/*; do
        [ -f "$f" ] || continue
        # The last bytes of a JPEG file, and of a PNG file.
        case $f:$(tail -c 8 "$f" | od -An -tx1 | tr -d ' \n') in
        *.jpg:*ffd9|*.png:49454e44ae426082) ;;
        *) unfinished="$unfinished $f" ;;
        esac
    done
    if [ -n "$unfinished" ] || [ $status -ne 143 ]; then
        fail "stopped $kind" "status $status, unfinished: $unfinished"
    else ok "stopped $kind"; fi
done
exit $bad
