# compare.awk - a variant against the whole method on the same scene. Used by bench/report.sh; arithmetic in curves.awk.
# SPDX-License-Identifier: BSD-2-Clause

# Points of a scene's variant into px (PSNR, dB) and pb (natural logarithm of bytes), sorted by PSNR; their number. as: "", or a variant at whose lambdas alone.
function load_curve(s, v, px, pb, as,    i, n, t) {
    for (i = 1; i <= n_runs[s, v]; i++) {
        t = runs[s, v, i]
        if (!has(t) || (as != "" && !has_lambda(s, as, lambda[t])))
            continue
        px[++n] = get(t, "psnr") + 0
        pb[n] = log(get(t, "bytes"))
    }
    curve_sort(px, pb, n)
    return n + 0
}

function has_lambda(s, v, value,    i) {
    for (i = 1; i <= n_runs[s, v]; i++)
        if (has(runs[s, v, i]) && lambda[runs[s, v, i]] == value)
            return 1
    return 0
}

# What a variant is compared with: the whole method; with the choice of capacity (VARIANT_auto), at the preset's full length (VARIANT_long), or with a
# heavier offset mask (VARIANT_moremask), that with the same.
# Where the global against names a variant, that one.
function base_of(v) { return against != "" ? against : v ~ /_auto$/ ? "whole_auto" : v ~ /_long$/ ? "whole_long" : v ~ /_moremask$/ ? "moremask" : "whole" }

# Bytes at the same PSNR, percent, of run t against the whole method's curve; "" where that does not reach.
function rate_change(t,    x, y, n, at) {
    n = load_curve(scene[t], base_of(variant[t]), x, y)
    at = curve_at(x, y, n, get(t, "psnr") + 0)
    return at == "" ? "" : percent_of(log(get(t, "bytes")) - at)
}

# PSNR at the same bytes, dB, likewise.
function psnr_change(t,    x, y, n, at) {
    n = load_curve(scene[t], base_of(variant[t]), x, y)
    curve_sort(y, x, n)
    at = curve_at(y, x, n, log(get(t, "bytes")))
    return at == "" ? "" : get(t, "psnr") - at
}

# The point of the whole method that is nearest in quality; "" when there is none.
function nearest(t,    i, best, d, u, far) {
    for (i = 1; i <= n_runs[scene[t], base_of(variant[t])]; i++) {
        u = runs[scene[t], base_of(variant[t]), i]
        if (!has(u))
            continue
        d = size_of(get(u, "psnr") - get(t, "psnr"))
        if (best == "" || d < far) {
            best = u
            far = d
        }
    }
    return best
}

# Of a variant on a scene, from those of its runs that are there:
#     change["runs"]                     how many
#     change["rate"], ["psnr"]           means of rate_change and psnr_change over the runs that the curve reaches; ""
#     change["near_psnr"], ["near_rate"] mean differences to the nearest points, dB and percent
#     change["gap"], ["cubic"]           rate between the two curves at the same lambdas, percent: straight lines; Bjontegaard's cubics, "" with fewer than four
#                                        points
#     change["worse"]                    1 worse than the whole method, 0 better, "" cannot be said
function compare(s, v, change,    i, t, u, r, p, n_r, n_p, d_p, d_b, na, nb, xa, ya, xb, yb) {
    split("", change)
    n_r = n_p = d_p = d_b = change["runs"] = 0
    for (i = 1; i <= n_runs[s, v]; i++) {
        t = runs[s, v, i]
        if (!has(t) || (u = nearest(t)) == "")
            continue
        change["runs"]++
        r = rate_change(t)
        p = psnr_change(t)
        if (r != "") { change["rate"] += r; n_r++ }
        if (p != "") { change["psnr"] += p; n_p++ }
        d_p += get(t, "psnr") - get(u, "psnr")
        d_b += log(get(t, "bytes") / get(u, "bytes"))
    }
    change["rate"] = n_r ? change["rate"] / n_r : ""
    change["psnr"] = n_p ? change["psnr"] / n_p : ""
    na = load_curve(s, base_of(v), xa, ya, v)
    nb = load_curve(s, v, xb, yb)
    change["gap"] = percent_of(curve_gap(xa, ya, na, xb, yb, nb))
    change["cubic"] = percent_of(bjontegaard(xa, ya, na, xb, yb, nb))
    change["near_psnr"] = change["runs"] ? d_p / change["runs"] : ""
    change["near_rate"] = change["runs"] ? percent_of(d_b / change["runs"]) : ""
    change["worse"] = change["runs"] ? is_worse(change) : ""
}

# At equal bytes, else at equal PSNR, else when one of them is better on both counts than the other's nearest points.
function is_worse(change) {
    if (change["psnr"] != "")
        return change["psnr"] < 0
    if (change["rate"] != "")
        return change["rate"] > 0
    if (change["near_psnr"] <= 0 && change["near_rate"] >= 0)
        return 1
    if (change["near_psnr"] >= 0 && change["near_rate"] <= 0)
        return 0
    return ""
}

# The rate of a variant in one number: by cubics where there are points enough, else at equal PSNR, else between straight lines.
function one_rate(change) { return change["cubic"] != "" ? change["cubic"] : change["rate"] != "" ? change["rate"] : change["gap"] }

# BD-rate, and how it was found.
function bd_rate(change) { return change["cubic"] != "" ? change["cubic"] : change["gap"] }
function bd_way(change) { return change["cubic"] != "" ? " (cubic)" : change["gap"] != "" ? " (lines)" : "" }
