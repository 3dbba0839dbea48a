# seeded.awk - differences that are within what seeds make: each variant against its base, seed by seed, at equal bytes, until their mean lies outside its error.
# Used by bench/report.sh. Runs SCENE-VARIANT-2, SCENE-VARIANT_seed2-2, ... of the group "seeded" against the whole method's (seeds.awk), of the group "recipe"
# against SCENE-recipe-2, SCENE-recipe_seed2-2, ... (recipe.awk).
# SPDX-License-Identifier: BSD-2-Clause

# Student's t of which 95 % lie below, for 1 to 9 degrees of freedom.
BEGIN { split("6.31 2.92 2.35 2.13 2.02 1.94 1.89 1.86 1.83", student, " ") }

function seeded_tag(s, v, j) { return s "-" v (j == 1 ? "" : "_seed" j) "-2" }
function is_recipe(v) { return v ~ /^recipe_/ }
function seeded_group(v) { return is_recipe(v) ? "recipe" : "seeded" }
function seeded_base(s, v, j) { return is_recipe(v) ? seeded_tag(s, "recipe", j) : whole_tag(s, j) }

# The runs with a seed 1 of a group: seeded_scene[1..n], seeded_variant[1..n]; n.
function seeded_runs(group,    k, j, n) {
    for (k = 1; k <= n_scenes; k++)
        for (j = 1; j <= n_variants; j++)
            if (variants[j] !~ /_seed/ && in_group(seeded_tag(scenes[k], variants[j], 1), group)) {
                seeded_scene[++n] = scenes[k]
                seeded_variant[n] = variants[j]
            }
    return n + 0
}

# How many seeds of it are wanted, 1, 2, ...
function seeded_count(s, v,    n) {
    while (n < 10 && in_group(seeded_tag(s, v, n + 1), seeded_group(v)))
        n++
    return n + 0
}

# PSNR of run t less that of run u, had both as many bytes: along the curve of the base at seed 1. "" where one is missing or the curve does not reach.
function change_between(t, u,    of_t, of_u) {
    of_t = has(t) ? psnr_change(t) : ""
    of_u = has(u) ? psnr_change(u) : ""
    return of_t == "" || of_u == "" ? "" : of_t - of_u
}

# change[1..n] by seed, ["n"], ["mean"], ["error"] (standard error of the mean), ["text"]; 0 when one is missing, or there is one seed alone.
function seeded_changes(s, v, change,    j, n, sum, square) {
    delete change
    n = seeded_count(s, v)
    against = is_recipe(v) ? "recipe" : "whole"
    for (j = 1; j <= n; j++) {
        change[j] = change_between(seeded_tag(s, v, j), seeded_base(s, v, j))
        if (change[j] == "")
            break
        sum += change[j]
        square += change[j] * change[j]
        change["text"] = join(change["text"], ", ", signed(change[j], 2, ""))
    }
    against = ""
    if (n < 2 || j <= n)
        return 0
    change["n"] = n
    change["mean"] = sum / n
    change["error"] = square * n > sum * sum ? sqrt((square - sum * sum / n) / (n - 1) / n) : 0
    return 1
}

# Whether the mean lies farther from zero than chance puts it once in twenty on that side: 1 worse, 0 better, "?" there is no saying.
function seeded_is_worse(change,    limit) {
    limit = student[change["n"] - 1] * change["error"]
    return change["mean"] < -limit ? 1 : change["mean"] > limit ? 0 : "?"
}
function seeded_word(change,    worse) {
    worse = seeded_is_worse(change)
    return worse == "?" ? "no saying" : worse ? "worse" : "better"
}

function mean_text(change) { return signed(change["mean"], 2, "") " ± " fixed(change["error"], 2) }

# For a bar; "" where it was not run.
function seeded_words(s, v,    change) {
    return seeded_changes(s, v, change) ? "; at " change["n"] " seeds " change["text"] ", mean " mean_text(change) " dB" mark_of(seeded_tags(s, v)) : ""
}

# Of a difference that is within seeds: is the variant worse (1), better (0), or is there no saying ("?")?
function seeded_verdict(s, v,    change) { return seeded_changes(s, v, change) ? seeded_is_worse(change) : "?" }

# All rows that such a difference comes from.
function seeded_tags(s, v,    j, n, tags) {
    tags = tags_of(s, is_recipe(v) ? "recipe" : "whole")
    n = seeded_count(s, v)
    for (j = 1; j <= n; j++)
        tags = tags " " seeded_tag(s, v, j) " " seeded_base(s, v, j)
    return tags
}

function seeded_section(    k, n, s, v, change) {
    say("")
    say("### Small differences over seeds")
    say("")
    say("Variants that differ from the whole method by no more than seeds do, each seed against the whole method at the same seed, λ 0.002: PSNR at equal")
    say("bytes, along the curve of the whole method, mean and its standard error. Negative: the variant is worse. *No saying*: a mean that chance alone makes")
    say("more often than once in twenty (Student's t, one side).")
    table("scene,variant,by seed,mean dB,verdict")
    n = seeded_runs("seeded")
    for (k = 1; k <= n; k++) {
        s = seeded_scene[k]
        v = seeded_variant[k]
        if (seeded_changes(s, v, change))
            row(s "|" v mark_of(seeded_tags(s, v)) "|" change["text"] "|" mean_text(change) "|" seeded_word(change))
        else
            row_missing(s "|" v)
    }
}
