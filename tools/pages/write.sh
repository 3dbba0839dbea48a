#!/bin/sh
# write.sh BUILD - writes manual pages into BUILD/man and completions into BUILD/completion, by
# means of the programs in BUILD/pages, each of which describes itself (pages.c). Run from the
# project's root.
# SPDX-License-Identifier: BSD-2-Clause
set -eu
b=$1
man=$b/man bash=$b/completion/bash zsh=$b/completion/zsh fish=$b/completion/fish
rm -rf "$man" "$b/completion"
mkdir -p "$man" "$bash" "$zsh" "$fish"
date=$(awk '/^date-released:/ {
    split("January February March April May June July August September October November December",
        month, " ")
    split($2, part, "-")
    print month[part[2] + 0] " " part[3] + 0 ", " part[1]
}' CITATION.cff)
programs=$(cd "$b/pages" && ls | grep '^ted4')
subcommands=$("$b/pages/ted4conf" --help | sed -n 's/^  \([a-z]*\) .*/\1/p' | xargs)

# each KIND [DATE]: has every program, or subcommand, write that kind of page.
each() {
    for p in $programs; do
        if [ "$p" = ted4conf ]; then
            for s in $subcommands; do "$b/pages/$p" "$s" "$@"; done
        else
            "$b/pages/$p" "$@"
        fi
    done
}

for p in $programs; do
    [ -e "tools/pages/$p.1" ] || "$b/pages/$p" man "$date" >"$man/$p.1"
done
for s in $subcommands; do "$b/pages/ted4conf" "$s" man "$date" >"$man/ted4conf-$s.1"; done
for page in tools/pages/*.1; do sed "s/@DATE@/$date/" "$page" >"$man/${page##*/}"; done

# filled TEMPLATE KIND: prints the template, with the output of the programs for @CASES@.
filled() {
    each "$2" >"$b/pages/cases"
    sed -e "/@CASES@/{r $b/pages/cases" -e 'd;}' \
        -e "s/@PROGRAMS@/$(echo $programs)/; s/@SUBCOMMANDS@/$subcommands/" "$1"
    rm "$b/pages/cases"
}
# Shells look for a file with the name of the program; only for fish there is one for each.
filled tools/pages/bash.in bash >"$bash/ted4dec"
for p in $programs; do [ "$p" = ted4dec ] || ln -s ted4dec "$bash/$p"; done
filled tools/pages/zsh.in zsh >"$zsh/_ted4"
each fish >"$b/pages/cases"
for p in $programs; do grep "^complete -c $p " "$b/pages/cases" >"$fish/$p.fish"; done
rm "$b/pages/cases"
echo "complete -c ted4conf -n __fish_use_subcommand -x -a '$subcommands'" >>"$fish/ted4conf.fish"
echo "complete -c ted4tolerance -n __fish_use_subcommand -x -a 'judge table'" \
    >>"$fish/ted4tolerance.fish"
