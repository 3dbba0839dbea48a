#!/bin/sh
# test_outputs.sh - files that programs write: if they may not grow, no unfinished one stays and the
# message says why; a file that is replaced keeps its mode and the links to it; a full standard
# output is an error, for a help text too. Prints lines as a cmocka program does; run by `make test`
# from the project's root.
# SPDX-License-Identifier: BSD-2-Clause
set -u
export LC_ALL=C
. tests/support/speak.sh
need outputs ted4enc ted4dec ted4edit ted4eval ted4info ted4scene ted4conf ted4tolerance
# equal NAME VALUE WANTED
equal() { if [ "$2" = "$3" ]; then ok "$1"; else fail "$1" "$2, expected $3"; fi; }
bin=$TED4_BUILD
scene=$out/scene
small="--preset draft --iterations 60,40 --capacity fixed --seed 1 -j 1 -q --set init_anchors=150
    --set max_anchors=260 --set offsets=4 --set feature=8 --set phi=4 --set bank_dim=8
    --set deform_width=8 --set head_width=12 --set hyper_width=16 --set ar_width=8 --set slices=2"
"$bin/ted4scene" pop -o "$scene" --size 32x24 --frames 4 --cameras 5 --test-cameras 1 -j 1 \
    2>/dev/null
"$bin/ted4enc" "$scene" -o "$out/a.ted4" $small --cameras --thumbnail || fail encode "no file"
"$bin/ted4enc" "$scene" -o "$out/plain.ted4" $small || fail encode "no file"
mkdir "$out/at"

# ---- a limit of file sizes: 1 KiB ----
# full NAME COMMAND...: in the folder "at", the command says why it fails, and leaves nothing.
full() {
    name=$1; shift
    expect "full_$name" 3 'File too large' sh -c 'cd "$0" && ulimit -f 2 && "$@"' "$out/at" "$@"
    left=$(ls -A "$out/at")
    [ -z "$left" ] && ok "left_$name" || fail "left_$name" "$left"
    rm -rf "$out/at"; mkdir "$out/at"
}
full edit "$bin/ted4edit" "$out/a.ted4" -o b.ted4 --title x
full export "$bin/ted4dec" "$out/a.ted4" -o b%d.ply
full encode "$bin/ted4enc" "$scene" -o b.ted4 $small
full checkpoint "$bin/ted4enc" "$scene" -o b.ted4 $small --checkpoint c
full stage1 "$bin/ted4enc" "$scene" -o b.ted4 $small --stage1 c
full transcode "$bin/ted4enc" --transcode "$out/a.ted4" -o b.ted4
full render "$bin/ted4dec" "$out/a.ted4" --render b.png --orbit 1
if command -v ffmpeg >/dev/null; then
    full video "$bin/ted4dec" "$out/a.ted4" --render b.mp4 --orbit 8
else
    skip full_video "there is no ffmpeg"
fi
full sheet "$bin/ted4eval" "$out/a.ted4" "$scene" --sheet b.png
echo '[{"t":[0,1],"cam":[0,0,0]}]' >"$out/q.json"
# Files before the one that does not fit stay.
for name in images scene contract; do
    case $name in
    images) set -- "$bin/ted4eval" "$out/a.ted4" "$scene" --images b ;;
    scene) set -- "$bin/ted4scene" pop -o b --size 32x24 --frames 2 -j 1 ;;
    contract) set -- "$bin/ted4dec" --ted4-run "$out/a.ted4" --tiers T5 --queries "$out/q.json" \
        --dump . ;;
    esac
    expect "full_$name" 3 'File too large' sh -c 'cd "$0" && ulimit -f 2 && "$@"' "$out/at" "$@"
    find "$out/at" -name '*.tmp' -o -name '*.part' >"$out/said"
    [ -s "$out/said" ] && fail "left_$name" "$(cat "$out/said")" || ok "left_$name"
    rm -rf "$out/at"; mkdir "$out/at"
done

