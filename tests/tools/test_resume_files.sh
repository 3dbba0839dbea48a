#!/bin/sh
# test_resume_files.sh - ted4enc does not overwrite a checkpoint or a log unless it continues from
# there or is told to, and refuses, before it trains, two outputs of one name, options without the
# one to which they belong, and "-" for a file. Prints lines as a cmocka program does; run by `make
# test` from the project's root.
# SPDX-License-Identifier: BSD-2-Clause
set -u
export LC_ALL=C
. tests/support/speak.sh
need resume_files ted4enc ted4info ted4scene
scene=$out/scene
small="--preset draft --iterations 30,20 --capacity fixed --seed 1 -j 1 --set init_anchors=150
    --set max_anchors=260 --set offsets=4 --set feature=8 --set phi=4 --set bank_dim=8
    --set deform_width=8 --set head_width=12 --set hyper_width=16 --set ar_width=8 --set slices=2"
"$TED4_BUILD/ted4scene" pop -o "$scene" --size 32x24 --frames 4 --cameras 5 --test-cameras 1 -j 1 \
    2>/dev/null
enc() { "$TED4_BUILD/ted4enc" "$scene" $small "$@"; }
cd "$out" || exit 1

# Existing files stay as they are.
echo mine >c; echo mine >l
expect checkpoint 3 'ted4enc: c: exists; --resume goes on from it, -f overwrites' \
    enc -o a.ted4 --checkpoint c
expect log 3 'ted4enc: l: exists; --resume goes on with it, -f overwrites' enc -o a.ted4 --log l
expect log_resumed 3 'l: there, but not a log' enc -o a.ted4 --log l --checkpoint d --resume
[ "$(cat c l | tr -d '\n')" = minemine ] && ok untouched || fail untouched "$(cat c l)"
[ -e a.ted4 ] && fail before_training "a file" || ok before_training
expect forced 0 'a.ted4: ' enc -o a.ted4 --checkpoint c --log l -f
expect resumed 0 'c: going on from step 50' enc -o b.ted4 --checkpoint c --log l --resume
expect resumed_forced 0 'c: going on from step 50' enc -o b.ted4 --checkpoint c --log l --resume -f
# A training of one frame rate gives files of others.
expect rate_resumed 0 'c: going on from step 50' enc -o f.ted4 --checkpoint c --resume --fps 6.5
expect rate_written 0 'frames      4 at 6.5 per second' "$TED4_BUILD/ted4info" f.ted4
expect device 0 'd.ted4: ' enc -o d.ted4 --log /dev/null

# A search for a size that a signal ends keeps the file that fits: here that of the first trial,
# which leaves half of the size unused; a search that has found none keeps none.
size=$(wc -c <a.ted4)
stop_search() { # OUT BYTES: in the second trial
    rm -f said
    "$TED4_BUILD/ted4enc" "$scene" $small --iterations 30,3000 -o "$1" --target-size "$2" 2>said &
    search=$!
    for i in $(seq 600); do grep -q '^ted4enc: lambda' said && break; sleep 0.1; done
    kill -TERM $search
    wait $search
}
stop_search found.ted4 $((2 * size)); status=$?
[ $status = 143 ] && [ -s found.ted4 ] && grep -q 'found.ted4: the file of lambda' said &&
    "$TED4_BUILD/ted4info" found.ted4 >info && ok search_found ||
    fail search_found "status $status: $(cat said)"
stop_search none.ted4 300; status=$?
[ $status = 143 ] && [ ! -e none.ted4 ] && ok search_none ||
    fail search_none "status $status: $(cat said)"

# The log does not get what is meant for a closed standard error.
enc -o s.ted4 --log s.log -v 2>&-
all_json() { [ -s "$1" ] && [ "$(grep -c . "$1")" = "$(grep -c '^{.*}$' "$1")" ]; }
all_json s.log && ok closed_stderr || fail closed_stderr "$(cat s.log)"

# One name for two outputs.
expect same_log 3 'ted4enc: --log and -o: both are w.ted4' enc -o w.ted4 --log w.ted4
expect same_stage1 3 'ted4enc: --stage1 and --checkpoint: both are ./t' \
    enc -o w.ted4 --checkpoint t --stage1 ./t
ln -s c link
expect same_link 3 'ted4enc: --log and --checkpoint: both are link' \
    enc -o w.ted4 --checkpoint c --log link -f
expect same_late 3 'ted4enc: --log and --stage1: both are n' \
    enc -o w.ted4 --log n --stage1 "../$(basename "$out")/n"

# Options that would have no effect.
expect lonely_every 3 'ted4enc: --checkpoint-every: only with --checkpoint (see --help)' \
    enc -o w.ted4 --checkpoint-every 60
expect lonely_resume 3 'ted4enc: --resume: only with --checkpoint (see --help)' \
    enc -o w.ted4 --resume
# None of these files can go to standard output.
for o in checkpoint stage1 log; do
    expect dash_$o 3 "ted4enc: --$o: bad value -; expected a file name (./- names such a file)" \
        enc -o w.ted4 --$o -
done
expect dash_out 3 'ted4enc: -o -: expected a file name that ends in .ted4' enc -o -
expect every 0 'v.ted4: ' enc -o v.ted4 --checkpoint v --checkpoint-every 60
[ -e w.ted4 ] || [ -e - ] || [ -e t ] || [ -e n ] && fail nothing "$(ls)" || ok nothing
exit $bad
