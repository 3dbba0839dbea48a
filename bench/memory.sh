#!/bin/sh
# Memory of training 300 frames of 20 cameras at 1352x1014, which do not fit in memory at once:
# bench/memory.md. Usage: bench/memory.sh [RUN...] The pictures are ray traced at three times; the
# other names are hard links to them, so that making the scene takes minutes and 60 MB, while to the
# encoder they are 6000 files, each read and decoded by itself. A limit of 8 GB on the address
# space, which is more than what is resident, is enforced. Growth is forced, from a fine grid on, so
# that the model soon has many anchors. Rows of runs made earlier stay, unless the scene's sizes
# (FRAMES, CAMERAS, WIDTH, HEIGHT) differ. A run takes an hour or two of two cores.
set -e
cd "$(dirname "$0")/.."
bin=${TED4_BUILD:-build}
out=${TED4_OUT:-out/memory}
page=${TED4_PAGE:-bench/memory.md}
threads=${TED4_THREADS:-2}
frames=${FRAMES:-300} cameras=${CAMERAS:-20} width=${WIDTH:-1352} height=${HEIGHT:-1014}
limit_kib=7812500 distinct=3
forced="--set cell=0.002 --set grow_gradient=0 --set grow_every=10 --set grow_until=1 --set probe=0"
runs="largest usual little-cache"
for name; do
    case " $runs " in
    *" $name "*) ;;
    *) echo "memory.sh: $name: not a run; runs are $runs" >&2; exit 3 ;;
    esac
done
mkdir -p "$out"

sizes="$frames frames, $cameras cameras, ${width}x$height"
if [ "$(cat "$out/scene.done" 2>/dev/null)" != "$sizes" ]; then
    rm -rf "$out/scene" "$out/scene.done" "$out"/*.row
    "$bin/ted4scene" bend -o "$out/scene" --layout neu3d --size "${width}x$height" \
        --cameras $((cameras - 1)) --test-cameras 1 --frames $distinct -j "$threads"
    for folder in "$out"/scene/cam*/images; do
        i=$distinct
        while [ $i -lt "$frames" ]; do
            ln "$folder/$(printf %04d $((i % distinct))).png" "$folder/$(printf %04d $i).png"
            i=$((i + 1))
        done
    done
    echo "$sizes" >"$out/scene.done"
fi

value() { sed -n "s/.*\"$1\":\([-0-9.e+]*\).*/\1/p" "$2"; }

run() {    # name iterations options: $out/NAME.row, when NAME or nothing was asked for
    name=$1 iterations=$2; shift 2
    case "$asked" in ''|*" $name "*) ;; *) return 0 ;; esac
    (
        ulimit -v $limit_kib
        "$bin/ted4enc" "$out/scene" -o "$out/$name.ted4" -f -q -j "$threads" \
            --iterations "$iterations" --seed 1 $forced --json --log "$out/$name.jsonl" "$@" \
            >"$out/$name.json"
    )
    tail -1 "$out/$name.jsonl" >"$out/line"
    echo "| $name | \`--iterations $iterations $*\` | $(value anchors "$out/line") |" \
        "$(value gaussians "$out/$name.json") | $(value peak_mib "$out/$name.json") |" \
        >"$out/$name.row"
}

asked=${*:+" $* "}
run largest 150,60 --preset paper
run usual 150,60 --preset medium
run little-cache 150,60 --preset medium --cache 256

{
    echo "# Memory"
    echo
    gigabytes=$(awk "BEGIN { printf \"%.1f\", $frames * $cameras * $width * $height * 3e-9 }")
    cat <<END
\`make bench-memory\` (\`bench/memory.sh\`) measures the peak memory of a training, and writes this
page. The scene has $frames frames ($distinct distinct ones) of
$cameras cameras at ${width}x$height, in all $gigabytes GB of pixels. It is trained by
\`ted4enc SCENE -o FILE -j $threads --seed 1\` with
\`$forced\`
and the options of the row, under \`ulimit -v $limit_kib\` (8 GB of address space): more would have
failed. Growth is forced. Anchors are those of the file; those that no picture would miss were
removed before stage 2. So short a training runs no trials of smaller models, which keep up to five
copies of all anchors, 55 MB each at 40,000. Peak is the largest resident memory, from the first
picture read to the checked file (\`peak_mib\` of \`--json\`, from getrusage).
END
    echo
    echo "| run | options | anchors | Gaussians in the file | peak MiB |"
    echo "|---|---|---|---|---|"
    for name in $runs; do
        if [ -e "$out/$name.row" ]; then cat "$out/$name.row"; fi
    done
} >"$page"
