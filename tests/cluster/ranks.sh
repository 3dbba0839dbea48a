#!/bin/sh
# ranks.sh - ted4enc-mpi gives the same bytes, log and checkpoint as ted4enc for any number of ranks
# and threads, also for a still scene, and handles a rank that is killed, stopped, or cannot read a
# picture. Prints lines as a cmocka program does; run by `make test-mpi` from the project's root.
# SPDX-License-Identifier: BSD-2-Clause
set -u
LC_ALL=C; export LC_ALL
. tests/support/speak.sh
command -v mpirun >/dev/null || { skip ranks "there is no mpirun (make deps-mpi)"; exit 0; }
pkg-config --exists ompi-c || { skip ranks "there is no Open MPI (make deps-mpi)"; exit 0; }
need ranks ted4enc ted4enc-mpi ted4scene python3
[ -d "$out" ] || exit 1
# There may be more ranks than cores; they run as root only if there is no other user.
launch="mpirun --oversubscribe $([ "$(id -u)" != 0 ] || echo --allow-run-as-root)"
how="--preset draft --set batch=4 --set stage1=150 --set stage2=80 -f"

make_scene() {
    "$TED4_BUILD/ted4scene" turn -o "$1" -f --size 48x32 --cameras 5 --test-cameras 1 --frames 4 \
        >/dev/null 2>&1
}
make_scene "$out/scene" || { fail scene "cannot be made"; exit 1; }

# enc NAME OPTION...: trains in one process. ranks N NAME OPTION...: trains in N processes.
enc() { name=$1; shift; "$TED4_BUILD/ted4enc" "$out/scene" $how -o "$out/$name.ted4" "$@"; }
ranks() {
    n=$1 name=$2; shift 2
    $launch -n "$n" "$TED4_BUILD/ted4enc-mpi" "$out/scene" $how -o "$out/$name.ted4" "$@"
}
# steady LOG: prints the log without what depends on time.
steady() {
    python3 -c 'import json, sys
for line in open(sys.argv[1]):
    row = json.loads(line)
    for k in "ms cpu_ms gaussian_pixels_per_s seconds cpu_seconds left".split():
        row.pop(k, None)
    print(row)' "$1"
}

enc whole -j 2 -q --log "$out/whole.log" || { fail one_process "fails"; exit 1; }
steady "$out/whole.log" >"$out/whole.steady"

# same NAME: checks that the file and the log are those of the undisturbed run.
same() {
    cmp -s "$out/whole.ted4" "$out/$1.ted4" || { fail "$1" "not the same file"; return; }
    [ ! -f "$out/$1.log" ] || steady "$out/$1.log" | cmp -s "$out/whole.steady" - ||
        { fail "$1" "not the same log"; return; }
    ok "$1"
}

for way in 1x2 2x1 2x2 3x1 4x1; do
    ranks "${way%x*}" "ranks_$way" -j "${way#*x}" -q --log "$out/ranks_$way.log"
    same "ranks_$way"
done

# pid_of RANK NAME: prints the process of a rank of the run of that name.
pid_of() {
    for pid in $(ls /proc | grep '^[0-9]*$'); do
        grep -qF -e "$out/$2.ted4" "/proc/$pid/cmdline" 2>/dev/null &&
            tr '\0' '\n' <"/proc/$pid/environ" | grep -qx "OMPI_COMM_WORLD_RANK=$1" &&
            echo "$pid" && return
    done
    return 1
}

# disturb NAME N SIGNAL RANK STEP: sends a signal to one rank of N when the log of checkpoints, one
# per step, reaches STEP; sets status to that of mpirun.
disturb() {
    rm -f "$out/$1.point"
    ranks "$2" "$1" -j 1 -v --log "$out/$1.log" --checkpoint "$out/$1.point" --checkpoint-every 0 \
        >"$out/$1.said" 2>&1 &
    run=$!
    seen=0 last=
    while kill -0 $run 2>/dev/null && [ $seen -lt "$5" ]; do
        now=$(stat -c %i-%Y-%Z-%y "$out/$1.point" 2>/dev/null)
        [ "$now" = "$last" ] || seen=$((seen + 1))
        last=$now
        [ $seen -gt 0 ] || sleep 0.02
    done
    pid=$(pid_of "$4" "$1") && kill "-$3" "$pid"
    wait $run
    status=$?
}

