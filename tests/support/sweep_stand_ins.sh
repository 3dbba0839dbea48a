# sweep_stand_ins.sh - a table of three runs for bench/sweep.sh, and stand-in programs that make
# rows of it without any training. Sourced after speak.sh by tests of that script; $out/calls has
# the arguments of each call.
# SPDX-License-Identifier: BSD-2-Clause
cat >"$out/table.txt" <<END
lambdas 0.001
base --preset draft
scene room  room
scene upper room      --downscale 2 --hold-out cam10
scene other room@tint --downscale 2
run rd whole room,upper,other 1 -
END
mkdir -p "$out/build/bench" "$out/bin" "$out/data/room" "$out/data/tint"
# stand_in PROGRAM: makes a stand-in that runs the script on stdin.
stand_in() { { echo '#!/bin/sh'; cat; } >"$out/$1"; chmod +x "$out/$1"; }
stand_in bin/make </dev/null
stand_in build/ted4enc <<END
while [ \$# -gt 0 ]; do
    case \$1 in -o) file=\$2 ;; --log) log=\$2 ;; --hold-out) held=\$2 ;; --stage1) first=\$2 ;; esac
    shift
done
echo "train \${held:-}" >>"$out/calls"
echo x >"\$file"
echo x >"\$first"
echo '{"step":250,"stage":"1","loss":0.5,"psnr":20,"anchors":5,"bytes":0,"ms":4,"seconds":1.25,"cpu_seconds":0.5}' >"\$log"
echo '{"anchors":5,"gaussians":9,"dynamic":2,"estimated_bits":10,"coded_bits":11,"hash":"abc"}'
END
stand_in build/ted4eval <<END
shift
echo "eval \$*" | sed 's/ [^ ]*\/data\// /' >>"$out/calls"
echo '{"psnr":30.25,"bytes":123}'
END
echo 'echo "{\"decode_ms\":5}"' | stand_in build/ted4dec
echo 'echo "{\"budget\":[]}"' | stand_in build/ted4info
for program in build/ted4scene build/bench/rate_check build/bench/spans build/bench/to_jpeg; do
    echo 'echo "{}"' | stand_in $program
done
use_stand_ins() {
    PATH=$out/bin:$PATH TED4_BUILD=$out/build TED4_RESULTS=$out TED4_TABLE=$out/table.txt
    TED4_DATA=$out/data
    export PATH TED4_BUILD TED4_RESULTS TED4_TABLE TED4_DATA
}
stand_ins() { ( use_stand_ins; exec bench/sweep.sh "$@" ); }
