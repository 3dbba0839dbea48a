#!/bin/sh
# test_mutants.sh - ted4conf mutants: the lists match the sources; results count only if they come
# from a build whose unchanged program passes, and only as long as everything on which they depend
# stays the same. A small tree replaces the decoder, a script the compiler: the program that it
# "makes" fails at V-two if its source says so. Prints lines as a cmocka program does; run by `make
# test` from the project's root.
# SPDX-License-Identifier: BSD-2-Clause
set -u
. tests/support/speak.sh
need mutants ted4conf
conf=$(cd "$TED4_BUILD" && pwd)/ted4conf
expect lists_fit_the_sources 0 ' mutants, ' "$conf" mutants --check

# The program that the "compiler" makes. $MOOD: how a machine or a build is broken.
mkdir -p "$out/bin" "$out/bench"
cat >"$out/bin/cc" <<'END'
#!/bin/sh
[ "${MOOD:-}" = no-build ] && exit 1
while [ "$1" != -o ]; do shift; done
cp bin/program "$2" && chmod +x "$2"
END
cat >"$out/bin/program" <<'END'
#!/bin/sh
here=$(dirname "$0")
source=$(cat "$here"/ref-decoder/*/*.c "$here/inc/spec/inflate.h" 2>/dev/null)
says() { printf '%s' "$source" | grep -qF "$1"; }
[ "${MOOD:-}" = no-suite ] && { echo 'ted4conf: no memory' >&2; exit 3; }
[ "${MOOD:-}" = no-vector ] && says 'x > 1' && exit 3
echo 'at V-one'
[ "${MOOD:-}" = slow ] && sleep 1
says 'y = 3' && kill -SEGV $$
echo 'at V-two'
says 'v = 3' && { echo 'fail: V-two: not by annex L'; exit 1; }
says 'w = 3' && case " $TED4_KERNEL $* " in
    ' plain '*' --threads 4 '*) echo 'fail: V-two: something else with threads'; exit 1;;
esac
says 'x > 1' && { echo 'fail: V-two: should be valid'; exit 1; }
[ "${MOOD:-}" = wrong ] && { echo 'fail: V-two: as ever'; exit 1; }
echo '2 run, 0 failed'
END
chmod +x "$out/bin/cc"
cp bench/sources.awk "$out/bench"
mkdir -p "$out/tests/spec" "$out/spec" "$out/player/wasm"
cp tests/spec/code.awk "$out/tests/spec"
export PATH="$out/bin:$PATH" TMPDIR="$out"            # folders of campaigns that end early stay

fresh() {
    rm -rf "$out/ref-decoder" "$out/suite"
    for d in base norm read recon; do mkdir -p "$out/ref-decoder/$d";
        echo "int $d;" >"$out/ref-decoder/$d/$d.h"; done
    printf '/* a */\nint f(void)\n{\n    if (x > 0)\n        y = 2;\n    z = 1;\n}\n' \
        >"$out/ref-decoder/norm/f.c"
    printf 'int g(void)\n{\n    w = 1;\n}\n' >"$out/ref-decoder/read/g.c"
    mkdir -p "$out/suite/vectors"
    echo '{"id":"V-one"}' >"$out/suite/vectors/V-one.json"
    echo '{"id":"V-two"}' >"$out/suite/vectors/V-two.json"
    cat >"$out/suite/mutants.list" <<'END'
mutant gt ref-decoder/norm/f.c
< if (x > 0)
> if (x > 1)
mutant crash
< y = 2;
> y = 3;
mutant lives ref-decoder/read/g.c
< w = 1;
> w = 2;
= nobody looks
END
    printf 'mutant same ref-decoder/norm/f.c\n< z = 1;\n> z = 0 + 1;\n= the same\n' \
        >"$out/suite/mutants-equivalent.list"
}
mutants() { (cd "$out" && MOOD=${mood:-} "$conf" mutants -s suite -b . --compile true \
    --libraries '' "$@"); }
# holds NAME N: N results are still valid.
holds() { expect "$1" 0 "3 mutants, $2 with a result that holds" mutants --check; }
ran() { fresh; mutants >/dev/null 2>&1; }
rows() { if [ -f "$out/suite/mutants.csv" ]; then fail "$1" "there are rows"; else ok "$1"; fi; }

fresh
holds nothing_ran 0
expect all_run 1 '3 mutants, 2 killed, 1 survived, 0 not judged: not enough' mutants
check rows "$out/suite/mutants.csv" ',killed,V-two,should be valid' ',killed,V-one,crash' \
    ',survived,,'
check page "$out/suite/MUTANTS.md" '| killed | 2 (66.7 %) |' \
    '| lives | ref-decoder/read/g.c | plain | survived | `w = 1;` | `w = 2;` | nobody looks |' \
    '`mutants.csv` names the first vector'
holds all_hold 3
cp "$out/suite/mutants.csv" "$out/before"
mutants >/dev/null 2>&1
if cmp -s "$out/before" "$out/suite/mutants.csv"; then ok nothing_twice;
else fail nothing_twice "rows were added"; fi

# What results depend on.
printf '/* b */\nint  f(void)\n{\n    if (x > 0)\n        y = 2;\n    z = 1;\n}\n' \
    >"$out/ref-decoder/norm/f.c"
