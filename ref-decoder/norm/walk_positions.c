/* walk_positions.c - spec 8: codes the payload of POSN.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "norm/coder.h"

#include "norm/half.h"
#include "norm/octree.h"

/* The byte offset of coordinate j is at + j step; step is 0 if one substream holds them all. */
static void judge(ted4_coder *c, const uint16_t *p, size_t at, size_t step)
{
    for (size_t j = 0; j < 3; j++) {
        const uint32_t size = p[j] & 0x7fff;

        ted4_require(c, size < 0x7c00 && p[j] != 0x8000, TED4_E_POS_VALUE, at + j * step);
        ted4_require(c, size <= 0x3c00, TED4_E_POS_RANGE, at + j * step);
    }
}

/* spec 8.2 */
static void walk_tree(ted4_coder *c, ted4_scene *s)
{
    const size_t n = s->head.n_anchors;
    size_t at = c->pos;

    s->grid = (uint8_t)ted4_code(c, "grid", 0, 1, s->grid);
    ted4_require(c, ted4_grid_exists(s->grid), TED4_E_POS_GRID, at);
    at = c->pos;
    c->ops->rest(c, n);
    c->ops->open(c, 1);
    ted4_trace(c, at, "tree_substream", 0, (int64_t)n);
    if (c->error.code != TED4_OK)
        return;
    if (!ted4_octree_walk(c, s->grid, n, s->position))
        ted4_fail(&c->error, TED4_E_POS_COUNT, at);
    c->ops->close(c);
    for (size_t i = 0; i < n && c->error.code == TED4_OK; i++)
        judge(c, s->position + 3 * i, at, 0);
}

/* spec 8.1 */
static void walk_array(ted4_coder *c, ted4_scene *s)
{
    const size_t at = c->pos, n = s->head.n_anchors;
    uint64_t before = 0;

    c->ops->array(c, 2, s->position, 3 * (uint64_t)n);
    for (size_t i = 0; c->error.code == TED4_OK && i < n; i++) {
        const uint16_t *p = s->position + 3 * i;
        const uint64_t code = ted4_morton(p);

        judge(c, p, at + 6 * i, 2);
        ted4_require(c, i == 0 || code > before, TED4_E_POS_ORDER, at + 6 * i);
        before = code;
        for (int j = 0; j < 3; j++)
            ted4_trace(c, at + 6 * i + 2 * (size_t)j, "position", (int64_t)(3 * i) + j, p[j]);
    }
}

/* spec 8 */
void ted4_walk_positions(ted4_coder *c, ted4_scene *s)
{
    if (s->profile == TED4_PROFILE_COMPACT)
        walk_tree(c, s);
    else
        walk_array(c, s);
}
