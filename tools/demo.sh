#!/bin/sh
# Runs the whole pipeline: makes a scene, trains it to a .ted4 file, and goes back to Gaussians and
# pictures in fresh processes. $1: folder for all results. The last line is one JSON object with
# psnr, bytes, train_s, decode_ms.
set -e
out=$1
bin=${TED4_BUILD:-build}
mkdir -p "$out"
value() { sed -n "s/.*\"$1\":\([-0-9.e+]*\).*/\1/p" "$2"; }

echo "1 scene: occluder, ray traced"
"$bin/ted4scene" occluder -o "$out/scene" -f
"$bin/ted4enc" --check "$out/scene"
echo "2 training and encoding: preset draft"
"$bin/ted4enc" "$out/scene" -o "$out/occluder.ted4" --preset draft --seed 1 \
    --title "Occluder" --cameras -f --json --log "$out/train.jsonl" >"$out/train.json"
echo "3 decoding in a fresh process"
"$bin/ted4dec" "$out/occluder.ted4" --test
"$bin/ted4info" "$out/occluder.ted4" --budget
echo "4 held-out views"
"$bin/ted4eval" "$out/occluder.ted4" "$out/scene" --split test --json --sheet "$out/sheet.png" -f \
    >"$out/eval.json"
psnr=$(value psnr "$out/eval.json") ssim=$(value ssim "$out/eval.json")
bytes=$(value bytes "$out/eval.json") decode=$(value decode_ms "$out/eval.json")
fps=$(value render_fps "$out/eval.json") train=$(value train_s "$out/train.json")
anchors=$(value anchors "$out/train.json") moving=$(value dynamic "$out/train.json")
cat <<END

  held-out PSNR     $psnr dB
  held-out SSIM     $ssim
  file              $bytes bytes
  anchors           $anchors, of which $moving move
  training          $train s
  decoding          $decode ms
  rendering         $fps frames per second
  truth, ours, error (times 5), at 4 times: $out/sheet.png

END
echo "{\"psnr\":$psnr,\"bytes\":$bytes,\"train_s\":$train,\"decode_ms\":$decode}"
