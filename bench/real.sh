#!/bin/sh
# Trains, encodes and evaluates real scenes; one row of bench/real.csv a result, keyed by the run's options and the sources that can change it, so that
# a result is never made twice and stale rows are seen. Usage: bench/real.sh [TAG...]; all runs when no tag is given. One training at a time.
set -e
cd "$(dirname "$0")/.."
bin=${TED4_BUILD:-build}
data=${TED4_DATA:-../shared/data}
out=${TED4_OUT:-out/real}
csv=bench/real.csv
mkdir -p "$out" bench/sheets
[ -f $csv ] || echo "tag,key,scene,options,psnr,ssim,ssim2,ms_ssim,bytes,train_s,ms_per_step,anchors,gaussians,dynamic,decode_ms,render_fps,estimated_bits,coded_bits" >$csv

version=$(cat ref-encoder/train/*.[ch] ref-encoder/train/*.def ref-encoder/write/*.[ch] ref-encoder/kernel/*.[ch] ref-encoder/data/*.[ch] \
    ref-decoder/norm/*.[ch] ref-decoder/recon/*.[ch] ref-decoder/render/*.[ch] | sha1sum | cut -c1-10)
value() { sed -n "s/.*\"$1\":\([-0-9.e+]*\).*/\1/p" "$2"; }

run() {    # tag scene options
    tag=$1 scene=$2; shift 2
    case " $wanted " in "  "|*" $tag "*) ;; *) return 0 ;; esac
    key=$(echo "$version $scene $*" | sha1sum | cut -c1-10)
    if grep -q "^$tag,$key," $csv; then echo "$tag: done"; return 0; fi
    if [ ! -d "$data/$scene" ]; then echo "$tag: skipped, no $data/$scene"; return 0; fi
    down=$(echo "$*" | sed -n 's/.*--downscale \([0-9]*\).*/\1/p')
    echo "$tag: ted4enc \$TED4_DATA/$scene $*"
    "$bin/ted4enc" "$data/$scene" -o "$out/$tag.ted4" --seed 1 "$@" -f --json --log "$out/$tag.jsonl" >"$out/$tag.train.json"
    "$bin/ted4eval" "$out/$tag.ted4" "$data/$scene" --downscale "${down:-1}" --json --sheet "bench/sheets/$tag.png" -f >"$out/$tag.eval.json"
    row=$tag,$key,$scene,"$*"
    for f in psnr ssim ssim2 ms_ssim bytes; do row=$row,$(value $f "$out/$tag.eval.json"); done
    for f in train_s ms_per_step anchors gaussians dynamic; do row=$row,$(value $f "$out/$tag.train.json"); done
    for f in decode_ms render_fps; do row=$row,$(value $f "$out/$tag.eval.json"); done
    for f in estimated_bits coded_bits; do row=$row,$(value $f "$out/$tag.train.json"); done
    sed -i "/^$tag,/d" $csv
    echo "$row" >>$csv
}

wanted="$*"
run chair          chair   --downscale 2 --preset medium
run still          still   --downscale 2 --preset fast
run kitchen        kitchen --downscale 2 --preset fast
run kitchen-small  kitchen --downscale 2 --preset fast --lambda 0.004
run kitchen-static kitchen --downscale 2 --preset fast --lambda 0.001 --set motion=0 --set activation=0
run dog            dog     --downscale 2 --preset fast
run dog-static     dog     --downscale 2 --preset fast --set motion=0 --set activation=0

# The table that people read.
{
    echo "# Real scenes"
    echo
    echo "Made by \`bench/real.sh\` (\`make real\`), on two cores, one training at a time unless noted; scenes in \`\$TED4_DATA\`. Every number is measured on the decoded file,"
    echo "on pictures that training never saw. \`bench/real.csv\` holds all columns; \`bench/sheets/\` truth, ours, error (5 times) at three times."
    echo
    echo "| run | command | PSNR | SSIM | MS-SSIM | bytes | training s | anchors | moving | decode ms |"
    echo "|---|---|---|---|---|---|---|---|---|---|"
    awk -F, 'NR > 1 { printf "| [%s](sheets/%s.png) | `ted4enc $TED4_DATA/%s %s --seed 1` | %.2f | %.4f | %.4f | %d | %.0f | %d | %d | %.0f |\n", $1, $1, $3, $4, $5, $6, $8, $9, $10, $12, $14, $15 }' $csv
    [ -f bench/real-notes.md ] && { echo; cat bench/real-notes.md; }
} >bench/real.md
