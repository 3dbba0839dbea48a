#!/bin/sh
# test_library.sh - the decoder as a library in other people's builds: the symbols of the shared
# library and their types, headers in every dialect, the examples of doc/examples by pkg-config, a
# project by CMake, and the Python module. Tests for which the machine lacks a tool are skipped.
# Prints lines as a cmocka program does; run by `make test` from the project's root.
# SPDX-License-Identifier: BSD-2-Clause
set -u
. tests/support/speak.sh
need library ted4dec ted4conf ted4tolerance
vector=conformance/vectors/content/CNT-pop-0.002.ted4
usr=$out/root/usr
has() { command -v "$1" >/dev/null; }

# Sanitizers have their own run-time libraries, which a shared library does not contain.
case "${CFLAGS:-} $(cat "$TED4_BUILD/how")" in
*-fsanitize*) skip library "this is a build with sanitizers"; exit 0 ;;
esac
make install-library B="$TED4_BUILD" DESTDIR="$out/root" PREFIX=/usr >"$out/said" 2>&1 ||
    { fail installs "$(cat "$out/said")"; exit 1; }
shared=$usr/lib/libted4dec.so.1
LD_LIBRARY_PATH=$usr/lib
export LD_LIBRARY_PATH

if has nm; then
    nm -D --defined-only "$shared" | awk '$2 != "A" { sub(/@.*/, "", $3); print $3 }' |
        sort >"$out/symbols"
    if cmp -s "$out/symbols" ref-decoder/libted4dec.symbols; then ok symbols
    else fail symbols "$(diff "$out/symbols" ref-decoder/libted4dec.symbols)"; fi
    readelf -d "$shared" >"$out/dynamic"
    sed -n 's/^ \(ted4_[a-z0-9_]*\)@TED4_1 .*/\1/p' debian/libted4dec1.symbols >"$out/debian"
    if cmp -s "$out/debian" ref-decoder/libted4dec.symbols; then ok debian_symbols
    else fail debian_symbols "$(diff "$out/debian" ref-decoder/libted4dec.symbols)"; fi
    check soname "$out/dynamic" "Library soname: [libted4dec.so.1]"
    if grep -q TEXTREL "$out/dynamic"; then fail position_independent TEXTREL
    else ok position_independent; fi
else
    skip symbols "there is no nm"
fi

# The library calls only zlib, xxHash and functions of C that neither print nor end the process nor
# reach outside it; and nothing in it can change (apart from constants that are relocated).
calls='ted4_.*|XXH.*|(in|de)flate(End|Init_)?|malloc|free|getenv|(mem|str)[a-z]*|bcmp|sqrtf?'
calls="$calls|_GLOBAL_OFFSET_TABLE_|__cpu_.*|__stack_chk_fail(_local)?|__aarch64_.*"
# Functions of _FORTIFY_SOURCE, and those that divide 64 bits where registers have 32.
calls="$calls|__(mem|str)[a-z]*_chk|__u?(div|mod|divmod)[ds]i[34]|__aeabi_u?[il]div(mod)?"
if has nm && has objdump; then
    nm -u "$TED4_BUILD/libted4dec.a" | awk '$1 == "U" { print $2 }' | grep -vxE "$calls" |
        sort -u >"$out/calls"
    if [ -s "$out/calls" ]; then fail calls "$(cat "$out/calls")"; else ok calls; fi
    objdump -t "$TED4_BUILD/libted4dec.a" |
        awk '/[ \t](\.data|\.bss|\.tdata|\.tbss|\*COM\*)/ && !/ d / && !/\.data\.rel\.ro/' \
            >"$out/kept"
    if [ -s "$out/kept" ]; then fail keeps "$(cat "$out/kept")"; else ok keeps; fi
else
    skip calls "there is no nm or no objdump"
fi

# The types of those functions, as programs see them, have not changed.
if ! has abidiff; then skip abi "there is no abidiff (abigail-tools)"
elif ! readelf -h "$shared" | grep -q 'X86-64' || ! readelf -S "$shared" | grep -q debug_info; then
    skip abi "not x86-64, or without debug information"