# The moments count the changes of the checkpoint that are seen, not all of them; the last one lies
# within or after the trials.
moment=0
for at in "1 2 1" "10 1 4" "40 0 3" "80 1 1" "120 0 2"; do
    set -- $at
    moment=$((moment + 1))
    name=killed_$moment
    disturb $name $(($2 + 2)) 9 "$2" "$1"
    if [ $status -eq 0 ] || [ -f "$out/$name.ted4" ]; then
        fail $name "it ends well"
    elif ! grep -q 'exited on signal 9' "$out/$name.said"; then
        fail $name "it does not say why: $(cat "$out/$name.said")"
    elif pid_of '[0-9]*' $name >/dev/null; then
        fail $name "a rank is left"
    else
        ranks "$3" $name -j 1 -q --log "$out/$name.log" --checkpoint "$out/$name.point" --resume
        same $name
    fi
done

disturb stopped 2 TERM 0 30
if [ $status -ne 0 ] && grep -q 'with --resume goes on' "$out/stopped.said"; then
    enc stopped -j 1 -q --log "$out/stopped.log" --checkpoint "$out/stopped.point" --resume
    same stopped
else
    fail stopped "status $status: $(cat "$out/stopped.said")"
fi

# apart NAME TEXT OPTION... : rank 1 works on another scene, or with other options.
apart() {
    name=$1 text=$2; shift 2
    $launch -n 1 "$TED4_BUILD/ted4enc-mpi" "$out/scene" $how -o "$out/a.ted4" -q : \
        -n 1 "$TED4_BUILD/ted4enc-mpi" "$@" $how -o "$out/a.ted4" -q >"$out/said" 2>&1
    status=$?
    if [ $status -eq 0 ] || [ -f "$out/a.ted4" ]; then
        fail "$name" "it ends well"
    elif [ "$(grep -c '^ted4enc:' "$out/said")" != 1 ] || ! grep -qF -e "$text" "$out/said"; then
        fail "$name" "$(cat "$out/said")"
    else
        ok "$name"
    fi
}
make_scene "$out/broken"
picture=$(find "$out/broken" -name '*.png' | sort | sed -n 3p)
head -c 300 "$picture" >"$out/half"
cp "$out/half" "$picture"
apart unreadable_picture "ted4enc: rank 1 of 2: $picture" "$out/broken"
apart another_training "is not at the same point of the same training" "$out/scene" --seed 9

# For a scene in which nothing moves, every training starts again without time, and its ranks stay
# together. Motion that does not learn is no better than none.
"$TED4_BUILD/ted4scene" things0 -o "$out/still" -f --size 48x32 --cameras 5 --test-cameras 1 \
    --frames 4 --hold 0 >/dev/null 2>&1
rest="--set stage1=1000 --set probe=0.2 --set lr_motion=0 --set lr_phi=0 --set lr_tau=0"
rest="$rest --set max_anchors=2000"
"$TED4_BUILD/ted4enc" "$out/still" $how $rest -o "$out/still.ted4" -j 2 -q --json >"$out/said" ||
    fail still_scene "one process fails"
if ! grep -q '"probe_without":0.0[0-9]*[1-9]' "$out/said"; then
    fail still_scene "no static test: $(cat "$out/said")"
elif $launch -n 2 "$TED4_BUILD/ted4enc-mpi" "$out/still" $how $rest -o "$out/ranks.ted4" -j 1 -q \
    >"$out/said" 2>&1 && cmp -s "$out/still.ted4" "$out/ranks.ted4"; then
    ok still_scene
else
    fail still_scene "not the same file: $(cat "$out/said")"
fi

# One rank writes a file in the other profile, without -f, and warns of the order of anchors.
"$TED4_BUILD/ted4enc" --transcode "$out/whole.ted4" --profile main -o "$out/one.ted4" -q \
    2>/dev/null
$launch -n 3 "$TED4_BUILD/ted4enc-mpi" --transcode "$out/whole.ted4" --profile main \
    -o "$out/main.ted4" -q >"$out/said" 2>&1
status=$?
if [ $status -eq 0 ] && [ "$(grep -c '^ted4enc:' "$out/said")" = 1 ] &&
    cmp -s "$out/one.ted4" "$out/main.ted4"; then
    ok transcode
else
    fail transcode "status $status: $(cat "$out/said")"
fi

# An error that all ranks find is reported once.
$launch -n 3 "$TED4_BUILD/ted4enc-mpi" "$out/broken" $how -o "$out/a.ted4" -q >"$out/said" 2>&1
status=$?
if [ $status -ne 0 ] && [ "$(grep -c "^ted4enc: $picture" "$out/said")" = 1 ] &&
    [ "$(grep -c '^ted4enc:' "$out/said")" = 1 ]; then ok said_once;
else fail said_once "status $status: $(cat "$out/said")"; fi
$launch -n 2 "$TED4_BUILD/ted4enc-mpi" --no-such-option >"$out/said" 2>&1
status=$?
if [ $status -ne 0 ] && [ "$(grep -c no-such-option "$out/said")" = 1 ]; then ok option_said_once;
else fail option_said_once "status $status: $(cat "$out/said")"; fi
exit $bad
