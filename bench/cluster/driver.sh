# driver.sh - what parallel.sh and slurm.sh share: the command line, and which runs of a table are
# left. Sourced from the project's root with the command line of the script, of which it leaves what
# stands after --. The script sets beforehand:
#     program   its name
#     takes     its options that have a number, with blanks around
#     flags     its options without a value, likewise
# An option --at-once 5 or a flag --wait is then in $at_once or $wait.
# SPDX-License-Identifier: BSD-2-Clause
die() { echo "$program: $*" >&2; exit 3; }
usage() { sed -n '2,/^# SPDX/{/^# SPDX/!s/^# \{0,1\}//p}' "bench/cluster/$program"; }

# Patterns are not file names.
set -f
table= patterns= missing=
while [ $# -gt 0 ]; do
    option=$1
    shift
    name=$(echo "${option#--}" | tr - _)
    case $option in
    --)        break ;;
    --missing) missing=--missing ;;
    -*)        case "$takes|$flags" in
               *" $option "*"|"*) case ${1:-} in ""|*[!0-9]*) die "$option needs a number" ;; esac
                                  eval "$name=$1"; shift ;;
               *"|"*" $option "*) eval "$name=1" ;;
               *)                 usage; [ "$option" = --help ] && exit 0; exit 3 ;;
               esac ;;
    *)         if [ -z "$table" ]; then table=$option; else patterns="$patterns $option"; fi ;;
    esac
done
case $table in
sweep|stability|capacity|zoo|bd_rate|held_out) ;;
*) usage; exit 3 ;;
esac
build=${TED4_BUILD:-build}
work=${TED4_WORK:-$build/$table}
mkdir -p "$work/cluster" && cd "$work" && work=$(pwd) && cd "$OLDPWD" || exit 3

# The script that makes the rows, with these options more.
rows() { "bench/$table.sh" $missing "$@" $patterns; }

# Tags of the runs whose rows are not there yet, a line each.
left_rows() {
    rows --list >"$work/cluster/list.$$" || exit 3
    awk -v missing="$missing" '$1 != "done" && $1 != "equal" && !(missing && $1 == "older") {
        print $2
    }' "$work/cluster/list.$$"
    rm "$work/cluster/list.$$"
}

# The first run of each thing that runs share and that is not there yet.
left_shared() {
    rows --shared --list >"$work/cluster/list.$$" || exit 3
    awk '{ print $2 }' "$work/cluster/list.$$"
    rm "$work/cluster/list.$$"
}

# How many rows are missing; fails if any is.
tell_left() {
    left=$(left_rows) || exit 3
    [ -n "$left" ] || { echo "$program: all rows are there"; return 0; }
    echo "$program: $(echo "$left" | wc -l) rows are missing; to go on, call this again"
    return 1
}
