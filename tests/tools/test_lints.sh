#!/bin/sh
# test_lints.sh - the lints detect what they claim to detect. Violations of each lint are planted in
# a copy of the tree: the lint must then fail, and name each of them. A lint for which nothing is
# planted here fails this test. Words that the lints would see in this file too are written with a
# gap ("99""9").
# Prints lines as a cmocka program does; run by `make test` from the project's root.
# SPDX-License-Identifier: BSD-2-Clause
set -u
. tests/support/speak.sh
need lints python3
root=$(pwd)
tree=$out/tree
mkdir "$tree"
tar -cf - --exclude='./build*' --exclude=./.git --exclude=./out --exclude=./shared . |
    tar -xf - -C "$tree"
cd "$tree" || exit 1

# file NAME LINE...: plants a file, or lines at the end of an existing one
file() {
    planted="$planted $1"
    mkdir -p "$(dirname "$1")"
    to=$1; shift
    printf '%s\n' "$@" >>"$to"
}
# edit NAME COMMAND...: changes a file by commands of sed, which have to change something
edit() {
    planted="$planted $1"
    to=$1; shift
    sed -i "$@" "$to"
    ! cmp -s "$to" "$root/$to" || fail "$lint" "nothing to edit in $to"
}
# says TEXT...: the lint, run on what is planted so far, fails and prints each text. Afterwards the
# tree is as before.
says() {
    if sh "tests/lint/$lint.sh" >"$out/said" 2>&1; then lost="it passes"; else lost=; fi
    for text; do
        grep -qF -e "$text" "$out/said" || lost="$lost
it does not say: $text"
    done
    if [ -z "$lost" ]; then ok "$lint"; else fail "$lint" "$lost
but: $(head -n 40 "$out/said")"; fi
    for f in $planted; do
        if [ -e "$root/$f" ]; then cp "$root/$f" "$f"; else rm -f "$f"; fi
    done
    planted=
}
# long N: prints a word of N letters
long() { printf "%0$1d" 0; }
# lines N: prints N lines
lines() { yes '    x++;' | head -n "$1"; }

plant_checks() {
    file tests/support/plant.h '    most[i % 3] = fma''xf(most[i % 3], x);' \
        '    *worst = fma''x(' '        *worst, y);' '    high = fma''x(low, high);' \
        '    // asse''rt_true(x);' '    /* fail_''msg("x"); */' '#if'' 0'
    says 'plant.h: a maximum that skips NaN: most[i % 3]' 'a maximum that skips NaN: *worst' \
        'plant.h: left out: 5:' 'plant.h: left out: 6:' 'plant.h: left out: 7:'
    ! grep -q high "$out/said" || fail checks_spares "$(cat "$out/said")"
}

plant_circles() {
    for pair in a_b b_c c_a; do
        file "tools/scene/plant_${pair%_*}.c" "void plant_in_${pair%_*}(void)" '{' \
            "    plant_in_${pair#*_}();" '}'
    done
    file ref-encoder/train/step/plant_top.c 'void plant_on_top(void)' '{' '}'
    file ref-encoder/train/math/plant_below.c 'void plant_below(void)' '{' '    plant_on_top();' '}'
    file ref-encoder/train/cellar/plant_lost.c 'void plant_lost(void)' '{' '}'
    says 'tools/scene: a circle of 3 files: plant_a plant_b plant_c' \
        'train/math/plant_below.c: calls plant_on_top of ref-encoder/train/step/plant_top.c, which' \
        'ref-encoder/train/cellar/plant_lost: its folder has no floor'
    rmdir ref-encoder/train/cellar
}

plant_cites() {
    file ref-decoder/base/arena.c '/* Algorithm'' facts */'
    file doc/switches.md "As the project's"" issue says."
    says 'arena.c:' '(cites what is not here)' 'doc/switches.md:'
}

plant_columns() {
    for f in plant.c plant.def plant.sh plant.awk plant.py plant.js plant.mjs plant.mk; do
        file "tools/$f" "$(long 101)"
    done
    file tools/plant.md "$(long 60) $(long 60)"
    says tools/plant.c:1 tools/plant.def:1 tools/plant.sh:1 tools/plant.awk:1 tools/plant.py:1 \
        tools/plant.js:1 tools/plant.mjs:1 tools/plant.mk:1 'tools/plant.md:1: 121 columns'
}

