#!/bin/sh
# test_tolerance.sh - ted4tolerance (annex E): thresholds.csv holds what the program computes, for a sample of its vectors; our decoder's own records keep the
# thresholds, records that are a little off do not, and missing ones neither. Speaks as cmocka programs do; run by `make test` from the project's root.
# SPDX-License-Identifier: BSD-2-Clause
set -u
export LC_ALL=C
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
bad=0
table=conformance/tolerance/thresholds.csv
stream=conformance/vectors/content/CNT-pop-0.002
sample='CNT-pop-0.002 WRK-smallest'

ok()   { echo "[       OK ] $1"; }
fail() { echo "[  FAILED  ] $1: $2"; bad=1; }
# judge NAME WANTED-STATUS WANTED-TEXT
judge() {
    "$TED4_BUILD/ted4tolerance" judge $stream.ted4 $stream.json "$out/dump" >"$out/said" 2>&1
    status=$?
    if [ $status -eq "$2" ] && grep -qF "$3" "$out/said"; then ok "$1"; else fail "$1" "status $status: $(cat "$out/said")"; fi
}

if [ -z "${TED4_BUILD:-}" ] || [ ! -x "$TED4_BUILD/ted4tolerance" ]; then
    echo "skipped: TED4_BUILD has no ted4tolerance"
    echo "[  SKIPPED ] tolerance"
    exit 0
fi
# shellcheck disable=SC2086
sh conformance/tolerance/table.sh "$TED4_BUILD/ted4tolerance" $sample >"$out/now" || fail table "status $?"
for id in vector $sample; do
    grep "^$id," "$out/now" >"$out/a"
    grep "^$id," $table >"$out/b"
    if [ -s "$out/a" ] && cmp -s "$out/a" "$out/b"; then ok "current_$id"; else fail "current_$id" "make tolerance"; fi
done

mkdir "$out/dump"
sed -n 's/^ "queries":\(.*\),$/\1/p' $stream.json >"$out/q.json"
"$TED4_BUILD/ted4dec" --ted4-run $stream.ted4 --tiers T5 --queries "$out/q.json" --dump "$out/dump" >/dev/null || fail dump "status $?"
judge ours 0 '{"class":"T","queries":["kept","kept","kept","kept"]}'
# Byte 2 of the first colour of record 1, of 14 numbers each: its exponent and leading bits.
cp "$out/dump/T5-1.bin" "$out/keep"
printf '\377' | dd of="$out/dump/T5-1.bin" bs=1 seek=102 conv=notrunc 2>/dev/null
judge off 1 '{"class":null,"queries":["kept","colour","kept","kept"]}'
head -c 5600 "$out/keep" >"$out/dump/T5-1.bin"
judge short 1 '"count"'
rm "$out/dump/T5-1.bin"
judge absent 1 '"missing"'
exit $bad
