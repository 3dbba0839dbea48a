/* anchor_appearance.c - evaluates anchors without rendering: see anchor_appearance.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "anchor_appearance.h"

#include <math.h>

#include "visible_blocks.h"

/* Number of training pictures from which anchors are evaluated if opacity depends on the direction.
 */
enum { DIRECTIONS = 8 };

/* Generates the Gaussians of all anchors at time 0, without activation, as seen from the camera of
 * picture item. */
static int generate_all(ted4_trainer *t, uint32_t item, ted4_splats *s)
{
    ted4_view v;
    ted4_generate_input in = { .layout = &t->layout, .net = t->net.value, .den = 1 };

    if (ted4_visible_blocks_fill(t, NULL) != 0)
        return -1;
    ted4_trainer_view(t, &t->data->pictures[item], &v, in.camera);
    ted4_visible_blocks_quantise(t, TED4_QUANT_ROUND);
    in.n_visible = t->visible_blocks.n;
    in.attr = t->visible_blocks.used;
    in.position = t->visible_blocks.position;
    in.lanes = t->visible_blocks.lanes;
    ted4_generator_pack(t->work.generator, t->net.value);
    return ted4_generate(t->work.generator, &in, t->parallel, s) != 0
               ? ted4_trainer_fail(t, "no memory to look at anchors")
               : 0;
}

/* Evaluates all anchors from one picture, and updates those that are more opaque than from the
 * pictures before, or all of them if this is the first picture. */
static int look(ted4_trainer *t, uint32_t item, int first, float *opacity, float *rgb)
{
    const size_t K = t->layout.head.n_offsets;
    ted4_splats s;

    if (generate_all(t, item, &s) != 0)
        return -1;
    for (size_t i = 0; i < t->anchors.n; i++) {
        float sum = 0, colour[3] = { 0 };

        for (size_t k = 0; k < K; k++) {
            const size_t at = (i / TED4_LANES * K + k) * TED4_LANES + i % TED4_LANES;
            const float o = fmaxf(s.opacity[at], 0.0f);

            sum += o;
            for (int c = 0; c < 3; c++)
                colour[c] += o * s.colour[c][at];
        }
        if (!first && !(sum > opacity[i]))
            continue;
        opacity[i] = sum;
        for (int c = 0; rgb != NULL && c < 3; c++)
            rgb[3 * i + (size_t)c] = sum > 0 ? colour[c] / sum : 0.0f;
    }
    return 0;
}

int ted4_anchor_appearance(ted4_trainer *t, float *opacity, float *rgb)
{
    const size_t most = t->layout.head.view == TED4_VIEW_FULL ? DIRECTIONS : 1;
    const size_t n = t->order.n < most ? t->order.n : most;

    for (size_t i = 0; i < n; i++)
        if (look(t, t->order.item[i * t->order.n / n], i == 0, opacity, rgb) != 0)
            return -1;
    return 0;
}
