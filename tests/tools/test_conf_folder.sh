#!/bin/sh
# test_conf_folder.sh - ted4conf run and encode leave no folder behind, however they end, and refuse
# two reports of one name. Prints lines as a cmocka program does; run by `make test` from the
# project's root.
# SPDX-License-Identifier: BSD-2-Clause
set -u
. tests/support/speak.sh
need conf_folder ted4conf ted4dec
conf=$TED4_BUILD/ted4conf
few="--list conformance/lists/few.txt"
mkdir "$out/tmp"
TMPDIR=$out/tmp
export TMPDIR
left() { find "$TMPDIR" -mindepth 1; }

# until_true COMMAND...: waits for it, a minute at most
until_true() {
    for _ in $(seq 600); do "$@" && return; sleep 0.1; done
    return 1
}
is_asked() { [ -e "$out/asked" ]; }
is_empty() { [ -z "$(left)" ]; }

# ends NAME SIGNAL STATUS COMMAND...: the signal ends the command when what it runs has begun.
ends() {
    name=$1 signal=$2 wanted=$3; shift 3
    "$@" >/dev/null 2>&1 &
    program=$!
    until_true is_asked || fail "$name.ready" "nothing runs"
    kill -"$signal" $program
    wait $program
    status=$?
    [ $status -eq "$wanted" ] && ok "$name.status" || fail "$name.status" "$status"
    until_true is_empty && ok "$name" || fail "$name" "$(left)"
    # shellcheck disable=SC2046 # several numbers
    [ ! -e "$out/asked" ] || kill $(cat "$out/asked") 2>/dev/null
    rm -rf "$out/tmp" "$out/asked"; mkdir "$out/tmp"
}
hang="sh -c 'case \$1 in --ted4-cap*) exec \"$TED4_BUILD/ted4dec\" \"\$@\";; esac;
    echo \$\$ >>\"$out/asked\"; exec sleep 600' x"
for one in TERM:143 HUP:129 KILL:137; do
    # Below nohup, SIGHUP is ignored.
    if sh -c "kill -${one%:*} \$\$"; then
        skip "run_${one%:*}" "this signal is ignored here"
        continue
    fi
    ends "run_${one%:*}" "${one%:*}" "${one#*:}" \
        "$conf" run -t 600 --memory 0 $few -d "$hang"
done
ends encode TERM 143 "$conf" encode -e "echo half >\"$TMPDIR\"/ted4conf-*/out.ted4;
    echo \$\$ >'$out/asked'; exec sleep 600;" "$out"

# Reports of one name would replace each other.
expect two_reports 3 "--json and --html: both are $out/report" "$conf" run -q $few \
    -d "$TED4_BUILD/ted4dec" --json "$out/report" --junit "$out/junit" --html "$out/report"

# A decoder that leaves files of its own.
litter="sh -c '[ \$1 != --ted4-run ] || : >\"\${2%/*}/litter\"
    exec \"$TED4_BUILD/ted4dec\" \"\$@\"' x"
expect litter 0 ': conforms' "$conf" run -q $few --memory 0 -d "$litter"
is_empty && ok litter_left || fail litter_left "$(left)"
exit $bad
