#!/bin/sh
# test_says.sh - the progress messages of ted4enc and ted4eval: a first message long before the end,
# what was found, videos as they are unpacked, the expected duration, where training resumes; and
# quiet mode prints nothing. Prints lines as a cmocka program does; run by `make test` from the
# project's root.
# SPDX-License-Identifier: BSD-2-Clause
set -u
export LC_ALL=C
. tests/support/speak.sh
need says ted4enc ted4dec ted4info ted4eval ted4scene
# equal NAME VALUE WANTED
equal() { if [ "$2" = "$3" ]; then ok "$1"; else fail "$1" "$2, expected $3"; fi; }
enc=$TED4_BUILD/ted4enc
small="--preset draft --iterations 300,100 --seed 1 -j 1 --set init_anchors=150
    --set max_anchors=260 --set offsets=4 --set feature=8 --set phi=4 --set bank_dim=8
    --set deform_width=8 --set head_width=12 --set hyper_width=16 --set ar_width=8 --set slices=2
    --capacity fixed"
"$TED4_BUILD/ted4scene" pop -o "$out/scene" --size 32x24 --frames 4 --cameras 5 --test-cameras 1 \
    -j 1 2>/dev/null
mkdir -p "$out/cache"
XDG_CACHE_HOME=$out/cache
export XDG_CACHE_HOME

# What was found, in a form for programs.
"$enc" "$out/scene" --check --json 2>/dev/null | tr -d '\n' >"$out/json"
check check_json "$out/json" '{"error":null,"layout":"D-NeRF","train":20,"test":4,"cameras":6,' \
    '"frames":4,"sizes":[[32,24],[32,24]],' '"rate":'
expect file_rate 0 '(the file will say ' "$enc" "$out/scene" --check

# --fps: of a scene that does not say it.
expect fps 0 'rate        23.976 frames/s' "$enc" "$out/scene" --check --fps 24000/1001
for bad_rate in x 6x -6 0 0/0 1/ nan 2e7 1e-9; do
    expect "fps_$bad_rate" 3 "--fps: bad value $bad_rate" \
        "$enc" "$out/scene" --check --fps $bad_rate
done
mkdir "$out/timed"
cp -R "$out/scene/." "$out/timed"
sed -i '1s/{/{"fps": 25, /' "$out/timed/transforms_train.json"
expect fps_same 0 'rate        25 frames/s' "$enc" "$out/timed" --check --fps 25
expect fps_other 3 '--fps: the scene states 25 frames per second, not 24' \
    "$enc" "$out/timed" --check --fps 24
expect check_json_missing 3 "$out/none: no such folder" "$enc" "$out/none" --check --json
"$enc" "$out/none" --check --json 2>/dev/null >"$out/json"
check check_json_error "$out/json" "{\"error\":\"$out/none: no such folder"

# An error that ends a training, or --transcode, before there is a file, is also one object, with
# the text of the message. Wrong usage gives none. ended NAME TEXT ARGUMENT...
ended() {
    name=$1 text=$2; shift 2
    "$enc" "$@" --json -q 2>"$out/err" >"$out/json"
    equal "$name" "$? $(cat "$out/json")" "3 {\"error\":\"$text\"}"
    equal "$name.told" "$(cat "$out/err")" "ted4enc: $text"
}
ended json_no_scene "$out/none: no such folder, expected a scene" "$out/none" -o "$out/x.ted4"
: >"$out/there.ted4"
ended json_there "$out/there.ted4: exists; -f overwrites" "$out/scene" -o "$out/there.ted4"
ended json_transcode "$out/there.ted4: exists; -f overwrites" --transcode \
    conformance/vectors/worked/WRK-annex-b2.ted4 -o "$out/there.ted4"
"$enc" --json >"$out/json" 2>/dev/null
equal json_usage "$? $(cat "$out/json")" "3 "

expect quiet_and_verbose 3 'ted4enc: -q and -v: only one of them' \
    "$enc" "$out/scene" --check -q -v

# More cameras than a chunk can list are refused before the training. All of these take the same
# picture.
mkdir "$out/many"
cp "$(find "$out/scene" -name '*.png' | sort | head -n 1)" "$out/many/a.png"
cp "$out/scene/transforms_test.json" "$out/many"
sed -i 's|"file_path": "[^"]*"|"file_path": "./a"|' "$out/many/transforms_test.json"
awk 'BEGIN {
    printf "{\"camera_angle_x\": 0.8, \"frames\": ["
    for (i = 0; i < 65537; i++)
        printf "%s{\"file_path\": \"./a\", \"time\": %d, \"transform_matrix\": " \
            "[[1,0,0,%d],[0,1,0,0],[0,0,1,4],[0,0,0,1]]}", i ? "," : "", i % 2, i
    print "]}"
}' >"$out/many/transforms_train.json"
expect many_cameras 3 'ted4enc: --cameras: 65537 cameras, more than the 65536 of a chunk' \
    "$enc" "$out/many" --check --cameras -q

