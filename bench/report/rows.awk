# rows.awk - reads the runs that are wanted and the rows that are there. Used by bench/report.sh, whose other files see them through these functions only.
# First file: a line a wanted run, STATE|GROUPS|TAG|SCENE|WHERE|VARIANT|PLACE|LAMBDA|KEEP|STAGE1|OPTIONS; STATE as in `sweep.sh --list`, the rest as
# bench/expand.awk prints it. Second file: sweep.csv, whose first line names the columns; it may be missing (/dev/null) or end early. Of its rows those count
# that the wanted options made, with these sources or older ones; a row that other options made is none.
# SPDX-License-Identifier: BSD-2-Clause

BEGIN { FS = "|" }

FILENAME == ARGV[1] {
    tag[++n_tags] = $3
    state[$3] = $1; groups[$3] = "+" $2 "+"; scene[$3] = $4; where[$3] = $5; variant[$3] = $6
    place[$3] = $7; lambda[$3] = $8; keep[$3] = "+" $9 "+"; options[$3] = $11
    if (!($4 in seen_scene)) {
        seen_scene[$4] = 1
        scenes[++n_scenes] = $4
    }
    if (!($6 in seen_variant)) {
        seen_variant[$6] = 1
        variants[++n_variants] = $6
    }
    add_run($4, $6, $3)
    next
}
FNR == 1 {
    n_columns = split($0, column, ",")
    next
}
{
    if (split($0, field, ",") != n_columns) {
        print FILENAME ":" FNR ": " n_columns " columns expected" >"/dev/stderr"
        failed = 1
        exit 1
    }
    if (!(field[1] in state)) {
        strangers++
        next
    }
    if (state[field[1]] == "stale") {
        others++
        next
    }
    for (i = 2; i <= n_columns; i++)
        value[field[1], column[i]] = field[i]
    have[field[1]] = 1
}

# runs[scene, variant, 1..n_runs[scene, variant]]: tags, by rising lambda.
function add_run(s, v, t,    i) {
    for (i = ++n_runs[s, v]; i > 1 && lambda[runs[s, v, i - 1]] + 0 > lambda[t] + 0; i--)
        runs[s, v, i] = runs[s, v, i - 1]
    runs[s, v, i] = t
}

function has(t) { return t in have }
# A cell; "" when it, the row or the column is not there.
function get(t, name) { return (t, name) in value ? value[t, name] : "" }
# Other sources than the present ones made this row.
function is_old(t) { return has(t) && state[t] != "done" }
function in_group(t, group) { return index(groups[t], "+" group "+") > 0 }
function keeps(t, what) { return index(keep[t], "+" what "+") > 0 }
# A variant of a scene belongs to a group when its first run does.
function wants(s, v, group) { return n_runs[s, v] > 0 && in_group(runs[s, v, 1], group) }
# A scene of the rate-distortion curves: the whole method at more than one lambda.
function has_curve(s) { return n_runs[s, "whole"] > 1 }
# How many of a variant's runs are there.
function count_runs(s, v,    i, n) {
    for (i = 1; i <= n_runs[s, v]; i++)
        n += has(runs[s, v, i])
    return n + 0
}
# Bytes of the attributes' substreams.
function payload(t) { return get(t, "b_feature") + get(t, "b_scaling") + get(t, "b_offset") + get(t, "b_phi") + get(t, "b_tau") }
# Milliseconds to decode the file on one thread and draw one picture with the run's threads; "" when one of them is not known.
function picture_ms(t) {
    return get(t, "decode_ms") == "" || get(t, "render_fps") + 0 <= 0 ? "" : get(t, "decode_ms") + 1000 / get(t, "render_fps")
}