elif abidiff ref-decoder/libted4dec.abi "$shared" >"$out/said" 2>&1; then ok abi
else fail abi "$(cat "$out/said")"; fi

# Every function that the installed headers declare is exported, and nothing else.
sed 's|//.*||' "$usr/include/ted4/ted4.h" "$usr/include/ted4/base/status.h" | tr '\n' ' ' |
    sed 's|/\*[^*]*\*\+\([^/*][^*]*\*\+\)*/| |g' | tr ';' '\n' |
    sed -n '/typedef/!s/.*[ *]\(ted4_[a-z0-9_]*\)(.*/\1/p' | sort -u >"$out/declared"
if cmp -s "$out/declared" ref-decoder/libted4dec.symbols; then ok declared
else fail declared "$(diff "$out/declared" ref-decoder/libted4dec.symbols)"; fi

echo '#include <ted4/ted4.h>' >"$out/header.c"
cp "$out/header.c" "$out/header.cc"
# dialect COMPILER STANDARD FILE
dialect() {
    if $1 -std="$2" -Wall -Wextra -Wpedantic -Wconversion -Werror -I"$usr/include" \
        -fsyntax-only "$out/$3" 2>"$out/err"
    then ok "header_$2"; else fail "header_$2" "$(cat "$out/err")"; fi
}
for standard in c99 c11 c17 c2x; do dialect "${CC:-cc}" $standard header.c; done
if has "${CXX:-c++}"; then
    for standard in c++11 c++17 c++20; do dialect "${CXX:-c++}" $standard header.cc; done
else
    skip header_cxx "there is no C++ compiler"
fi

hash=$("$TED4_BUILD/ted4dec" --hash "$vector" | cut -d' ' -f2)
if has pkg-config; then
    PKG_CONFIG_PATH=$usr/lib/pkgconfig
    export PKG_CONFIG_PATH
    flags="$(pkg-config --define-prefix --cflags ted4) -Wall -Wextra -Werror -fopenmp"
    for example in attributes memory allocator threads; do
        # shellcheck disable=SC2086 # several flags
        ${CC:-cc} -std=c99 $flags doc/examples/$example.c \
            $(pkg-config --define-prefix --libs ted4) -o "$out/$example" 2>"$out/err" ||
            fail "$example" "$(cat "$out/err")"
    done
    expect memory 0 "$hash" "$out/memory" "$vector"
    expect refused 1 "con.magic at byte 0: " "$out/memory" README.md
    expect absent 3 "$out/absent: No such file or directory" "$out/memory" "$out/absent"
    expect allocator 0 " blocks held, 0 after ted4_scene_free" "$out/allocator" "$vector"
    expect attributes 0 "frame 0: " "$out/attributes" "$vector"
    frames=$("$TED4_BUILD/ted4info" "$vector" |
        sed -n 's/^frames *\([0-9]*\).*/\1/p')
    "$out/attributes" "$vector" >"$out/lines"
    if [ "$(wc -l <"$out/lines")" = "$frames" ]; then ok frames
    else fail frames "not $frames lines"; fi
    one=$(OMP_NUM_THREADS=1 "$out/threads" "$vector")
    three=$(OMP_NUM_THREADS=3 "$out/threads" "$vector")
    if [ -n "$one" ] && [ "$one" = "$three" ]; then ok threads
    else fail threads "$one, $three"; fi
else
    skip pkg_config "there is no pkg-config"
fi

# A program that is not position independent may keep the addresses of functions.
cat >"$out/address.c" <<'C'
#include <stdio.h>
#include <ted4/ted4.h>
static void (*const end)(ted4_scene *) = ted4_scene_free;
int main(void)
{
    end(NULL);
    return puts("fine") < 0;
}
C
if ${CC:-cc} -fno-pie -no-pie -I"$usr/include" "$out/address.c" -L"$usr/lib" -lted4dec \
    -o "$out/address" 2>"$out/err"; then expect address 0 fine "$out/address"
