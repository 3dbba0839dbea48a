# page.awk - writes bench/capacity.md. Used by bench/capacity_page.sh, last.
# SPDX-License-Identifier: BSD-2-Clause

function model(t) {
    return get(t, "n_offsets") "/" get(t, "feature_dim") "/" get(t, "phi_dim") ", " get(t, "bank_rows") "x" get(t, "bank_dim") ", " \
        get(t, "deform_width") "/" get(t, "head_width") ", " get(t, "hyper_layers") "x" get(t, "hyper_width") "/" get(t, "n_slices") "x" get(t, "ar_width") \
        ", " get(t, "view") (get(t, "scale_domain") == 1 ? ", linear" : "")
}

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
function spread(s,    i, n, c, sum, square) {
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

function show_scene(s,    i, v, t, best, b) {
    best = best_fixed(s)
    for (i = 1; i <= n_variants; i++) {
        v = variants[i]
        if (n_runs[s, v] == 0)
            continue
        t = runs[s, v, 1]
        if (!has(t)) {
            row_missing(s "|" v)
            continue
        }
        b = best != "" && cost(t) != "" ? signed(100 * (cost(t) / cost(best) - 1), 1, " %") : "-"
        row(s "|" v mark_of(t) "|" get(t, "bytes") "|" fixed(get(t, "psnr"), 2) "|" fixed(cost(t), 5) "|" b "|" sprintf("%.0f", temporal(t)) "|" \
            fixed(get(t, "cpu_s"), 0) "|" get(t, "trial_steps") "|" fixed(get(t, "decode_ms"), 2) "|" model(t))
    }
}

function bar4(s,    t, best, over, sd) {
    t = runs[s, "auto", 1]
    best = best_fixed(s)
    if (!has(t) || best == "" || cost(t) == "")
        return ""
    over = cost(t) / cost(best) - 1
    sd = spread(s)
    return over <= 0.02 || (sd != "" && cost(t) - cost(best) <= sd) ? 1 : 0
}

# Fixed settings that a scene is to be trained with.
function count_fixed(s,    i, n) {
    for (i = 1; i <= n_variants; i++)
        n += variants[i] != "auto" && n_runs[s, variants[i]] > 0
    return n
}

function summary(    i, s, ok, met, missed, unknown, list) {
    for (i = 1; i <= n_scenes; i++) {
        s = scenes[i]
        if (n_runs[s, "auto"] == 0 || count_fixed(s) < 2)
            continue
        ok = bar4(s)
        if (ok == "")
            unknown++
        else if (ok)
            met++
        else {
            missed++
            list = join(list, ", ", s)
        }
    }
    say("Auto costs at most 2 % more than the best fixed setting, or one standard deviation over its seeds, on " met + 0 " scenes of " \
        met + missed + unknown "; more on " (missed > 0 ? missed ": " list : "none") (unknown > 0 ? "; not known yet on " unknown : "") ".")
}

function content(title, list,    n, i, s, t) {
    say("")
    say("## " title)
    table("scene,auto: bytes,of them for time,anchors that move,PSNR,whole: bytes,of them for time,PSNR")
    n = split(list, s, " ")
    for (i = 1; i <= n; i++) {
        t = runs[s[i], "auto", 1]
        if (!has(t)) {
            row_missing(s[i])
            continue
        }
        line = s[i] mark_of(t) "|" get(t, "bytes") "|" sprintf("%.0f", temporal(t)) "|" get(t, "dynamic") "|" fixed(get(t, "psnr"), 2)
        t = runs[s[i], "whole", 1]
        row(line (has(t) ? "|" get(t, "bytes") "|" sprintf("%.0f", temporal(t)) "|" fixed(get(t, "psnr"), 2) : "|-|-|-"))
    }
}

END {
    if (failed)
        exit 1
    say("# Capacity: no more model than a scene needs")
    say("")
    say("Written by `make capacity` from bench/capacity.csv; the runs are those of bench/capacity.txt. Cost: 0.8 L1 + 0.2 (1 - SSIM) of held-out pictures, plus lambda")
    say("times the bits of the file over the values of all anchors of the scene's `whole` run, so that a bit weighs the same in every run of a scene. Bytes for")
    say("time: bank, temporal features, activations, and the networks' share. CPU: seconds of training, trials included; trials: steps of trained ones. Model: K/F/d,")
    say("rows x width of the bank, widths of F_deform/heads, hyperprior/slices, view. †: made by other sources.")
    say("")
    summary()
    say("")
    say("## Auto against fixed settings")
    table("scene,setting,bytes,PSNR,cost,against the best fixed,for time,CPU s,trials,decode ms,model")
    for (i = 1; i <= n_scenes; i++)
        show_scene(scenes[i])
    content("How many things move", "things0 things1 things2 things4 things8")
    content("For how long", "things4 long2 long4 rest")
    for (i = 1; i <= n_body; i++)
        print body[i]
}
