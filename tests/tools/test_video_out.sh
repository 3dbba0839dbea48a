#!/bin/sh
# test_video_out.sh - ted4dec --render FILE.mp4 and -o -: what ffmpeg is asked for and given, the
# message if it is missing or fails, and that no unfinished file stays; one time on standard output.
# Prints lines as a cmocka program does; run by `make test` from the project's root.
# SPDX-License-Identifier: BSD-2-Clause
set -u
export LC_ALL=C
. tests/support/speak.sh
need video_out ted4dec
equal() { if [ "$2" = "$3" ]; then ok "$1"; else fail "$1" "$2, expected $3"; fi; }
dec=$TED4_BUILD/ted4dec
vector=conformance/vectors/worked/WRK-annex-b2.ted4
camera() { printf '{"width":%d,"height":3,"fx":4,"fy":4,"cx":2,"cy":1,"R":[1,0,0,0,1,0,0,0,1],
    "t":[0,0,%d],"time":%s}' "$1" "$2" "$3"; }
echo "[$(camera 5 4 0), $(camera 5 5 1)]" >"$out/two.json"
echo "[$(camera 5 4 0), $(camera 6 5 1)]" >"$out/mixed.json"

# An ffmpeg that stores its input and writes the smallest whole video; FAIL=1: it fails; FAIL=2: it
# ends early as if all was well; FAIL=3: its disk becomes full, as if all was well; FAIL=4: it
# complains of what does no harm, as a loader of libraries may do.
mkdir "$out/bin"
cat >"$out/bin/ffmpeg" <<'END'
#!/bin/sh
echo "$*" >"$KEEP/words"
for last; do :; done
[ "$FAIL" = 1 ] && { echo 'half' >"${last#file:}"; echo 'Unknown encoder' >&2; exit 1; }
[ "$FAIL" = 2 ] && exit 0
[ "$FAIL" = 4 ] && echo 'ffmpeg: libtinfo.so.6: no version information available' >&2
cat >"$KEEP/pictures"
{
    printf '\0\0\0\10ftyp\0\0\0\11moovM\0\0\0\1mdat\0\0\0\0\0\0\0\22'
    [ "$FAIL" = 3 ] || printf ab
} >"${last#file:}"
[ "$FAIL" = 3 ] && echo 'Error writing trailer: No space left on device' >&2
exit 0
END
chmod +x "$out/bin/ffmpeg"
KEEP=$out FAIL=0
export KEEP FAIL
path=$PATH
PATH=$out/bin:$PATH
"$dec" "$vector" --render "$out/a.mp4" --camera "$out/two.json"
equal complete "$(wc -c <"$out/a.mp4" | tr -d ' ')" 35
check words "$out/words" "-f rawvideo -pix_fmt rgb24 -s 5x3 -r " " -i pipe:0" \
    "-vf pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709,format=yuv420p" \
    "-color_range tv -colorspace bt709 -color_primaries bt709 -color_trc iec61966-2-1" \
    "-f mp4 -y file:$out/a.mp4."
"$dec" "$vector" --render "$out/p%d.png" --camera "$out/two.json" -q
equal all_pictures "$(wc -c <"$out/pictures" | tr -d ' ')" 90
expect exists 3 'a.mp4: exists; -f overwrites' "$dec" "$vector" --render "$out/a.mp4" \
    --camera "$out/two.json"
expect mixed 3 'the cameras differ in size' "$dec" "$vector" --render "$out/b.mp4" \
    --camera "$out/mixed.json"
expect percent 3 'bad value b%d.mp4; expected a name without %' "$dec" "$vector" --render b%d.mp4 \
    --camera "$out/two.json"
# With four files at most, the video is the last one that can be opened.
expect no_messages 3 'b.mp4: no temporary file for the messages of ffmpeg: Too many open files' \
    sh -c 'ulimit -n 4; exec "$@"' sh "$dec" "$vector" --render "$out/b.mp4" \
    --camera "$out/two.json" -j 1
FAIL=1
expect fails 3 'b.mp4: ffmpeg failed: Unknown encoder' "$dec" "$vector" --render "$out/b.mp4" \
    --camera "$out/two.json"
