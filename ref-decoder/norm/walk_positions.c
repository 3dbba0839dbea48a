/* walk_positions.c - spec 8: codes the payload of POSN.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "norm/coder.h"

#include "norm/half.h"

static void judge(ted4_coder *c, const uint16_t *p, size_t at)
{
    for (int j = 0; j < 3; j++) {
        const uint32_t size = p[j] & 0x7fff;

        ted4_require(c, size < 0x7c00 && p[j] != 0x8000, TED4_E_POS_VALUE, at + 2 * (size_t)j);
        ted4_require(c, size <= 0x3c00, TED4_E_POS_RANGE, at + 2 * (size_t)j);
    }
}

/* spec 8 */
void ted4_walk_positions(ted4_coder *c, ted4_scene *s)
{
    const size_t at = c->pos, n = s->head.n_anchors;
    uint64_t before = 0;

    c->ops->array(c, 2, s->position, 3 * (uint64_t)n);
    for (size_t i = 0; c->error.code == TED4_OK && i < n; i++) {
        const uint16_t *p = s->position + 3 * i;
        const uint64_t code = ted4_morton(p);

        judge(c, p, at + 6 * i);
        ted4_require(c, i == 0 || code > before, TED4_E_POS_ORDER, at + 6 * i);
        before = code;
        for (int j = 0; j < 3; j++)
            ted4_trace(c, at + 6 * i + 2 * (size_t)j, "position", (int64_t)(3 * i) + j, p[j]);
    }
}