plant_debian() {
    edit debian/changelog '1s/(.*)/(0.0.1)/'
    file debian/ted4.docs doc/planted.md
    edit debian/control "s/^ This package contains the shared library\./ $(long 80)/"
    says 'debian/changelog: version 0.0.1, but ted4.h has' \
        'doc/planted.md is named, but does not exist' 'debian/control:44: 81 columns'
}

plant_elsewhere() {
    file conformance/rules-elsewhere.txt 'tests/decoder/planted.c'
    file conformance/branches-excluded.txt 'ref-decoder/norm/planted.c'
    says 'tests/decoder/planted.c is named, but does not exist' \
        'ref-decoder/norm/planted.c is named, but does not exist'
}

# It stops at the first difference.
plant_errors() {
    edit spec/14-errors.md '/^| `con.magic` /d'
    says 'spec/14-errors.md lacks: | `con.magic` | 5.1 |'
    edit spec/14-errors.md '/^| `con.magic` /{p; s/con.magic/con.planted/}'
    says 'spec/14-errors.md lists other identifiers than status.def'
}

plant_findings() {
    edit ref-decoder/read/findings.def '/(E_CON_MAGIC,/d'
    says 'findings.def: no line for E_CON_MAGIC' 'not one line for each verdict'
    edit ref-decoder/read/findings.def '/(E_CON_MAGIC,/s/R-CON-001/R-CON-002/'
    says 'findings.def: R-CON-002 does not name con.magic'
    edit ref-decoder/read/findings.def '/(E_CON_MAGIC,/s/R-CON-001/R-CON-9''99/'
    says 'findings.def: no rule R-CON-9''99'
}

plant_format() {
    if ! command -v clang-format-14 >/dev/null; then
        skip format "there is no clang-format-14"
        return
    fi
    for folder in ref-decoder/base ref-encoder/math conformance/tool fuzz tests/support bench \
        tools player/wasm doc/examples
    do file $folder/plant.c 'int  planted( void );'; done
    says ref-decoder/base/plant.c:1 ref-encoder/math/plant.c:1 conformance/tool/plant.c:1 \
        fuzz/plant.c:1 tests/support/plant.c:1 bench/plant.c:1 tools/plant.c:1 \
        player/wasm/plant.c:1 doc/examples/plant.c:1
}

plant_help() {
    file Makefile '.PHONY: planted'
    file tools/make-help.txt '  grown   a target that there is not' "  $(long 120)"
    says 'no line for the target planted' 'there is no target grown' 'more than 100 columns'
}

plant_includes() {
    file ref-decoder/norm/plant.c '#include "render/project.h"'
    file ref-encoder/train/math/plant_m.c '#include "train/step/step.h"'
    file ref-decoder/base/plant_b.h '#include "planted.h"' '#  include "planted/a.h" /* a */' \
        '    #include "planted/b.h"' '#include <render/raster_plain.h>' \
        '#include <arena.h>' '#include <png.h>'
    says 'ref-decoder/norm/plant.c: may not include render/project.h' \
        'plant_m.c: may not include train/step/step.h' 'plant_b.h: may not include planted.h' \
        'may not include planted/a.h' 'may not include planted/b.h' \
        'render/raster_plain.h is in angle brackets' 'arena.h is in angle brackets'
    ! grep -q png.h "$out/said" || fail includes_spares "$(cat "$out/said")"
}

# As clang-format leaves a tag behind text that it has moved.
plant_licences() {
    file tools/plant_none.c 'int x;'
    file tools/plant_pieces.c '/* A file. SPDX-License''-Identifier:' ' * BSD-2-Clause */'
    file bench/plant_behind.h '/* A file.' ' * And more. SPDX-License''-Identifier: BSD-2-Clause */'
    file tools/plant_more.sh '# SPDX-License''-Identifier: BSD-2-Clause and more'
    says 'tools/plant_none.c: no licence' 'tools/plant_pieces.c: a licence in pieces' \
        'bench/plant_behind.h: a licence behind other text' \
        'tools/plant_more.sh: a licence in pieces'
}

