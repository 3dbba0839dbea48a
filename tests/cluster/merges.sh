#!/bin/sh
# merges.sh - kills bench/sweep.sh before and after each command that moves or removes a file, while
# it merges rows and while it makes them: the table is complete at every moment, no row is lost or
# doubled, and the next call ends with the same table. Programs are stand-ins. Prints lines as a
# cmocka program does; run by `make test-cluster` from the project's root.
# SPDX-License-Identifier: BSD-2-Clause
set -u
LC_ALL=C; export LC_ALL
unset TED4_WORK
. tests/support/speak.sh
need merges python3
command -v setsid >/dev/null || { skip merges "there is no setsid"; exit 0; }
[ -d "$out" ] || exit 1
. tests/support/sweep_stand_ins.sh

# Call number $KILL_AT of mv or rm kills everything, before or after its work as $KILL_WHEN says.
for command in mv rm; do
    stand_in "bin/$command" <<END
n=\$((\$(cat "$out/count") + 1))
echo \$n >"$out/count"
[ "\$n \$KILL_WHEN" != "\$KILL_AT before" ] || kill -9 0
$(command -v $command) "\$@" || exit
[ "\$n \$KILL_WHEN" != "\$KILL_AT after" ] || kill -9 0
END
done
export KILL_AT=never KILL_WHEN=never

# The initial table: an older row of a run that is made again, and one that no run of the table
# makes.
work=$out/build/sweep
echo 0 >"$out/count"
stand_ins --jobs 1 >"$out/said" 2>&1 || { fail rows "$(cat "$out/said")"; exit 1; }
sed -n '1p; s/^room-whole-1,[^,]*/elsewhere-whole-1,old/p' "$out/sweep.csv" >"$out/before.csv"
{
    head -n 1 "$out/sweep.csv"
    { sed 1d "$out/sweep.csv"; sed 1d "$out/before.csv"; } | sort
} >"$out/expected.csv"
sed -n 's/^upper-whole-1,[^,]*/upper-whole-1,old/p' "$out/sweep.csv" >>"$out/before.csv"
mkdir "$out/files"
sed 1d "$out/sweep.csv" | while IFS= read -r row; do
    echo "$row" >"$out/files/${row%%,*}.row"
done

# The table is complete: a first line, and each row once and with as many cells; every finished run
# has a row here or in a file.
whole() {
    awk -F, -v head="$(head -n 1 "$out/expected.csv")" '
        NR == 1 { cells = NF; if ($0 != head) exit 1 }
        NF != cells || seen[$1]++ { exit 1 }' "$out/sweep.csv" || return 1
    cat "$out/sweep.csv" "$work"/rows/*.row 2>/dev/null >"$out/all"
    for row in $(find "$1" -name '*.row'); do
        grep -qxF -e "$(cat "$row")" "$out/all" || return 1
    done
    grep -q '^elsewhere-whole-1,' "$out/sweep.csv"
}

# everywhere NAME FILES OPTION: starts with these files of rows, kills the script at each moment in
# turn, and calls it again.
everywhere() {
    at=1 kills=0 wrong=
    while [ -z "$wrong" ]; do
        ended=
        for when in before after; do
            cp "$out/before.csv" "$out/sweep.csv"
            rm -rf "$work/rows"
            cp -r "$2" "$work/rows"
            echo 0 >"$out/count"
            ( use_stand_ins; KILL_AT=$at KILL_WHEN=$when exec setsid --wait bench/sweep.sh $3 ) \
                >"$out/said" 2>&1
            case $? in 137) kills=$((kills + 1)) ;; *) ended=1 ;; esac
            whole "$2" || wrong="killed $when call $at: $(cat "$out/sweep.csv")"
            stand_ins $3 >"$out/said" 2>&1
            cmp -s "$out/sweep.csv" "$out/expected.csv" && [ -z "$(ls "$work/rows")" ] ||
                wrong="called again after call $at, $when: $(diff "$out/sweep.csv" \
                    "$out/expected.csv") $(cat "$out/said")"
        done
        [ -z "$ended" ] || break
        at=$((at + 1))
    done
    [ -z "$wrong" ] && [ $kills -ge 10 ] && ok "$1" || fail "$1" "$wrong"
    [ -n "$wrong" ] || echo "result: $kills kills of bench/sweep.sh $3: nothing lost, nothing twice"
}

mkdir "$out/none"
everywhere merge_killed "$out/files" --merge
everywhere run_killed "$out/none" '--jobs 1'
exit $bad