# If something is wrong, only that is reported.
mkdir "$out/broken"
cp -R "$out/scene/." "$out/broken"
first=$(find "$out/broken" -name '*.png' | sort | head -n 1)
head -c 100 "$first" >"$out/part" && cp "$out/part" "$first"
"$enc" "$out/broken" --check 2>"$out/err" >"$out/text"
equal check_wrong "$? $(cat "$out/text")" '3 '

# Names that are not UTF-8, and a message that is cut inside a character, still give valid JSON.
odd=$(printf 'no\377'); unknown=$(printf '\357\277\275')
"$enc" "$out/scene" --check --json --hold-out "a$(printf '\303\244%.0s' $(seq 120))" 2>/dev/null \
    >"$out/json"
check check_json_cut "$out/json" "{\"error\":\"" "$(printf 'a\303\244')"
odd_files() {
    "$enc" "$out/$odd" --check --json 2>/dev/null >"$out/json"
    check check_json_bytes "$out/json" "{\"error\":\"$out/no$unknown: no such folder"
    "$TED4_BUILD/ted4info" "$out/$odd" --json >"$out/json" 2>/dev/null
    check missing_json_bytes "$out/json" "\"file\":\"$out/no$unknown\""
    cp conformance/vectors/worked/WRK-annex-b2.ted4 "$out/$odd.ted4"
    "$TED4_BUILD/ted4dec" "$out/$odd.ted4" -o "$out/$odd.ply" --render "$out/$odd.png" --orbit 1 \
        --json --time 0 2>/dev/null >"$out/json"
    check dec_json_bytes "$out/json" "\"exports\":[{\"path\":\"$out/no$unknown.ply\"" \
        "\"views\":[{\"path\":\"$out/no$unknown.png\"" "\"file\":\"$out/no$unknown.ted4\""
    "$TED4_BUILD/ted4info" "$out/$odd.ted4" --validate --json >"$out/json"
    check info_json_bytes "$out/json" "\"file\":\"$out/no$unknown.ted4\""
}
# Some file systems accept only names in UTF-8.
if (: >"$out/$odd.ted4") 2>/dev/null; then odd_files; else
    skip odd_files "no file here can be called that"
fi

# A video whose frames take time: an ffmpeg that makes one picture in a second and a half. If
# TYPESCRIPT names a file, it makes no second one before "1 frame" is there, within a minute.
mkdir "$out/bin" "$out/clips"
cat >"$out/bin/ffmpeg" <<'EOF'
#!/bin/sh
for i in 1 2 3; do
    sleep 1.5; cp "$PICTURE" 00000$i.png
    n=0
    while [ $i -eq 1 ] && [ -n "${TYPESCRIPT-}" ] && [ $n -lt 600 ] &&
        ! grep -qs '1 frame' "$TYPESCRIPT"; do sleep 0.1; n=$((n + 1)); done
done
EOF
chmod +x "$out/bin/ffmpeg"
PICTURE=$(find "$out/scene" -name '*.png' | sort | head -n 1)
export PICTURE
printf '\000\000\000\030ftypmp42' >"$out/clips/a.mp4"
echo '{"frames": 3, "cameras": [{"name": "a", "w": 32, "h": 24,
    "K": [[30, 0, 16], [0, 30, 12], [0, 0, 1]],
    "w2c": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 4], [0, 0, 0, 1]]}]}' >"$out/clips/cams.json"

# Through a pipe: what was printed while the video was unpacked, and what by the end.
rm -f "$out/err" "$out/status"
(PATH=$out/bin:$PATH "$enc" "$out/clips" --check >/dev/null 2>"$out/err"; echo $? >"$out/status") &
i=0
while [ $i -lt 600 ] && ! grep -qs loading "$out/err" && [ ! -e "$out/status" ]; do
    sleep 0.1; i=$((i + 1))
done
cp "$out/err" "$out/first"
if [ -e "$out/status" ]; then fail early "said at the end only"; else ok early; fi
wait
check first_word "$out/first" "ted4enc: loading $out/clips"
equal checked "$(cat "$out/status")" 0
check unpacking "$out/err" "ted4enc: unpacking a.mp4: "
if script -qec true /dev/null >/dev/null 2>&1 </dev/null; then
    rm -rf "$out/cache/ted4"
    PATH=$out/bin:$PATH TYPESCRIPT=$out/typescript \
        script -qefc "'$enc' '$out/clips' --check" "$out/typescript" >/dev/null 2>&1 </dev/null
    check terminal "$out/typescript" "ted4enc: loading $out/clips" "unpacking a.mp4: 1 frame"
else
    skip terminal "there is no program script, or no terminal for it"
fi

"$enc" "$out/scene" -o "$out/x.ted4" $small -v --checkpoint "$out/c" 2>"$out/err" ||
    fail encode "$(cat "$out/err")"
check says "$out/err" \
    "ted4enc: D-NeRF: 20 training pictures, 4 held out, of 6 cameras and 4 times, 32 x 24 pixels" \
    " until the file is written" \
    "ted4enc: 250/400 stage 1  loss " "ted4enc: 400/400 stage 2i  loss " "ted4enc: $out/x.ted4: "
