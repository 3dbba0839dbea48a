#!/bin/sh
# test_cross.sh - the bookkeeping of conformance/cross/cross.sh, with a compiler that compiles
# nothing and makes programs with several behaviours. Builds that passed are not run again; those
# that lack a tool are skipped and never count as passed; failures and crashes are named; wrong
# claims and different hashes fail, and so do fewer than 12 builds unless some are chosen. Prints
# lines as a cmocka program does; run by `make test` from the project's root.
# SPDX-License-Identifier: BSD-2-Clause
set -u
export LC_ALL=C
. tests/support/speak.sh
need cross ted4conf ted4dec
# cross NAME WANTED-STATUS WANTED-TEXT ['']: runs it on the table as it is, with all builds chosen
# by a pattern, or without a pattern if '' is given.
cross() {
    expect "$1" "$2" "$3" env PATH="$out/bin:$PATH" TED4_BUILD="$out/build" TED4_RESULTS="$out" \
        TED4_TABLE="$out/table" conformance/cross/cross.sh ${4-'*'}
}
# A decoder with sanitizers needs all of its address space, which programs with a runner get.
runner=
! grep -q __asan_init "$TED4_BUILD/ted4dec" || runner=env
# build NAME CLASS COMPILER FLAGS: a line of the table
build() { echo "$1; $2; $3; $4; ; $runner; ; few; package-of-$1" >>"$out/table"; }

# The behaviour of a program is the flag -Dmood=, which it gets with its first object.
key=$({ cat conformance/SUITE.json; find conformance/vectors -name '*.json' | sort |
    tr '\n' '\0' | xargs -0 cat; } | sha256sum | cut -c1-16)
mkdir -p "$out/bin" "$out/build/cross/libraries" "$out/build/cross/suite-$key"
touch "$out/build/cross/libraries/ready"
cp -R conformance/vectors conformance/SUITE.json "$out/build/cross/suite-$key/"
ln -s "$(cd "$TED4_BUILD" && pwd)/ted4conf" "$out/build/ted4conf"
cat >"$out/bin/fakecc" <<END
#!/bin/sh
[ "\$1" != --version ] || { echo "fakecc 1"; exit; }
mood=good object=
for a; do
    case \$a in
    -Dmood=*) mood=\${a#-Dmood=} ;;
    *.o) object=\${object:-\$a} ;;
    ref-decoder/*.c | conformance/*.c) echo "\$a" >>"$out/compiled" ;;
    esac
    [ "\${last:-}" != -o ] || target=\$a
    last=\$a
done
case "\$*" in
*' -c '*) echo "\$mood" >"\$target"; exit ;;
esac
{ echo '#!/bin/sh'; echo "mood=\$(cat "\$object")"; cat "$out/program"; } >"\$target"
chmod +x "\$target"
END
cat >"$out/program" <<END
case \$1 in --ted4-*) exec "$(cd "$TED4_BUILD" && pwd)/ted4dec" "\$@" ;; esac
echo "at AAA-1" >&2
echo "class X"
[ \$mood != wrong ] || echo "fail AAA-1: fail: T3: another hash, or none"
echo "at AAA-2" >&2
[ \$mood != crash ] || kill -SEGV \$\$
if [ \$mood = wrong ]; then echo "vectors 2 passed 1 failed 1"; else echo "vectors 2 passed 2 failed 0"; fi
if [ \$mood = other ]; then echo "tier-e 22"; else echo "tier-e 11"; fi
echo "class-x 33"
END
chmod +x "$out/bin/fakecc"

build one X fakecc -Dmood=good
cross passes 0 'passed   one, '
cross not_again 0 'passed   one (as results.csv says)'
# What it compiles makes a program, here of the objects that are built already.
sanitizers=
[ -z "$runner" ] || sanitizers=-fsanitize=address,undefined
sed -e '/cross_decoder/!{s/c$/o/' -e "s|^|$TED4_BUILD/|" -e '}' -e 's/.*/"&"/' "$out/compiled" \
    >"$out/objects"
if ${CC:-cc} -std=c11 -D_POSIX_C_SOURCE=200809L $sanitizers -Iref-decoder -iquote conformance/tool \
    @"$out/objects" -ljansson -lxxhash -lz -lm -o "$out/linked" >"$out/said" 2>&1; then ok links
else fail links "$(cat "$out/said")"; fi
build two X no-such-cc -O3
cross skipped 0 'skipped  two: no no-such-cc (needs package-of-two)'
if grep -q '| two |.*skipped: no no-such-cc' "$out/CROSS.md" &&
    ! grep -q '^two,' "$out/cross/results.csv"; then
    ok not_passed
else
    fail not_passed "$(cat "$out/CROSS.md")"
fi
build one-more X fakecc -Dmood=other
cross differs 1 'Tier E: 2 different hashes.'
sed -i /one-more/d "$out/table"
build wrong X fakecc -Dmood=wrong
cross named 1 'FAILED   wrong: 1 vectors fail: AAA-1: fail: T3'
sed -i /wrong/d "$out/table"
build crash X fakecc -Dmood=crash
cross crash 1 'FAILED   crash: does not come to its end: at AAA-2'
sed -i /crash/d "$out/table"
build claim none fakecc -Dmood=good
cross claim 1 'FAILED   claim: claims class X; should claim none'
sed -i /claim/d "$out/table"
cross too_few 1 'cross.sh: 1 builds passed; at least 12 have to' ''
for n in 02 03 04 05 06 07 08 09 10 11; do build more-$n X fakecc -Dmood=good; done
cross one_too_few 1 'cross.sh: 11 builds passed; at least 12 have to' ''
build more-12 X fakecc -Dmood=good
cross enough 0 '12 builds passed, 0 failed.' ''
build more-13 X fakecc -Dmood=other
cross enough_but_one 1 'Tier E: 2 different hashes.' ''
sed -i /more-/d "$out/table"
sed -i 's/mood=good/mood=good -O2/' "$out/table"
rm "$out/bin/fakecc"
cross stale 1 'skipped  one: no fakecc'
exit $bad