else fail address "$(cat "$out/err")"; fi

# Libraries outside PREFIX, installed by a user whose files others may not read.
(umask 077; make install-library B="$TED4_BUILD" DESTDIR='' PREFIX="$out/far/opt" \
    LIBDIR="$out/far/lib") >"$out/said" 2>&1
check far "$out/far/lib/pkgconfig/ted4.pc" "libdir=$out/far/lib" "prefix=$out/far/opt"
if find "$out/far" -type f ! -perm -444 | grep -q .; then fail readable "$(ls -lR "$out/far")"
else ok readable; fi

if has cmake; then
    mkdir "$out/project"
    cp doc/examples/memory.c doc/examples/read_file.h "$out/project"
    cat >"$out/project/CMakeLists.txt" <<'CMAKE'
cmake_minimum_required(VERSION 3.13)
project(user C)
find_package(ted4 0.2 REQUIRED)
foreach(kind ted4dec ted4dec_static)
  add_executable(with_${kind} memory.c)
  target_link_libraries(with_${kind} ted4::${kind})
endforeach()
CMAKE
    if cmake -S "$out/project" -B "$out/made" -DCMAKE_PREFIX_PATH="$usr" >"$out/said" 2>&1 &&
        cmake --build "$out/made" >>"$out/said" 2>&1; then ok cmake
    else fail cmake "$(cat "$out/said")"; fi
    for kind in ted4dec ted4dec_static; do
        expect "cmake_$kind" 0 "$hash" "$out/made/with_$kind" "$vector"
    done
    # Where each architecture has a folder of libraries.
    make install-library B="$TED4_BUILD" DESTDIR="$out/multi" PREFIX=/usr LIBDIR=/usr/lib/triplet \
        >"$out/said" 2>&1
    if cmake -S "$out/project" -B "$out/made2" >>"$out/said" 2>&1 \
        -Dted4_DIR="$out/multi/usr/lib/triplet/cmake/ted4" &&
        cmake --build "$out/made2" >>"$out/said" 2>&1; then ok cmake_triplet
    else fail cmake_triplet "$(cat "$out/said")"; fi
    # cmake_finds NAME FOLDER: configures and builds the project with the package there.
    cmake_finds() {
        if cmake -S "$out/project" -B "$out/made_$1" -Dted4_DIR="$2" >"$out/said" 2>&1 &&
            cmake --build "$out/made_$1" >>"$out/said" 2>&1; then ok "cmake_$1"
        else fail "cmake_$1" "$(cat "$out/said")"; fi
    }
    cmake_finds far "$out/far/lib/cmake/ted4"
    # Where /lib is a link to /usr/lib.
    ln -s usr/lib "$out/multi/lib"
    cmake_finds merged "$out/multi/lib/triplet/cmake/ted4"
    sed -i 's/ted4 0.2 REQ/ted4 0.1...<0.2 REQ/' "$out/project/CMakeLists.txt"
    if cmake -S "$out/project" -B "$out/made3" -DCMAKE_PREFIX_PATH="$usr" >"$out/said" 2>&1
    then fail cmake_range "0.2 is taken for less than 0.2"; else ok cmake_range; fi
else
    skip cmake "there is no cmake"
fi

python=
for p in python3 /usr/bin/python3; do
    [ -n "$python" ] || ! $p -c 'import numpy' 2>/dev/null || python=$p
done
if [ -n "$python" ]; then
    "$TED4_BUILD/ted4dec" "$vector" -o "$out/frame_%d.raw" --keep-all -q 2>"$out/err"
    export TED4_LIBRARY=$shared PYTHONDONTWRITEBYTECODE=1 PYTHONPATH=python
    if "$python" - "$vector" "$hash" "$out" >"$out/said" 2>&1 <<'PYTHON'
import copy
import pickle
import sys
import threading
import numpy as np
import ted4