holds comments_and_spacing 3
echo 'int h;' >>"$out/ref-decoder/norm/f.c"
holds code_of_its_file 0
ran; echo 'int h;' >>"$out/ref-decoder/read/g.c"
holds code_of_another_file 2
ran; sed -i 's/x > 1/x > 2/' "$out/suite/mutants.list"
holds text 2
ran; echo '{"id":"V-three"}' >"$out/suite/vectors/V-three.json"
holds suite_grows 2
mutants --only none >/dev/null 2>&1
check no_share_of_some "$out/suite/MUTANTS.md" '| killed | 2 |' '| not run | 1 |' \
    '* ref-decoder/read/g.c: lives'
fresh; mutants --only none >/dev/null 2>&1
check all_wait "$out/suite/MUTANTS.md" 'none' '* ref-decoder/norm/f.c: gt crash' \
    '* ref-decoder/read/g.c: lives'
expect no_compiler 3 '--compile is missing' sh -c "cd '$out' && '$conf' mutants -s suite -b ."
ran; echo '{"id":"V-two","rules":["R-CON-001"],"intent":"more"}' >"$out/suite/vectors/V-two.json"
holds what_is_said_of_vectors 3
ran; echo '{"id":"V-two","bytes":1}' >"$out/suite/vectors/V-two.json"
holds killing_vector_changes 1
ran; rm "$out/suite/vectors/V-two.json"
holds killing_vector_goes 1
mutants >/dev/null 2>&1
holds stale_ones_run_again 2
ran; sed -i 's/x > 1/x > 2/' "$out/suite/mutants.list"; mutants >/dev/null 2>&1
holds rows_again 3
if [ "$(wc -l <"$out/suite/mutants.csv")" -eq 3 ]; then ok stale_rows_go;
else fail stale_rows_go "$(cat "$out/suite/mutants.csv")"; fi

# Places: with threads, by the printed decoder of DEFLATE, and by kernels that no machine has
# together with this one's.
case $(uname -m) in x86_64) far=neon lacks=NEON;; *) far=v3 lacks=AVX2;; esac
places() {
    fresh
    for d in kernel tool; do mkdir -p "$out/ref-decoder/$d"; done
    echo 'int k;' | tee "$out/ref-decoder/kernel/k.h" >"$out/ref-decoder/kernel/k.c"
    echo 'int t;' | tee "$out/ref-decoder/tool/threads.h" >"$out/ref-decoder/tool/threads.c"
    echo 'int i;' >"$out/player/wasm/inflate.c"
    printf 'Text.\n\n```c\n    v = 1;\n```\n' >"$out/spec/annex-l-deflate.md"
    cat >>"$out/suite/mutants.list" <<END
mutant race
> w = 3;
@ threads
mutant annex spec/annex-l-deflate.md
< v = 1;
> v = 3;
@ printed
mutant away ref-decoder/kernel/k.c
< int k;
> int l;
@ $far
END
}
sees() { expect "$1" 0 "6 mutants, $2 with a result that holds" mutants --check; }
places
expect places_run 1 '6 mutants, 4 killed, 1 survived, 1 not judged: not enough' mutants
check places_rows "$out/suite/mutants.csv" 'race,' ',killed,V-two,something else with threads' \
    ',killed,V-two,not by annex L'
check places_page "$out/suite/MUTANTS.md" '| not run | 1 |' '| killed | 4 (80.0 %) |' \
    '| threads | 1 | 1 | 0 |' "* ref-decoder/kernel/k.c, for $lacks: away"
if grep -q '^away,' "$out/suite/mutants.csv"; then fail no_row_of_absent "there is one";
else ok no_row_of_absent; fi
sees places_hold 5
sed -i 's/@ threads/@ printed/' "$out/suite/mutants.list"
sees place_of_a_mutant 4
places; sed -i 's/w = 3/w = 4/' "$out/suite/mutants.list"; mutants >/dev/null 2>&1
sees place_of_a_survivor 5
echo 'int m;' >>"$out/ref-decoder/kernel/k.c"
sees kernels_of_a_survivor 4
places; sed -i 's/@ threads/@ moon/' "$out/suite/mutants.list"
expect place_unknown 3 'race: no such place: @ moon' mutants --check

# A broken machine, build or suite kills no mutant.
for mood in no-build no-suite wrong; do
    fresh
    expect "unchanged_$mood" 3 'the unchanged program' mutants
    rows "no_rows_$mood"
done
mood=slow; fresh
expect unchanged_slow 3 'mutants need a time limit of 4 times that' mutants -t 3
mood=no-vector; fresh
expect came_to_no_vector 3 'gt: the runner was ended, or came to no vector' mutants --only gt
rows no_rows_no_vector
mood=

# Lists that do not match.
fresh; sed -i 's/w = 1/w = 7/' "$out/ref-decoder/read/g.c"
expect text_is_not_there 3 'lives: its line is in ref-decoder/read/g.c 0 times: w = 1;' mutants \
    --check
fresh; echo '    w = 1;' >>"$out/ref-decoder/read/g.c"
expect text_is_there_twice 3 'lives: its line is in ref-decoder/read/g.c 2 times' mutants --check
fresh; sed -i 's/z = 1/z = 2/' "$out/ref-decoder/norm/f.c"
expect equivalent_is_not_there 3 'same: its line is in ref-decoder/norm/f.c 0 times' mutants --check
fresh; sed -i '/^=/d' "$out/suite/mutants-equivalent.list"
expect equivalent_says_why 3 'same: why?' mutants --check
fresh; sed -i '1s/ ref-decoder.*//' "$out/suite/mutants.list"
expect file_of_the_first 3 'bad line: mutant gt' mutants --check
fresh; cat "$out/suite/mutants.list" >"$out/twice"; cat "$out/twice" >>"$out/suite/mutants.list"
expect id_twice 3 'gt is there twice' mutants --check
exit $bad
