# singles.awk - comparisons of a few runs: medium preset, tinted cameras, scenes without motion: bars 2, 3 and 4. Used by bench/report.sh.
# SPDX-License-Identifier: BSD-2-Clause

function short_table() { table("run,λ,PSNR dB,SSIM,bytes,training s,jobs x threads") }
function short_row(t) {
    if (has(t))
        row(name_of(t) "|" lambda[t] "|" values(t, "psnr:2 ssim:4 bytes train_s:0 team"))
    else
        row_missing(t "|" lambda[t])
}

function medium_section(    t, ok, what, limit) {
    t = "kitchen_full-medium-1"
    what = "kitchen at full size, `--preset medium`, highest rate, two cores"
    limit = "60 minutes; 27 dB (aim 30); 1.5 MB"
    say("")
    say("## Medium preset, every pixel")
    say("")
    say("Time of training steps, probe and checkpoints; without looking at the scene first, previews, and coding.")
    short_table()
    short_row(t)
    if (!has(t)) {
        bar(2, what, limit, "", "", sweep("medium"))
        return
    }
    ok = get(t, "psnr") >= 27 && get(t, "bytes") <= 1.5e6 && get(t, "train_s") <= 3600 && get(t, "jobs") * get(t, "threads") <= 2
    bar(2, what, limit, fixed(get(t, "train_s") / 60, 1) " min of steps by " get(t, "threads") " threads; " fixed(get(t, "psnr"), 2) " dB; " \
        fixed(get(t, "bytes") / 1e6, 2) " MB" mark_of(t) "; what limits it: [notes](#notes)", ok, sweep("medium"))
}

function tint_section(    a, b, c, d, gain, loss, plain) {
    a = "tint-colour-2"; b = "tint-nocolour-2"; c = "tint_by_kitchen-fast-2"; d = "kitchen-fast-2"
    say("")
    say("## Cameras whose colours differ")
    say("")
    say("`kitchen_tint` is `kitchen` with a colour bias per camera, the held-out camera untouched; both at 240x135. Its pictures are JPEG, those of `kitchen` are not, so that")
    say("each scene would be judged by other pictures: *tint_by_kitchen* is trained on `kitchen` and judged, like the others, by the held-out pictures of `kitchen_tint`;")
    say("*kitchen-fast-2* is the same training judged by those of `kitchen`.")
    short_table()
    short_row(a); short_row(b); short_row(c); short_row(d)
    if (has(a) && has(b))
        gain = get(a, "psnr") - get(b, "psnr")
    if (has(a) && has(c))
        loss = get(a, "psnr") - get(c, "psnr")
    if (has(a) && has(d))
        plain = "; each judged by its own held-out pictures " signed(get(a, "psnr") - get(d, "psnr"), 2, " dB") mark_of(a " " d)
    bar(3, "kitchen_tint with colour correction against without", "at least 1 dB better", signed(gain, 2, " dB") mark_of(a " " b), \
        gain == "" ? "" : gain >= 1, sweep("tint"))
    bar(3, "kitchen_tint with colour correction against kitchen, both judged by the held-out pictures of kitchen_tint", "within 0.5 dB", \
        loss == "" ? "" : signed(loss, 2, " dB") mark_of(a " " c) plain, loss == "" ? "" : loss >= -0.5, sweep("tint kitchen-fast-2"))
}

function still_section(    i, n, s, t, u, spent, ratio, said, rates, none, near) {
    say("")
    say("## Scenes in which nothing moves")
    say("")
    say("*static*: the same encoder with time compiled out (`--set motion=0 --set activation=0`). Bytes of the bank, of temporal features φ and")
    say("of activations τ; whether the header announces a temporal mask.")
    table("run,PSNR dB,bytes,bank,φ,τ,temporal mask,against static")
    n = split("still chair", s, " ")
    none = near = ""
    for (i = 1; i <= n; i++) {
        t = s[i] "-whole-2"
        u = s[i] "-static-2"
        still_row(t, u)
        still_row(u, "")
        if (has(t)) {
            spent = get(t, "b_bank") + get(t, "b_phi") + get(t, "b_tau")
            said = join(said, "; ", s[i] ": " spent " bytes" (get(t, "temporal_mask") + 0 ? ", a temporal mask" : "") mark_of(t))
            none = none (get(t, "b_bank") == "" ? "" : spent == 0 && get(t, "temporal_mask") + 0 == 0 ? 1 : 0)
        }
        if (has(t) && has(u)) {
            ratio = 100 * (get(t, "bytes") / get(u, "bytes") - 1)
            rates = join(rates, "; ", s[i] ": " signed(ratio, 2, " %") mark_of(t " " u))
            near = near (size_of(ratio) <= 2 ? 1 : 0)
        }
    }
    none = none ~ /0/ ? 0 : length(none) == n ? 1 : ""
    near = near ~ /0/ ? 0 : length(near) == n ? 1 : ""
    bar(4, "still and chair: bank, temporal feature, activation, temporal mask", "not one byte", said, none, sweep("still"))
    bar(4, "still and chair: rate against time compiled out", "within 2 %", rates, near, sweep("still"))
}

# u: the run to compare with, or "".
function still_row(t, u,    against) {
    if (!has(t)) {
        row_missing(t)
        return
    }
    if (u != "" && has(u))
        against = signed(100 * (get(t, "bytes") / get(u, "bytes") - 1), 2, " %, ") signed(get(t, "psnr") - get(u, "psnr"), 2, " dB")
    row(name_of(t) "|" values(t, "psnr:2 bytes b_bank b_phi b_tau") "|" (get(t, "temporal_mask") + 0 ? "yes" : "no") "|" against)
}
