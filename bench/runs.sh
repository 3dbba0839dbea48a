# runs.sh - what bench/{sweep,stability,capacity,zoo,bd_rate,held_out}.sh share: the runs of a
# table, one process each, and a row of a CSV for each result. Sourced, from the project's root. A
# row's key tells its options and the sources that decide its bytes, and what else `judges` names;
# comments and spacing do not count. The row is stale when either differs from the present ones,
# unless bench/equal.csv says that those sources write the same bytes. A row keeps the key of the
# sources that made it. Programs that only measure a file (ref-encoder/tool, ref-decoder/tool,
# spans, rate_check) are in no key: whoever changes what they measure takes the rows out.
# The script may be killed at any moment and called again, also several times at once: programs are
# copied before use, each stage 1 that runs share and each own scene is made once, trainings go on
# from their last checkpoint, and rows go into the table whole: each is first a file of its own,
# which is removed once the table has it. Several machines may work on one folder if its locks hold
# between them (flock). The script sets beforehand:
#     program                   its name
#     build data work results   folders
#     table                     the table of runs
#     csv columns               the rows, and the names of their columns, divided by commas; the
#                               first two are tag and key
#     want                      programs to build
#     jobs threads              defaults of --jobs and --threads
#     share                     1: runs whose options of stage 1 agree share one stage 1
#     judges                    sources that decide what is measured on a file, but not the file
#                               itself: rows are stale when these change, trainings stay
# and then defines
#     measure                   of the run that was trained to $out.ted4, $out.json and $out.jsonl:
#                               its $row, and in $said what to say of it; or fails
#     measure_failure CODE      the same for a training that ended with that status; may be left
#                               out: there is no row then
# and calls begin_runs "$@".
# SPDX-License-Identifier: BSD-2-Clause
only= list= missing= patterns= child= build_only= shared= row_files= merge=

. bench/row_files.sh

die() { echo "$program: $*" >&2; exit 3; }
value() { sed -n "s/.*\"$1\":\"\{0,1\}\([-0-9a-z.+]*\).*/\1/p" "$2"; }
key_hash() { sha1sum | cut -c1-10; }
measure_failure() { return 1; }

# lock FD: of the file that is open there. 2: another run holds it.
lock() {
    flock -n "$1"
    case $? in 0) ;; 1) return 2 ;; *) die "files below $work and $results cannot be locked" ;; esac
}

# What a training that ended by itself without a file ended with; fails for one that was ended from
# outside. Signals that a program gets for what it does itself: ILL TRAP ABRT BUS FPE SEGV.
status_word() {
    case $1 in
    132|133|134|135|136|139) echo crash ;;
    3)                       echo error ;;
    *)                       return 1 ;;
    esac
}

# What it said last, as a cell.
last_words() { tail -n 1 "$out.err" | tr ',"' ';' | cut -c1-200; }

