#!/bin/sh
# test_bench_scripts.sh - bench/memory.sh and bench/outlined.sh with programs that only seem to
# work: wrong arguments and failures are told, and a page never mixes scenes of different sizes.
# Prints lines as a cmocka program does; run by `make test` from the project's root.
# SPDX-License-Identifier: BSD-2-Clause
set -u
. tests/support/speak.sh
mkdir "$out/bin" "$out/bin/bench"
export TED4_BUILD="$out/bin" TED4_OUT="$out/memory" TED4_PAGE="$out/page.md"

cat >"$out/bin/ted4scene" <<'END'
#!/bin/sh
echo made >>"$TED4_OUT/made"
mkdir -p "$3/cam00/images"
for i in 0 1 2; do : >"$3/cam00/images/000$i.png"; done
END
cat >"$out/bin/ted4enc" <<'END'
#!/bin/sh
echo '{"anchors":12}' >"${3%.ted4}.jsonl"
echo '{"gaussians":34,"peak_mib":56}'
END
cat >"$out/bin/ted4eval" <<'END'
#!/bin/sh
echo "ted4eval: scene: no such folder" >&2
exit 3
END
chmod +x "$out/bin"/ted4*

# measured NAME FRAMES RUN TIMES: memory.sh succeeds, and so many scenes have been made since the
# beginning.
measured() {
    if FRAMES=$2 bench/memory.sh "$3" >"$out/said" 2>&1 &&
        [ "$(grep -c '' "$TED4_OUT/made")" = "$4" ]; then ok "$1"
    else fail "$1" "$(cat "$out/said" "$TED4_OUT/made")"; fi
}
echo kept >"$TED4_PAGE"
expect memory_unknown 3 "memory.sh: typical: not a run; runs are largest" \
    bench/memory.sh usual typical
check memory_kept "$TED4_PAGE" kept
measured memory_fine 5 usual 1
check memory_row "$TED4_PAGE" '| usual | `--iterations 150,60 --preset medium` | 12 | 34 | 56 |' \
    'The scene has 5 frames'
measured memory_once 5 largest 1
check memory_both "$TED4_PAGE" '| usual |' '| largest |'
measured memory_twice 7 largest 2
check memory_one "$TED4_PAGE" '| largest |' 'The scene has 7 frames'
if grep -q '| usual |' "$TED4_PAGE"; then fail memory_mixed "$(cat "$TED4_PAGE")"
else ok memory_mixed; fi

printf '8 8\n00000 0,0 4,0 4,4\n' >"$out/outlines"
expect outlined_failure 3 "ted4eval: scene: no such folder" \
    bench/outlined.sh x.ted4 scene "$out/outlines" 1
exit $bad
