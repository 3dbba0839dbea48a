# bytes.awk - bytes of the whole method's files by syntax element, over λ: bar 5. Used by bench/report.sh.
# SPDX-License-Identifier: BSD-2-Clause

function bytes_section(    k, i, j, n, element, line, t) {
    say("")
    say("## Bytes by syntax element")
    say("")
    say("By `ted4info FILE.ted4 --budget`. *frames*: what frames chunks, tiles and the file.")
    table("run,λ,all,header,entropy networks,networks,bank,positions,masks,feature,scaling,offset,φ,τ,frames")
    n = split("header nete netr bank positions masks feature scaling offset phi tau frame", element, " ")
    for (k = 1; k <= n_curve_scenes; k++)
        for (i = 1; i <= n_runs[curve_scenes[k], "whole"]; i++) {
            t = runs[curve_scenes[k], "whole", i]
            if (!has(t)) {
                row_missing(t "|" lambda[t])
                continue
            }
            line = name_of(t) "|" lambda[t] "|" get(t, "bytes")
            for (j = 1; j <= n; j++)
                line = line "|" get(t, "b_" element[j])
            row(line)
        }
    bytes_chart()
}

# kB of the parts, from the bottom of a column to its top.
function bytes_parts(t,    networks, time, rest) {
    networks = get(t, "b_netr") + get(t, "b_bank")
    time = get(t, "b_phi") / 1000 " " get(t, "b_tau") / 1000
    rest = get(t, "b_header") + get(t, "b_frame")
    return get(t, "b_nete") / 1000 " " networks / 1000 " " get(t, "b_positions") / 1000 " " get(t, "b_masks") / 1000 " " get(t, "b_feature") / 1000 " " \
        get(t, "b_scaling") / 1000 " " get(t, "b_offset") / 1000 " " time " " rest / 1000
}

function bytes_chart(    k, i, s, t, n, list) {
    for (k = 1; k <= n_curve_scenes; k++)
        if (count_runs(curve_scenes[k], "whole") > 0)
            list[++n] = curve_scenes[k]
    if (n > 0) {
        chart_open("bytes", 900, int((n + 1) / 2) * 330 + 8, "Bytes by syntax element over λ")
        stacks_parts("entropy networks|networks, bank|positions|masks|features|scalings|offsets|φ: motion|τ: activation|header, framing")
        for (k = 1; k <= n; k++) {
            s = list[k]
            stacks_begin()
            for (i = 1; i <= n_runs[s, "whole"]; i++) {
                t = runs[s, "whole", i]
                if (has(t))
                    stacks_column(lambda[t], bytes_parts(t))
            }
            stacks_draw((k - 1) % 2 * 370, int((k - 1) / 2) * 330 + 4, 370, 324, s, "λ, weight of the rate", "kB (1000 bytes)", 0)
        }
        stacks_legend(752, 46)
        svg_close()
    }
    show_chart("bytes", "Bytes by syntax element over λ, by scene")
}