# ---- what is replaced ----
mode() { ls -lL "$1" | cut -c 1-10; }
cp "$out/a.ted4" "$out/at/m.ted4"
chmod 600 "$out/at/m.ted4"
ln -s m.ted4 "$out/at/link.ted4"
(cd "$out/at" && umask 022 && "$bin/ted4edit" m.ted4 -o m.ted4 -f -q --title x)
equal mode "$(mode "$out/at/m.ted4")" -rw-------
(cd "$out/at" && umask 022 && "$bin/ted4edit" m.ted4 -o link.ted4 -f -q --title y)
equal link_stays "$(readlink "$out/at/link.ted4")" m.ted4
equal link_written "$("$bin/ted4info" "$out/at/m.ted4" | grep -c '^title=y$')" 1
equal link_mode "$(mode "$out/at/m.ted4")" -rw-------
chmod 640 "$out/at/m.ted4"
(cd "$out/at" && umask 022 && "$bin/ted4enc" --transcode "$out/a.ted4" -o link.ted4 -f -q)
equal mode_transcode "$(mode "$out/at/m.ted4")" -rw-r-----
ln -s elsewhere/x.ply "$out/at/x.ply"
chmod 600 "$out/at/m.ted4"
# Checkpoints are outputs too, and two runs that share a file do not share its temporary name.
mkdir "$out/at/m.point.part" "$out/at/m.stage1.part"
: >"$out/at/m.point"
chmod 600 "$out/at/m.point"
ln -s m.point "$out/at/link.point"
(cd "$out/at" && umask 022 && "$bin/ted4enc" "$scene" -o n.ted4 $small -f --checkpoint link.point \
    --stage1 m.stage1) || fail checkpoint_replaced "no file"
equal checkpoint_link "$(readlink "$out/at/link.point") $(mode "$out/at/m.point")" \
    "m.point -rw-------"
[ -s "$out/at/m.point" ] && [ -s "$out/at/m.stage1" ] && ok checkpoint_written ||
    fail checkpoint_written "$(ls -l "$out/at")"
rm -r "$out/at/m.point.part" "$out/at/m.stage1.part"
equal checkpoint_left "$(ls -A "$out/at" | grep 'part$')" ""
(cd "$out/at" && ln -s m.raw x.raw && : >m.raw && chmod 600 m.raw &&
    umask 022 && "$bin/ted4dec" "$out/a.ted4" -o x.raw --time 0 -f -q)
equal export_link "$(readlink "$out/at/x.raw") $(mode "$out/at/m.raw")" "m.raw -rw-------"
expect dangling_export 3 "x.ply: exists; -f overwrites" "$bin/ted4dec" "$out/a.ted4" \
    -o "$out/at/x.ply" --time 0
for name in render sheet; do
    case $name in
    render) set -- "$bin/ted4dec" "$out/a.ted4" --render l.png --orbit 1 -f -q ;;
    sheet) set -- "$bin/ted4eval" "$out/a.ted4" "$scene" --sheet l.png -f -q ;;
    esac
    (cd "$out/at" && ln -s m.png l.png && : >m.png && chmod 600 m.png && umask 022 && "$@" \
        >/dev/null)
    equal link_$name "$(readlink "$out/at/l.png") $(mode "$out/at/m.png")" "m.png -rw-------"
    [ -s "$out/at/m.png" ] && ok "written_$name" || fail "written_$name" "empty"
    rm -f "$out/at/l.png" "$out/at/m.png"
done
ln -s elsewhere/x.ted4 "$out/at/x.ted4"
expect dangling_edit 3 "x.ted4: exists; -f overwrites" "$bin/ted4edit" "$out/a.ted4" \
    -o "$out/at/x.ted4" --title x
expect dangling_forced 0 "the scene is the same" "$bin/ted4edit" "$out/a.ted4" \
    -o "$out/at/x.ted4" --title x -f
[ -L "$out/at/x.ted4" ] && fail dangling_replaced "a link" || ok dangling_replaced
ln -s elsewhere/x.png "$out/at/x.png"
expect dangling_sheet 3 "x.png: exists; -f overwrites" "$bin/ted4eval" "$out/a.ted4" "$scene" \
    --sheet "$out/at/x.png"
# A standard input that is closed is no file without bytes.
expect closed_stdin 3 "Bad file descriptor" sh -c '"$0" - <&-' "$bin/ted4info"
# A sheet that cannot be written is told of before pictures are compared; one that would take the
# place of a picture of the same run goes beside it.
expect sheet_nowhere 3 "ted4eval: $out/nowhere/x.png: cannot be written" "$bin/ted4eval" \
    "$out/a.ted4" "$scene" --anyway -v --sheet "$out/nowhere/x.png"
equal sheet_nowhere_first "$(grep -c psnr "$out/said")" 0
mkdir -p "$out/among/truth"
expect sheet_among 3 "png holds the result" "$bin/ted4eval" "$out/a.ted4" "$scene" \
    --anyway --images "$out/among" --sheet "$out/among/truth/00000.png"
equal sheet_beside "$(find "$out/among/truth" -name '00000.*.png' | wc -l)" 1