# Variables, whatever they look like; memory, printing and the end in each folder of the library.
plant_memory() {
    file ref-decoder/norm/plant.c 'int kept_a;' 'static const char *kept_b = "x;{";' \
        'static const char *const name[] = { "a" };' 'static int (*kept_c)(void);' \
        'static int (*const fixed)(void) = 0;' 'static int kept_d[N(3)];' \
        '_Alignas(64) static int kept_e;' 'static struct point kept_f;' \
        'static struct { int x; } kept_g;' 'static _Atomic(int) kept_h;' \
        '__attribute__((aligned(64))) static int kept_i[3] = { 1 };' \
        'static const int steady = 1, *kept_j;' '_Thread_local int kept_k;' \
        '#define PLANT(x) static int kept_l_##x' 'struct known { int x; };' 'enum { A = 1 };' \
        'int f(void)' '{' '    static int kept_m = 1;' '    static const int m[] = { 1 };' \
        '    switch (m[0]) {' '    case 1: {' '        static _Thread_local' \
        '            uint64_t kept_n[2];' '    }' '    }' \
        '    return (struct known) { .x = 1 }.x;' '}'
    file ref-decoder/base/plant.h '    p = malloc(1);' '    use = realloc;'
    file ref-decoder/norm/plant_s.c '    f("\"malloc(1)\"");' '    f("\"" "x", calloc(1, 2), "\"");'
    file ref-decoder/read/plant.c '    inflateInit(&z);' '    f = fopen(p, "r");'
    file ref-decoder/kernel/plant.c '    abort();' '    thrd_create(&t, f, p);'
    file ref-decoder/recon/plant.c '    printf("x");' '    free(p);'
    set --
    for i in a b c d e f g h i j k l m n; do set -- "$@" "kept_$i"; done
    says "$@" 'base/plant.h: memory of its own:     p = malloc(1)' 'use = realloc' \
        'read/plant.c: zlib has malloc' 'read/plant.c: prints, ends or starts a thread:' \
        'kernel/plant.c: prints, ends or starts a thread:     abort()' 'thrd_create(&t' \
        'recon/plant.c: prints, ends or starts a thread:' 'recon/plant.c: memory of its own:'
    grep -q 'plant_s.c: memory of its own: .*calloc' "$out/said" ||
        fail memory_strings "$(grep plant_s "$out/said")"
    ! grep -q 'plant_s.c: .*malloc(1)' "$out/said" || fail memory_strings "text counts"
    spared=$(grep -cE 'keeps: .*(name|fixed|known|m\[\])' "$out/said")
    [ "$spared" -eq 0 ] || fail memory_spares "$(grep keeps: "$out/said")"
    edit Makefile 's/addprefix ref-decoder/addprefix gone/'
    says 'Makefile: no folders in DEC_SRC'
}

plant_nofloat() {
    file ref-decoder/norm/plant.c 'double x;' 'int y = log2f(z);'
    set --
    for n in 0.5f 1e-3f .25f 0x1p-3f 2. 1E4 3.e1 0X.8P+2; do
        file ref-decoder/read/plant.h "float x = $n;"
        set -- "$@" "x = $n;"
    done
    file ref-decoder/read/plant.h '#include <math.h>'
    file ref-decoder/read/plant_i.h 'int x = 0x1e3 + 0x1eULL - 0xe-3;' 'int y = s.e1;' \
        'f("\" 0.5 ");'
    says 'norm/plant.c: ' 'double x' 'log2f(z)' 'read/plant.h: ' 'math.h' "$@"
    ! grep -q plant_i "$out/said" || fail nofloat_spares "$(cat "$out/said")"
    # The programs that the lint needs besides gcc.
    mkdir "$out/few"
    for program in sh sed grep; do ln -s "$(command -v $program)" "$out/few/$program"; done
    path=$PATH
    PATH=$out/few
    if sh tests/lint/nofloat.sh >"$out/said"; then gone="it passes"; else gone=; fi
    PATH=$path
    [ -z "$gone" ] && grep -q 'there is no gcc' "$out/said" && ok nofloat_needs ||
        fail nofloat_needs "$gone$(cat "$out/said")"
}

plant_outside() {
    file ref-decoder/norm/plant.c '    const char *x = getenv("X");' '    return system(x);'
    file ref-decoder/tool/plant.c '    run = popen;' '    execvp(a, b);' '    posix_spawn(&a);'
    file ref-encoder/data/plant.c '    fork();' '    s.system(1);' '    p->popen(x);' \
        '    puts("execv(x)");' '    /* dlopen */'
    file bench/plant.h '    socket(a, b, c);' '    return environ[0];'
    edit ref-decoder/base/level.c 's/getenv(/no_name(/'
    says 'norm/plant.c: may not use getenv' 'norm/plant.c: may not use system' \
        'tool/plant.c: may not use popen' 'tool/plant.c: may not use execvp' \
        'tool/plant.c: may not use posix_spawn' 'data/plant.c: may not use fork' \
        'bench/plant.h: may not use socket' 'bench/plant.h: may not use environ' \
        'ref-decoder/base/level.c does not use getenv'
    spared=$(grep -cE 'data/plant.c: may not use (system|popen|execv|dlopen)' "$out/said")
    [ "$spared" -eq 0 ] || fail outside_spares "$(cat "$out/said")"
}

