#!/bin/sh
# test_encoder_mutants.sh - make encoder-mutants: the list matches the sources; results count only
# if the unchanged programs pass, and only as long as what they depend on stays the same. A small
# tree replaces the encoder, and a script replaces make: the program that it "builds" reads the
# source. Prints lines as a cmocka program does; run by `make test` from the project root.
# SPDX-License-Identifier: BSD-2-Clause
set -u
. tests/support/speak.sh
need encoder_mutants encoder_mutants
tool=$(cd "$TED4_BUILD" && pwd)/encoder_mutants
expect list_fits_the_sources 0 ' mutants, ' "$tool" --check

# The "make", which is given the programs to build, and the program.
mkdir -p "$out/tree/bench" "$out/tree/bin"
cp bench/sources.awk "$out/tree/bench"
cat >"$out/tree/bin/make" <<'END'
#!/bin/sh
grep -q 'z = ;' ref-encoder/a.c && { echo 'a.c: error'; exit 1; }
[ "${MOOD:-}" = no-build ] && exit 1
for t in "$@"; do mkdir -p "$(dirname "$t")"; cp bin/program "$t"; chmod +x "$t"; done
END
cat >"$out/tree/bin/program" <<'END'
#!/bin/sh
says() { grep -qF "$1" ref-encoder/a.c; }
name=$(basename "$0")
[ "${MOOD:-}" = wrong ] && { echo '[  FAILED  ] as_ever: 1'; exit 1; }
[ "${MOOD:-}" = slow ] && sleep 1
[ "${MOOD:-}" = idle ] && exit 0
[ $name = test_two ] && says 'x > 1' && { echo '[  FAILED  ] compares'; exit 1; }
says 'y = 3' && kill -SEGV $$
says 'y = 4' && exec sleep 60
echo '[       OK ] compares'
END
chmod +x "$out/tree/bin/make"
export TMPDIR="$out"                                  # copies of campaigns that end early stay

fresh() {
    (
        cd "$out/tree" || exit
        rm -rf ref-encoder tests build
        mkdir -p ref-encoder/math tests/x tests/mutants build
        printf '/* a */\nint f(void)\n{\n    if (x > 0)\n        y = 2;\n    z = 1;\n}\n' \
            >ref-encoder/a.c
        echo 'int g;' >ref-encoder/math/g.c
        echo 'int one;' >tests/x/test_one.c
        echo 'int two;' >tests/x/test_two.c
        cat >tests/mutants/mutants.list <<'END'
mutant a-gt ref-encoder/a.c
< if (x > 0)
> if (x > 1)
! x/test_one x/test_two
mutant a-crash ref-encoder/a.c
< y = 2;
> y = 3;
! x/test_one
mutant b-lives ref-encoder/a.c
< z = 1;
> z = 2;
= nobody looks
! x/test_one x/test_two
END
    )
}
mutants() { (cd "$out/tree" && MOOD=${mood:-} "$tool" --make bin/make "$@"); }
# holds NAME N: N results are still valid.
holds() { expect "$1" 0 "mutants, $2 with a result that holds" mutants --check; }
ran() { fresh; mutants >/dev/null 2>&1; }
csv="$out/tree/tests/mutants/mutants.csv"
rows() { if [ -f "$csv" ]; then fail "$1" "there are rows"; else ok "$1"; fi; }

fresh
holds nothing_ran 0
expect all_run 1 '3 mutants, 2 killed, 1 survived, 0 not judged: not enough' mutants
check rows "$csv" ',killed,x/test_two,compares' ',killed,x/test_one,crash: signal' ',survived,,'
check page "$out/tree/tests/mutants/MUTANTS.md" '| killed | 2 (66.7 %) |' '| a | 2 | 2 |' \
    '| b | 1 | 0 |' \
    '| b-lives | ref-encoder/a.c | survived | `z = 1;` | `z = 2;` | nobody looks |'
holds all_hold 3
cp "$csv" "$out/before"
mutants >/dev/null 2>&1
if cmp -s "$out/before" "$csv"; then ok nothing_twice; else fail nothing_twice "rows were added"; fi
if cmp -s "$out/tree/ref-encoder/a.c" - <<'END'
/* a */
int f(void)
{
    if (x > 0)
        y = 2;
    z = 1;
}
END
then ok source_untouched; else fail source_untouched "the tree was changed"; fi
if ls "$out" | grep -q ted4mutants; then fail copy_removed "$out"; else ok copy_removed; fi

# What results depend on.
sed -i 's,/\* a \*/,/* b */,' "$out/tree/ref-encoder/a.c"
holds comments 3
echo 'int h;' >>"$out/tree/ref-encoder/a.c"
holds code_of_its_file 0
ran; echo 'int h;' >>"$out/tree/ref-encoder/math/g.c"
holds code_of_another_file 2
ran; echo 'int h;' >>"$out/tree/tests/x/test_two.c"
holds program_changes 1
ran; rm "$out/tree/tests/x/test_two.c"
holds program_goes 1
ran; sed -i 's/x > 1/x > 2/' "$out/tree/tests/mutants/mutants.list"
holds text 2
fresh; mutants --only b >/dev/null 2>&1
check some "$out/tree/tests/mutants/MUTANTS.md" '| killed | 0 |' '| not run | 2 |' \
    '## Not run' '| a-gt | ref-encoder/a.c |'
holds some_hold 1

# Mutants that do not terminate or do not compile.
fresh; sed -i 's/y = 3/y = 4/' "$out/tree/tests/mutants/mutants.list"
mutants --only a-crash -t 5 >/dev/null 2>&1
check hang "$csv" ',killed,x/test_one,hang'
fresh; sed -i 's/z = 2/z = ;/' "$out/tree/tests/mutants/mutants.list"
mutants --only b >/dev/null 2>&1
check no_compile "$csv" ',no compile,,'

# A broken machine or build kills no mutant.
for mood in no-build wrong idle; do
    fresh
    expect "unchanged_$mood" 3 'the unchanged x/test_one' mutants
    rows "no_rows_$mood"
done
mood=slow; fresh
expect unchanged_slow 3 'mutants need a time limit of 4 times that' mutants -t 3
mood=

# Lists that do not match.
expect no_make 3 '--make is missing' sh -c "cd '$out/tree' && '$tool'"
fresh; sed -i 's/z = 1/z = 7/' "$out/tree/ref-encoder/a.c"
expect text_is_not_there 3 'b-lives: its line is in ref-encoder/a.c 0 times' mutants --check
fresh; sed -i '/^!/d' "$out/tree/tests/mutants/mutants.list"
expect names_programs 3 'a-gt: no program judges it' mutants --check
exit $bad
