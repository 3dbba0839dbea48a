#!/bin/sh
# machines.sh - trains the same small scene with every build of machines.txt and compares the files:
# machines.csv, and the table in machines.md. `make cross-train`.
# Usage, from anywhere:  bench/machines.sh [--list | --report] [PATTERN...]
#     PATTERN...   builds whose name fits one of these shell patterns; all builds without any
#     --list       says of each build what state it is in, and does nothing
#     --report     only writes the table
# A build is made and trains when machines.csv has no row of it with these sources, this line of
# machines.txt, this compiler and this scene; comments and spacing of sources do not count. A build
# whose compiler, runner, libraries or instruction set is missing is skipped, which is said; a row
# that it has of the same sources stays. May be killed at any moment and called again, and several
# times at once for different builds.
# Exit code: 0, or 1: a build fails, or two that have to agree do not, or too few of them have
# passed (8; 1 with a PATTERN); 3: wrong usage, no scene.
# Environment: TED4_BUILD (build: where ted4scene is; builds are made in TED4_BUILD/machines),
# TED4_RESULTS (bench: where machines.csv and machines.md are), TED4_TABLE (bench/machines.txt).
# SPDX-License-Identifier: BSD-2-Clause
set -u
program=machines.sh
columns=name,key,compiler,level,threads,agrees,hash,variants,bytes,seconds,verdict
fields="name compiler variables level threads agrees runner packages"
. "$(dirname "$0")/builds.sh"

# The scene has what moves, what comes and goes, and cameras that disagree about colours: all parts
# of the method have something to do. Sizes are odd ones, so that vectors have remainders.
scene="fair --size 44x34 --cameras 4 --test-cameras 1 --frames 6 --tint 1 --seed 1"
# The line break in it belongs to the key of every row.
model="--preset draft --set offsets=3 --set feature=10 --set phi=4 --set head_width=14"
model="$model --set bank_dim=12 --set deform_width=18 --set deform_layers=1 --set hyper_width=18
    --set ar_width=10 --set octaves=6 --set max_anchors=300 --set grow_every=25"
model="$model --set grow_gradient=1e-4"
whole="--iterations 1000,500 --why --set init_anchors=150 --set probe=0.2"
whole="$whole --set capacity_share=0.25 --set lr_mask=0.05"
# What the whole method does not take: a network of place and time, bank and feature side by side,
# linear scalings, one distribution for all anchors, other views.
small="--iterations 60,50 --capacity fixed --set init_anchors=250 --set probe=0"
variants="network:--set+motion=3+--set+linear_scale=1+--set+view=2"
variants="$variants side:--set+motion=2+--set+factorised=1+--set+view=0+--set+slices=1"

value() { sed -n "s/.*\"$1\":\"\{0,1\}\([-0-9a-f.]*\).*/\1/p" "$2"; }

enter() {
    cd "$(dirname "$0")/.." || exit 3
    build=${TED4_BUILD:-build} results=${TED4_RESULTS:-bench}
    table=${TED4_TABLE:-bench/machines.txt}
    csv=$results/machines.csv page=$results/machines.md
    mkdir -p "$build/machines" || exit 3
    work=$(cd "$build/machines" && pwd) || exit 3
    own_folder || exit 3
    aarch64="libpng-dev:arm64 libjpeg62-turbo-dev:arm64 libjansson-dev:arm64"
    aarch64="$aarch64 libxxhash-dev:arm64 zlib1g-dev:arm64"
    sources=$({
        find ref-decoder ref-encoder tools/scene -name '*.[ch]' -o -name '*.def' | sort |
            xargs awk -f bench/sources.awk
        sed -n '/^[A-Z_a-z0-9]* *[:?]*=/p' Makefile
        echo "$scene $model $whole $small $variants"
    } | short_hash)
    [ $do != run ] || prepare
}

settle() {
    [ -z "$runner" ] || command -v "$runner" >/dev/null || runner=$runner-static
    packages=$(echo "$packages" | sed "s/ARM64/$aarch64/")
    key=$(echo "$name;$compiler;$variables;$level;$threads;$agrees;$sources" | short_hash)
}

# has FLAG...: all among those that Linux says of this machine
has() {
    for flag; do
        grep -qw "^flags.* $flag" /proc/cpuinfo || return 1
    done
}

missing() {
    missing_command ${compiler%% *} $runner
    case $level in
    v[134] | best) [ "$(uname -m)" = x86_64 ] || echo "x86-64" ;;
    neon)   [ "$(uname -m)" = aarch64 ] || [ -e /usr/lib/aarch64-linux-gnu/libjansson.a ] ||
                echo "libraries for aarch64" ;;
    esac
    case $level in
    v3) has avx2 fma bmi2 || echo "AVX2 with FMA" ;;
    v4) has avx512f avx512bw avx512dq avx512vl || echo "AVX-512" ;;
    esac
}

