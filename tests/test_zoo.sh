#!/bin/sh
# test_zoo.sh - the cases of bench/zoo.txt, made small: all are read; those that differ from another in
# files alone are trained to the same bytes; and some short trainings end well. Speaks as cmocka
# programs do; run by `make test` from the project's root.
# SPDX-License-Identifier: BSD-2-Clause
set -u
. tests/speak.sh
need zoo ted4enc ted4eval ted4scene bench/zoo_masks python3
"$TED4_BUILD/ted4enc" -h | grep -q -e --hold-out || { skip zoo "this ted4enc does not read all of them"; exit 0; }
XDG_CACHE_HOME=$out/cache; export XDG_CACHE_HOME

awk -f bench/expand.awk ref-encoder/train/options.def bench/zoo.txt >"$out/runs" || { fail table "not read"; exit 1; }
awk '$1 == "case" { n++; twin[$2] = $3 }
     END { for (s in twin) if (twin[s] != "-" && !(twin[s] in twin)) { print s ": no twin " twin[s]; bad = 1 }
           if (n < 24) { print n " cases"; bad = 1 } exit bad }' bench/zoo.txt >"$out/said" && ok table || fail table "$(cat "$out/said")"

# made NAME SIZE: the scene of a case, in $out/SIZE/NAME; $reading: the options with which it is read.
made() {
    folder=$out/$2/$1
    where=$(awk -F'|' -v s="$1" '$3 == s { print $4 }' "$out/runs")
    reading=$(awk -F'|' -v s="$1" '$3 == s { print " " $10 }' "$out/runs" | grep -o -E -- ' --(alpha|hold-out|black)( [^- ]+)?' | tr -d '\n')
    [ -d "$folder" ] || "$TED4_BUILD/ted4scene" $(echo "${where#own:}" | sed 's/+/ --/g; s/=/ /g') --size "$2" -o "$folder" -j 2
}

# ---- all are read ----

# Missing pictures are said once, and so are points in empty space, which only a plain background
# tells; the others say nothing.
for name in $(awk -F'|' '{ print $3 }' "$out/runs"); do
    case $name in videos) command -v ffmpeg >/dev/null || { skip "reads_$name" "there is no ffmpeg"; continue; } ;; esac
    made "$name" 24x16 || { fail "reads_$name" "not made"; continue; }
    "$TED4_BUILD/ted4enc" "$folder" $reading --check >"$out/said" 2>&1
    status=$? warnings=$(grep -c 'warning:' "$out/said")
    wanted=0
    case $name in missing | box10 | random | white10 | turns10 | large10) wanted=1 ;; esac
    [ $status = 0 ] && [ "$warnings" = $wanted ] && ok "reads_$name" || fail "reads_$name" "status $status: $(cat "$out/said")"
done

# ---- the same pictures, written in another way ----

# hash_of NAME: of the file that a few steps make.
hash_of() {
    made "$1" 24x16
    "$TED4_BUILD/ted4enc" "$folder" $reading -o "$out/$1.ted4" --preset draft --iterations 30,10 --seed 1 -j 1 -f -q --json 2>&1 |
        sed 's/.*"hash":"\([0-9a-f]*\)".*/\1/'
}

# same NAME LIKE
same() {
    a=$(hash_of "$1") b=$(hash_of "$2")
    [ ${#a} = 32 ] && [ "$a" = "$b" ] && ok "same_$1" || fail "same_$1" "$a, but $2 gives $b"
}

for name in plain ext val; do same $name toys; done
for name in png16 interlaced premult; do same $name clear; done
same k-each room
same hold-clips first
same clear-dark toys
[ "$(hash_of white)" != "$(hash_of toys)" ] && ok differs_white || fail differs_white "white and black give the same"

# ---- short trainings ----

# trained NAME: PSNR of held-out pictures in $psnr, of what moves in training pictures in $moving.
trained() {
    made "$1" 48x32
    "$TED4_BUILD/ted4enc" "$folder" -o "$out/$1.ted4" --preset draft --iterations 1500,400 --seed 1 -j 2 -f -q >"$out/said" 2>&1 ||
        { fail "trains_$1" "status $?: $(cat "$out/said")"; return 1; }
    psnr=$("$TED4_BUILD/ted4eval" "$out/$1.ted4" "$folder" --json -q | sed 's/.*"psnr":\([0-9.]*\).*/\1/')
    "$TED4_BUILD/ted4eval" "$out/$1.ted4" "$folder" --split train -v --images "$out/pictures" -f >"$out/said" 2>"$out/views" &&
        moving=$("$TED4_BUILD/bench/zoo_masks" "$folder" "$out/pictures" <"$out/views" | sed 's/.*"moving_psnr":\([0-9.]*\).*/\1/')
}

# Within how many decibels of the friendly one so short a training is. Ten times as many steps bring
# them within one: bench/zoo.md.
if trained toys; then
    friendly=$psnr
    awk "BEGIN { exit !($psnr > 26 && $moving > 16) }" && ok trains_toys || fail trains_toys "$psnr dB, what moves $moving"
    trained none && { awk "BEGIN { exit !($psnr > $friendly - 4 && $moving > 15) }" && ok trains_none ||
        fail trains_none "$psnr dB, friendly $friendly, what moves $moving"; }
fi

# ---- what moves ----

# Pictures of two pixels, of which the mask holds the second: errors of 3, 4 and 12 there, so a mean square of 169 / 3.
python3 - "$out/hand" <<'END'
import os, struct, sys, zlib
def png(path, kind, row):
    chunk = lambda t, d: struct.pack(">I", len(d)) + t + d + struct.pack(">I", zlib.crc32(t + d))
    os.makedirs(os.path.dirname(path), exist_ok=True)
    head = struct.pack(">IIBBBBB", 2, 1, 8, kind, 0, 0, 0)
    data = chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(b"\0" + bytes(row))) + chunk(b"IEND", b"")
    open(path, "wb").write(b"\x89PNG\r\n\x1a\n" + data)
out = sys.argv[1]
for number in "00000", "00001":
    png(f"{out}/pictures/truth/{number}.png", 2, [1, 2, 3, 100, 100, 100])
    png(f"{out}/pictures/ours/{number}.png", 2, [9, 9, 9, 103, 96, 112])
png(f"{out}/scene/truth/masks/train/b.png", 0, [0, 255])
END
printf '%s\n' "warning: no line of a picture" "$out/hand/scene/train/a.png frame 0: psnr 1" "$out/hand/scene/train/b.png frame 1: psnr 1" >"$out/views"
"$TED4_BUILD/bench/zoo_masks" "$out/hand/scene" "$out/hand/pictures" <"$out/views" >"$out/said" 2>&1
[ "$(cat "$out/said")" = '{"moving_psnr":30.6231,"moving_pixels":1,"pictures":1}' ] && ok masks || fail masks "$(cat "$out/said")"
exit $bad