# Sources whose change may change a row; own scenes depend on their maker too.
sources() {
    {
        grep -E '^(OPT|STRICT|FREE|FLAGS_v3|FLAGS_v4|CFLAGS_ALL) ' Makefile
        awk -f bench/sources.awk ref-encoder/train/*.[ch] ref-encoder/train/*/*.[ch] \
            ref-encoder/train/*/*.def \
            ref-encoder/math/*.[ch] ref-encoder/write/*.[ch] ref-encoder/kernel/*.[ch] \
            ref-encoder/data/*.[ch] ref-encoder/eval/*.[ch] ref-decoder/base/*.[ch] \
            ref-decoder/norm/*.[ch] ref-decoder/recon/*.[ch] ref-decoder/render/*.[ch] "$@"
    } | key_hash
}

# time_decoder FILE: the best of five decodings on one thread, in $decode_ms.
time_decoder() {
    decode_ms=
    for i in 1 2 3 4 5; do
        "$programs/ted4dec" "$1" --test --json -j 1 -q >"$out.decode.json" || return 1
        decode_ms=$(echo "$decode_ms $(value decode_ms "$out.decode.json")" |
            awk '{ print (NF < 2 || $2 < $1 ? $NF : $1) }')
    done
}

# keep_picture FILE.png FOLDER NAME: as FOLDER/NAME.jpg among the results; FILE.png goes.
keep_picture() {
    mkdir -p "$results/$2"
    "$programs/to_jpeg" "$1" "$results/$2/$3.jpg" && rm -f "$1"
}

# run COMMAND...: in the background and waited for, so that a signal reaches it at once.
run() {
    "$@" & child=$!
    wait $child
    status=$?
    child=
    return $status
}

# The programs as the sources make them, built and copied once for each state of the sources, those
# that are in no key as well, so that a later build changes no run under way.
copy_programs() {
    programs=$work/programs-$version$measured-$(awk -f bench/sources.awk \
        ref-encoder/tool/*.[ch] ref-decoder/*/*.[ch] bench/*.[ch] | key_hash)
    mkdir -p "$work"
    (
        flock 9 || exit 1
        [ -d "$programs" ] && exit 0
        make -s B="$build" $(for p in $want; do echo "$build/$p"; done) || exit 1
        [ "$(sources)" = "$version" ] ||
            { echo "$program: sources changed while they were built" >&2; exit 1; }
        rm -rf "$programs.part" && mkdir "$programs.part" || exit 1
        for p in $want; do cp "$build/$p" "$programs.part" || exit 1; done
        mv "$programs.part" "$programs"
    ) 9>"$work/programs.lock" || die "no programs"
}

# Where the scene lies, in $folder. $judge: the scene whose pictures judge, if it is another. The
# end of stage 1 that this run shares with others, if runs do: $stage1_file.
find_places() {
    judge= stage1_file=
    case $where in *@*) judge=$data/${where#*@} ;; esac
    case $where in
    own:*)  folder=$work/scenes/${where#own:}-$own_version ;;
    bare:*) folder=$work/scenes/${where#bare:}-bare ;;
    *)      folder=$data/${where%@*} ;;
    esac
    [ -z "$share" ] ||
        stage1_file=$work/stage1-$sources_now/$(echo "${where%@*} $stage1" | key_hash).stage1
}

# Links in folder $1 to all that the scene $2 has but its initial points, of which its transforms
# do not speak either.
link_bare() {
    mkdir "$1" || return
    for f in "$(cd "$2" && pwd)"/*; do
        case $f in
        */points3d.ply) ;;
        */transforms*.json)
            python3 -c 'import json, sys
scene = json.load(sys.stdin)
scene.pop("ply_file_path", None)
json.dump(scene, sys.stdout)' <"$f" >"$1/${f##*/}" || return ;;
        *) ln -s "$f" "$1" || return ;;
        esac
    done
}

# Own scenes are made: own:NAME+size=96x64 by ted4scene NAME --size 96x64, bare:NAME of links. 2:
# another run is making it.
make_scene() {
    case $where in own:*|bare:*) ;; *) return 0 ;; esac
    [ -d "$folder" ] && return 0
    mkdir -p "$work/scenes"
    exec 7>"$folder.lock"
    lock 7 || return
    [ -d "$folder" ] && return 0
    rm -rf "$folder.part"
    case $where in
    bare:*) link_bare "$folder.part" "$data/${where#bare:}" ;;
    *)      run "$programs/ted4scene" $(echo "${where#own:}" | sed 's/+/ --/g; s/=/ /g') \
                -o "$folder.part" ;;
    esac && mv "$folder.part" "$folder"
}

# train OUT OPTIONS...: to OUT.ted4, OUT.json and OUT.jsonl, once; goes on where it was killed. What
# ted4enc says: OUT.err.
train() {
    out=$1; shift
    [ -s "$out.json" ] && return 0
    [ -z "$share" ] || set -- "$@" --stage1 "$stage1_file"
    run "$programs/ted4enc" "$folder" -o "$out.ted4" "$@" --checkpoint "$out.checkpoint" --resume \
        -j "$threads" -f -q --json --log "$out.jsonl" >"$out.json.part" 2>"$out.err"
    trained=$?
    cat "$out.err" >&2
    [ $trained = 0 ] || return $trained
    mv "$out.json.part" "$out.json"
    rm -f "$out.checkpoint"
}

