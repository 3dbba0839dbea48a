#!/bin/sh
# test_edit_program.sh - ted4edit and the options of ted4enc that describe a scene: the chunks are
# in the file, ted4info shows them, the scene stays the same, and errors are refused with one line,
# before anything is written. Prints lines as a cmocka program does; run by `make test` from the
# project's root.
# SPDX-License-Identifier: BSD-2-Clause
set -u
. tests/support/speak.sh
need edit_program python3 ted4enc ted4eval ted4dec ted4info ted4edit ted4scene
equal() { if [ "$2" = "$3" ]; then ok "$1"; else fail "$1" "$2, expected $3"; fi; }
info() { "$TED4_BUILD/ted4info" "$out/$1.ted4"; }
hash_of() { info "$1" | sed -n 's/^hash *//p'; }
edit() { "$TED4_BUILD/ted4edit" "$@" 2>"$out/err" || fail edit "$(cat "$out/err")"; }

"$TED4_BUILD/ted4scene" pop -o "$out/scene" --size 32x24 --frames 4 --cameras 5 --test-cameras 1 \
    -j 1 2>/dev/null
encode() { name=$1; shift; "$TED4_BUILD/ted4enc" "$out/scene" -o "$out/$name.ted4" --preset draft \
    --iterations 40,40 --capacity fixed --seed 1 -j 1 -q "$@" 2>"$out/err" ||
    fail "$name" "$(cat "$out/err")"; }

encode plain
encode all --title 'A pop' --author 'Somebody' --licence CC0-1.0 --cameras --thumbnail
equal plain_says_nothing "$(info plain | grep -c '^chunk\|^title')" 0
equal same_scene "$(hash_of all)" "$(hash_of plain)"
equal texts "$(info all | grep -c '^title=A pop$\|^author=Somebody$\|^licence=CC0-1.0$')" 3
equal cameras "$(info all | grep -c 'CAMS, 420 bytes: 5 cameras, up 0 0 1$')" 1
equal thumbnail "$(info all | grep -c 'THMB, [0-9]* bytes$')" 1
equal valid "$("$TED4_BUILD/ted4info" "$out/all.ted4" --validate |
    grep -c 'adv.chunk\|adv.meta\|adv.minor')" 0
equal json "$("$TED4_BUILD/ted4info" "$out/all.ted4" --json | grep -o '"type":"[A-Z]*"' |
    tr -d '\n')" '"type":"META""type":"CAMS""type":"THMB"'
encode again --title 'A pop' --author 'Somebody' --licence CC0-1.0 --cameras --thumbnail
cmp -s "$out/all.ted4" "$out/again.ted4" && ok deterministic || fail deterministic differ

# Each camera of "turns" has one picture, at a time of its own: what the file lists has it as well.
equal times_of_still "$("$TED4_BUILD/ted4info" "$out/all.ted4" --cameras | grep -c '"time"')" 0
"$TED4_BUILD/ted4scene" toys -o "$out/turns" --turns --cameras 6 --test-cameras 0 --size 32x24 \
    -j 1 2>/dev/null
"$TED4_BUILD/ted4enc" "$out/turns" -o "$out/turns.ted4" --preset draft --iterations 40,20 --seed 1 \
    --capacity fixed --cameras -j 1 -q || fail encode_turns "no file"
"$TED4_BUILD/ted4dec" "$out/turns.ted4" --render "$out/taken%d.png" --camera file -q
"$TED4_BUILD/ted4eval" "$out/turns.ted4" "$out/turns" --split train --images "$out/turns.pictures" \
    --anyway -q >"$out/err" 2>&1 || fail eval_turns "$(cat "$out/err")"
