#!/bin/sh
# sweep.sh - makes the rows of bench/sweep.csv that bench/sweep.txt wants and that are missing or stale: trains, encodes, decodes and measures. `make sweep`.
# Usage, from anywhere:  bench/sweep.sh [--list] [--missing] [--jobs N] [--threads N] [--only TAG] [PATTERN...]
#     PATTERN...   runs of which a group or the tag fits one of these shell patterns; all runs without any
#     --only TAG   this run (for the array of a cluster: one job a tag of --list, all of them on one TED4_WORK)
#     --list       says of each run chosen what state it is in and how it is run, and does nothing
#     --missing    leaves rows alone that the same options made with older sources
#     --jobs N     N runs at a time, each of one thread; 1 with all cores without it
#     --threads N  threads of each run instead
# A row's key tells its options and the sources that decide its bytes and numbers; comments and spacing do not count. It is stale when either differs now. May be
# killed at any moment and called again, also several times at once: programs are copied before use, each stage 1 and each own scene is made once,
# trainings go on from their last checkpoint, and rows go into the table whole.
# Environment: TED4_BUILD (build), TED4_DATA (../shared/data), TED4_WORK (TED4_BUILD/sweep: what is worth keeping between calls), TED4_RESULTS (bench),
# TED4_TABLE (bench/sweep.txt).
# SPDX-License-Identifier: BSD-2-Clause
set -u
cd "$(dirname "$0")/.." || exit 3
LC_ALL=C; export LC_ALL
build=${TED4_BUILD:-build}
data=${TED4_DATA:-../shared/data}
work=${TED4_WORK:-$build/sweep}
results=${TED4_RESULTS:-bench}
table=${TED4_TABLE:-bench/sweep.txt}
csv=$results/sweep.csv
columns=tag,key,scene,groups,options,lambda,psnr,ssim,ssim2,ms_ssim,bytes
columns=$columns,b_header,b_nete,b_netr,b_bank,b_positions,b_masks,b_feature,b_scaling,b_offset,b_phi,b_tau,b_frame,motion,activation,temporal_mask
columns=$columns,train_s,stage1_s,cpu_s,stage1_cpu_s,anchors,gaussians,dynamic,decode_ms,render_fps,estimated_bits,coded_bits
columns=$columns,integer_bits,float32_bits,float64_bits,integer_ms,float32_ms,float64_ms,span_short,span_between,span_long,changed,short_changed,short_same,jobs,threads,hash
only= list= missing= jobs=1 threads=0 patterns= child=

die() { echo "sweep.sh: $*" >&2; exit 3; }
value() { sed -n "s/.*\"$1\":\"\{0,1\}\([-0-9a-z.+]*\).*/\1/p" "$2"; }
short_hash() { sha1sum | cut -c1-10; }

