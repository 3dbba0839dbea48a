# recipe.awk - the paper's recipe alone with one thing changed, over seeds: what that part of the method is worth where nothing that the paper does not have does
# its work. Used by bench/report.sh; runs and arithmetic: seeded.awk.
# SPDX-License-Identifier: BSD-2-Clause

function recipe_section(    k, n) {
    say("")
    say("### The paper's recipe alone")
    say("")
    say("The same comparison without what the paper does not have: no sprouts, transients or probe. Each seed against the recipe at the same seed and λ, as in the")
    say("paper's table: PSNR, bytes; their means; and the mean of PSNR at equal bytes, along the recipe's own curve of three λ, with its standard error.")
    table("scene,changed,by seed,mean,at equal bytes,verdict,paper")
    n = seeded_runs("recipe")
    for (k = 1; k <= n; k++)
        if (seeded_variant[k] != "recipe")
            recipe_row(seeded_scene[k], seeded_variant[k])
}

function recipe_row(s, v,    j, n, t, u, psnr, rate, sums, text, changed, change) {
    changed = v
    sub(/^recipe_/, "", changed)
    n = seeded_count(s, v)
    for (j = 1; j <= n; j++) {
        t = seeded_tag(s, v, j)
        u = seeded_base(s, v, j)
        if (!has(t) || !has(u)) {
            row_missing(s "|" changed)
            return
        }
        psnr = get(t, "psnr") - get(u, "psnr")
        rate = 100 * (get(t, "bytes") / get(u, "bytes") - 1)
        sums["psnr"] += psnr / n
        sums["rate"] += rate / n
        text = join(text, "; ", signed(psnr, 2, " dB") ", " signed(rate, 1, " %"))
    }
    row(s "|" changed mark_of(seeded_tags(s, v)) "|" text "|" signed(sums["psnr"], 2, " dB") ", " signed(sums["rate"], 1, " %") "|" \
        (seeded_changes(s, v, change) ? mean_text(change) " dB|" seeded_word(change) : "-|-") "|" (changed in paper ? paper[changed] : ""))
}

function recipe_bars(s) {
    recipe_bar(s, "inr", "bank against inr, layers as wide as F_deform's", "bank better", 0)
    recipe_bar(s, "concat", "bank against concat", "bank better", 0)
    recipe_bar(s, "noactive", "no activation", "costs rate or quality", 0)
    recipe_bar(s, "noprogress", "no progressive training", "costs quality", 0)
    recipe_bar(s, "nomotion", "no deformation, activation kept", "far worse (here: at least 1 dB)", 1)
}

# least: how many dB worse the mean has to be.
function recipe_bar(s, changed, what, limit, least,    v, change, measured, ok) {
    v = "recipe_" changed
    if (!in_group(seeded_tag(s, v, 1), "recipe"))
        return
    if (seeded_changes(s, v, change)) {
        measured = "`" own_options(seeded_tag(s, v, 1)) "`: PSNR at equal bytes, " change["n"] " seeds: " change["text"] ", mean " mean_text(change) " dB" \
            mark_of(seeded_tags(s, v))
        ok = seeded_is_worse(change)
        if (ok == 1)
            ok = -change["mean"] >= least
    }
    bar(1, s ", the paper's recipe alone: " what, limit, measured, measured == "" ? "" : ok, sweep("recipe '" s "-recipe-*'"))
}