path, wanted, folder = sys.argv[1:]
scene = ted4.Scene.open(path)
assert scene.hash == wanted, scene.hash
for j in range(scene.frames):
    g = scene.frame(j)
    raw = np.fromfile(f"{folder}/frame_{j}.raw", "<f4").reshape(-1, 14)
    assert len(g) == scene.gaussian_count == len(raw), (len(g), len(raw))
    assert np.array_equal(g.records().view(np.uint32), raw.view(np.uint32)), j
for damage, error, offset in ((b"", "con.truncated", 0), (b"x" * 40, "con.magic", 0)):
    try:
        ted4.Scene(damage)
        raise AssertionError("not refused")
    except ted4.Ted4Error as e:
        assert (e.id, e.offset, e.verdict) == (error, offset, "invalid"), str(e)
try:
    ted4.Scene.open(path, max_bytes=1000)
    raise AssertionError("not refused")
except ted4.Ted4Error as e:
    assert e.id == "limit.memory" and e.offset is None, str(e)
try:
    scene.frame(scene.frames)
    raise AssertionError("no such frame")
except IndexError:
    pass
# An invalid query is refused, and never taken for another one.
for num, den in ((2**32, 5), (3, 2**32 + 5), (-1, 5), (6, 5), (0, 0), (1, 2**24)):
    try:
        scene.gaussians(num, den)
        raise AssertionError((num, den))
    except ted4.Ted4Error as e:
        assert e.id == "query.range", str(e)
for wrong, what in ((lambda: scene.gaussians(0.5, 1), TypeError),
                    (lambda: scene.frame(0, (1, 2)), ValueError),
                    (lambda: ted4.Scene.open(path, max_bytes=-1), ValueError),
                    (lambda: ted4.Scene(5), "bytes-like"),
                    (lambda: ted4.Scene(path), "bytes-like"),
                    (lambda: scene.frame(0.5), "integer"),
                    (lambda: copy.copy(scene), TypeError)):
    try:
        wrong()
        raise AssertionError(what)
    except what if isinstance(what, type) else TypeError as e:
        assert isinstance(what, type) or what in str(e), str(e)
class Bytes(bytes):
    pass
for data in (memoryview(open(path, "rb").read()), Bytes(open(path, "rb").read())):
    assert ted4.Scene(data).hash == wanted
# Gaussians are compared, and are keys, as objects are.
a, b = scene.frame(0), scene.frame(0)
assert a != b and a == a and len({a, b}) == 2
# Threads that share a scene get the Gaussians of the times that they ask for.
hashes, wrong = [scene.frame(j).hash for j in range(scene.frames)], []
def ask(j):
    for _ in range(200):
        g = scene.frame(j)
        if g.hash != hashes[j]:
            wrong.append(j)
sys.setswitchinterval(1e-6)
threads = [threading.Thread(target=ask, args=(j,)) for j in range(min(4, scene.frames))]
for thread in threads:
    thread.start()
for thread in threads:
    thread.join()
assert not wrong, f"{len(wrong)} wrong frames"
# A refusal says the same in another process.
try:
    ted4.Scene(b"x" * 40)
except ted4.Ted4Error as refusal:
    for other in (pickle.loads(pickle.dumps(refusal)), copy.copy(refusal)):
        assert type(other) is ted4.Ted4Error and str(other) == str(refusal), repr(other)
        assert vars(other) == vars(refusal), vars(other)
# Where times need larger denominators than queries have, they are rounded (R-HDR-005).
scene.frames, last = 2**25 - 1, 2**24 - 1
for j, num in ((29, 14), (11, 6), (2**25 - 2, last)):
    assert scene.frame(j).hash == scene.gaussians(num, last).hash, j
PYTHON
    then ok python; else fail python "$(cat "$out/said")"; fi
    expect python_library 0 loaded env TED4_LIBRARY= LD_LIBRARY_PATH="$(dirname "$shared")" \
        "$python" -c 'import ted4; print("loaded")'
else
    skip python "there is no numpy"
fi
exit $bad
