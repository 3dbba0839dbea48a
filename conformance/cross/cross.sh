#!/bin/sh
# cross.sh - runs the conformance suite on our decoder, built in every way that builds.txt lists,
# and writes results.csv and ../CROSS.md. `make cross`.
# Usage, from anywhere:  conformance/cross/cross.sh [--list | --report] [PATTERN...]
#     PATTERN...   builds whose name fits one of these shell patterns; all builds without any
#     --list       only says what state each build is in
#     --report     only writes CROSS.md
# A build is made and run unless results.csv has a row of it that passed with these sources, this
# line of builds.txt and this compiler; comments and spacing of sources do not count. The judge
# counts only for builds that are asked everything by the contract: two hashes represent the answers
# of a build, so one build that is judged again stands for all with the same hashes. A build whose
# compiler or runner is missing is skipped and reported; a row that it has of the same sources
# stays. The script may be killed at any moment and called again, and may run several times at once
# for different compilers. Exit code: 0; 1 if a build fails, two of them disagree, or too few have
# passed (fewer than 12, since skipped ones prove nothing; fewer than 1 with a PATTERN); 3 for wrong
# usage, no suite, no libraries.
# Environment: TED4_BUILD (build: where ted4conf is; it works in TED4_BUILD/cross), TED4_RESULTS
# (conformance: where cross/results.csv and CROSS.md are), TED4_TABLE
# (conformance/cross/builds.txt).
# SPDX-License-Identifier: BSD-2-Clause
set -u
program=cross.sh
columns=name,key,compiler,class,vectors,passed,tier_e,class_x
columns=$columns,contract_vectors,contract_passed,seconds,verdict
fields="name class compiler flags link runner again contract packages"
. "$(dirname "$0")/../../bench/builds.sh"

# enter: sets the folders, goes into a copy of what builds are made from, so that editing a source
# meanwhile does no harm, and makes sure that suite and libraries are there
enter() {
    cd "$(dirname "$0")/../.." || exit 3
    root=$(pwd)
    mkdir -p "${TED4_BUILD:-build}/cross" "${TED4_RESULTS:-conformance}/cross" || exit 3
    build=$(cd "${TED4_BUILD:-build}" && pwd)
    results=$(cd "${TED4_RESULTS:-conformance}" && pwd)
    csv=$results/cross/results.csv
    work=$build/cross
    own_folder || exit 3
    table=builds
    mkdir -p "$own/conformance" "$own/bench" && cp -R ref-decoder Makefile "$own/" &&
        cp bench/sources.awk "$own/bench/" &&
        cp -R conformance/tool conformance/cross conformance/lists "$own/conformance/" &&
        cp "${TED4_TABLE:-conformance/cross/builds.txt}" "$own/$table" && cd "$own" ||
        die "no copy of the sources"
    what_from
    suite=suite-$(suite_key "$root/conformance")
    sources=$(sources_key)
    suite=$work/$suite
    [ $do != run ] || (flock 9; fetch && prepare) 9>"$work/lock" ||
        die "no suite, or no sources of zlib, Jansson and xxHash from Debian"
}

