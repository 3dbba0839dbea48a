#!/bin/sh
# test_own_video.sh - tools/own-video.sh: a video of a moving camera, and clips of cameras that
# stand still, each give a SCENE with the lens and the poses with which the footage was made; wrong
# arguments give one clear error. Prints lines as a cmocka program does; run by `make test` from the
# project's root.
# SPDX-License-Identifier: BSD-2-Clause
set -u
export LC_ALL=C
. tests/support/speak.sh
need own_video ted4enc ted4scene
sh=$(command -v sh)

# refuse NAME TEXT COMMAND...: the exit status is 3, and the only line printed contains that text.
refuse() {
    expect "$@"
    [ "$(grep -c '' "$out/said")" = 1 ] || fail "$1" "not one line: $(cat "$out/said")"
}
mkdir "$out/none" "$out/full"
echo "no video" >"$out/text.mp4"
echo here >"$out/full/file"
refuse usage 3 "usage: own-video.sh FOLDER VIDEO" sh tools/own-video.sh "$out/s"
refuse line_break 3 "a name has a line break, a tab or the like" \
    sh tools/own-video.sh "$(printf '%s/a\nb' "$out")" "$out/text.mp4"
refuse no_tools 3 "there is no program ffmpeg (Debian:" env PATH="$out/none" "$sh" \
    tools/own-video.sh "$out/s" "$out/text.mp4"
# Every digit of COLMAP's numbers is kept; this pose has no rotation.
f=330.11249999999995 k=-0.012345678901234567 x=0.12345678901234568
echo "a.png	a.mp4" >"$out/list"
echo "1 SIMPLE_RADIAL 320 240 $f 160 120 $k" >"$out/cameras.txt"
printf '1 1 0 0 0 %s 2 3 1 a.png\n\n' "$x" >"$out/images.txt"
awk -v rate=30 -f tools/cams.awk "$out/list" "$out/cameras.txt" "$out/images.txt" >"$out/exact"
check digits "$out/exact" "[[$f, 0, 159.5], [0, $f, 119.5], [0, 0, 1]]" "\"dist\": [$k, 0, 0, 0]" \
    "[1, 0, 0, $x]"
# Names reach the JSON unchanged, whichever awk is installed.
printf 'a"\\b.png\ta"\\b.mp4\n' >"$out/list"
printf '1 1 0 0 0 0 2 3 1 a"\\b.png\n\n' >"$out/images.txt"
for awk in awk mawk gawk; do
    command -v $awk >/dev/null || continue
    $awk -v rate=30 -f tools/cams.awk "$out/list" "$out/cameras.txt" "$out/images.txt" >"$out/named"
    check named_$awk "$out/named" '"name": "a\"\\b", "video": "a\"\\b.mp4"'
done

# Names that the tools would take for something else, with tools that only seem to work.
mkdir "$out/seem" "$out/here"
cat >"$out/seem/ffmpeg" <<'END'
#!/bin/sh
for v; do
    case $last$v in -i-* | -i*:*) case $v in */*) ;; *) exit 1 ;; esac ;; esac
    last=$v
done
: >"$v"
END
cat >"$out/seem/ffprobe" <<'END'
#!/bin/sh
for v; do :; done
[ -e "$v.rate" ] && exec cat "$v.rate"
rate=${RATE-25/2}
[ -z "$rate" ] || printf 'r_frame_rate=%s\navg_frame_rate=%s\n' "$rate" "$rate"
END
cat >"$out/seem/colmap" <<'END'
#!/bin/sh
command=$1
for v; do
    case $last in --output_path) to=$v ;; esac
    last=$v
done
case $command in
mapper) mkdir "$to/0"; printf '\003\0\0\0' >"$to/0/images.bin" ;;
model_converter)
    echo 1 SIMPLE_RADIAL 320 240 330 160 120 0 >"$to/cameras.txt" 2>/dev/null
    for p in "$to/../images"/*; do printf '1 1 0 0 0 0 2 3 1 %s\n\n' "${p##*/}"; done \
        >"$to/images.txt" 2>/dev/null ;;
