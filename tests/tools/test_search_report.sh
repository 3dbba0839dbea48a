#!/bin/sh
# test_search_report.sh - the decisions of ted4enc about the size of the model are reported: always
# in the log, in the file on request, once, and by ted4info. Prints lines as a cmocka program does;
# run by `make test` from the project's root.
# SPDX-License-Identifier: BSD-2-Clause
set -u
. tests/support/speak.sh
need why ted4enc ted4dec ted4info ted4scene
# equal NAME VALUE WANTED
equal() { if [ "$2" = "$3" ]; then ok "$1"; else fail "$1" "$2, expected $3"; fi; }
small="--preset draft --iterations 300,500 --seed 1 -j 1 -q --set init_anchors=150
    --set max_anchors=260 --set offsets=4 --set feature=8 --set phi=4 --set bank_dim=8
    --set deform_width=8 --set head_width=12 --set hyper_width=16 --set ar_width=8 --set slices=2"

"$TED4_BUILD/ted4scene" pop -o "$out/scene" --size 32x24 --frames 4 --cameras 5 --test-cameras 1 \
    -j 1 2>/dev/null
encode() { name=$1; shift; "$TED4_BUILD/ted4enc" "$out/scene" -o "$out/$name.ted4" $small "$@" \
    2>"$out/err" || fail "$name" "$(cat "$out/err")"; }
told() { "$TED4_BUILD/ted4info" "$out/$1.ted4" --why | grep -c '^capacity\.[0-9]'; }
logged() { grep -c '"event":"capacity"' "$out/$1.jsonl"; }
hash_of() { "$TED4_BUILD/ted4dec" "$out/$1.ted4" --hash | sed -n 's/^ends //p'; }

encode silent --log "$out/silent.jsonl"
encode told --why --log "$out/told.jsonl" --checkpoint "$out/told.checkpoint"
n=$(logged told)
[ "$n" -gt 5 ] && ok trials || fail trials "$n"
equal as_many_in_the_file "$(told told)" "$n"
equal none_unasked "$(told silent)" 0
equal logged_unasked "$(logged silent)" "$n"
equal same_scene "$(hash_of told)" "$(hash_of silent)"
equal valid_meta "$("$TED4_BUILD/ted4info" "$out/told.ted4" --validate | grep -c 'adv.meta')" 0
equal no_names "$(grep -acF "$out" "$out/told.ted4")" 0
taken=$(grep -c '"event":"capacity".*"taken":true' "$out/told.jsonl")
equal taken "$("$TED4_BUILD/ted4info" "$out/told.ted4" --why | grep -c ': taken; ')" "$taken"

# Moving anchors are reported only if trials left motion in the model; the trials test motion first,
# if there is any.
moves() {
    "$TED4_BUILD/ted4info" "$out/told.ted4" --why |
        grep -c "^capacity.[0-9]*=motion, 1 to 0: $1;"
}
if [ "$(moves taken)" = 0 ] && [ "$(moves left)" -gt 0 ]; then moving=1; else moving=0; fi
told_moving=$("$TED4_BUILD/ted4info" "$out/told.ted4" --why |
    grep -c '^capacity.moving=[0-9]* of [0-9]* anchors: ')
equal moving "$told_moving" $moving

# A run that is resumed after its decisions also reports them once.
cp "$out/told.ted4" "$out/first.ted4"
encode told --why --log "$out/told.jsonl" --checkpoint "$out/told.checkpoint" --resume -f
equal resumed_log "$(logged told)" "$n"
cmp -s "$out/told.ted4" "$out/first.ted4" && ok resumed_file || fail resumed_file "another file"

expect silent_why 0 "ted4info: note: $out/silent.ted4: the file does not say why" \
    "$TED4_BUILD/ted4info" "$out/silent.ted4" --why
encode fixed --why --log "$out/fixed.jsonl" --capacity fixed
equal fixed_log "$(logged fixed)" 0
equal fixed_file "$("$TED4_BUILD/ted4info" "$out/fixed.ted4" --why | grep '^capacity')" \
    "capacity=fixed; lambda 0.002
capacity.dropout=0.2 of the anchors at most; 5 cameras per time"
encode whole --why --capacity fixed --set dropout=0
equal without_dropout "$("$TED4_BUILD/ted4info" "$out/whole.ted4" --why | grep '^capacity')" \
    "capacity=fixed; lambda 0.002"
"$TED4_BUILD/ted4enc" "$out/scene" -o "$out/x.ted4" --capacity some 2>"$out/err"
equal refused "$?:$(cat "$out/err")" '3:ted4enc: --capacity: bad value some; expected auto or fixed'

# Flickering light gets a row of the bank for every time; other scenes get one for every second
# time.
"$TED4_BUILD/ted4scene" flicker -o "$out/flicker" --size 32x24 --frames 6 --cameras 5 \
    --test-cameras 1 -j 1 2>/dev/null
rows() { "$TED4_BUILD/ted4info" -v "$out/$1.ted4" | sed -n 's/^ *bank_rows *//p'; }
"$TED4_BUILD/ted4enc" "$out/flicker" -o "$out/flicker.ted4" $small --capacity fixed --set probe=0 \
    --set motion_worth=0 --why 2>"$out/err" || fail flicker "$(cat "$out/err")"
encode steady --capacity fixed --set probe=0 --set motion_worth=0
equal rows_of_flicker "$(rows flicker)" 6
equal rows_of_pop "$(rows steady)" 2
flicker=$("$TED4_BUILD/ted4info" "$out/flicker.ted4" --why |
    grep -c '^capacity.light=flickers by .*of 6 rows for 6 times')
equal flicker_told "$flicker" 1
exit $bad
