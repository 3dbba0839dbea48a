# cost.awk - what a run costs, and what of its file is there for time's sake.
# SPDX-License-Identifier: BSD-2-Clause

# Values of the anchors of a run: what lambda's bits are divided by, the same for all runs of a scene: those of its whole model.
function values_of(t) {
    return get(t, "anchors") * (get(t, "feature_dim") + 6 + 3 * get(t, "n_offsets") + get(t, "phi_dim") + 4 * get(t, "activation"))
}
# Distortion of held-out pictures as training weighs it.
function distortion(t) { return 0.8 * get(t, "l1") + 0.2 * (1 - get(t, "ssim")) }
function scene_values(s) { return n_runs[s, "whole"] > 0 && has(runs[s, "whole", 1]) ? values_of(runs[s, "whole", 1]) : 0 }
# "" where it is not known.
function cost(t,    n) {
    n = scene_values(scene[t])
    return has(t) && n > 0 ? distortion(t) + 8 * get(t, "lambda") * get(t, "bytes") / n : ""
}

# Weights of a chain of layers: inputs, hidden layers of a width, outputs.
function chain(first, hidden, width, last) {
    return hidden > 0 ? (first + 1) * width + (hidden - 1) * (width + 1) * width + (width + 1) * last : (first + 1) * last
}
# Of the networks of reconstruction, those that move things.
function motion_weights(t,    d) {
    d = get(t, "bank_dim")
    if (get(t, "motion") + 0 == 0)
        return 0
    if (get(t, "motion") == 1)
        return chain(get(t, "phi_dim"), 0, 0, d) + chain(d, get(t, "deform_layers"), get(t, "deform_width"), 3 + get(t, "feature_dim"))
    return chain(get(t, "motion") == 2 ? get(t, "phi_dim") + d : 84, get(t, "deform_layers"), get(t, "deform_width"), 3 + get(t, "feature_dim"))
}
function head_weights(t,    f, k, l, w, v) {
    f = get(t, "feature_dim"); k = get(t, "n_offsets"); l = get(t, "head_layers"); w = get(t, "head_width"); v = get(t, "view")
    return chain(f + 3 * (v == 2), l, w, k) + chain(f + 3 * (v == 2), l, w, 7 * k) + chain(f + 3 * (v > 0), l, w, 3 * k)
}
# Bytes that a file has because things move, come or go: bank, temporal features, activations, and the networks' share.
function temporal(t,    m) {
    m = motion_weights(t)
    return get(t, "b_bank") + get(t, "b_phi") + get(t, "b_tau") + get(t, "b_netr") * m / (m + head_weights(t))
}

# Mean of a column, or of bytes for time, over the seeds of a scene's variant; "" as long as one is missing.
function mean_over_seeds(s, v, column,    i, sum) {
    for (i = 1; i <= n_runs[s, v]; i++) {
        if (!has(runs[s, v, i]))
            return ""
        sum += column == "temporal" ? temporal(runs[s, v, i]) : get(runs[s, v, i], column)
    }
    return n_runs[s, v] > 0 ? sum / n_runs[s, v] : ""
}