n=0
for picture in "$out/turns.pictures/ours"/*.png; do
    cmp -s "$picture" "$out/taken$n.png" && n=$((n + 1))
done
equal times_of_moving "$n" "$("$TED4_BUILD/ted4info" "$out/turns.ted4" --cameras |
    grep -c '"time"')"
[ $n -gt 2 ] && ok pictures_of_moving || fail pictures_of_moving "$n"

# Stripped down to the last byte, and set again.
edit "$out/all.ted4" -o "$out/bare.ted4" --strip all
cmp -s "$out/plain.ted4" "$out/bare.ted4" && ok stripped || fail stripped differ
edit "$out/all.ted4" -o "$out/some.ted4" --strip THMB --title 'Another' --author '' --up 0,-2,0
equal replaced "$(info some | grep -c '^title=Another$\|^author=\|THMB\|5 cameras, up 0 -1 0$')" 2
edit "$out/some.ted4" -o "$out/axis.ted4" --up -x
equal up_axis "$(info axis | grep -c '5 cameras, up -1 0 0$')" 1
equal edited_scene "$(hash_of some)" "$(hash_of plain)"
cat >"$out/path.json" <<END
[{"width":32,"height":24,"fx":30,"fy":30,"cx":16,"cy":12,"R":[1,0,0,0,1,0,0,0,1],"t":[0,0,4],
  "frame":3},
 {"width":32,"height":24,"fx":30,"fy":30,"cx":16,"cy":12,"R":[1,0,0,0,1,0,0,0,1],"t":[0,0,5],
  "time":"1/3"}]
END
"$TED4_BUILD/ted4dec" "$out/plain.ted4" --render "$out/view%d.png" --camera "$out/path.json" \
    2>/dev/null
edit "$out/all.ted4" -o "$out/path.ted4" --path "$out/path.json" --thumbnail "$out/view0.png"
equal path "$(info path | grep -c 'CAMS, 180 bytes: 2 cameras of a path, up 0 0 1$')" 1
{ sed -n 1p "$out/path.json"; echo '  "frame":3}]'; } >"$out/single.json"
edit "$out/plain.ted4" -o "$out/single.ted4" --path "$out/single.json" --cameras "$out/single.json"
equal single "$(info single | grep -c ': 1 camera, up unknown$\|: 1 camera of a path, up unknown$')" 2
equal both_kinds "$(info path | grep -c 'CAMS')" 2
edit "$out/path.ted4" -o "$out/path.ted4" -f --strip CAMS
equal in_place "$(info path | grep -c 'CAMS')" 0

# Of two chunks with cameras the last one counts (16.4), also once --up has changed it.
edit "$out/plain.ted4" -o "$out/two.ted4" --cameras "$out/path.json"
python3 - "$out/all.ted4" "$out/two.ted4" "$out/doubled.ted4" <<'END'
import struct, sys
def chunks(file):
    at = 12
    while at < len(file):
        end = at + 20 + struct.unpack("<I", file[at + 8:at + 12])[0]
        yield file[at:end]
        at = end
first, second = (open(name, "rb").read() for name in sys.argv[1:3])
cams, = (c for c in chunks(second) if c[:4] == b"CAMS")
*body, end = chunks(first)
open(sys.argv[3], "wb").write(first[:12] + b"".join(body) + cams + end)
END
count() { "$TED4_BUILD/ted4info" "$out/$1.ted4" --cameras | grep -c width; }
equal last_counts "$(count doubled)" 2
edit "$out/doubled.ted4" -o "$out/up.ted4" --up 0,-1,0
equal last_counts_with_up "$(count up) $(info up | grep -c 'CAMS.*2 cameras, up 0 -1 0$')" "2 1"

# What --lenient recovers of a file does not come from a chunk of cameras that is damaged.
python3 - "$out/all.ted4" "$out/spoilt.ted4" <<'END'
import sys
file = bytearray(open(sys.argv[1], "rb").read())
file[file.index(b"CAMS") + 40] ^= 1
open(sys.argv[2], "wb").write(file)
END
spoilt() { expect "$@"; rm -f "$out/spoilt.ply"; }
set -- "$TED4_BUILD/ted4dec" "$out/spoilt.ted4" --lenient -o "$out/spoilt.ply" --time 0
spoilt spoilt_widen 3 '--widen needs the cameras that took the pictures' "$@" --widen
spoilt spoilt_auto 3 '--up auto: the file does not say which way is up' "$@" --up auto
spoilt spoilt_up 2 'incomplete: tiles 0 to' "$@" --up y

# One clear line each, and no output.
refuse() { expect "$1" 3 "$2" "$TED4_BUILD/ted4edit" "$out/plain.ted4" -o "$out/no.ted4" $3 "$4"
    [ -e "$out/no.ted4" ] && fail "$1" 'an output'; rm -f "$out/no.ted4"; }
refuse no_key 'ted4edit: --set: expected KEY=VALUE' --set title
refuse two_lines 'ted4edit: --title: expected a text of one line' --title 'a
b'
refuse no_utf8 'ted4edit: --title: expected a text of one line, in UTF-8' --title \
    "$(printf 'caf\351')"
refuse no_text 'ted4edit: --set: expected KEY=VALUE, one line in UTF-8' --set "$(printf 'a=b\tc')"
refuse no_date 'ted4edit: --created: expected a date, as 2026-11-24 or ' --created yesterday
refuse no_date_set 'ted4edit: --set: expected a date, as 2026-11-24 or ' --set created=2026-02-29
expect date 0 'the scene is the same' "$TED4_BUILD/ted4edit" "$out/plain.ted4" \
    -o "$out/dated.ted4" --created 2026-11-24T12:00:00Z --title "$(printf 'A t\303\251st')"
equal dated_valid "$("$TED4_BUILD/ted4info" "$out/dated.ted4" --validate | grep -c 'adv.meta')" 0
expect enc_utf8 3 'expected a text of one line, at most 1000 bytes of UTF-8' "$TED4_BUILD/ted4enc" \
    "$out/scene" --check --title "$(printf 'caf\351')"
refuse strip_scene 'ted4edit: --strip: the scene is made of chunks HEAD' --strip HEAD
refuse strip_no_type 'ted4edit: --strip: expected META, CAMS, THMB, another type, or all' \
    --strip 'ME-A'
expect strip_nothing 0 "ted4edit: note: $out/all.ted4: no chunk to strip: meta" \
    "$TED4_BUILD/ted4edit" "$out/all.ted4" -o "$out/kept.ted4" --strip meta
expect strip_none 0 "ted4edit: note: $out/plain.ted4: no chunk to strip" \
    "$TED4_BUILD/ted4edit" "$out/plain.ted4" -o "$out/kept.ted4" -f --strip all
refuse no_direction 'ted4edit: --up: expected an axis, as z, or a direction X,Y,Z' --up 0,0,0
refuse no_png "ted4edit: $out/path.json: expected a PNG file of at most 1024 x 1024 pixels" \
    --thumbnail "$out/path.json"
head -c 60 "$out/view0.png" >"$out/short.png"
refuse short_png "ted4edit: $out/short.png: a PNG file that is cut short or damaged" \
    --thumbnail "$out/short.png"
refuse no_list 'ted4edit: ' --cameras "$out/view0.png"
sed 's/"frame":3/"frame":4/' "$out/path.json" >"$out/late.json"
refuse late_frame "ted4edit: $out/late.json: camera 0: frame 4, but the scene has 4" \
    --cameras "$out/late.json"
sed 's/0,0,0,1\]/0,0,0,-1]/' "$out/path.json" >"$out/mirror.json"
refuse mirror "ted4edit: $out/mirror.json: camera 0 has an R that is a mirror image" \
    --cameras "$out/mirror.json"
sed 's/"fx"/"pixel":2,"fx"/' "$out/path.json" >"$out/pixel.json"
expect no_pixel 0 "ted4edit: warning: $out/pixel.json: the member pixel is left out" \
    "$TED4_BUILD/ted4edit" "$out/plain.ted4" -o "$out/pixel.ted4" --path "$out/pixel.json"
expect exists 3 "ted4edit: $out/some.ted4: exists; -f overwrites" "$TED4_BUILD/ted4edit" \
    "$out/plain.ted4" -o "$out/some.ted4"
head -c 1000 "$out/plain.ted4" >"$out/cut.ted4"
expect cut 1 "ted4edit: $out/cut.ted4: byte " "$TED4_BUILD/ted4edit" "$out/cut.ted4" -o \
    "$out/no.ted4"
exit $bad