# what_from: sets the sources, and the flags that the Makefile gives them
what_from() {
    strict=$(sed -n 's/^STRICT *= *//p' Makefile)
    avx512=$(sed -n 's/^AVX512 *= *//p' Makefile)
    vnni=$(sed -n 's/^VNNI *= *//p' Makefile)
    [ -n "$strict" ] && [ -n "$avx512" ] && [ -n "$vnni" ] ||
        die "Makefile: STRICT or the flags of AVX-512 not found"
    decoder=$(ls ref-decoder/base/*.c ref-decoder/norm/*.c ref-decoder/read/*.c \
        ref-decoder/recon/*.c ref-decoder/kernel/*.c)
    program="conformance/cross/cross_decoder.c conformance/tool/answer.c conformance/tool/text.c
        ref-decoder/tool/contract.c ref-decoder/tool/tier_hash.c ref-decoder/tool/sha256.c
        ref-decoder/tool/cli.c ref-decoder/tool/json_file.c ref-decoder/tool/json_string.c
        ref-decoder/tool/read_file.c"
    judge="conformance/tool/judge.c conformance/tool/judge.h conformance/tool/process.h
        conformance/tool/suite.h"
    headers=$(for f in answer text; do echo "conformance/tool/$f.h"; done
        for f in contract tier_hash record sha256 cli json_file json_string; do
            echo "ref-decoder/tool/$f.h"
        done)
    # The files of zlib that work on bytes in memory.
    zlib="adler32 compress crc32 deflate inffast inflate inftrees trees zutil"
    # Wine has a folder of its own, prints nothing, and asks for nothing.
    WINEPREFIX=$work/wine WINEDEBUG=-all WINEDLLOVERRIDES='mscoree,mshtml='
    export WINEPREFIX WINEDEBUG WINEDLLOVERRIDES
}

# suite_key FOLDER: hash of the suite's manifest and descriptors; the manifest has hashes of the
# files
suite_key() {
    {
        cat "$1/SUITE.json"
        find "$1/vectors" -name '*.json' | sort | tr '\n' '\0' | xargs -0 cat
    } | short_hash
}

# sources_key: hash of everything that the program is made from, and of what it is asked
sources_key() {
    {
        awk -f bench/sources.awk $decoder $program ref-decoder/ted4.h ref-decoder/base/*.[hd]* \
            ref-decoder/norm/*.h ref-decoder/read/*.[hd]* ref-decoder/recon/*.h \
            ref-decoder/kernel/*.h $headers conformance/cross/windows.h
        cat conformance/lists/few.txt conformance/cross/wasi.mjs
        echo "$strict $avx512 $vnni $suite"
    } | short_hash
}

settle() {
    judge_key=
    [ "$contract" != all ] || judge_key=$(awk -f bench/sources.awk $judge | short_hash)
    key=$(echo "$name;$class;$compiler;$flags;$link;$runner;$again;$contract;$sources$judge_key" |
        short_hash)
}

missing() {
    missing_command ${compiler%% *} ${runner%% *}
}

# fetch: puts Debian's sources of zlib, Jansson and xxHash into $work/libraries, without changing
# this system
fetch() {
    [ -e "$work/libraries/ready" ] && return
    rm -rf "$work/libraries"
    a=$work/libraries/apt
    mkdir -p "$a/state/lists/partial" "$a/cache/archives/partial" "$a/parts" || return 1
    # The system's own package sources, for source packages.
    for list in /etc/apt/sources.list.d/debian.sources /etc/apt/sources.list; do
        [ -s "$list" ] && sed 's/^Types: deb$/Types: deb-src/; s/^deb /deb-src /' "$list" \
            >"$a/parts/$(basename "$list" .list).${list##*.}"
    done
    (
        cd "$work/libraries" || exit 1
        set -- -o "Dir::State=$a/state" -o "Dir::Cache=$a/cache" \
            -o Dir::Etc::sourcelist=/dev/null -o "Dir::Etc::sourceparts=$a/parts" \
            -o APT::Sandbox::User=root
        apt-get -qq "$@" update && apt-get -qq "$@" source zlib jansson xxhash &&
            mv zlib-* zlib && mv jansson-* jansson && mv xxhash-* xxhash
    ) >"$work/libraries/log" 2>&1 || { cat "$work/libraries/log" >&2; return 1; }
    (
        cd "$work/libraries" || exit 1
        mkdir include
        cp zlib/zlib.h zlib/zconf.h jansson/src/jansson.h xxhash/xxhash.h include/
        sed 's/@json_inline@/inline/; s/@json_have_long_long@/1/; s/@json_have_localeconv@/1/
            s/@json_have_[a-z]*_builtins@/0/' \
            jansson/src/jansson_config.h.in >include/jansson_config.h
        {
            for have in STDINT_H UNISTD_H SYS_TIME_H SYS_TYPES_H STRTOLL SNPRINTF LOCALECONV; do
                echo "#define HAVE_$have 1"
            done
        } >jansson/src/jansson_private_config.h
    ) && touch "$work/libraries/ready"
}

# prepare: makes the suite with the files that are made on demand, in $suite
prepare() {
    [ ! -e "$suite" ] || return 0
    [ -x "$build/ted4conf" ] || die "$build/ted4conf is missing: make cross"
    part=$work/part
    rm -rf "$part"
    mkdir -p "$part/suite" || return 1
    cp -R "$root/conformance/vectors" "$root/conformance/SUITE.json" "$part/suite/" || return 1
    [ "$suite" = "$work/suite-$(suite_key "$part/suite")" ] ||
        die "the suite changes while it is copied"
    (cd "$root" && "$build/ted4conf" gen --demand -o "$part/made/vectors") >"$part/log" ||
        { cat "$part/log" >&2; return 1; }
    (cd "$part/made" && find . -name '*.ted4') | while read -r file; do
        [ -e "$part/suite/$file" ] || cp "$part/made/$file" "$part/suite/$file"
    done
    mv "$part/suite" "$suite" && rm -rf "$part"
}

# objects FOLDER FLAGS SOURCE...: compiles each source to an object in the folder
objects() {
    mkdir -p "$1" || return 1
    folder=$1 options=$2
    shift 2
    for source in "$@"; do
        $compiler -std=c11 -D_POSIX_C_SOURCE=200809L $machine -I"$work/libraries/include" \
            $options -c "$source" -o "$folder/$(basename "$source" .c).o" || return 1
    done
}

# make_libraries: compiles the libraries once for each compiler, as a distribution would, in $others
make_libraries() {
    others=$work/libraries/made-$(echo "$compiler $(version)" | short_hash) from=$work/libraries
    [ ! -e "$others/ready" ] || return 0
    objects "$others" "-O2 -w -DHAVE_UNISTD_H" $(for f in $zlib; do echo "$from/zlib/$f.c"; done) &&
        objects "$others/jansson" "-O2 -w -DHAVE_CONFIG_H -I$from/jansson/src" \
            "$from"/jansson/src/*.c &&
        objects "$others/xxhash" "-O2 -w" "$from/xxhash/xxhash.c" && touch "$others/ready"
}

# compile: makes $here/program
compile() {
    here=$work/builds/$name
    rm -rf "$here"
    mkdir -p "$here" || return 1
    machine=
    case $name in windows-*) machine="-include conformance/cross/windows.h" ;; esac
    make_libraries || return 1
    ours="$(echo "$flags" | sed "s/STRICT/$strict/") -Wall -Iref-decoder -iquote conformance/tool"
    for source in $decoder $program conformance/tool/judge.c; do
        case $source in
        *_avx2.c)   isa=-mavx2 ;;
        *_avx512.c) isa=$avx512 ;;
        *_vnni.c)   isa=$vnni ;;
        *)          isa= ;;
        esac
        case $name in
        x86-64-*) ;;
        windows-*) isa="$isa${isa:+ -Wa,-muse-unaligned-vector-move}" ;;
        *) isa= ;;
        esac
        objects "$here/ours" "$ours $isa" "$source" || return 1
    done
    $compiler "$here"/ours/*.o "$others"/*.o "$others"/*/*.o $link -lm -o "$here/program" ||
        return 1
    [ ! -e "$here/program.exe" ] || mv "$here/program.exe" "$here/program"
}

# judge FILE [NAME=VALUE]: runs the whole suite in one process, with its output in FILE
judge() {
    env ${2:-NOTHING=} $runner "$here/program" "$suite" 2>"$1.stderr" | tr -d '\r' >"$1"
    grep -q '^tier-e ' "$1" ||
        { echo "does not come to its end: $(tail -n 1 "$1.stderr")"; return 1; }
    grep '^fail ' "$1" >"$1.failures" || return 0
    first=$(cut -d' ' -f2- "$1.failures" | head -n 3 | tr ',\n' '; ')
    echo "$(grep -c . "$1.failures") vectors fail: $first"
    return 1
}

# by_contract: runs the suite, or few of its vectors, in a process each; sets contract_vectors and
# contract_passed
by_contract() {
    list="--list conformance/lists/few.txt"
    [ "$contract" = few ] || list=
    memory=; [ -z "$runner" ] || memory="--memory 0"
    log=$here/contract.log
    TMPDIR=$here "$build/ted4conf" run --suite "$suite" --once -j 1 --timeout 600 $memory $list \
        --decoder "$runner $here/program" --json "$here/contract.json" >"$log" 2>&1
    code=$?
    contract_passed=$(sed -n 's/^.*: \([0-9]*\) passed, .*/\1/p' "$log")
    n='\([0-9]*\)'
    contract_vectors=$(
        sed -n "s/^.*: $n passed, $n failed, $n without answer, $n missing.*/\1 \2 \3 \4/p" "$log" |
        awk '{ print $1 + $2 + $3 + $4 }')
    [ $code = 0 ] || { echo "by the contract: $(tail -n 1 "$log" | tr ',' ';')"; return 1; }
}

# try: compiles and runs the build; sets verdict and the columns
try() {
    claimed= vectors= passed= tier_e= class_x= contract_vectors= contract_passed=
    if ! compile >"$work/$name.log" 2>&1; then
        verdict="does not build: $(grep -m 1 -i -E 'error|cannot' "$work/$name.log" | tr ',' ';')"
        return
    fi
    grep -i warning "$work/$name.log" | head -n 5
    verdict=$(judge "$here/lines")
    claimed=$(sed -n 's/^class //p' "$here/lines")
    vectors=$(sed -n 's/^vectors \([0-9]*\) .*/\1/p' "$here/lines")
    passed=$(sed -n 's/^vectors .* passed \([0-9]*\) .*/\1/p' "$here/lines")
    tier_e=$(sed -n 's/^tier-e //p' "$here/lines")
    class_x=$(sed -n 's/^class-x //p' "$here/lines")
    [ -z "$verdict" ] || return
    [ "$claimed" = "$class" ] || { verdict="claims class $claimed; should claim $class"; return; }
    if [ -n "$again" ]; then
        verdict=$(judge "$here/again" "$again")
        [ -z "$verdict" ] || { verdict="with $again: $verdict"; return; }
        cmp -s "$here/lines" "$here/again" || { verdict="not the same with $again"; return; }
    fi
    by_contract >"$here/why" || { verdict=$(cat "$here/why"); return; }
    verdict=passed
}

make_row() {
    begun=$(date +%s)
    try
    seconds=$(($(date +%s) - begun))
    judged=$claimed,$vectors,$passed,$tier_e,$class_x
    put_row "$judged,$contract_vectors,$contract_passed,$seconds,$verdict"
    [ "$verdict" = passed ] || return
    echo "passed   $name, $seconds s"
    rm -rf "$here"
}

# result_line: prints the build's line of CROSS.md
result_line() {
    state
    tell_state "$row_verdict" "stale: $row_verdict with other sources, suite, flags or compiler"
    echo "$row" | awk -F, -v name="$name" -v said="$said" '
        function start(hash) { return hash == "" ? "" : "`" substr(hash, 1, 8) "`" }
        function part(n, of) { return of == "" ? "" : n " of " of }
        { print "| " name " | " $3 " | " $4 " | " part($6, $5) " | " part($10, $9) " | " \
              start($7) " | " start($8) " | " $11 " | " said " |" }'
}

# summary: prints what all rows in $own/counted say together
summary() {
    awk -F, '$12 == "passed" { n++; if ($4 == "X") x++ }
        $7 != "" && !($7 in e) { e[$7]; n_e++; one_e = $7 }
        $8 != "" && !($8 in c) { c[$8]; n_c++; one_c = $8 }
        END { print n + 0 " builds passed, " NR - n " failed."
              print "Tier E: " (n_e == 1 ? "one hash, `" one_e "`, in every build." : \
                  n_e + 0 " different hashes.")
              print "Class X: " (n_c == 1 ? "one hash, `" one_c "`, in all " x + 0 \
                  " passing builds that claim it." : n_c + 0 " different hashes.") }' "$own/counted"
}

# agree: prints the summary; succeeds if no build fails, no two disagree, and enough have passed
agree() {
    summary
    least=12 passed=$(cut -d, -f12 "$own/counted" | grep -cx passed)
    [ -z "$patterns" ] || least=1
    [ "$passed" -ge $least ] ||
        { echo "cross.sh: $passed builds passed; at least $least have to" >&2; return 1; }
    [ "$passed" = "$(grep -c . "$own/counted")" ] &&
        [ "$(cut -d, -f7 "$own/counted" | sort -u | grep -c .)" = 1 ] &&
        [ "$(cut -d, -f8 "$own/counted" | grep . | sort -u | grep -c .)" -le 1 ]
}

report() {
    : >"$own/counted"
    each | while read -r line; do split "$line"; result_line; done >"$own/rows"
    {
        sed '/^<!-- results -->$/,$d' conformance/cross/intro.md
        summary
        echo
        echo "| build | compiler | class claimed | vectors | by the contract | Tier E | class X | seconds | result |"
        echo "|---|---|---|---|---|---|---|---|---|"
        cat "$own/rows"
        sed '1,/^<!-- results -->$/d; /^<!-- builds -->$/,$d' conformance/cross/intro.md
        echo "| build | compiler | flags | linked with | run by | Debian packages beyond \`make deps\` |"
        echo "|---|---|---|---|---|---|"
        each | while read -r line; do
            split "$line"
            echo "| $name | \`$compiler\` | \`$flags\` | ${link:+\`$link\`} | ${runner:+\`$runner\`} | $packages |"
        done
        sed '1,/^<!-- builds -->$/d' conformance/cross/intro.md
    } >"$results/CROSS.md.$$" && mv "$results/CROSS.md.$$" "$results/CROSS.md"
}

begin_builds "$@"
exit
