#!/bin/sh
# test_manual.sh - manual pages and shell completion have the options of each program's help text,
# and are accepted by mandoc and the shells; file(1) and shared-mime-info recognise a TED4 file by
# our magic. What the machine lacks is skipped. Prints lines as a cmocka program does; run by `make
# test` from the project's root.
# SPDX-License-Identifier: BSD-2-Clause
set -u
. tests/support/speak.sh
need pages ted4dec ted4info ted4enc ted4eval ted4edit ted4conf ted4scene ted4tolerance
[ -d "$TED4_BUILD/man" ] || { skip pages "TED4_BUILD has no man (make man)"; exit 0; }
man=$TED4_BUILD/man completion=$TED4_BUILD/completion
vector=conformance/vectors/content/CNT-pop-0.002.ted4
has() { command -v "$1" >/dev/null; }
subcommands=$("$TED4_BUILD/ted4conf" --help | sed -n 's/^  \([a-z]*\) .*/\1/p' | xargs)

# same NAME WANTED FOUND: checks that two files are equal.
same() { if cmp -s "$2" "$3"; then ok "$1"; else fail "$1" "$(diff "$2" "$3")"; fi; }

# runs NAME COMMAND...: checks that the command succeeds.
runs() {
    name=$1; shift
    if "$@" >"$out/said" 2>&1; then ok "$name"; else fail "$name" "$(cat "$out/said")"; fi
}

# page_options PAGE COMMAND...: checks that the options of the page are those of --help, which fits
# a terminal.
page_options() {
    page=$1; shift
    "$TED4_BUILD/$@" --help >"$out/help"
    if awk 'length > 80 { print; bad = 1 } END { exit bad }' "$out/help" >"$out/wide"
    then ok "${page}_width"; else fail "${page}_width" "$(cat "$out/wide")"; fi
    sed -n 's/^  \(-., \|    \)--\([a-z0-9-]*\).*/\2/p' "$out/help" | sort >"$out/wanted"
    [ -s "$out/wanted" ] || fail "$page" "the help text has no option"
    sed -n 's/^\.It .*Fl -\([a-z0-9-]*\).*/\1/p' "$man/$page.1" | sort >"$out/found"
    same "${page}_page" "$out/wanted" "$out/found"
}

# options PAGE COMMAND...: the same, and for completion in bash too.
options() {
    page_options "$@"
    shift
    awk -v p="\"$*\")" '$1 " " $2 == p || $1 == p { take = 1 } take && /options=/ {
        gsub(/.*options=|\047/, ""); print; exit }' "$completion/bash/ted4dec" | tr ' ' '\n' |
        sed -n 's/^--//p' | sort >"$out/found"
    same "${page}_bash" "$out/wanted" "$out/found"
}
for p in ted4dec ted4info ted4enc ted4eval ted4edit ted4scene ted4tolerance; do options $p $p; done
for s in $subcommands; do options ted4conf-$s ted4conf $s; done
echo $subcommands | tr ' ' '\n' >"$out/wanted"
sed -n 's/^\.It Cm //p' "$man/ted4conf.1" >"$out/found"
same subcommands "$out/wanted" "$out/found"

for page in "$man"/*.1; do
    for part in '.Nd ' '.Sh NAME' '.Sh SYNOPSIS' '.Sh DESCRIPTION' '.Sh OPTIONS' \
        '.Sh EXIT STATUS' '.Sh EXAMPLES' '.Sh SEE ALSO'; do
        grep -q "^$part" "$page" || echo "${page##*/}: no $part"
    done
    grep -A 1 '^\.Sh EX' "$page" | grep -q '^\.Sh S' && echo "${page##*/}: an empty section"
done >"$out/lacks"
if [ -s "$out/lacks" ]; then fail sections "$(cat "$out/lacks")"; else ok sections; fi

if has mandoc; then
    # It does not find the pages that these refer to, and expects the name of a BSD.
    mandoc -Tlint "$man"/*.1 | grep -v 'referenced manual not found\|operating system' \
        >"$out/lint"
    if [ -s "$out/lint" ]; then fail mandoc "$(cat "$out/lint")"; else ok mandoc; fi
else
    skip mandoc "there is no mandoc"
fi

# completes NAME WANTED WORD...: what bash offers for the last word.
cat >"$out/complete.bash" <<'BASH'
. "$1/bash/ted4dec"
shift
COMP_WORDS=("$@") COMP_CWORD=$(($# - 1))
_ted4
echo "${COMPREPLY[*]}"
BASH
completes() {
    name=$1 wanted=$2; shift 2
    found=$(bash "$out/complete.bash" "$completion" "$@")
    if [ "$found" = "$wanted" ]; then ok "$name"; else fail "$name" "$found"; fi
}
if has bash; then
    runs bash_syntax bash -n "$completion/bash/ted4dec"
    completes bash_option "--camera-centre --camera" ted4dec --ca
    completes bash_path CHANGELOG.md ted4dec x.ted4 -o CHANGE
    completes bash_equals CHANGELOG.md ted4dec x.ted4 --output = CHANGE
    completes bash_value "" ted4dec --time ""
    completes bash_word "judge table" ted4tolerance ""
    completes bash_word_option "--help" ted4tolerance --h
    completes bash_word_path CHANGELOG.md ted4tolerance judge CHANGE
    completes bash_nothing "" ted4dec --no-such
    completes bash_subcommand "run replay" ted4conf r
    completes bash_of_subcommand "--jobs --json --junit" ted4conf run --j
    completes bash_operand CHANGELOG.md /usr/bin/ted4info CHANGE
else
    skip bash "there is no bash"
fi
if has zsh; then runs zsh_syntax zsh -n "$completion/zsh/_ted4"
else skip zsh "there is no zsh"; fi
if has fish; then
    HOME=$out XDG_CONFIG_HOME=$out expect fish 0 '--json' fish -c "
        for f in $completion/fish/*.fish; source \$f; end; complete -C 'ted4conf run --j'"
else
    skip fish "there is no fish"
fi

if has file; then
    expect magic 0 "TED4 dynamic scene of 3D Gaussians, major version 1, minor 0, profile Main, level 1" \
        file -m tools/ted4.magic "$vector"
    expect magic_type 0 model/vnd.ted4 file -m tools/ted4.magic --mime-type "$vector"
    if file -m tools/ted4.magic README.md | grep -q Gaussians; then fail magic_other README.md
    else ok magic_other; fi
else
    skip magic "there is no file(1)"
fi
if has update-mime-database; then
    mkdir -p "$out/mime/packages"
    cp tools/ted4.xml "$out/mime/packages"
    runs mime update-mime-database "$out/mime"
    check mime_glob "$out/mime/globs2" "50:model/vnd.ted4:*.ted4"
    check mime_magic "$out/mime/magic" "[60:model/vnd.ted4]"
else
    skip mime "there is no update-mime-database"
fi
exit $bad
