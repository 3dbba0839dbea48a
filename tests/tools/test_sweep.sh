#!/bin/sh
# test_sweep.sh - bench/sweep.sh with stand-in programs: a run is judged by the pictures that its
# training held out. Prints lines as a cmocka program does; run by `make test` from the project's
# root.
# SPDX-License-Identifier: BSD-2-Clause
set -u
unset TED4_WORK
. tests/support/speak.sh
need sweep python3

. tests/support/sweep_stand_ins.sh

stand_ins --jobs 1 >"$out/said" 2>&1 &&
    [ "$(cut -d, -f1,7 "$out/sweep.csv" | tr '\n' ' ')" = \
        "tag,psnr other-whole-1,30.25 room-whole-1,30.25 upper-whole-1,30.25 " ] &&
    ok rows || fail rows "$(cat "$out/said" "$out/sweep.csv")"
sed -i 's/ --json.*//' "$out/calls"
[ "$(sort "$out/calls" | uniq | tr '\n' ';')" = "eval room --anyway --downscale 1;eval room \
--hold-out cam10 --anyway --downscale 2;eval tint --anyway --downscale 1;train ;train cam10;" ] &&
    ok held_out || fail held_out "$(cat "$out/calls")"

# Rows in files of their own leave the table alone until they are merged into it.
mv "$out/sweep.csv" "$out/whole.csv"
stand_ins --row-files >"$out/said" 2>&1
[ ! -e "$out/sweep.csv" ] && [ "$(ls "$out/build/sweep/rows" | tr '\n' ' ')" = \
    "other-whole-1.row room-whole-1.row upper-whole-1.row " ] && ok row_files ||
    fail row_files "$(cat "$out/said")"
[ "$(stand_ins --list | cut -d' ' -f1 | uniq)" = done ] && ok state_of_row_files ||
    fail state_of_row_files "$(stand_ins --list)"
stand_ins --merge >"$out/said" 2>&1
cmp -s "$out/sweep.csv" "$out/whole.csv" && [ -z "$(ls "$out/build/sweep/rows")" ] && ok merge ||
    fail merge "$(cat "$out/said")"

# A row of the wanted options stays in spite of a file that others have left.
sed 's/^\(room-whole-1,[^-,]*\)-[^,]*/\1-aaaaaaaaaa/' "$out/whole.csv" >"$out/sweep.csv"
cp "$out/sweep.csv" "$out/older.csv"
sed -n 's/^\(room-whole-1\),[^,]*/\1,ffffffffff-bbbbbbbbbb/p' "$out/whole.csv" \
    >"$out/build/sweep/rows/room-whole-1.row"
stand_ins --merge >"$out/said" 2>&1
cmp -s "$out/sweep.csv" "$out/older.csv" && [ -z "$(ls "$out/build/sweep/rows")" ] &&
    ok left_over || fail left_over "$(cat "$out/said" "$out/sweep.csv")"

# A script that is terminated ends after its training, which has a checkpoint to write.
stand_in build/ted4enc <<END
trap 'sleep 1; echo saved >"$out/checkpoint"; exit 130' TERM
echo >"$out/started"
for i in \$(seq 300); do sleep 0.1; done
END
rm -rf "$out/sweep.csv" "$out/build/sweep"
( use_stand_ins; exec bench/sweep.sh --jobs 1 ) >"$out/said" 2>&1 & script=$!
for i in $(seq 200); do [ -e "$out/started" ] && break; sleep 0.1; done
kill $script
wait $script
[ -e "$out/checkpoint" ] && ok terminated || fail terminated "$(cat "$out/said")"
exit $bad