# prepare: the scene, once for all builds, as pictures must be the same ones
prepare() {
    pictures=$work/scene-$(echo "$scene" | short_hash)
    [ ! -e "$pictures/truth.json" ] || return 0
    [ -x "$build/ted4scene" ] || die "$build/ted4scene is missing: make cross-train"
    rm -rf "$pictures.part"
    "$build/ted4scene" $scene -o "$pictures.part" && mv "$pictures.part" "$pictures" ||
        die "no scene"
}

# train FILE OPTION...: by the program of the build
train() {
    file=$1
    shift
    env $kernel $runner "$here/ted4enc" "$pictures" -o "$file.ted4" $model "$@" --seed 1 \
        -j "$threads" -f --json --log "$file.jsonl" >"$file.json" 2>"$file.stderr" ||
        { tail -n 1 "$file.stderr" | tr ',' ';'; return 1; }
}

# one_build: compiles, trains everything; sets hash, variants_hash, bytes, verdict
one_build() {
    hash= variants_hash= bytes= seconds=
    kernel=TED4_KERNEL=$level
    [ "$level" != best ] || kernel="-u TED4_KERNEL"
    here=$work/$(echo "$compiler $variables" | short_hash)
    set -- $(echo "$variables" | sed 's/ -/,-/g')
    for v; do
        shift
        set -- "$@" "$(echo "$v" | sed 's/,-/ -/g')"
    done
    set -- B="$here" CC="$compiler" "$@" "$here/ted4enc"
    if ! ${MAKE:-make} -s -j "$(getconf _NPROCESSORS_ONLN)" "$@" >"$work/$name.log" 2>&1; then
        verdict="does not build: $(grep -m 1 -i -E 'error|cannot' "$work/$name.log" | tr ',' ';')"
        return
    fi
    begun=$(date +%s)
    verdict=$(train "$work/$name" $whole) || { verdict="does not train: $verdict"; return; }
    seconds=$(($(date +%s) - begun))
    for v in $variants; do
        v_name=${v%%:*}
        verdict=$(train "$work/$name-$v_name" $small $(echo "${v#*:}" | tr + ' ')) ||
            { verdict="does not train $v_name: $verdict"; return; }
    done
    bytes=$(value bytes "$work/$name.json")
    hash=$(short_hash <"$work/$name.ted4")
    variants_hash=$(for v in $variants; do cat "$work/$name-${v%%:*}.ted4"; done | short_hash)
    verdict=passed
}

make_row() {
    one_build
    put_row "$level,$threads,$agrees,$hash,$variants_hash,$bytes,$seconds,$verdict"
    [ "$verdict" != passed ] ||
        echo "passed   $name: $hash, variants $variants_hash, $bytes bytes, $seconds s"
}

# report: the table, between its marks in machines.md
report() {
    : >"$own/counted"
    each | while read -r line; do
        split "$line"
        state
        tell_state "passed elsewhere" stale
        [ "$agrees" = same ] || said="$said; may differ"
        echo "$row" | awk -F, -v what="$name | \`$compiler\` | \`$variables\` | $level | $threads" \
            -v said="$said" '
            function code(text) { return text == "" ? "" : "`" text "`" }
            { print "| " what " | " code($7) " | " code($8) " | " $9 " | " $10 " | " said " |" }'
    done >"$own/rows"
    awk -v rows="$own/rows" '
        /^<!-- trainings -->$/ { print; skip = 1
            print "| build | compiler | make | level | threads | whole method | variants " \
                  "| bytes | seconds | result |"
            print "|---|---|---|---|---|---|---|---|---|---|"
            while ((getline line < rows) > 0) print line }
        /^<!-- end of trainings -->$/ { skip = 0 }
        !skip' "$page" >"$page.new" && mv "$page.new" "$page"
}

# agree: of builds that have to give the same files none fails, no two differ, and enough have
# passed
agree() {
    least=8
    [ -z "$patterns" ] || least=1
    grep ',same,' "$own/counted" >"$own/same"
    passed=$(grep -c ',passed$' "$own/same")
    different=$(cut -d, -f7,8 "$own/same" | sort -u | grep -c .)
    echo "$passed builds that have to agree passed:"
    cut -d, -f7,8 "$own/same" | sort | uniq -c |
        sed 's/^ *\([0-9]*\) \(.*\),\(.*\)/    \1 gave \2, variants \3/'
    [ "$passed" -ge $least ] || { echo "machines.sh: at least $least have to pass" >&2; return 1; }
    [ "$different" = 1 ] && ! grep -qv ',passed$' "$own/counted"
}

begin_builds "$@"
exit
