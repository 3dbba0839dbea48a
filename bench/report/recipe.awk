# recipe.awk - the paper's recipe alone with one thing changed, at three seeds each: what that part of the method is worth where nothing that the paper does
# not have does its work. Used by bench/report.sh. Runs SCENE-recipe_VARIANT-2, SCENE-recipe_VARIANT_seed2-2, ... of the group "recipe", against SCENE-recipe-2, ...
# SPDX-License-Identifier: BSD-2-Clause

function recipe_section(    k, n) {
    say("")
    say("### The paper's recipe alone")
    say("")
    say("The same comparison without what the paper does not have: no sprouts, transients or probe. Each seed against the recipe at the same seed and λ, as in the")
    say("paper's table: PSNR, bytes. *Mean*: of the three.")
    table("scene,changed,seed 1,seed 2,seed 3,mean,paper")
    n = seeded_runs("recipe")
    for (k = 1; k <= n; k++)
        if (seeded_variant[k] != "recipe")
            recipe_row(seeded_scene[k], seeded_variant[k])
}

function recipe_row(s, v,    j, t, u, psnr, rate, sums, text, changed, tags) {
    changed = v
    sub(/^recipe_/, "", changed)
    for (j = 1; j <= n_seeds; j++) {
        t = seeded_tag(s, v, j)
        u = seeded_tag(s, "recipe", j)
        tags = tags " " t " " u
        if (!has(t) || !has(u)) {
            row_missing(s "|" changed)
            return
        }
        psnr = get(t, "psnr") - get(u, "psnr")
        rate = 100 * (get(t, "bytes") / get(u, "bytes") - 1)
        sums["psnr"] += psnr / n_seeds
        sums["rate"] += rate / n_seeds
        text = text "|" signed(psnr, 2, " dB") ", " signed(rate, 1, " %")
    }
    row(s "|" changed mark_of(tags) text "|" signed(sums["psnr"], 2, " dB") ", " signed(sums["rate"], 1, " %") "|" (changed in paper ? paper[changed] : ""))
}