FAIL=2
expect early 3 'b.mp4: ' "$dec" "$vector" --render "$out/b.mp4" --path "$out/two.json" --views 9000
expect nothing 3 'b.mp4: ' "$dec" "$vector" --render "$out/b.mp4" --camera "$out/two.json"
FAIL=3
cp "$out/a.mp4" "$out/old"
expect cut 3 'a.mp4: ffmpeg failed: Error writing trailer: No space left on device' "$dec" \
    "$vector" --render "$out/a.mp4" --camera "$out/two.json" -f
cmp -s "$out/a.mp4" "$out/old" && ok cut_stays || fail cut_stays "the video has changed"
FAIL=4
"$dec" "$vector" --render "$out/a.mp4" --camera "$out/two.json" -f
equal harmless "$?" 0
mkdir "$out/none"
PATH=$path
expect missing 3 'videos need the program ffmpeg' env PATH="$out/none" "$dec" "$vector" \
    --render "$out/b.mp4" --camera "$out/two.json"
equal nothing_left "$(ls "$out" | grep -c '^b.mp4')" 0

# If the program is killed while ffmpeg writes, neither ffmpeg nor its unfinished file stays.
cat >"$out/bin/ffmpeg" <<'END'
#!/bin/sh
for last; do :; done
echo half >"${last#file:}"
echo $$ >"$KEEP/writer.new" && mv "$KEEP/writer.new" "$KEEP/writer"
exec sleep 60
END
PATH=$out/bin:$path "$dec" "$vector" --render "$out/k.mp4" --camera "$out/two.json" -q &
decoder=$!
for _ in $(seq 600); do [ -e "$out/writer" ] || sleep 0.1; done
equal half_written "$(ls "$out" | grep -c '^k.mp4.*part$')" 1
kill -TERM $decoder
wait $decoder
equal killed "$?" 143
equal no_half "$(ls "$out" | grep -c '^k.mp4')" 0
if kill -0 "$(cat "$out/writer")" 2>/dev/null; then fail no_writer "ffmpeg goes on"
else ok no_writer; fi

# A video that is replaced keeps its mode, and the link to it.
FAIL=0
cat >"$out/bin/ffmpeg" <<'END'
#!/bin/sh
for last; do :; done
cat >/dev/null
cp "$KEEP/old" "${last#file:}"
END
chmod 600 "$out/a.mp4"
ln -s a.mp4 "$out/l.mp4"
PATH=$out/bin:$path "$dec" "$vector" --render "$out/l.mp4" --camera "$out/two.json" -f
equal link "$(readlink "$out/l.mp4") $(ls -l "$out/a.mp4" | cut -c 1-10)" "a.mp4 -rw-------"

if command -v ffmpeg >/dev/null; then
    "$dec" "$vector" --render "$out/real.mp4" --path "$out/two.json" --views 12 -q
    ffmpeg -v error -i "$out/real.mp4" -f rawvideo -pix_fmt rgb24 -y "$out/back" 2>"$out/err"
    equal real "$(wc -c <"$out/back" | tr -d ' ')" $((12 * 6 * 4 * 3))
else
    skip real "there is no ffmpeg"
fi

# Standard output gets one file, in a format that is named.
"$dec" "$vector" -o "$out/one.ply" --time 0 -q
"$dec" "$vector" -o - --time 0 -q >"$out/two.ply"
cmp -s "$out/one.ply" "$out/two.ply" && ok stdout || fail stdout "differs"
"$dec" "$vector" -o "$out/one.raw" --time 0 -q --keep-all
"$dec" "$vector" -o - --format RAW --time 0 -q --keep-all >"$out/two.raw"
cmp -s "$out/one.raw" "$out/two.raw" && ok stdout_raw || fail stdout_raw "differs"
expect several 3 'standard output takes one frame' "$dec" "$vector" -o -
expect twice 3 'o -: goes without --json' "$dec" "$vector" -o - --time 0 --json
expect format 3 'only with -o -' "$dec" "$vector" -o "$out/x.ply" --time 0 --format ply
expect no_format 3 'bad value out; expected ply, splat' "$dec" "$vector" -o - --time 0 --format out
if [ -e /dev/full ]; then
    "$dec" "$vector" -o - --time 0 -q >/dev/full 2>"$out/err"
    equal full "$? $(cat "$out/err")" "3 ted4dec: standard output: No space left on device"
fi
exit $bad
