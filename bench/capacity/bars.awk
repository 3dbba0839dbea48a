# bars.awk - judges bars 4 to 6 of the lab.
# SPDX-License-Identifier: BSD-2-Clause

BEGIN { equal_psnr = 0.1 }      # dB: a fixed setting that far below auto still counts as equal

function capacity_command(patterns) { return "`bench/capacity.sh " patterns "`" }

# The fixed run of a scene that costs least; "" without any.
function best_fixed(s,    i, v, t, best) {
    for (i = 1; i <= n_variants; i++) {
        v = variants[i]
        t = v != "auto" && n_runs[s, v] > 0 ? runs[s, v, 1] : ""
        if (t != "" && cost(t) != "" && (best == "" || cost(t) < cost(best)))
            best = t
    }
    return best
}

# Spread of auto's cost over seeds; "" with fewer than two.
function cost_spread(s,    i, n, c, sum, square) {
    for (i = 1; i <= n_runs[s, "auto"]; i++) {
        c = cost(runs[s, "auto", i])
        if (c != "") {
            n++
            sum += c
            square += c * c
        }
    }
    return n > 1 && square / n > sum * sum / n / n ? sqrt((square - sum * sum / n) / (n - 1)) : ""
}

# By what share auto costs more than the best of all fixed settings that are wanted; "" as long as one of these is missing.
function over_best(s,    i) {
    if (!has(runs[s, "auto", 1]))
        return ""
    for (i = 1; i <= n_variants; i++)
        if (n_runs[s, variants[i]] > 0 && !has(runs[s, variants[i], 1]))
            return ""
    return cost(runs[s, "auto", 1]) / cost(best_fixed(s)) - 1
}

# Fixed settings that a scene is to be trained with.
function count_fixed(s,    i, n) {
    for (i = 1; i <= n_variants; i++)
        n += variants[i] != "auto" && n_runs[s, variants[i]] > 0
    return n
}

function is_near_best(s,    sd) {
    sd = cost_spread(s)
    return over_best(s) <= 0.02 || (sd != "" && cost(runs[s, "auto", 1]) - cost(best_fixed(s)) <= sd)
}

# 4: cost on every scene with a grid.
function cost_bar(    i, s, over, worst, at, n, met, missed, known) {
    for (i = 1; i <= n_scenes; i++) {
        s = scenes[i]
        if (n_runs[s, "auto"] == 0 || count_fixed(s) < 2)
            continue
        n++
        if ((over = over_best(s)) == "")
            continue
        known++
        if (worst == "" || over > worst) {
            worst = over
            at = s
        }
        if (is_near_best(s))
            met++
        else
            missed = join(missed, ", ", s " " signed(100 * over, 1, " %"))
    }
    bar(4, "cost of auto against the best fixed setting", "at most 2 % more, or one standard deviation over seeds, on every scene", \
        known ? met + 0 " of " n " scenes" (missed == "" ? "" : "; not " missed) "; most: " at " " signed(100 * worst, 1, " %") : "", \
        missed != "" ? 0 : known == n && n > 0 ? 1 : "", capacity_command("auto grid"))
}

# 4: processor time of auto against that of the options as they are.
function time_bar(    i, s, t, u, more, worst, at, n, known) {
    for (i = 1; i <= n_scenes; i++) {
        s = scenes[i]
        if (n_runs[s, "auto"] == 0 || n_runs[s, "whole"] == 0)
            continue
        n++
        t = runs[s, "auto", 1]
        u = runs[s, "whole", 1]
        if (!has(t) || !has(u))
            continue
        known++
        more = get(t, "cpu_s") / get(u, "cpu_s") - 1
        if (worst == "" || more > worst) {
            worst = more
            at = s
        }
    }
    bar(4, "training time of auto against the same options fixed, CPU", "at most 25 % more", known ? "most: " at " " signed(100 * worst, 0, " %") : "", \
        known && worst > 0.25 ? 0 : known == n && n > 0 ? 1 : "", capacity_command("'*-auto-1' '*-whole-1'"))
}

# 5: a scene without time. The smallest fixed file of about auto's quality, or better.
function still_bar(s,    i, t, u, best, text, ok, all) {
    t = runs[s, "auto", 1]
    all = has(t)
    for (i = 1; has(t) && i <= n_variants; i++) {
        u = variants[i] != "auto" && n_runs[s, variants[i]] > 0 ? runs[s, variants[i], 1] : ""
        if (u == "")
            continue
        all = all && has(u)
        if (has(u) && get(u, "psnr") > get(t, "psnr") - equal_psnr && (best == "" || get(u, "bytes") + 0 < get(best, "bytes") + 0))
            best = u
    }
    if (has(t)) {
        text = sprintf("%.0f", temporal(t)) " bytes for time; " get(t, "bytes") " bytes at " fixed(get(t, "psnr"), 2) " dB, " \
            (best == "" ? "no fixed setting as good" : variant[best] " " get(best, "bytes") " at " fixed(get(best, "psnr"), 2) " dB")
        ok = temporal(t) == 0 && get(t, "motion") == 0 && get(t, "activation") == 0 && (best == "" || get(t, "bytes") + 0 < get(best, "bytes") + 0)
    }
    bar(5, s ": syntax for time, size", "none; smaller than any fixed setting of equal PSNR (" equal_psnr " dB)", text, \
        !has(t) ? "" : !ok ? 0 : all ? 1 : "", capacity_command("'" s "-*'"))
}

# 6: bytes for time by how many things move, mean over seeds.
function things_bar(    n, i, s, now, text, last, ok, known) {
    n = split("0 1 2 4 8", s, " ")
    ok = 1
    for (i = 1; i <= n; i++) {
        now = mean_over_seeds("things" s[i], "auto", "temporal")
        if (now == "")
            continue
        known++
        text = join(text, ", ", sprintf("%.0f", now))
        ok = ok && (s[i] == 0 ? now == 0 : last == "" || now > last)
        last = now
    }
    bar(6, "bytes for time with 0, 1, 2, 4, 8 moving things, mean over seeds", "0 first, then more and more", text, known && !ok ? 0 : known == n ? 1 : "", \
        capacity_command("'things*-auto-*'"))
}
