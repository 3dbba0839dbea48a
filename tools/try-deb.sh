#!/bin/sh
# try-deb.sh MIRROR [FOLDER] - installs the packages of FOLDER (build/deb, by `make deb`) into a
# bare Debian 12 that debootstrap makes from MIRROR, and uses them there. Needs root and the
# network. Prints lines as the tests do; run from the project's root.
# SPDX-License-Identifier: BSD-2-Clause
set -u
[ $# -ge 1 ] || { echo "try-deb.sh: usage: try-deb.sh MIRROR [FOLDER]" >&2; exit 3; }
mirror=$1 folder=${2:-build/deb}
for tool in debootstrap chroot; do
    command -v $tool >/dev/null || { echo "try-deb.sh: there is no $tool" >&2; exit 3; }
done
ls "$folder"/ted4-tools_*.deb >/dev/null || exit 3
out=$(mktemp -d) root=$out/root bad=0
trap 'rm -rf --one-file-system "$out"' EXIT

# inside NAME TEXT COMMAND: the command succeeds in that system, and prints the text, if any.
inside() {
    chroot "$root" env LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive sh -c "cd /try && $3" \
        >"$out/said" 2>&1
    status=$?
    if [ $status -eq 0 ] && { [ -z "$2" ] || grep -qF -e "$2" "$out/said"; }; then
        echo "[       OK ] $1"
    else
        echo "[  FAILED  ] $1: status $status: $(tail -n 5 "$out/said")"; bad=1
    fi
}
apt='apt-get install -y -q --no-install-recommends'

debootstrap --variant=minbase bookworm "$root" "$mirror" >"$out/said" 2>&1 ||
    { tail -n 5 "$out/said"; exit 1; }
mkdir "$root/try"
cp "$folder"/*.deb doc/examples/* conformance/vectors/content/CNT-pop-0.002.ted4 "$root/try"
vector=CNT-pop-0.002.ted4
chroot "$root" apt-get update -q >"$out/said" 2>&1 || { tail -n 5 "$out/said"; exit 1; }

inside install_tools '' "$apt ./ted4-tools_*.deb ./libted4dec1_*.deb"
inside info 'TED4, Main profile' "ted4info $vector"
inside export '' "ted4dec $vector -o frame_%05d.ply && test -s frame_00000.ply"
inside hash '' "ted4dec --hash $vector | cut -d' ' -f2 >hash && test -s hash"
inside scene '' 'ted4scene turn -o turn --size 32x32 --cameras 3 --frames 2'
inside train '' \
    'ted4enc turn -o turn.ted4 --preset draft --iterations 20,20 --capacity fixed -q && ted4info turn.ted4'
inside measure psnr 'ted4eval turn.ted4 turn --anyway'

inside install_dev '' \
    "$apt ./libted4dec-dev_*.deb gcc libc6-dev pkg-config cmake make man-db file bash-completion"
for example in attributes memory allocator threads; do
    inside example_$example '' \
        "cc -fopenmp $example.c \$(pkg-config --cflags --libs ted4) -o $example && ./$example $vector"
done
inside example_hash '' "./memory $vector | grep -qF \$(cat hash)"
inside static '' "cc memory.c \$(pkg-config --cflags ted4) -l:libted4dec.a -lxxhash -lz -lm \
    -o fixed && ./fixed $vector | grep -qF \$(cat hash)"
cat >"$root/try/CMakeLists.txt" <<'CMAKE'
cmake_minimum_required(VERSION 3.13)
project(user C)
find_package(ted4 0.2 REQUIRED)
add_executable(with_cmake memory.c)
target_link_libraries(with_cmake ted4::ted4dec)
CMAKE
inside cmake '' \
    "cmake -S . -B made && cmake --build made && made/with_cmake $vector | grep -qF \$(cat hash)"

inside manual 'EXIT STATUS' 'man ted4enc'
inside whatis 'decode TED4 files' 'whatis ted4dec'
inside magic model/vnd.ted4 "file -m /usr/share/ted4/ted4.magic --mime-type $vector"
inside completion --camera-centre \
    'bash -c ". /usr/share/bash-completion/bash_completion; _completion_loader ted4dec
        COMP_WORDS=(ted4dec --ca) COMP_CWORD=1; _ted4; echo \${COMPREPLY[*]}"'
inside remove '' "apt-get purge -y -q ted4-tools libted4dec1 libted4dec-dev &&
    ! find /usr /etc /var/lib/dpkg/info -iname '*ted4*' | grep ."
exit $bad