# 2: another run is making it.
make_stage1() {
    [ -n "$share" ] || return 0
    [ -s "$stage1_file" ] && return 0
    mkdir -p "${stage1_file%/*}"
    exec 7>"$stage1_file.lock"
    lock 7 || return
    [ -s "$stage1_file" ] && return 0
    rm -f "${stage1_file%.stage1}.json"
    echo "$tag: stage 1: $where $stage1"
    train "${stage1_file%.stage1}" $stage1 --set stage2=0 && [ -s "$stage1_file" ]
}

# Sources that are known to write the same bytes as $1 for the scene $where with $options, by the
# table equal.csv among the results, or that of bench/, with blanks around.
equal_to() {
    equal=$results/equal.csv
    [ -f "$equal" ] || equal=bench/equal.csv
    awk -F, -v now="$1" -v where="$where" -v run="$where $options " '
        function fits(but) { return but != "" && (where ~ "^(" but ")$" || run ~ "^(" but ")$") }
        NR > 1 && !fits($4) { from[NR] = $1; to[NR] = $2 }
        END {
            known[now] = 1
            do {
                found = 0
                for (i in from)
                    if (known[to[i]] && !known[from[i]])
                        found = known[from[i]] = 1
            } while (found)
            for (k in known)
                if (known[k] && k != now)
                    printf " %s", k
            print " "
        }' "$equal"
}

# Was the row with the key $had made by other sources, which are known to write the same bytes?
is_equal() {
    made=${had##*-}
    case $made in *"$measured") made=${made%"$measured"} ;; *) return 1 ;; esac
    case $(equal_to "$sources_now") in *" $made "*) return 0 ;; *) return 1 ;; esac
}

# done, equal (made by sources of the same bytes), older (same options, other sources), stale or
# missing: $state, by the table or by the file of the row, of which it had the key $had; the key of
# the row that is wanted: $key; that of its training: $trained_key
find_state() {
    sources_now=$version
    case $where in own:*) sources_now=$own_version ;; esac
    trained_key=$(echo "$where $options" | key_hash)-$sources_now
    key=$trained_key$measured
    state=missing
    for had in $(key_in "$csv") $(key_in "$work/rows/$tag.row"); do
        case $had in
        "$key")        state=done; return ;;
        "${key%-*}"-*) if is_equal; then state=equal; return; else state=older; fi ;;
        *)             state=stale ;;
        esac
    done
}

# Is there nothing to do? Of the run whose $state was found.
is_there() {
    case $state$missing in done*|equal*|oldermissing) return 0 ;; *) return 1 ;; esac
}

# One row. 0: there. 1: failed. 2: something that it needs is being made by another run: later.
make_row() {
    mkdir -p "$work/runs"
    exec 8>"$work/runs/$tag.lock"
    lock 8 || return
    find_state
    is_there && return 0
    find_places
    make_scene || return
    for f in "$folder" "${judge:-$folder}"; do
        [ -d "$f" ] || { echo "$tag: skipped, no $f"; return 0; }
    done
    make_stage1 || return
    [ -z "$shared" ] || return 0
    echo "$tag: ted4enc $where $options"
    train "$work/runs/$tag-$trained_key" $options
    trained=$?
    if [ $trained = 0 ]; then measure; else measure_failure $trained; fi && put_row ||
        { echo "$tag: FAILED"; return 1; }
    echo "$tag: $said"
}

# The runs that the command line asks for, a line each. Patterns are not file names: set -f.
each_chosen() {
    set -f
    python3 -m bench.pages runs "$table" >"$work/table.$$" || die "$table"
    while IFS='|' read -r groups tag scene where variant place lambda keep stage1 options; do
        wanted=
        for p in $patterns; do
            for word in $(echo "$groups" | tr + ' ') "$tag"; do
                case $word in $p) wanted=1 ;; esac
            done
        done
        [ -z "$patterns" ] || [ -n "$wanted" ] || continue
        [ -z "$only" ] || [ "$only" = "$tag" ] || continue
        echo "$groups|$tag|$scene|$where|$lambda|$keep|$stage1|$options"
    done <"$work/table.$$"
    rm -f "$work/table.$$"
}