plant_readme() {
    file README.md '[planted](doc/planted.md)' '[away](#planted)' "$(long 900)"
    file bench/plant.md '[planted](absent.md)'
    file player/README.md '[planted](../README.md#planted)'
    edit README.md -E 's/^    make deps (demo|test)/    make \1/; s/\.(jpe?g|png|svg)\)/.gif)/'
    says 'README.md: more than 6,000 bytes' "no 'make deps demo' in" "no 'make deps test' in" \
        'README.md: no picture' 'README.md: no chart' \
        'README.md: link to doc/planted.md, which does not exist' \
        'README.md: link to #planted, which is no heading' \
        'bench/plant.md: link to absent.md, which does not exist' \
        'player/README.md: link to ../README.md#planted, which is no heading'
}

plant_sections() {
    file ref-encoder/data/image_file.c '/* spec 9''9.9 */'
    file player/plant.js '// spec 9''6.1'
    file python/plant.py '# annex'' B.95'
    file doc/switches.md 'See chapter 7''7, or annex'' C.88.'
    says 'spec 9''9.9: cited, but' 'spec 7''7: cited, but' 'spec C.''88: cited, but' \
        'spec 9''6.1: cited, but no such heading: player/plant.js' \
        'spec B.''95: cited, but no such heading: python/plant.py'
}

plant_size() {
    file ref-decoder/base/plant.c "$(lines 601)"
    file tools/plant_s.sh 'f() {' "$(lines 61)" '}' "$(lines 340)"
    file tools/plant_p.py 'def f():' "$(lines 61)" 'x = 1'
    file fuzz/plant.c 'int f(void)' '{' "$(lines 61)" '}'
    file player/wasm/plant_w.c "$(lines 601)"
    file doc/examples/plant_e.c "$(lines 601)"
    says 'ref-decoder/base/plant.c: 601 lines' 'tools/plant_s.sh: 403 lines' \
        'tools/plant_s.sh:1: function of 62 lines' 'tools/plant_p.py:1: function of 61 lines' \
        'fuzz/plant.c:2: function of 62 lines' 'file names used twice: plant.c' \
        'player/wasm/plant_w.c: 601 lines' 'doc/examples/plant_e.c: 601 lines'
}

plant_spec_json() {
    edit spec/rules.json 's/"section":"5.1"/"section":"5.2"/'
    edit spec/errors.json 's/"text":"not a TED4 file"/"text":"planted"/'
    says 'spec/rules.json is not what its sources say' 'spec/rules.json differs from annex G' \
        'spec/errors.json is not what its sources say' 'spec/errors.json differs from the table'
}

plant_spec_rules() {
    file ref-decoder/base/arena.c '/* R-CON-9''99 */'
    file spec/annex-g-rules.md '| R-CON-001 | 5.1 | stream | none | `con.planted` |'
    edit ref-decoder/base/status.def '/(E_CON_MAGIC,/s/con.magic/con.grown/'
    says 'spec/annex-g-rules.md is not what the rules say' 'R-CON-001: defined twice' \
        'R-CON-001: no MUST, SHOULD or MAY' 'R-CON-9''99: quoted, but no such rule' \
        'con.grown: in status.def, but no rule names it' \
        'con.planted: named by a rule, but not in status.def'
}

plant_spec_text() {
    file spec/98-planted.md '[x](absent.md), see (9''9.9), in /var/x' '```c' 'x = a << 3 | b;'
    says 'link to absent.md, which does not exist' 'spec/98-planted.md: not in the table' \
        'section 9''9.9 is cited, but' 'names an absolute path or a host' \
        'spec/98-planted.md: a code block is not closed' 'a shift and a mask without parentheses'
}

plant_switches() {
    edit doc/switches.md '/^| `motion` | 0 to 3 /s/0 to 3/0 to 4/'
    says 'doc/switches.md is not what options.def says'
}

plant_temporary() {
    file tests/support/plant.h 'static const char *where = "/t''mp/";'
    says 'tests/support/plant.h:1:' '(use temporary.h)'
}

planted=
for l in tests/lint/*.sh; do
    lint=$(basename "$l" .sh)
    if command -v "plant_$lint" >/dev/null; then "plant_$lint"
    else fail "$lint" "nothing is planted for this lint"; fi
done
exit $bad
