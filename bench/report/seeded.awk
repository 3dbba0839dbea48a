# seeded.awk - variants that differ from the whole method by no more than seeds do, at three seeds each: is there a difference? Used by bench/report.sh.
# Runs SCENE-VARIANT-2, SCENE-VARIANT_seed2-2 and SCENE-VARIANT_seed3-2 of the group "seeded", against those of seeds.awk.
# SPDX-License-Identifier: BSD-2-Clause

function seeded_tag(s, v, j) { return s "-" v (j == 1 ? "" : "_seed" j) "-2" }

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

# PSNR of run t less that of run u, had both as many bytes: along the curve of the whole method. "" where one is missing or the curve does not reach.
function change_between(t, u,    of_t, of_u) {
    of_t = has(t) ? psnr_change(t) : ""
    of_u = has(u) ? psnr_change(u) : ""
    return of_t == "" || of_u == "" ? "" : of_t - of_u
}

# change[1..3] by seed, change["mean"], change["text"]; 0 when one is missing.
function seeded_changes(s, v, change,    j, sum) {
    delete change
    for (j = 1; j <= n_seeds; j++) {
        change[j] = change_between(seeded_tag(s, v, j), whole_tag(s, j))
        if (change[j] == "")
            return 0
        sum += change[j]
        change["text"] = join(change["text"], ", ", signed(change[j], 2, ""))
    }
    change["mean"] = sum / n_seeds
    return 1
}

# The same sign at every seed?
function seeded_word(change) {
    if (change[1] < 0 && change[2] < 0 && change[3] < 0)
        return "worse at every seed"
    return change[1] > 0 && change[2] > 0 && change[3] > 0 ? "better at every seed" : "changes sign with the seed"
}

# For a bar; "" where it was not run.
function seeded_words(s, v,    change) {
    return seeded_changes(s, v, change) ? "; at three seeds " change["text"] " dB" mark_of(seeded_tags(s, v)) : ""
}

# Of a difference that is within seeds: is the variant worse at every seed (1), better at every seed (0), or is there no saying ("?")?
function seeded_verdict(s, v,    change) {
    if (!seeded_changes(s, v, change))
        return "?"
    return seeded_word(change) ~ /^worse/ ? 1 : seeded_word(change) ~ /^better/ ? 0 : "?"
}

# All rows that such a difference comes from.
function seeded_tags(s, v,    j, tags) {
    tags = tags_of(s, "whole")
    for (j = 1; j <= n_seeds; j++)
        tags = tags " " seeded_tag(s, v, j) " " whole_tag(s, j)
    return tags
}

function seeded_section(    k, n, s, v, change) {
    say("")
    say("### Small differences at three seeds")
    say("")
    say("Variants that differ from the whole method by no more than seeds do, each seed against the whole method at the same seed, λ 0.002: PSNR at equal")
    say("bytes, along the curve of the whole method. Negative: the variant is worse.")
    table("scene,variant,seed 1,seed 2,seed 3,mean dB,verdict")
    n = seeded_runs("seeded")
    for (k = 1; k <= n; k++) {
        s = seeded_scene[k]
        v = seeded_variant[k]
        if (seeded_changes(s, v, change))
            row(s "|" v mark_of(seeded_tags(s, v)) "|" signed(change[1], 2, "") "|" signed(change[2], 2, "") "|" signed(change[3], 2, "") "|" \
                signed(change["mean"], 2, "") "|" seeded_word(change))
        else
            row_missing(s "|" v)
    }
}