# Goes over all runs until none has to wait for another. A run that failed is not tried again. A
# signal waits for the program under way, which may have a checkpoint to write.
worker() {
    trap '[ -z "$child" ] || { kill $child 2>/dev/null; wait $child; }; exit 143' TERM
    failed=
    while :; do
        later=
        while IFS='|' read -r groups tag scene where lambda keep stage1 options <&3; do
            kill -0 $$ 2>/dev/null || exit 1
            case " $failed " in *" $tag "*) continue ;; esac
            find_state
            is_there && continue
            make_row
            case $? in 0) ;; 2) later=1 ;; *) failed="$failed $tag" ;; esac
            exec 7>&- 8>&-
        done 3<"$1"
        [ -n "$later" ] || break
        run sleep 20
    done
    [ -z "$failed" ]
}

# The comment at the head of the script, which tells its usage.
usage() { sed -n '2,/^# SPDX/{/^# SPDX/!s/^# \{0,1\}//p}' "bench/$program"; }

take_arguments() {
    while [ $# -gt 0 ]; do
        case $1 in
        --list)    list=1 ;;
        --missing) missing=missing ;;
        --build)   build_only=1 ;;
        --shared)  shared=1 ;;
        --row-files) row_files=1 ;;
        --merge)   merge=1 ;;
        --jobs|--threads|--only)
                   [ $# -ge 2 ] || die "$1 needs a value"
                   case $1 in --jobs) jobs=$2 ;; --threads) threads=$2 ;; *) only=$2 ;; esac
                   shift ;;
        -*)        usage; [ "$1" = --help ] && exit 0; exit 3 ;;
        *)         patterns="$patterns $1" ;;
        esac
        shift
    done
    case $jobs$threads in *[!0-9]*) die "--jobs and --threads need numbers" ;; esac
    [ "$jobs" -le 1 ] || [ "$threads" -gt 0 ] || threads=1
    cores=$threads
    [ "$cores" -gt 0 ] || cores=$(getconf _NPROCESSORS_ONLN)
}

list_chosen() {
    echo "$chosen" | while IFS='|' read -r groups tag scene where lambda keep stage1 options; do
        find_state
        echo "$state $tag $groups: ted4enc $where $options"
    done
}

# Of what runs share and what is still to be made, the first run that needs it.
list_shared() {
    seen=
    echo "$chosen" | while IFS='|' read -r groups tag scene where lambda keep stage1 options; do
        find_state
        is_there && continue
        find_places
        need=
        case $where in own:*|bare:*) [ -d "$folder" ] || need=$folder ;; esac
        [ -z "$stage1_file" ] || [ -s "$stage1_file" ] || need="$need $stage1_file"
        case $need in "") continue ;; esac
        case $seen in *"<$need>"*) continue ;; esac
        seen="$seen<$need>"
        echo "$state $tag $groups:" $need
    done
}

begin_runs() {
    take_arguments "$@"
    mkdir -p "$work" "$results" || exit 3
    [ ! -f "$csv" ] || [ "$(head -n 1 "$csv")" = "$columns" ] ||
        die "$csv has other columns than this script writes"
    version=$(sources)
    own_version=$(sources tools/scene/*.[ch])
    measured=
    [ -z "$judges" ] || measured=.$(awk -f bench/sources.awk $judges | key_hash)
    chosen=$(each_chosen) || exit 3
    [ -n "$chosen" ] || die "no run chosen; --list shows them all"
    if [ -n "$list" ]; then
        if [ -n "$shared" ]; then list_shared; else list_chosen; fi
        exit 0
    fi
    if [ -n "$merge" ]; then
        merge_chosen
        exit
    fi
    copy_programs
    [ -z "$build_only" ] || exit 0
    [ -n "$row_files" ] || merge_chosen
    echo "$chosen" >"$work/chosen.$$"
    workers=
    trap 'kill $workers 2>/dev/null; wait; rm -f "$work/chosen.$$"; exit 130' INT TERM HUP
    i=0
    while [ $i -lt "$jobs" ]; do
        worker "$work/chosen.$$" & workers="$workers $!"
        i=$((i + 1))
    done
    status=0
    for w in $workers; do wait "$w" || status=1; done
    rm -f "$work/chosen.$$"
    exit $status
}
