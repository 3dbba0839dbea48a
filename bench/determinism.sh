#!/bin/sh
# determinism.sh - the same streams, many compilers, optimisation levels and machines: all must print the same hashes (tests/hash_dump.c).
# Usage, from the project root:  bench/determinism.sh [STREAM.ted4 ...]    without streams: those of tests/hash_stream.c
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
decoder="$(ls ref-decoder/base/*.c ref-decoder/norm/*.c ref-decoder/read/*.c ref-decoder/recon/*.c ref-decoder/kernel/*.c)"
native=$(uname -m)
failed=0

# build NAME COMPILER FLAGS LINK SOURCES: objects one by one, as kernels have flags of their own
build() {
    mkdir -p "$work/$1"
    for source in $5 $decoder; do
        isa=
        case $source-$1 in
        *_avx2.c-x86_64*) isa=-mavx2 ;;
        *_avx512.c-x86_64*) isa=$avx512 ;;
        esac
        $2 $base $3 $isa -c "$source" -o "$work/$1/$(basename "$source" .c).o" || return 1
    done
    $2 "$work/$1"/*.o $4 -lxxhash -lz -lm -o "$work/$1/program"
}

# compare NAME DEMAND RUNNER: the lines against those of the first build. DEMAND x: class X, all lines; E: class X declined,
# the integers only (t4 and query are binary32 arithmetic, which such a build may reorder).
compare() {
    $3 "$work/$1/program" $streams >"$work/lines" || { verdict="**does not run**"; failed=1; return; }
    class=$(sed -n 's/^class-x //p' "$work/lines")
    grep -v ^class-x "$work/lines" >"$work/got"
    [ -e "$work/want" ] || cp "$work/got" "$work/want"
    case $2$class in
    xyes) verdict="all equal" ;;
    Eno)  verdict="Tier E equal"
          grep -E '^(file|ends) ' "$work/want" >"$work/want.part"
          grep -E '^(file|ends) ' "$work/got" >"$work/got.part"
          cmp -s "$work/want.part" "$work/got.part" || verdict="**differs**" ;;
    *)    verdict="**claims the wrong class**" ;;
    esac
    [ "$2" = E ] || cmp -s "$work/want" "$work/got" || verdict="**differs**"
    case $verdict in *equal) ;; *) failed=1 ;; esac
}

# row NAME MACHINE DEMAND COMPILER FLAGS LINK RUNNER
row() {
    class=-
    if build "$1" "$4" "$5" "$6" tests/hash_dump.c >"$work/log" 2>&1; then
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

# cross ARCH TRIPLET QEMU [FLAGS]: -O2 and -O3, statically linked, under emulation; FLAGS are what class X needs there
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
        row "$3$level" "$3" x "$2-gcc" "$level $strict${4:+ $4}" "$libraries" "qemu-$3-static"
        [ -z "${4:-}" ] || row "$3$level-without" "$3" E "$2-gcc" "$level $strict" "$libraries" "qemu-$3-static"
        base=$saved
    done
}

streams=$*
if [ -z "$streams" ]; then
    build "$native-streams" gcc "-O2 $strict" "" "tests/hash_stream.c $(ls ref-encoder/write/*.c)"
    "$work/$native-streams/program" "$work/stream"
    streams=$(ls "$work"/stream*.ted4)
fi
for compiler in gcc $clang; do
    name=$native-$(basename "$compiler")
    for level in -O0 -O2 "-O3 -march=native"; do
        row "$name$(echo "$level" | tr -d ' ')" "$native" x "$compiler" "$level $strict" "" ""
    done
    row "$name-plain" "$native" x "$compiler" "-O3 $strict" "" "env TED4_KERNEL=plain"
    row "$name-Ofast" "$native" E "$compiler" "-Ofast" "" ""
done
cross arm64 aarch64-linux-gnu aarch64
# gcc for s390x computes in double under -std=c11 alone, and such a build declines class X.
cross s390x s390x-linux-gnu s390x -fexcess-precision=fast
{
    echo "# Determinism"
    echo
    echo "Made by \`bench/determinism.sh\`: streams decoded by one source built in every way below; the lines of"
    echo "\`tests/hash_dump.c\` are compared with those of the first row. Builds that are not strict decline class X and are"
    echo "held to Tier E: the line ends, a hash of the decoded integers. Their lines t4 (dequantised attributes) and query"
    echo "(Gaussians) are binary32 arithmetic and may differ: gcc -Ofast does reorder the two products of t4. s390x is"
    echo "big-endian, and its gcc computes in double under -std=c11 unless told otherwise. Other machines than this one run"
    echo "under qemu-user."
    echo
    echo "| machine | compiler | flags | run by | class X | verdict |"
    echo "|---|---|---|---|---|---|"
    cat "$work/table"
    echo
    echo "The lines:"
    echo
    sed 's/^/    /' "$work/want"
} >"$out"
[ $failed = 0 ]
