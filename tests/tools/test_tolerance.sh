#!/bin/sh
# test_tolerance.sh - ted4tolerance (annex E): thresholds.csv contains what the program computes,
# for a sample of its vectors; our decoder's own records satisfy the thresholds, slightly wrong
# records and missing ones do not. Prints lines as a cmocka program does; run by `make test` from
# the project's root.
# SPDX-License-Identifier: BSD-2-Clause
set -u
export LC_ALL=C
. tests/support/speak.sh
need tolerance ted4tolerance ted4dec
table=conformance/tolerance/thresholds.csv
stream=conformance/vectors/content/CNT-pop-0.002
sample='CNT-pop-0.002 WRK-smallest'

# judge NAME WANTED-STATUS WANTED-TEXT
expect help 0 'Usage: ted4tolerance judge' "$TED4_BUILD/ted4tolerance" --help
expect version 0 'ted4tolerance ' "$TED4_BUILD/ted4tolerance" --version
expect usage 3 'ted4tolerance: usage: ' "$TED4_BUILD/ted4tolerance"
judge() { expect "$1" "$2" "$3" "$TED4_BUILD/ted4tolerance" judge $stream.ted4 $stream.json \
    "$out/dump"; }

# shellcheck disable=SC2086
sh conformance/tolerance/table.sh "$TED4_BUILD/ted4tolerance" $sample >"$out/now" ||
    fail table "status $?"
for id in vector $sample; do
    grep "^$id," "$out/now" >"$out/a"
    grep "^$id," $table >"$out/b"
    if [ -s "$out/a" ] && cmp -s "$out/a" "$out/b"; then ok "current_$id";
    else fail "current_$id" "make tolerance"; fi
done

mkdir "$out/dump"
python3 -c 'import json, sys; json.dump(json.load(sys.stdin)["queries"], sys.stdout)' \
    <$stream.json >"$out/q.json"
"$TED4_BUILD/ted4dec" --ted4-run $stream.ted4 --tiers T5 --queries "$out/q.json" \
    --dump "$out/dump" >/dev/null || fail dump "status $?"
judge ours 0 '{"class":"T","queries":["kept","kept","kept","kept"]}'
# Byte 2 of the first colour of record 1, of 14 numbers per record: its exponent and leading bits.
cp "$out/dump/T5-1.bin" "$out/keep"
printf '\377' | dd of="$out/dump/T5-1.bin" bs=1 seek=102 conv=notrunc 2>/dev/null
judge off 1 '{"class":null,"queries":["kept","colour","kept","kept"]}'
head -c 5600 "$out/keep" >"$out/dump/T5-1.bin"
judge short 1 '"count"'
rm "$out/dump/T5-1.bin"
judge absent 1 '"missing"'

# The example of the help text, in a folder without anything.
cp $stream.ted4 "$out/a.ted4"
(cd "$out" && "$TED4_BUILD/ted4dec" --ted4-run a.ted4 --tiers T5 --queries q.json --dump out \
    >/dev/null) && ok makes_folder || fail makes_folder "status $?"
expect example 0 '"class":"T"' "$TED4_BUILD/ted4tolerance" judge "$out/a.ted4" "$out/q.json" \
    "$out/out"

# What is wrong with a query, a dump, a list and a stream.
run() { expect "$1" 3 "$2" "$TED4_BUILD/ted4dec" --ted4-run "$out/a.ted4" --tiers T5 --queries \
    "$3" --dump "$4"; }
echo '[{"t":[0,1]}]' >"$out/odd.json"
echo '{' >"$out/broken.json"
echo '{}' >"$out/none.json"
run no_queries "ted4dec: $out/absent.json: No such file or directory" "$out/absent.json" "$out/out"
run broken_queries "ted4dec: $out/broken.json: line " "$out/broken.json" "$out/out"
run odd_query "ted4dec: $out/odd.json: query 0: expected {\"t\":[num,den],\"cam\":[x,y,z]}" \
    "$out/odd.json" "$out/out"
run no_list "ted4dec: $out/none.json: expected a list of queries" "$out/none.json" "$out/out"
run no_dump "ted4dec: $out/a.ted4/x: Not a directory" "$out/q.json" "$out/a.ted4/x"
if [ -c /dev/full ]; then
    mkdir "$out/full"
    ln -s /dev/full "$out/full/T5-3.bin"
    run full_dump "ted4dec: $out/full: No space left on device" "$out/q.json" "$out/full"
else
    skip full_dump "there is no /dev/full"
fi
judge_of() { expect "$1" "$2" "$3" "$TED4_BUILD/ted4tolerance" judge "$4" "$5" "$out/out"; }
judge_of judge_absent 3 "ted4tolerance: $out/absent.json: No such file or directory" \
    "$out/a.ted4" "$out/absent.json"
judge_of judge_broken 3 "ted4tolerance: $out/broken.json: line " "$out/a.ted4" "$out/broken.json"
judge_of judge_none 3 "ted4tolerance: $out/none.json: no list of queries" "$out/a.ted4" \
    "$out/none.json"
judge_of judge_odd 3 "ted4tolerance: $out/odd.json: query 0: expected" "$out/a.ted4" "$out/odd.json"
head -c 1000 "$out/a.ted4" >"$out/cut.ted4"
judge_of judge_cut 1 "ted4tolerance: $out/cut.ted4: byte 1000: refused [con.truncated]" \
    "$out/cut.ted4" "$out/q.json"
# Class X has no result for a time out of range, and no decoder may give records.
echo '[{"t":[2,1],"cam":[0,0,0]}]' >"$out/late.json"
judge_of out_of_range 1 '{"class":null,"queries":["out of range"]}' "$out/a.ted4" "$out/late.json"
rm "$out/out/T5-0.bin"
judge_of out_of_range_kept 0 '{"class":"T","queries":["kept"]}' "$out/a.ted4" "$out/late.json"
judge_of judge_no_stream 3 "ted4tolerance: $out/absent.ted4: No such file" "$out/absent.ted4" \
    "$out/q.json"
exit $bad
