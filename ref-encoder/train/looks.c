/* looks.c - what all anchors look like now, one number each: for what is decided about an anchor apart from any one picture. See trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>

#include "space.h"
#include "trainer.h"

/* All anchors at time 0, without activation, from the first training camera. */
static int generate_all(ted4_trainer *t, ted4_splats *s)
{
    ted4_view           v;
    ted4_generate_input in = { &t->layout, t->net, 0, NULL, NULL, NULL, 0, 1, { 0 }, 0 };

    if (ted4_slots_fill(t, NULL) != 0)
        return -1;
    ted4_space_view(&t->layout.head, &t->data->pictures[t->order.item[0]].camera, &v, in.camera);
    in.n_slots = t->slots.n;
    in.attr = t->slots.raw;
    in.position = t->slots.position;
    in.lanes = t->slots.lanes;
    ted4_generator_pack(t->generator, t->net);
    return ted4_generate(t->generator, &in, t->parallel, s) != 0
               ? ted4_trainer_fail(t, "no memory to look at anchors") : 0;
}

int ted4_trainer_looks(ted4_trainer *t, float *opacity, float *rgb)
{
    const size_t K = t->layout.head.n_offsets;
    ted4_splats  s;

    if (generate_all(t, &s) != 0)
        return -1;
    for (size_t i = 0; i < t->anchors.n; i++) {
        float sum = 0, colour[3] = { 0 };

        for (size_t k = 0; k < K; k++) {
            const size_t at = (i / TED4_LANES * K + k) * TED4_LANES + i % TED4_LANES;
            const float  o = fmaxf(s.opacity[at], 0.0f);

            sum += o;
            for (int c = 0; c < 3; c++)
                colour[c] += o * s.colour[c][at];
        }
        opacity[i] = sum;
        for (int c = 0; rgb != NULL && c < 3; c++)
            rgb[3 * i + (size_t)c] = sum > 0 ? colour[c] / sum : 0.0f;
    }
    return 0;
}
