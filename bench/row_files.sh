# row_files.sh - rows of a table of runs, each first a file of its own, from which the table is made
# (bench/runs.sh, which sources this and says what its variables are). Every file appears whole, by
# being renamed, and a row's file goes only after the table with that row is there. So whoever is
# killed, the next merge finds all rows, and a row that was merged already is only put in its place
# again.
# SPDX-License-Identifier: BSD-2-Clause

# key_in FILE: of the tag's row there; nothing if it has none.
key_in() { [ ! -f "$1" ] || awk -F, -v tag="$tag" '$1 == tag { print $2 }' "$1"; }

count_cells() { echo "$1" | awk -F, '{ print NF }'; }

# Into the table in place of the tag's older row; the table is sorted and never half-written. Its
# lock is a file beside it, open for writing, since NFS locks no others.
into_table() {
    (
        flock 9 || exit 1
        {
            echo "$columns"
            {
                [ ! -f "$csv" ] || sed 1d "$csv" | awk -F, -v tag="$tag" '$1 != tag'
                cat "$work/rows/$tag.row"
            } | sort
        } >"$csv.part" && mv "$csv.part" "$csv"
    ) 9>>"$csv.lock" && rm "$work/rows/$tag.row"
}

# Into a file of its own, and from there into the table, unless --row-files leaves that to --merge.
# The caller holds the tag's lock: nobody else writes or removes the file.
put_row() {
    [ "$(count_cells "$row")" = "$(count_cells "$columns")" ] ||
        { echo "$tag: malformed row: $row"; return 1; }
    mkdir -p "$work/rows"
    echo "$row" >"$work/rows/$tag.part" && mv "$work/rows/$tag.part" "$work/rows/$tag.row" &&
        { [ -n "$row_files" ] || into_table; }
}

# The file of the tag's row, if it has one, into the table, and away; it only goes if the table has
# a row of the present sources, or of the wanted options, and the file has none, or if the table has
# it already. 2: a run is at work on it, which will leave a newer one.
merge_row() {
    [ -f "$work/rows/$tag.row" ] || return 0
    exec 8>"$work/runs/$tag.lock"
    lock 8 || return
    [ -f "$work/rows/$tag.row" ] || return 0
    find_state
    there=$(key_in "$csv") new=$(key_in "$work/rows/$tag.row")
    case $state:$had in done:"$there"|equal:"$there") new= ;; esac
    case ${there%-*}:${new%-*} in
    "${key%-*}:${key%-*}") ;;
    "${key%-*}:"*) new= ;;
    esac
    if [ -z "$new" ]; then rm "$work/rows/$tag.row"; else into_table && echo "$tag: merged"; fi
}

# 1: some stay what they were. The sentence about files that no run claims: only if all were asked.
merge_chosen() {
    echo "$chosen" | {
        status=0
        while IFS='|' read -r groups tag scene where lambda keep stage1 options; do
            merge_row
            case $? in
            0) ;;
            2) status=1; echo "$tag: not merged, a run is at work on it" ;;
            *) status=1; echo "$tag: not merged" ;;
            esac
            exec 8>&-
        done
        exit $status
    } || return
    left=$(find "$work/rows" -name '*.row' 2>/dev/null | wc -l)
    [ -n "$patterns$only" ] || [ "$left" = 0 ] ||
        echo "$program: $left rows that $table does not want stay in $work/rows"
}
