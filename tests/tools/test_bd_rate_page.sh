#!/bin/sh
# test_bd_rate_page.sh - the page of profile Compact, made from a small table of rows whose BD-rate
# can be computed by hand. Prints lines as a cmocka program does; run by `make test` from the
# project's root.
# SPDX-License-Identifier: BSD-2-Clause
set -u
. tests/support/speak.sh
need bd_rate_page python3
make_page() { TED4_RESULTS=$out TED4_TABLE=$out/table.txt python3 -m bench.pages bd_rate \
    "$out/states"; }
page=$out/bd_rate.md

cat >"$out/table.txt" <<END
lambdas 0.001 0.002 0.006 0.018
base  --preset fast
scene still own:still
scene turn  own:turn
run bd before  all 1,2,3,4 - --set stage2=2000
run bd compact all 1,2,3,4 - --set profile=1
END
# Bytes of "before", PSNR; those of "compact" are SHARE of them at the same PSNR, so that this is
# the BD-rate. Positions have 48 and BITS bits an anchor; the features have 1000 bits, of
# which training estimates ESTIMATE.
rows() {
    awk -v share="$1" -v bits="$2" -v estimate="$3" 'BEGIN {
        print "tag,key,lambda,bytes,psnr,b_positions,anchors,cpu_s,estimated_bits,b_feature," \
            "decode_ms"
        split("0.001 0.002 0.006 0.018", lambda, " ")
        for (scene = 1; scene <= 2; scene++)
            for (i = 1; i <= 4; i++) {
                name = scene == 1 ? "still" : "turn"
                bytes = scene * 80000 / i
                print name "-before-" i ",k," lambda[i] "," bytes "," 35 - i ",600,100,10," \
                    "1000,125,4"
                print name "-compact-" i ",k," lambda[i] "," bytes * share "," 35 - i "," \
                    bits * 100 / 8 ",100,20," estimate ",125,5"
            }
    }'
}
# Before, files of profile Main had one and a quarter times as many bytes as now.
{
    echo tag,key,lambda,bytes,psnr
    rows 1 48 1000 | awk -F, -v OFS=, '/before/ { print $1, $2, $3, 1.25 * $4, $5 }'
    rows 1 48 1000 | awk -F, -v OFS=, '/still-before/ { sub("before", "before_seed2", $1)
        print $1, $2, $3, 1.25 * $4, $5 }'
} >"$out/bd_rate-before.csv"
states() { sed '1d; s/\([^,]*\),.*/done \1/' "$out/bd_rate.csv" >"$out/states"; }

rows 0.7 18 1004 >"$out/bd_rate.csv" && states && make_page || fail page "not made"
check met "$page" 'Bars: 3 met, 0 missed, 0 not run yet.' \
    'still -44.0 %, turn -44.0 %' '18.0 to 18.0 bits' \
    'alone: still -30.0 %, turn -30.0 %.' 'at most +0.40 %' \
    '| still | compact | -30.0 % (cubic) |' \
    '| turn-before-1 | 0.001 | 160000 | 34.00 | 100 | 48.0 |'
rows 0.95 21 1011 >"$out/bd_rate.csv" && make_page || fail page "not made"
check missed "$page" 'Bars: 0 met, 3 missed, 0 not run yet.' \
    'still -24.0 %, turn -24.0 %' \
    '21.0 to 21.0 bits' '+1.10 %'
rows 0.7 18 1004 | grep -v '^turn-compact-[34]' >"$out/bd_rate.csv" && states && make_page ||
    fail page "not made"
check incomplete "$page" 'Bars: 0 met, 0 missed, 3 not run yet.' \
    '| still -44.0 % | not run yet |' \
    '14 of 16 rows are there' '| turn-compact-4 | not run yet |'
# Another seed on one scene: the mean over seeds counts, -24 % for -44 and -4.
cp "$out/table.txt" "$out/one_seed.txt"
cat >>"$out/table.txt" <<END
run seeds before_seed2  still 1,2,3,4 - --set stage2=2000 --seed 2
run seeds compact_seed2 still 1,2,3,4 - --set profile=1 --seed 2
END
{ rows 0.7 18 1004; rows 1.2 18 1004 | grep '^still' | sed 's/-[1-4],/_seed2&/'; } \
    >"$out/bd_rate.csv" && states && make_page || fail page "not made"
check seeds "$page" 'Bars: 2 met, 1 missed, 0 not run yet.' \
    'still -24.0 % (2 seeds: -44.0, -4.0), turn -44.0 %' \
    '| still | compact_seed2 | +20.0 % (cubic) | ' '24 of 24 rows are there'
cp "$out/one_seed.txt" "$out/table.txt"
rm "$out/bd_rate.csv" && : >"$out/states" && make_page || fail page "not made"
check empty "$page" 'Bars: 0 met, 0 missed, 3 not run yet.' '| turn | compact | - | - | 0 of 8 |'

# The drivers of bench/cluster take its table, as bench/bd_rate.sh says.
said=$(program=parallel.sh takes=" " flags=" " TED4_WORK=$out/work
    set -- bd_rate 'kitchen-*'
    . bench/cluster/driver.sh
    echo "$table$patterns")
[ "$said" = "bd_rate kitchen-*" ] && ok cluster || fail cluster "$said"
# A run without an estimate is shown as unknown, and as nothing else.
rows 0.7 18 "" >"$out/bd_rate.csv" && states && make_page || fail page "not made"
check no_estimate "$page" '| within 1 % | at most +0.00 %: still-before-1 | not run yet |' \
    '| 18.0 | - | 5.0 | 20 |'
exit $bad