esac
exit 0
END
chmod +x "$out/seem"/*
: >"$out/here/-a.mp4"; : >"$out/here/12:30.mp4"; : >"$out/here/b\\tc.mp4"
odd() { name=$1 status=$2 text=$3; shift 3
    expect "$name" "$status" "$text" env PATH="$out/seem:$PATH" "$sh" -c 'cd "$0/here" && "$@"' \
        "$out" "$@"; }
odd odd_names 0 'x=1 is a SCENE' "$sh" "$PWD/tools/own-video.sh" x=1 -a.mp4 12:30.mp4 'b\tc.mp4'
check odd_cameras "$out/here/x=1/cams.json" '"fps": 12.5,' '{"name": "-a", "video": "-a.mp4", ' \
    '{"name": "12:30", "video": "12:30.mp4", ' '{"name": "b\\tc", "video": "b\\tc.mp4", '
for r in 0/0 N/A ''; do
    odd no_rate 3 '12:30.mp4: no frame rate' env RATE="$r" "$sh" "$PWD/tools/own-video.sh" y \
        12:30.mp4 -a.mp4
    rm -rf "$out/here/y"
done
# Names without an extension, in a folder with a full stop; a shell can read the last line.
mkdir "$out/here/my.v"
for v in a b c a.mp4; do : >"$out/here/my.v/$v"; done
odd bare_names 0 "./it's ü is a SCENE: ted4enc --check './it'\\''s ü'" "$sh" \
    "$PWD/tools/own-video.sh" "it's ü" my.v/a my.v/b my.v/c
check bare_cameras "$out/here/it's ü/cams.json" '{"name": "a", "video": "a", ' \
    '{"name": "b", "video": "b", ' '{"name": "c", "video": "c", '
odd bare_twice 3 './my.v/a.mp4: another clip is called a, too' "$sh" "$PWD/tools/own-video.sh" z \
    my.v/a my.v/a.mp4

# rates NAME WARNING RATES...: clips whose lowest common and mean rates are these give that
# warning before COLMAP begins, or none if it is empty.
rates() {
    told=$1 warns=$2 i=0; shift 2
    rm -rf "$out/here/rated"; mkdir "$out/here/rated"
    for r; do
        shift; set -- "$@" "rated/$i.mp4"
        : >"$out/here/rated/$i.mp4"
        printf 'r_frame_rate=%s\navg_frame_rate=%s\n\n' "${r% *}" "${r#* }" \
            >"$out/here/rated/$i.mp4.rate"
        i=$((i + 1))
    done
    odd "$told" 0 "${warns:-is a SCENE}" "$sh" "$PWD/tools/own-video.sh" rated/s "$@"
    sed '/looking for/,$d' "$out/said" >"$out/early"
    if [ -n "$warns" ]; then
        check "${told}_early" "$out/early" "$warns" "-r 30 NEW.mp4"
    elif [ -s "$out/early" ]; then fail "${told}_silent" "$(cat "$out/early")"
    else ok "${told}_silent"; fi
}
rates same_rates "" '30/1 30/1' '30/1 1200000/40001' '30 30'
rates varies "./rated/1.mp4: its frame rate varies: 16 per second on average, not 30" \
    '30/1 30/1' '30/1 16/1' '30/1 30/1'
rates varies_first "./rated/0.mp4: its frame rate varies: 15 per second on average, not 30" \
    '30/1 15/1' '30/1 30/1'
rates unequal "./rated/1.mp4: 25 frames per second, but ./rated/0.mp4 has 12.5" \
    '25/2 25/2' '25/1 25/1' '25/2 25/2'
rates ntsc "./rated/2.mp4: 29.97 frames per second, but ./rated/0.mp4 has 30" \
    '30/1 30/1' '30/1 30/1' '30000/1001 30000/1001'
for p in ffmpeg ffprobe colmap; do command -v $p >/dev/null ||
    { skip own_video "there is no $p"; exit $bad; }; done
refuse no_file 3 "$out/absent.mp4: no such file" sh tools/own-video.sh "$out/s" "$out/absent.mp4"
refuse not_empty 3 "$out/full: not empty" sh tools/own-video.sh "$out/full" "$out/text.mp4"
refuse no_rate 3 "FPS=0: expected frames per second" env FPS=0 sh tools/own-video.sh "$out/s" \
    "$out/text.mp4"
refuse rate 3 "FPS=fast: expected frames per second" env FPS=fast sh tools/own-video.sh "$out/s" \
    "$out/text.mp4"
if [ -e "$out/s" ]; then fail nothing_made "$out/s"; else ok nothing_made; fi
expect no_video 3 "ffmpeg -i failed: the end of $out/s/log says why" sh tools/own-video.sh \
    "$out/s" "$out/text.mp4"
# Names that look like options, or like protocols of ffmpeg.
mkdir "$out/odd" "$out/odd/-s"
cp "$out/text.mp4" "$out/odd/12:30.mp4"
expect odd_names 3 "ffmpeg -i failed: the end of ./-s/log says why" sh -c \
    'script=$PWD/tools/own-video.sh && cd "$0" && sh "$script" -s 12:30.mp4' "$out/odd"
check odd_read "$out/odd/-s/log" 'Invalid data'

# Footage: 12 positions on an arc, half a second each; five of them also as clips of half a second.
film() { ffmpeg -v error -framerate "$1" -i "$2" -c:v libx264 -threads 1 -crf 14 -pix_fmt yuv420p \
    "$3" </dev/null || fail footage "$3"; }
"$TED4_BUILD/ted4scene" still -o "$out/still" --layout llff --size 320x240 --frames 1 --cameras 24 \
    --test-cameras 0 -j 1 2>/dev/null
mkdir "$out/walk" "$out/clips"
i=0
for c in 00 02 04 06 08 10 12 14 16 18 20 22; do cp "$out/still/images/cam$c.png" \
    "$out/walk/$(printf %02d $i).png"; i=$((i + 1)); done
film 2 "$out/walk/%02d.png" "$out/walk.mp4"
for c in 04 06 08 10 12; do
    mkdir "$out/clip"
    for i in 0 1 2 3 4 5; do cp "$out/still/images/cam$c.png" "$out/clip/$i.png"; done
    film 12.5 "$out/clip/%d.png" "$out/clips/cam $c.mp4"
    mv "$out/clip" "$out/clip$c"
done

# ffprobe sees that the third frame of a clip comes late.
ffmpeg -v error -framerate 30 -i "$out/walk/%02d.png" -vf "setpts=PTS+if(gt(N\,1)\,0.134/TB\,0)" \
    -vsync vfr -c:v libx264 -threads 1 -pix_fmt yuv420p "$out/late.mp4" </dev/null
mv "$out/seem/ffprobe" "$out/absent"
expect late 0 "late.mp4: its frame rate varies: " env PATH="$out/seem:$PATH" \
    sh tools/own-video.sh "$out/later" "$out/late.mp4" "$out/clips/cam 04.mp4"

# looks NAME PICTURES LENSES: the report of --check on the scene, whose focal length equals the
# width of its pictures.
looks() {
    "$TED4_BUILD/ted4enc" --check "$out/$1" >"$out/$1.says" 2>"$out/said" ||
        { fail "$1" "$(cat "$out/said")"; return; }
    check "$1" "$out/$1.says" "$2" "$3"
    awk '$1 == "focal" { split($2, f, "\\.\\."); exit !(f[1] > 300 && $4 < 340) }' \
        "$out/$1.says" && ok "$1_lens" || fail "$1_lens" "$(grep focal "$out/$1.says")"
}
# A clip may be a link.
mv "$out/clips/cam 04.mp4" "$out/elsewhere.mp4"
ln -s ../elsewhere.mp4 "$out/clips/cam 04.mp4"
XDG_CACHE_HOME=$out/cache
export XDG_CACHE_HOME
mkdir "$out/50%"
expect walk_made 0 "12 of 12 pictures have poses" env FPS=2 sh tools/own-video.sh \
    "$out/50%/walked" "$out/walk.mp4"
refuse too_short 3 "$out/walk.mp4: 0 pictures at FPS=0.01" env FPS=0.01 sh tools/own-video.sh \
    "$out/short" "$out/walk.mp4"
looks 50%/walked "11 train, 1 test" "frames      12"
# A clip whose file has a rotation flag gives an empty line after its rate.
mkdir "$out/bin"
printf '#!/bin/sh\n%s "$@"; echo\n' "$(command -v ffprobe)" >"$out/bin/ffprobe"
chmod +x "$out/bin/ffprobe"
# A COLMAP that has the names that newer versions give to the GPU options.
cat >"$out/bin/colmap" <<END
#!/bin/sh
case "\$*" in
*-h) exec $(command -v colmap) "\$@" 2>&1 | sed 's/Sift\(.*use_gpu\)/Feature\1/' ;;
*Sift*use_gpu*) echo "unrecognised option" >&2; exit 1 ;;
esac
for a; do
    shift
    case \$a in --Feature*.use_gpu) a=--Sift\${a#--Feature} ;; esac
    set -- "\$@" "\$a"
done
exec $(command -v colmap) "\$@"
END
chmod +x "$out/bin/colmap"
expect clips_made 0 "5 of 5 pictures have poses" env PATH="$out/bin:$PATH" sh tools/own-video.sh \
    "$out/rig" "$out/clips"/*.mp4
if grep -q warning "$out/said"; then fail no_warning "$(cat "$out/said")"; else ok no_warning; fi
looks rig "25 train, 5 test" "12.5 frames/s"
check in_order "$out/rig/cams.json" '"name": "cam 04", "video": "cam 04.mp4"' ', 0, 159.5], [0, '
# COLMAP's own files, and cams.json made from them, give the same cameras through their loaders.
"$TED4_BUILD/ted4enc" --check "$out/rig/poses" >"$out/poses.says" 2>/dev/null
same() { grep -E "^$1 " "$out/rig.says" >"$out/a"; grep -E "^$1 " "$out/poses.says" |
    cmp -s - "$out/a" && ok "same_$1" ||
    fail "same_$1" "$(cat "$out/a"; grep "^$1" "$out/poses.says")"; }
for what in focal centres points; do same $what; done
refuse twice 3 "another clip is called cam 04, too" sh tools/own-video.sh "$out/twice" \
    "$out/clips/cam 04.mp4" "$out/clips/cam 04.mp4"
expect stands 3 "COLMAP found no poses: did the camera move" env FPS=12.5 sh tools/own-video.sh \
    "$out/stands" "$out/clips/cam 04.mp4"
exit $bad