# Sources whose change may change a row; own scenes depend on their maker too.
sources() {
    {
        grep -E '^(OPT|STRICT|FREE|CFLAGS_ALL) ' Makefile
        awk -f bench/sources.awk ref-encoder/train/*.[ch] ref-encoder/train/*.def ref-encoder/write/*.[ch] ref-encoder/kernel/*.[ch] \
            ref-encoder/data/*.[ch] ref-encoder/eval/*.[ch] ref-decoder/base/*.[ch] ref-decoder/norm/*.[ch] ref-decoder/recon/*.[ch] \
            ref-decoder/render/*.[ch] "$@"
    } | short_hash
}

# run COMMAND...: in the background and waited for, so that a signal reaches it at once.
run() {
    "$@" & child=$!
    wait $child
    status=$?
    child=
    return $status
}

# The programs as they are now, built and copied once for each state of the sources, so that a later build changes no run under way.
copy_programs() {
    programs=$work/programs-$version
    mkdir -p "$work"
    (
        flock 9
        [ -d "$programs" ] && exit 0
        want="ted4enc ted4dec ted4eval ted4info ted4scene bench/rate_check bench/spans"
        make -s B="$build" $(for p in $want; do echo "$build/$p"; done) || exit 1
        [ "$(sources)" = "$version" ] || { echo "sweep.sh: sources changed while they were built" >&2; exit 1; }
        rm -rf "$programs.part" && mkdir "$programs.part" || exit 1
        for p in $want; do cp "$build/$p" "$programs.part" || exit 1; done
        mv "$programs.part" "$programs"
    ) 9>"$work/programs.lock" || die "no programs"
}

# Where the scene lies, in $folder; own ones are made. $judge: the scene whose pictures judge, if it is another. 2: another run is making it.
find_scene() {
    judge=
    case $where in *@*) judge=$data/${where#*@} ;; esac
    case $where in
    own:*)  folder=$work/scenes/${where#own:}-$own_version
            [ -d "$folder" ] && return 0
            mkdir -p "$work/scenes"
            exec 7>"$folder.lock"
            flock -n 7 || return 2
            [ -d "$folder" ] && return 0
            rm -rf "$folder.part"
            "$programs/ted4scene" "${where#own:}" -o "$folder.part" && mv "$folder.part" "$folder" ;;
    *)      folder=$data/${where%@*} ;;
    esac
}

# train OUT OPTIONS...: to OUT.ted4, OUT.json and OUT.jsonl, once; goes on where it was killed.
train() {
    out=$1; shift
    [ -s "$out.json" ] && return 0
    run "$programs/ted4enc" "$folder" -o "$out.ted4" "$@" --stage1 "$stage1_file" --checkpoint "$out.checkpoint" --resume -j "$threads" -f -q --json \
        --log "$out.jsonl" >"$out.json.part" || return 1
    mv "$out.json.part" "$out.json"
    rm -f "$out.checkpoint"
}

# The end of stage 1 that this run shares with others. 2: another run is making it.
make_stage1() {
    stage1_file=$work/stage1-$sources_now/$(echo "${where%@*} $stage1" | short_hash).stage1
    [ -s "$stage1_file" ] && return 0
    mkdir -p "${stage1_file%/*}"
    exec 7>"$stage1_file.lock"
    flock -n 7 || return 2
    [ -s "$stage1_file" ] && return 0
    rm -f "${stage1_file%.stage1}.json"
    echo "$tag: stage 1: $where $stage1"
    train "${stage1_file%.stage1}" $stage1 --set stage2=0 && [ -s "$stage1_file" ]
}

# The best of five decodings on one thread: $decode_ms.
time_decoder() {
    decode_ms=
    for i in 1 2 3 4 5; do
        "$programs/ted4dec" "$1" --test --json -j 1 -q >"$out.decode.json" || return 1
        decode_ms=$(echo "$decode_ms $(value decode_ms "$out.decode.json")" | awk '{ print NF < 2 || $2 < $1 ? $NF : $1 }')
    done
}

# What the table keeps of a run besides its row.
keep_pictures() {
    down=$(echo "$options" | sed -n 's/.*--downscale \([0-9]*\).*/\1/p')
    [ -z "$judge" ] || down=1
    sheet=
    case +$keep+ in *+sheet+*) mkdir -p "$results/sheets"; sheet="--sheet $results/sheets/$tag.png" ;; esac
    run "$programs/ted4eval" "$out.ted4" "${judge:-$folder}" --downscale "${down:-1}" --json $sheet -f -q -j "$threads" >"$out.eval.json" || return 1
    set -- "$out.ted4"
    case +$keep+ in *+spans+*) mkdir -p "$results/charts"; set -- "$@" "$folder" "${down:-1}" "$results/charts/spans-$tag.png" ;; esac
    run "$programs/spans" "$@" >"$out.spans.json" || return 1
    case +$keep+ in *+log+*)
        mkdir -p "$results/logs"
        awk -v most=100 -f bench/log.awk "$first_log" "$out.jsonl" >"$out.log" && mv "$out.log" "$results/logs/$tag.jsonl" || return 1 ;;
    esac
}

measure() {
    out=$work/runs/$tag-$key
    first_log=${stage1_file%.stage1}.jsonl
    keep_pictures && time_decoder "$out.ted4" || return 1
    "$programs/ted4info" "$out.ted4" --budget --json >"$out.info.json" && "$programs/rate_check" "$out.ted4" >"$out.rate.json" || return 1
    parts=$(awk -f bench/budget.awk "$out.info.json") && times=$(awk -f bench/log.awk "$first_log" "$out.jsonl") || return 1
    row=$tag,$key,$scene,$groups,$options,$lambda
    for f in psnr ssim ssim2 ms_ssim bytes; do row=$row,$(value $f "$out.eval.json"); done
    row=$row,$parts
    for f in motion activation temporal_mask; do row=$row,$(value $f "$out.info.json"); done
    row=$row,$times
    for f in anchors gaussians dynamic; do row=$row,$(value $f "$out.json"); done
    row=$row,$decode_ms,$(value render_fps "$out.eval.json")
    for f in estimated_bits coded_bits; do row=$row,$(value $f "$out.json"); done
    for f in integer_bits float32_floored_bits float64_floored_bits integer_ms float32_ms float64_ms; do row=$row,$(value $f "$out.rate.json"); done
    for f in span_short span_between span_long changed short_changed short_same; do row=$row,$(value $f "$out.spans.json"); done
    row=$row,$jobs,$cores,$(value hash "$out.json")
    [ "$(echo "$row" | awk -F, '{ print NF }')" = "$(echo "$columns" | awk -F, '{ print NF }')" ] || { echo "$tag: malformed row: $row"; return 1; }
}

