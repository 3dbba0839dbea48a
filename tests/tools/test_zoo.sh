#!/bin/sh
# test_zoo.sh - the cases of bench/zoo.txt, made small: all can be read; cases that differ from
# another one only in their files are trained to the same bytes; and some short trainings succeed.
# Prints lines as a cmocka program does; run by `make test` from the project's root.
# SPDX-License-Identifier: BSD-2-Clause
set -u
. tests/support/speak.sh
need zoo ted4enc ted4eval ted4scene bench/zoo_masks python3
XDG_CACHE_HOME=$out/cache; export XDG_CACHE_HOME

python3 -m bench.pages runs bench/zoo.txt >"$out/all" || { fail table "not read"; exit 1; }
grep '^zoo|' "$out/all" >"$out/runs"
awk '$1 == "case" { n++; twin[$2] = $3 }
     END {
         for (s in twin)
             if (twin[s] != "-" && !(twin[s] in twin)) { print s ": no twin " twin[s]; bad = 1 }
         if (n < 24) { print n " cases"; bad = 1 }
         exit bad
     }' bench/zoo.txt >"$out/said" && ok table || fail table "$(cat "$out/said")"

# made NAME SIZE OPTIONS: makes the scene of a case in $out/SIZE/NAME; sets $reading, the options
# for reading it.
made() {
    folder=$out/$2/$1
    where=$(awk -F'|' -v s="$1" '$3 == s { print $4 }' "$out/runs")
    reading=$(awk -F'|' -v s="$1" '$3 == s { print " " $10 }' "$out/runs" |
        grep -o -E -- ' --(alpha|hold-out|black)( [^- ]+)?' | tr -d '\n')
    shift
    [ -d "$folder" ] || "$TED4_BUILD/ted4scene" $(echo "${where#own:}" |
        sed 's/+/ --/g; s/=/ /g') --size "$@" -o "$folder" -j 2
}

# ---- all are read ----

tiny="24x16 --cameras 5 --test-cameras 1"

# Each case gives the warning that it should, and no other. The search for points takes seconds, so
# the cases that need it and are read like others are left out.
for name in $(awk -F'|' '{ print $3 }' "$out/runs"); do
    case $name in random|white10|large10|turns10|room-box10|*-none) continue ;; esac
    if [ "$name" = videos ] && ! command -v ffmpeg >/dev/null; then
        skip "reads_$name" "there is no ffmpeg"
        continue
    fi
    made "$name" $tiny || { fail "reads_$name" "not made"; continue; }
    case $where in
    *missing*)                       due='entries have no picture' ;;
    *points=box10*|*points=random*)  due='initial points do not lie on' ;;
    *)                               due= ;;
    esac
    "$TED4_BUILD/ted4enc" "$folder" $reading --check >"$out/said" 2>&1
    status=$?
    others=$(grep 'warning:' "$out/said" | grep -v -e "${due:-nothing is due}")
    if [ $status = 0 ] && [ -z "$others" ]; then ok "reads_$name";
        else fail "reads_$name" "status $status: $(cat "$out/said")"; fi
    if [ "$name" = missing ] &&
        ! grep -q '^ted4enc: warning: 17 of 96 ' "$out/said"; then fail counts_missing \
        "$(cat "$out/said")"; fi
done

# ---- the same pictures, written differently ----

# hash_of NAME: prints the hash of the file after a few training steps.
hash_of() {
    made "$1" $tiny
    "$TED4_BUILD/ted4enc" "$folder" $reading -o "$out/$1.ted4" --preset draft --iterations 30,10 \
        --seed 1 -j 1 -f -q --json 2>&1 |
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
a=$(hash_of white) b=$(hash_of toys)
[ ${#a} = 32 ] && [ ${#b} = 32 ] && [ "$a" != "$b" ] && ok differs_white ||
    fail differs_white "white gives $a, black $b"

# ---- short trainings ----

# trained NAME: sets $psnr, the PSNR of training pictures, and $moving, that of the moving part.
trained() {
    made "$1" 48x32
    "$TED4_BUILD/ted4enc" "$folder" -o "$out/$1.ted4" --preset draft --iterations 1500,400 \
        --seed 1 -j 2 -f -q >"$out/said" 2>&1 ||
        { fail "trains_$1" "status $?: $(cat "$out/said")"; return 1; }
    psnr=$("$TED4_BUILD/ted4eval" "$out/$1.ted4" "$folder" --split train \
        -v --json --images "$out/pictures" -f 2>"$out/views" |
        sed 's/.*"psnr":\([0-9.]*\).*/\1/')
    moving=$("$TED4_BUILD/bench/zoo_masks" "$folder" "$out/pictures" <"$out/views" |
        sed 's/.*"moving_psnr":\([0-9.]*\).*/\1/')
}

# How many decibels below the friendly case a training this short may be; for ten times as many
# steps see bench/zoo.md. A picture without content has 16 dB.
if trained toys; then
    friendly=$psnr
    awk "BEGIN { exit !($psnr > 27 && $moving > 16) }" && ok trains_toys ||
        fail trains_toys "$psnr dB, what moves $moving"
    trained turns10 && { awk "BEGIN { exit !($psnr > $friendly - 6) }" && ok trains_turns10 ||
        fail trains_turns10 "$psnr dB, friendly $friendly, what moves $moving"; }
fi

# ---- the moving part ----

# Pictures of two pixels, the second of which is in the mask, with errors of 3, 4 and 12: the mean
# square is 169 / 3.
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
printf '%s\n' "warning: no line of a picture" "$out/hand/scene/train/a.png frame 0: psnr 1" \
    "$out/hand/scene/train/b.png frame 1: psnr 1" >"$out/views"
"$TED4_BUILD/bench/zoo_masks" "$out/hand/scene" "$out/hand/pictures" <"$out/views" >"$out/said" 2>&1
[ "$(cat "$out/said")" = '{"moving_psnr":30.6231,"moving_pixels":1,"pictures":1}' ] && ok masks ||
    fail masks "$(cat "$out/said")"
exit $bad
