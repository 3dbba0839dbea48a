# builds.sh - what conformance/cross/cross.sh and bench/machines.sh share: the builds of a table,
# each made and judged once, and a row of a CSV for each. Sourced, from any folder.
# A row is kept while its key and its compiler are those of the build now. A build whose tools are
# missing is skipped, which is said; a row that it has of the same key stays. May be killed at any
# moment and called again, and several times at once for different builds.
# The script sets beforehand:
#     program   its name
#     columns   of the CSV, divided by commas: name, key and compiler first, the verdict last
#     fields    of a line of the table, divided by ";": name, compiler and packages among them
# and defines
#     enter     goes where the sources are; sets csv, table, and work, the folder of all calls;
#               calls own_folder
#     settle    of the fields: sets key
#     missing   prints what the build needs that is not there; nothing: all is there
#     make_row  makes the build and judges it: sets verdict, calls put_row, and says what passed
#     report    writes the page
#     agree     says whether the builds agree, by its status
# and calls begin_builds "$@".
# SPDX-License-Identifier: BSD-2-Clause
LC_ALL=C; export LC_ALL
verdict_column=$(echo "$columns" | awk -F, '{ print NF }')

die() { echo "$program: $*" >&2; exit 3; }
short_hash() { sha256sum | cut -c1-16; }

# own_folder: $own, of this call, gone when it ends
own_folder() {
    own=$work/run.$$
    trap 'rm -rf "$own"' EXIT
    trap 'exit 3' INT TERM
    mkdir -p "$own"
}

each() { grep -v -e '^#' -e '^$' "$table"; }

# split LINE: the fields of the table's line
split() {
    IFS=';' read -r $fields <<END
$(echo "$1" | sed 's/ *; */;/g')
END
    settle
}

# missing_command WORD...: the first command that is not there
missing_command() {
    for command; do
        command -v "$command" >/dev/null || { echo "$command"; return; }
    done
}

version() { ${compiler%% *} --version 2>/dev/null | head -n 1 | tr ',' ' '; }
of_row() { echo "$row" | cut -d, -f"$1"; }

# state: sets state to passed, kept (tools missing, but a row of these sources is there), skipped,
# failed, stale or new; row and row_verdict; lacks, what is missing
state() {
    row=$(grep "^$name," "$csv" 2>/dev/null | tail -n 1)
    row_verdict=$(of_row "$verdict_column")
    lacks=$(missing | head -n 1)
    if [ -n "$lacks" ]; then
        state=skipped
        [ "$(of_row 2)" != "$key" ] || state=kept
    elif [ -z "$row" ]; then
        state=new
    elif [ "$(of_row 2)" != "$key" ] || [ "$(of_row 3)" != "$(version)" ]; then
        state=stale
    elif [ "$row_verdict" = passed ]; then
        state=passed
    else
        state=failed
    fi
}

# tell_state KEPT STALE: for the page's line of a build in this state: sets said, to these words
# where the row is kept or stale; empties row where it counts for nothing; rows that count go into
# $own/counted
tell_state() {
    case $state in
    passed)  said=passed ;;
    kept)    said=$1 ;;
    failed)  said="**failed**: $row_verdict" ;;
    stale)   said=$2 ;;
    skipped) said="skipped: no $lacks" row= ;;
    *)       said="not run" row= ;;
    esac
    case $state in passed | kept | failed) echo "$row" >>"$own/counted" ;; esac
}

# put_row VALUES: of the columns after the compiler, in place of an earlier row
put_row() {
    (
        flock 9
        {
            echo "$columns"
            { grep -v -e "^$name," -e "^name," "$csv" 2>/dev/null
              echo "$name,$key,$(version),$1"; } | sort
        } >"$csv.new" && mv "$csv.new" "$csv"
    ) 9>"$work/lock"
}

chosen() {
    [ -n "$patterns" ] || return 0
    set -f
    for pattern in $patterns; do
        case $name in $pattern) set +f; return 0 ;; esac
    done
    set +f
    return 1
}

one() {
    rows=${csv##*/}
    state
    case $state in
    passed)  echo "passed   $name (as $rows says)"; return ;;
    kept)    echo "kept     $name: no $lacks here; $rows has a row of the same sources"; return ;;
    skipped) echo "skipped  $name: no $lacks${packages:+ (needs $packages)}"; return ;;
    esac
    make_row
    [ "$verdict" = passed ] || echo "FAILED   $name: $verdict"
}

# begin_builds [--list | --report] [PATTERN...]; $do says which, $patterns which builds
begin_builds() {
    patterns= do=run
    for argument; do
        case $argument in
        --list)   do=list ;;
        --report) do=report ;;
        -*)       die "$argument: no such option" ;;
        *)        patterns="$patterns $argument" ;;
        esac
    done
    enter
    each >"$own/todo"
    while [ $do != report ] && read -r line <&3; do
        split "$line"
        chosen || continue
        case $do in
        run)  one ;;
        list) state; echo "$state $name" ;;
        esac
    done 3<"$own/todo"
    [ $do = list ] || report
    [ $do != run ] || agree
}