# Into the table in place of the tag's older row; the table is sorted and never half-written.
put_row() {
    (
        flock 9
        {
            echo "$columns"
            { [ ! -f "$csv" ] || sed 1d "$csv" | awk -F, -v tag="$tag" '$1 != tag'; echo "$row"; } | sort
        } >"$csv.part" && mv "$csv.part" "$csv"
    ) 9<"$results"
}

# done, older (same options, other sources), stale or missing: $state; the row's key: $key
find_state() {
    sources_now=$version
    case $where in own:*) sources_now=$own_version ;; esac
    key=$(echo "$where $options" | short_hash)-$sources_now
    had=$([ -f "$csv" ] && awk -F, -v tag="$tag" '$1 == tag { print $2 }' "$csv")
    case $had in
    "$key")        state=done ;;
    "${key%-*}"-*) state=older ;;
    "")            state=missing ;;
    *)             state=stale ;;
    esac
}

# One row. 0: there. 1: failed. 2: something that it needs is being made by another run: later.
make_row() {
    mkdir -p "$work/runs"
    exec 8>"$work/runs/$tag.lock"
    flock -n 8 || return 2
    find_state
    case $state$missing in done*|oldermissing) return 0 ;; esac
    find_scene || return
    for f in "$folder" "${judge:-$folder}"; do
        [ -d "$f" ] || { echo "$tag: skipped, no $f"; return 0; }
    done
    make_stage1 || return
    echo "$tag: ted4enc $where $options"
    train "$work/runs/$tag-$key" $options && measure && put_row || { echo "$tag: FAILED"; return 1; }
    echo "$tag: $(value psnr "$out.eval.json") dB, $(value bytes "$out.eval.json") bytes"
}

# The runs that the command line asks for, a line each. Patterns are not file names: set -f.
each_chosen() {
    set -f
    awk -f bench/expand.awk ref-encoder/train/options.def "$table" >"$work/table.$$" || die "$table"
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

# Goes over all runs until none has to wait for another. A run that failed is not tried again.
worker() {
    trap '[ -z "$child" ] || kill $child 2>/dev/null; exit 143' TERM
    failed=
    while :; do
        later=
        while IFS='|' read -r groups tag scene where lambda keep stage1 options <&3; do
            kill -0 $$ 2>/dev/null || exit 1
            case " $failed " in *" $tag "*) continue ;; esac
            find_state
            case $state$missing in done*|oldermissing) continue ;; esac
            make_row
            case $? in 0) ;; 2) later=1 ;; *) failed="$failed $tag" ;; esac
            exec 7>&- 8>&-
        done 3<"$1"
        [ -n "$later" ] || break
        run sleep 20
    done
    [ -z "$failed" ]
}

while [ $# -gt 0 ]; do
    case $1 in
    --list)    list=1 ;;
    --missing) missing=missing ;;
    --jobs|--threads|--only)
               [ $# -ge 2 ] || die "$1 needs a value"
               case $1 in --jobs) jobs=$2 ;; --threads) threads=$2 ;; *) only=$2 ;; esac
               shift ;;
    -*)        sed -n '2,16s/^# \{0,1\}//p' "$0"; [ "$1" = --help ] && exit 0; exit 3 ;;
    *)         patterns="$patterns $1" ;;
    esac
    shift
done
case $jobs$threads in *[!0-9]*) die "--jobs and --threads need numbers" ;; esac
[ "$jobs" -le 1 ] || [ "$threads" -gt 0 ] || threads=1
cores=$threads
[ "$cores" -gt 0 ] || cores=$(getconf _NPROCESSORS_ONLN)
mkdir -p "$work" "$results" || exit 3
[ ! -f "$csv" ] || [ "$(head -n 1 "$csv")" = "$columns" ] || die "$csv has other columns than this script writes"
version=$(sources)
own_version=$(sources tests/scenes/*.[ch])
chosen=$(each_chosen) || exit 3
[ -n "$chosen" ] || die "no run chosen; --list shows them all"
if [ -n "$list" ]; then
    echo "$chosen" | while IFS='|' read -r groups tag scene where lambda keep stage1 options; do
        find_state
        echo "$state $tag $groups: ted4enc $where $options"
    done
    exit 0
fi
copy_programs
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
