#!/bin/sh
# instructions.sh - counts the instructions of a training step, by AVX2 (TED4_BUILD/ted4enc, level
# v3) and by NEON (TED4_BUILD/aarch64/ted4enc), under qemu with count_instructions.c, and puts them
# into bench/machines.md. `make bench-instructions`.
# Of a stage, a step is half of what three steps take more than one; all of it is counted, so that
# loading and coding, which are in both, fall out. Both programs do the same: their files are equal.
# SPDX-License-Identifier: BSD-2-Clause
set -eu
cd "$(dirname "$0")/.."
build=${TED4_BUILD:-build} page=bench/machines.md
work=$build/instructions
rm -rf "$work"
mkdir -p "$work"
"$build/ted4scene" occluder --size 160x120 --cameras 3 --test-cameras 1 --frames 4 -o "$work/scene"
options="--preset draft --capacity fixed --seed 1 -j 1 --set probe=0 --set integer_share=0
    --set transients=0 --set sprouts=0 --set colour=0 --set init_anchors=1500
    --set max_anchors=1500"

# count LEVEL STEPS: instructions of a training of so many steps, in $counted
count() {
    case $1 in
    v3)   qemu="qemu-x86_64 -cpu max" program=$build/ted4enc ;;
    neon) qemu=qemu-aarch64 program=$build/aarch64/ted4enc ;;
    esac
    TED4_KERNEL=$1 $qemu -plugin "$build/bench/count_instructions.so" -d plugin -D "$work/count" \
        "$program" "$work/scene" -o "$work/$1-$2.ted4" $options --iterations "$2" -q
    counted=$(sed -n 's/^instructions //p' "$work/count")
}

# step LEVEL FEW MORE: millions of instructions of one of the two steps between
step() {
    count "$1" "$2"
    few=$counted
    count "$1" "$3"
    awk -v a="$few" -v b="$counted" 'BEGIN { printf "%.1f", (b - a) / 2e6 }'
}

for stage in 1 2; do
    case $stage in
    1) few=1,0 more=3,0 ;;
    2) few=1,1 more=1,3 ;;
    esac
    v3=$(step v3 $few $more) neon=$(step neon $few $more)
    cmp "$work/v3-$more.ted4" "$work/neon-$more.ted4"
    ratio=$(awk -v a="$v3" -v b="$neon" 'BEGIN { printf "%.2f", b / a }')
    echo "| $stage | $v3 | $neon | $ratio |"
done >"$work/rows"
cat "$work/rows"
awk -v rows="$work/rows" '
    /^<!-- instructions -->$/ {
        print
        print "| stage | AVX2 (v3), millions | NEON, millions | NEON / AVX2 |"
        print "|---|---|---|---|"
        while ((getline line < rows) > 0) print line
        skip = 1
    }
    /^<!-- end of instructions -->$/ { skip = 0 }
    !skip' "$page" >"$page.new"
mv "$page.new" "$page"