# ---- a pipe, or a device, is neither replaced nor written ----
mkfifo "$out/at/pipe"
for p in b.ted4 b.ply b.png b.point; do ln -s pipe "$out/at/$p"; done
# special NAME COMMAND...: in the folder "at", the command says why it fails, and leaves the pipe.
special() {
    name=$1; shift
    expect "special_$name" 3 "$says" sh -c 'cd "$0" && "$@"' "$out/at" "$@"
    [ -p "$out/at/pipe" ] && ok "stays_$name" || fail "stays_$name" "no pipe"
}
says="Operation not supported"
special export "$bin/ted4dec" "$out/a.ted4" -o b.ply --time 0 -f
special render "$bin/ted4dec" "$out/a.ted4" --render b.png --orbit 1 -f
says="is a pipe or a device, expected a file name"
special sheet "$bin/ted4eval" "$out/a.ted4" "$scene" --sheet b.png -f
special edit "$bin/ted4edit" "$out/a.ted4" -o b.ted4 -f --title x
special encode "$bin/ted4enc" "$scene" -o b.ted4 $small -f
special checkpoint "$bin/ted4enc" "$scene" -o c.ted4 $small -f --checkpoint b.point
rm -rf "$out/at"; mkdir "$out/at"

# ---- a file that appears during a training stays, and so does the training's ----
# The training waits until somebody reads its log.
mkfifo "$out/at/log"
"$bin/ted4enc" "$scene" -o "$out/at/b.ted4" $small --log "$out/at/log" --json >"$out/json" \
    2>"$out/err" &
encoder=$!
exec 3<"$out/at/log"
echo theirs >"$out/at/b.ted4"
cat <&3 >/dev/null
exec 3<&-
wait $encoder
equal appeared "$?" 3
equal appeared_stays "$(cat "$out/at/b.ted4")" theirs
equal appeared_kept "$(ls "$out/at")" "b.$encoder.ted4
b.ted4
log"
cmp -s "$out/at/b.$encoder.ted4" "$out/plain.ted4" && ok appeared_same || fail appeared_same differs
check appeared_says "$out/err" "ted4enc: $out/at/b.$encoder.ted4 holds the result: $out/at/b.ted4 "
check appeared_json "$out/json" "{\"error\":\"$out/at/b.$encoder.ted4 holds the result: "
rm -rf "$out/at"; mkdir "$out/at"

# Nothing is drawn before it is known that all pictures can be written.
mkdir -p "$out/images/error"
: >"$out/images/error/00001.png"
expect images 3 "00001.png: exists; -f overwrites" "$bin/ted4eval" "$out/a.ted4" "$scene" --images \
    "$out/images"
equal images_first "$(find "$out/images" -name '*.png' | wc -l | tr -d ' ')" 1

# ---- a signal while a large picture is written: it is whole, or gone ----
cat >"$out/large.json" <<E
[{"width":3000,"height":3000,"fx":3000,"fy":3000,"cx":1500,"cy":1500,
  "R":[1,0,0,0,1,0,0,0,1],"t":[0,0,5],"time":0}]
E
mkdir "$out/ended"
"$bin/ted4dec" "$out/a.ted4" --render "$out/ended/x.png" --camera "$out/large.json" -q -j 1 &
while [ -z "$(ls -A "$out/ended")" ] && kill -0 $! 2>/dev/null; do :; done
kill $! 2>/dev/null
wait $!
equal ended_status $? 143
equal ended_render "$(ls -A "$out/ended" | grep -v '^x\.png$')" ""

# ---- a name that is too long ----
long=$(awk 'BEGIN { for (i = 0; i < 4200; i++) printf "n" }')
expect long_export 3 "File name too long" "$bin/ted4dec" "$out/a.ted4" -o "$long%d.ply" -f -q

# ---- "-", which does not mean standard output here ----
at() { (cd "$out/at" && "$@"); }
expect dash_images 3 \
    "ted4eval: --images: bad value -; expected a folder name (./- names such a folder)" \
    at "$bin/ted4eval" "$out/a.ted4" "$scene" --images -
expect dash_sheet 3 "ted4eval: -: --sheet writes .png only" \
    at "$bin/ted4eval" "$out/a.ted4" "$scene" --sheet -
expect dash_edit 3 "expected a file name that ends in .ted4" at "$bin/ted4edit" \
    "$out/a.ted4" -o -
equal dash "$(ls -A "$out/at")" ""

# ---- standard output ----
if [ -e /dev/full ]; then
    for p in ted4enc ted4dec ted4info ted4edit ted4eval ted4scene ted4conf ted4tolerance; do
        for o in --help --version; do
            "$bin/$p" $o >/dev/full 2>"$out/err"
            status=$?
            equal "stdout_$p$o" "$status $(cat "$out/err")" \
                "3 $p: standard output: No space left on device"
        done
    done
    for f in ply splat glb raw; do
        "$bin/ted4dec" "$out/a.ted4" -o - --format $f --time 0.5 -q >/dev/full 2>"$out/err"
        status=$?
        equal "stdout_$f" "$status $(cat "$out/err")" \
            "3 ted4dec: standard output: No space left on device"
    done
else
    skip stdout "there is no /dev/full"
fi
exit $bad
