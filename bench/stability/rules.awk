# rules.awk - when a run counts as failed, and where. The only place of these limits.
# SPDX-License-Identifier: BSD-2-Clause

BEGIN {
    worst_gap = 2           # dB: the worst held-out frame that far below the mean, over seeds, of the whole method's worst frames on the scene
    worst_floor = 18        # dB: a worst frame below this shows something else than the scene
    worst_drop = 5          # dB: the worst frame that far below the mean of the run's own frames: one view or time is lost
    most_out = 0.01         # share of the drawn anchors that motion throws out of every picture
    most_escapes = 1 / 256  # share of symbols, as R-ENC-006 advises
    most_ends = 0.001       # share of symbols or contexts at the ends of their ranges: what they stand for is lost
    most_spread = 1         # dB between seeds of the whole method
    weak_gap = 2            # dB: the whole method on a scene that far below itself on the table's first, which nothing makes hard
    rules = "crash error nan diverges rollback gap floor drop out escapes ends spread weak"
    letter["crash"] = "C";    meaning["crash"] = "ted4enc crashed"
    letter["error"] = "E";    meaning["error"] = "ted4enc gave up with an error"
    letter["nan"] = "N";      meaning["nan"] = "something is not finite: the decoder refuses a time, or a number of the log is none"
    letter["diverges"] = "D"; meaning["diverges"] = "the distortion ends above its start"
    letter["rollback"] = "B"; meaning["rollback"] = "the watch in the trainer went back to a checkpoint"
    letter["gap"] = "W";      meaning["gap"] = "the worst frame lies more than " worst_gap " dB below the whole method's"
    letter["floor"] = "F";    meaning["floor"] = "the worst frame lies below " worst_floor " dB"
    letter["drop"] = "P";     meaning["drop"] = "the worst frame lies more than " worst_drop " dB below the mean of all frames"
    letter["out"] = "O";      meaning["out"] = "more than " 100 * most_out " % of the drawn anchors are thrown out of every picture"
    letter["escapes"] = "X";  meaning["escapes"] = "more than one of " 1 / most_escapes " symbols needs an escape"
    letter["ends"] = "R";     meaning["ends"] = "more than " 100 * most_ends " % of symbols or contexts stand at the ends of their ranges"
    letter["spread"] = "S";   meaning["spread"] = "seeds differ by more than " most_spread " dB in mean PSNR"
    letter["weak"] = "L";     meaning["weak"] = "the whole method's mean PSNR lies more than " weak_gap " dB below its own on the first scene"
    split(rules, rule_order, " ")
}

# Of the rows that are there and have a number in that column: mean, least, most; "" when there are none. s, v: scene, variant.
function mean_of(s, v, column,    i, n, sum, x) {
    for (i = 1; i <= n_runs[s, v]; i++)
        if ((x = get(runs[s, v, i], column)) != "") {
            sum += x
            n++
        }
    return n ? sum / n : ""
}
function extreme_of(s, v, column, sign,    i, x, best) {
    best = ""
    for (i = 1; i <= n_runs[s, v]; i++)
        if ((x = get(runs[s, v, i], column)) != "" && (best == "" || sign * x > sign * best))
            best = x
    return best
}
function least_of(s, v, column) { return extreme_of(s, v, column, -1) }
function most_of(s, v, column) { return extreme_of(s, v, column, 1) }
function sum_of(s, v, column,    i, sum) {
    for (i = 1; i <= n_runs[s, v]; i++)
        sum += get(runs[s, v, i], column)
    return sum + 0
}
# Between seeds, of mean PSNR; "" with fewer than two.
function spread_of(s, v) { return count_runs(s, v) > 1 && mean_of(s, v, "psnr") != "" ? most_of(s, v, "psnr") - least_of(s, v, "psnr") : "" }

# Does the rule hold of that row? spread and weak are no rules of one row.
function breaks(t, rule,    s, of_whole) {
    s = scene[t]
    if (!has(t) || rule == "spread" || rule == "weak")
        return 0
    if (rule == "crash" || rule == "error")
        return get(t, "status") == rule
    if (get(t, "status") != "fine")
        return 0
    if (rule == "nan")      return get(t, "refused_views") + get(t, "refused_times") + get(t, "log_bad") + get(t, "skipped") > 0
    if (rule == "diverges") return get(t, "diverged") + 0 > 0
    if (rule == "rollback") return get(t, "rollbacks") + 0 > 0
    if (rule == "out")      return get(t, "out_share") > most_out
    if (rule == "escapes")  return get(t, "escape_share") > most_escapes
    if (rule == "ends")     return get(t, "symbol_ends") > most_ends || get(t, "context_ends") > most_ends
    if (get(t, "worst") == "")
        return 0
    if (rule == "floor")    return get(t, "worst") < worst_floor
    if (rule == "drop")     return get(t, "psnr") - get(t, "worst") > worst_drop
    of_whole = mean_of(s, "whole", "worst")
    return of_whole != "" && of_whole - get(t, "worst") > worst_gap
}

function is_weak(s,    here, first) {
    here = mean_of(s, "whole", "psnr")
    first = mean_of(scenes[1], "whole", "psnr")
    return here != "" && first != "" && first - here > weak_gap
}

# How many rows of a variant break it; of spread and weak, which are the whole method's, all or none.
function count_breaks(s, v, rule,    i, n) {
    if (rule == "spread")
        return v == "whole" && spread_of(s, v) != "" && spread_of(s, v) > most_spread ? count_runs(s, v) : 0
    if (rule == "weak")
        return v == "whole" && is_weak(s) ? count_runs(s, v) : 0
    for (i = 1; i <= n_runs[s, v]; i++)
        n += breaks(runs[s, v, i], rule)
    return n + 0
}

# Letters of what fails, each with the number of seeds where these are not all: "W O2"; "" when nothing fails.
function marks_of(s, v,    i, n, text) {
    for (i = 1; i in rule_order; i++)
        if ((n = count_breaks(s, v, rule_order[i])) > 0)
            text = join(text, " ", letter[rule_order[i]] (n < count_runs(s, v) ? n : ""))
    return text
}
