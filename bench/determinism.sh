#!/bin/sh
# determinism.sh - one stream, many compilers, optimisation levels and machines: all must print the same hashes (tests/hash_dump.c).
# Usage, from the project root:  bench/determinism.sh [STREAM.ted4]    without a stream: one made by tests/hash_stream.c
# Writes bench/determinism.md; ends with 1 when a line differs. Needs gcc, clang; cross builds need the packages gcc-aarch64-linux-gnu,
# gcc-s390x-linux-gnu, qemu-user-static (missing: the row says so), and fetch zlib and xxHash for those machines from Debian.
# SPDX-License-Identifier: BSD-2-Clause
set -eu
work=${TMPDIR:-/tmp}/ted4-determinism.$$
mkdir -p "$work"
trap 'rm -rf "$work"' EXIT INT TERM
out=bench/determinism.md
clang=$(command -v clang || command -v clang-14 || true)
base="-std=c11 -D_POSIX_C_SOURCE=200809L -Iref-decoder -Iref-encoder -Itests"
strict="-ffp-contract=off -fno-fast-math"
avx512="-mavx512f -mavx512bw -mavx512vl -mprefer-vector-width=512"
sources="tests/hash_dump.c $(ls ref-decoder/base/*.c ref-decoder/norm/*.c ref-decoder/read/*.c ref-decoder/recon/*.c ref-decoder/kernel/*.c)"
failed=0

# build NAME COMPILER FLAGS LINK: objects one by one, as kernels have flags of their own
build() {
    mkdir -p "$work/$1"
    for source in $sources; do
        isa=
        case $source-$1 in
        *_avx2.c-x86_64*) isa=-mavx2 ;;
        *_avx512.c-x86_64*) isa=$avx512 ;;
        esac
        $2 $base $3 $isa -c "$source" -o "$work/$1/$(basename "$source" .c).o" || return 1
    done
    $2 "$work/$1"/*.o $4 -lxxhash -lz -lm -o "$work/$1/hash_dump"
}

# compare NAME TIERS RUNNER: the lines against the first build's. TIERS: all, or E for ends and t4.
compare() {
    $3 "$work/$1/hash_dump" "$stream" >"$work/lines" || { verdict="**does not run**"; failed=1; return; }
    class=$(sed -n 's/^class-x //p' "$work/lines")
    grep -v ^class-x "$work/lines" >"$work/got"
    [ -e "$work/want" ] || cp "$work/got" "$work/want"
    if [ "$2" = E ]; then
        grep -E '^(ends|t4) ' "$work/want" >"$work/part" && grep -E '^(ends|t4) ' "$work/got" >"$work/got.part"
        cmp -s "$work/part" "$work/got.part" && verdict="ends, t4 equal" || verdict="**differs**"
    else
        cmp -s "$work/want" "$work/got" && verdict="all equal" || verdict="**differs**"
    fi
    case $verdict in *differs*) failed=1 ;; esac
}

# row NAME MACHINE TIERS COMPILER FLAGS LINK RUNNER
row() {
    class=-
    if build "$1" "$4" "$5" "$6" >"$work/log" 2>&1; then
        compare "$1" "$3" "$7"
    else
        verdict="**does not build**"; failed=1; cat "$work/log" >&2
    fi
    echo "| $2 | $($4 --version | head -n 1) | \`$5\` | ${7:-native} | $class | $verdict |" >>"$work/table"
}

# fetch ARCH DIRECTORY: Debian's zlib and xxHash of another machine, unpacked, without touching this system
fetch() {
    mkdir -p "$2/state/lists/partial" "$2/cache/archives/partial"
    set -- "$1" "$2" -o "APT::Architecture=$1" -o "APT::Architectures=$1" -o "Dir::State=$2/state" \
        -o "Dir::Cache=$2/cache" -o Dir::State::status=/dev/null
    directory=$2; shift 2
    apt-get -qq "$@" update && (cd "$directory" && apt-get -qq "$@" download zlib1g-dev libxxhash-dev) || return 1
    for package in "$directory"/*.deb; do
        dpkg -x "$package" "$directory/root" || return 1
    done
}

# cross ARCH TRIPLET QEMU: -O2 and -O3, statically linked, under emulation
cross() {
    if ! command -v "$2-gcc" >/dev/null || ! command -v "qemu-$3-static" >/dev/null; then
        echo "| $3 | $2-gcc | | | - | not run: compiler or emulator missing |" >>"$work/table"
        return
    fi
    if ! fetch "$1" "$work/$1" >"$work/log" 2>&1; then
        echo "| $3 | $2-gcc | | | - | not run: no libraries for it |" >>"$work/table"
        return
    fi
    libraries="-I$work/$1/root/usr/include -static -L$work/$1/root/usr/lib/$2"
    for level in -O2 -O3; do
        saved=$base
        base="$base -I$work/$1/root/usr/include"
        row "$3$level" "$3" all "$2-gcc" "$level $strict" "$libraries" "qemu-$3-static"
        base=$saved
    done
}

stream=${1:-}
if [ -z "$stream" ]; then
    stream=$work/random.ted4
    gcc $base -O2 tests/hash_stream.c $(ls ref-encoder/write/*.c ref-decoder/base/*.c ref-decoder/norm/*.c) \
        -lxxhash -lz -lm -o "$work/hash_stream"
    "$work/hash_stream" "$stream"
fi
for compiler in gcc $clang; do
    name=$(uname -m)-$(basename "$compiler")
    for level in -O0 -O2 "-O3 -march=native"; do
        row "$name$(echo "$level" | tr -d ' ')" "$(uname -m)" all "$compiler" "$level $strict" "" ""
    done
    row "$name-plain" "$(uname -m)" all "$compiler" "-O3 $strict" "" "env TED4_KERNEL=plain"
    row "$name-Ofast" "$(uname -m)" E "$compiler" "-Ofast" "" ""
done
cross arm64 aarch64-linux-gnu aarch64
cross s390x s390x-linux-gnu s390x
{
    echo "# Determinism"
    echo
    echo "Made by \`bench/determinism.sh\`. One stream, decoded by one source built in every way below; the lines of"
    echo "\`tests/hash_dump.c\` are compared with those of the first row. Builds that are not strict decline class X and are"
    echo "held to Tier E (ends: the integers; t4: the dequantised attributes). s390x is big-endian."
    echo
    echo "| machine | compiler | flags | run by | class X | verdict |"
    echo "|---|---|---|---|---|---|"
    cat "$work/table"
    echo
    echo "The stream has $(wc -c <"$stream") bytes. Its lines:"
    echo
    sed 's/^/    /' "$work/want"
} >"$out"
[ $failed = 0 ]