# The last line agrees with the file.
last=$(grep '^ted4enc: 400/400' "$out/err")
equal bytes "$(echo "$last" | sed 's/.* bytes \([0-9]*\) .*/\1/')" \
    "$(wc -c <"$out/x.ted4" | tr -d ' ')"
psnr=$("$TED4_BUILD/ted4eval" "$out/x.ted4" "$out/scene" 2>/dev/null |
    sed -n 's/^psnr *\([0-9.]*\) dB/\1/p')
echo "$last" | sed 's/.* psnr \([0-9.]*\) .*/\1/' |
    awk -v want="$psnr" '{ exit !(want > 5 && $1 - want < 0.5 && want - $1 < 0.5) }' && ok psnr ||
    fail psnr "$last; $psnr"

"$enc" "$out/scene" -o "$out/x.ted4" -f $small --checkpoint "$out/c" --resume 2>"$out/err"
check resumed "$out/err" "ted4enc: $out/c: going on from step 400 of 400"
"$enc" "$out/scene" -o "$out/x.ted4" -f $small --checkpoint "$out/d" --resume 2>"$out/err"
check no_checkpoint "$out/err" "ted4enc: $out/d: not there yet; beginning at step 0"
"$enc" "$out/scene" -o "$out/x.ted4" -f $small -q 2>"$out/err"
equal quiet "$(wc -c <"$out/err" | tr -d ' ')" 0

# ted4eval reports what it does, and refuses files that do not belong together.
expect eval 0 "ted4eval: comparing $out/x.ted4 with $out/scene" "$TED4_BUILD/ted4eval" \
    "$out/x.ted4" "$out/scene"
"$TED4_BUILD/ted4scene" pop -o "$out/longer" --size 32x24 --frames 5 --cameras 5 --test-cameras 1 \
    -j 1 2>/dev/null
expect eval_other 3 "x.ted4: cannot be of $out/longer: 4 times in the file, 5 in the scene" \
    "$TED4_BUILD/ted4eval" "$out/x.ted4" "$out/longer" -q
expect eval_anyway 0 'psnr ' "$TED4_BUILD/ted4eval" "$out/x.ted4" "$out/longer" --anyway
# Pictures alone do not distinguish another scene from too short a training.
"$enc" "$out/scene" -o "$out/young.ted4" $small --iterations 1,1 -q
expect eval_young 3 "young.ted4: may not be of $out/scene, or is hardly trained: its pictures are " \
    "$TED4_BUILD/ted4eval" "$out/young.ted4" "$out/scene" -q
expect eval_young_anyway 0 'psnr ' "$TED4_BUILD/ted4eval" "$out/young.ted4" "$out/scene" --anyway
expect eval_first_times 0 'psnr ' "$TED4_BUILD/ted4eval" "$out/x.ted4" "$out/longer" --max-frames 4

# A file that lists its cameras tells that the pictures of its training had another size.
"$enc" "$out/scene" -o "$out/listed.ted4" $small --checkpoint "$out/c" --resume --cameras -q
# size NAME WARNINGS ARGUMENT...: ted4eval says so many times that the sizes differ.
size() {
    name=$1 warnings=$2; shift 2
    "$TED4_BUILD/ted4eval" "$@" --anyway -q >"$out/text" 2>"$out/err"
    equal "$name" "$? $(grep -c '^psnr ' "$out/text") $(grep -c '' "$out/err")" "0 1 $warnings"
}
size eval_size 0 "$out/listed.ted4" "$out/scene"
size eval_other_size 1 "$out/listed.ted4" "$out/scene" --downscale 2
check eval_warns "$out/err" "ted4eval: warning: these pictures have 16x12 pixels, those of its \
training 32x24: give --downscale as the training did, or --trained-downscale"
size eval_trained 0 "$out/listed.ted4" "$out/scene" --downscale 2 --trained-downscale 1
size eval_unlisted 0 "$out/x.ted4" "$out/scene" --downscale 2

# A single one is not in the plural.
"$TED4_BUILD/ted4scene" still -o "$out/one" --layout calibration --size 32x24 --frames 1 \
    --cameras 1 --test-cameras 0 -j 1 2>/dev/null
"$enc" "$out/one" --check 2>"$out/err" >/dev/null
check one_picture "$out/err" ": 1 training picture, 0 held out, of 1 camera and 1 time, "
one=conformance/vectors/worked/WRK-annex-b1.ted4
expect one_anchor 0 ": valid, 317 bytes, 1 anchor, 1 Gaussian, 1 frame; " \
    "$TED4_BUILD/ted4dec" $one --test
expect one_exported 0 ": 0 of 1 Gaussian, " "$TED4_BUILD/ted4dec" $one -o "$out/one.ply" -v

# If nothing is held out, the line says that its pictures were trained on.
"$TED4_BUILD/ted4scene" pop -o "$out/all" --layout calibration --size 32x24 --frames 4 --cameras 5 \
    --test-cameras 0 -j 1 2>/dev/null
"$enc" "$out/all" -o "$out/x.ted4" -f $small -v 2>"$out/err"
check train_psnr "$out/err" ", 0 held out, " "  train psnr "
exit $bad
