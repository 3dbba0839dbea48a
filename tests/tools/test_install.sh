#!/bin/sh
# test_install.sh - the files of `make install` are sufficient for writing a program: <ted4/ted4.h>
# in C and in C++, with no other folder of headers; libted4dec.a, whose whole content needs no
# library but zlib, xxHash and libm; and the programs that doc/programs.md names, with each command
# of ted4conf. `make uninstall` removes them all, and nothing else. Prints lines as a cmocka program
# does; run by `make test` from the project's root.
# SPDX-License-Identifier: BSD-2-Clause
set -u
. tests/support/speak.sh
need install ted4dec ted4conf ted4tolerance
vector=conformance/vectors/content/CNT-pop-0.002.ted4

# Nothing may be rebuilt, possibly with another compiler.
usr="$out/a root/usr"
cp "$TED4_BUILD/how" "$out/how"
if make install B="$TED4_BUILD" DESTDIR="$out/a root" PREFIX=/usr >"$out/said" 2>&1; then ok \
    installs; else fail installs "$(cat "$out/said")"; fi
if cmp -s "$TED4_BUILD/how" "$out/how"; then ok as_built; else fail as_built "$(cat "$out/said")";
    fi
wanted=$(echo $(sed -n 's/^    \(ted4[a-z]*\) .*/\1/p' doc/programs.md) ted4scene | tr ' ' '\n' |
    sort -u)
if [ "$(ls "$usr/bin")" = "$wanted" ]; then ok programs; else fail programs "$(ls "$usr/bin")"; fi
for c in $("$TED4_BUILD/ted4conf" --help | sed -n 's/^  \([a-z]*\) .*/\1/p'); do
    if grep -q "^    ted4conf \(.* \)\{0,1\}$c " doc/programs.md; then ok "told_$c"; else
        fail "told_$c" "doc/programs.md does not name it"; fi
done
if [ "$(echo $(ls "$usr/lib"))" = "cmake libted4dec.a libted4dec.so libted4dec.so.1 pkgconfig" ]; \
    then ok libraries; else fail libraries "$(ls "$usr/lib")"; fi
for f in man/man1/ted4enc.1 bash-completion/completions/ted4enc zsh/site-functions/_ted4 \
    fish/vendor_completions.d/ted4enc.fish mime/packages/ted4.xml ted4/ted4.magic; do
    if [ -s "$usr/share/$f" ]; then ok "share_${f##*/}"; else fail "share_${f##*/}" missing; fi
done

cat >"$out/user.c" <<'C'
#include <ted4/ted4.h>
#include <stdio.h>

int main(int argc, char **argv)
{
    static unsigned char data[1 << 20];
    FILE *const f = fopen(argv[argc - 1], "rb");
    const size_t size = f != NULL ? fread(data, 1, sizeof data, f) : 0;
    ted4_error e = { TED4_OK, 0 };
    ted4_scene *scene;
    ted4_info info;

    if (ted4_decode(data, size, NULL, &scene, &e) != TED4_OK) {
        printf("%s %s\n", ted4_verdict_name(ted4_status_verdict(e.code)), ted4_status_id(e.code));
        return 1;
    }
    ted4_scene_info(scene, &info);
    printf("ends ");
    for (int i = 0; i < 16; i++)
        printf("%02x", info.hash[i]);
    printf(info.motion == TED4_MOTION_BANK ? ", bank\n" : "\n");
    ted4_scene_free(scene);
    return 0;
}
C
cp "$out/user.c" "$out/user.cc"
wanted="$("$TED4_BUILD/ted4dec" --hash "$vector"), bank"

# user NAME COMPILER SOURCE: compiles a user's program and runs it. The flags are empty unless the
# build has sanitizers.
user() {
    # shellcheck disable=SC2086 # several flags
    $2 ${CFLAGS:-} ${LDFLAGS:-} -Wall -Wextra -Wpedantic -Werror -I"$usr/include" "$out/$3" \
        -L"$usr/lib" -Wl,--whole-archive -l:libted4dec.a \
        -Wl,--no-whole-archive -lxxhash -lz -lm -o "$out/$1" 2>"$out/err" ||
        { fail "$1" "$(cat "$out/err")"; return; }
    expect "$1" 0 "$wanted" "$out/$1" "$vector"
    expect "$1_refused" 1 'invalid con.magic' "$out/$1" README.md
}
user in_c "${CC:-cc} -std=c11" user.c
if command -v "${CXX:-c++}" >/dev/null; then
    user in_cxx "${CXX:-c++} -std=c++11" user.cc
else
    skip in_cxx "there is no C++ compiler"
fi

# `make uninstall` removes all that and nothing else, without a build; folders that are not the
# project's own stay.
# uninstall NAME ROOT VARIABLE...: what is no folder in $2 is then what ROOT.others holds.
uninstall() {
    name=$1 root=$2; shift 2
    make uninstall B="$out/none" DESTDIR="$root" "$@" >"$out/said" 2>&1 ||
        fail "$name" "$(cat "$out/said")"
    (cd "$root" && find . ! -type d | sort) >"$out/left"
    if cmp -s "$out/left" "$root.others"; then ok "$name"; else
        fail "$name" "$(cat "$out/left")"; fi
    find "$root" -type d -name 'ted4*' >"$out/left"
    if [ -s "$out/left" ]; then fail "${name}_folders" "$(cat "$out/left")"; else
        ok "${name}_folders"; fi
}
others="bin/other bin/ted4dec.old include/other.h lib/libted4dec.so.0 lib/pkgconfig/other.pc
    share/man/man1/other.1 share/fish/vendor_completions.d/other.fish"
for f in $others; do echo "$f" >"$usr/$f"; done
echo $others | tr ' ' '\n' | sed 's|^|./usr/|' | sort >"$out/a root.others"
uninstall uninstalls "$out/a root" PREFIX=/usr
uninstall uninstalls_nothing "$out/a root" PREFIX=/usr
[ -e "$out/none" ] && fail uninstalls_unbuilt "a build" || ok uninstalls_unbuilt
set -- PREFIX="/u s r" LIBDIR="/l i b" ZSH_COMPLETIONS="/z s h"
make install B="$TED4_BUILD" DESTDIR="$out/b" "$@" >"$out/said" 2>&1 || fail b "$(cat "$out/said")"
: >"$out/b.others"
uninstall uninstalls_elsewhere "$out/b" "$@"
mkdir -p "$out/b/u s r/share/ted4"
echo mine >"$out/b/u s r/share/ted4/mine"
make uninstall DESTDIR="$out/b" "$@" >"$out/said" 2>&1 && [ -e "$out/b/u s r/share/ted4/mine" ] &&
    ok folder_in_use || fail folder_in_use "$(cat "$out/said")"
exit $bad
