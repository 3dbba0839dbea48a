/* export_scene.c - converts a trained model to a scene: see export_scene.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "export_scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/bytes.h"
#include "norm/half.h"
#include "norm/scene.h"
#include "norm/tables.h"
#include "choose_spans.h"
#include "settle_positions.h"
#include "stages.h"
#include "train/state/anchor_masks.h"
#include "write/encode.h"

static int16_t round_symbol(float value, float q)
{
    const float k = rintf(value / q);

    return (int16_t)(k > 32767.0f ? 32767.0f : k < -32767.0f ? -32767.0f : k);
}

static float step_of(const ted4_scene *s, int type, size_t i)
{
    return s->head.step[type] * ted4_bits_float(ted4_step[s->step_index[type][i]]);
}

/* Returns whether component c of a type is coded for anchor i (spec 10.2). */
static int is_coded(const ted4_scene *s, int type, unsigned c, size_t i)
{
    if (type == TED4_OFFSET)
        return s->offset_bits[i] >> (c / 3) & 1;
    if (type == TED4_PHI)
        return s->dynamic[i];
    return 1;
}

static void fill_symbols(const ted4_trainer *t, const uint32_t *keep, ted4_scene *s)
{
    const size_t n = s->head.n_anchors;

    for (int y = 0; y < TED4_TYPES; y++)
        for (unsigned c = 0; c < s->shape.dim[y]; c++)
            for (size_t i = 0; i < n; i++)
                s->symbol[y][c * n + i] =
                    (int16_t)(is_coded(s, y, c, i)
                                  ? round_symbol(*ted4_anchor_value(&t->anchors, TED4_ROW_VALUE,
                                                                    keep[i],
                                                                    t->layout.first[y] + (int)c),
                                                 step_of(s, y, i))
                                  : 0);
    /* R-ATT-001: the end must not be before the start. */
    for (size_t i = 0; s->shape.dim[TED4_TAU] > 0 && i < n; i++)
        if (s->symbol[TED4_TAU][2 * n + i] < s->symbol[TED4_TAU][i])
            s->symbol[TED4_TAU][2 * n + i] = s->symbol[TED4_TAU][i];
}

static void fill_masks(const ted4_trainer *t, const uint32_t *keep, ted4_scene *s)
{
    for (size_t i = 0; i < s->head.n_anchors; i++) {
        for (int j = 0; j < 3; j++)
            s->position[3 * i + (size_t)j] =
                ted4_float_to_half(*ted4_anchor_value(&t->anchors, TED4_ROW_POSITION, keep[i], j));
        s->dynamic[i] = (uint8_t)ted4_is_dynamic(t, keep[i]);
        s->offset_bits[i] = ted4_offset_bits(t, keep[i]);
    }
}

/* Copies weights; one that the format forbids (R-CNV-001) becomes the nearest one that it allows.
 */
static void copy_values(ted4_blob *to, const float *from)
{
    for (size_t i = 0; i < to->n; i++)
        to->values[i] = fabsf(from[i]) < 0x1p-126f ? 0.0f : from[i];
}

/* An anchor and its place in the file. */
typedef struct {
    uint64_t key;
    uint32_t anchor;
} placed;

static int compare_placed(const void *x, const void *y)
{
    const placed *a = x, *b = y;

    return a->key != b->key ? (a->key < b->key ? -1 : 1)
                            : (a->anchor > b->anchor) - (a->anchor < b->anchor);
}

/* Lists the anchors of the file, keep[*n], in its order (spec 8). Returns 0, or -1 if memory ran
 * out. */
static int keep_anchors(const ted4_trainer *t, uint32_t *keep, size_t *n)
{
    placed *p = malloc((t->anchors.n + 1) * sizeof *p);

    *n = 0;
    if (p == NULL)
        return -1;
    for (size_t i = 0; i < t->anchors.n; i++)
        if (ted4_offset_bits(t, i) != 0)
            p[(*n)++] = (placed) { ted4_position_key(t, i), (uint32_t)i };
    qsort(p, *n, sizeof *p, compare_placed);
    for (size_t i = 0; i < *n; i++)
        keep[i] = p[i].anchor;
    free(p);
    return 0;
}

/* Enters the integer stage if necessary, and stage 2 before it, even if that has no steps. Then
 * chooses spans, if the encoder decides what pays. */
static int settle(ted4_trainer *t)
{
    if (!t->phase.stage2 && ted4_stage2_begin(t) != 0)
        return -1;
    if (!t->phase.integer && ted4_integer_begin(t) != 0)
        return -1;
    return t->opt.capacity ? ted4_choose_spans(t) : 0;
}

/* R-ENC-004: a mask all of whose bits are 1 is not coded. */
static void drop_constant_masks(ted4_scene *s)
{
    const uint16_t all = (uint16_t)((1u << s->head.n_offsets) - 1);
    int still = 0, dropped = 0;

    for (size_t i = 0; i < s->head.n_anchors; i++) {
        still |= !s->dynamic[i];
        dropped |= s->offset_bits[i] != all;
    }
    s->head.temporal_mask &= (uint8_t)still;
    s->head.offset_mask &= (uint8_t)dropped;
    ted4_shape_make(&s->shape, &s->head);
}

int ted4_export_scene(ted4_trainer *t, ted4_scene **scene)
{
    ted4_header h;
    ted4_error e = { TED4_OK, 0 };
    uint32_t *keep;
    size_t n;

    *scene = NULL;
    t->is_empty = 0;
    if (ted4_trainer_check(t, 1) != 0 || settle(t) != 0)
        return -1;
    keep = malloc((t->anchors.n + 1) * sizeof *keep);
    if (keep == NULL || keep_anchors(t, keep, &n) != 0) {
        free(keep);
        return ted4_trainer_fail(t, "no memory to export");
    }
    h = t->layout.head;
    h.n_anchors = (uint32_t)n;
    t->is_empty = n == 0;
    if (t->is_empty || (*scene = ted4_scene_new(&h, NULL)) == NULL) {
        free(keep);
        return t->is_empty ? ted4_trainer_fail(t,
                                               "nothing is left to encode: at lambda %g, every "
                                               "Gaussian costs more than it contributes",
                                               t->opt.lambda)
                           : ted4_trainer_fail(t, "no memory to export");
    }

    ted4_scene *s = *scene;

    s->profile = (uint8_t)t->opt.profile;
    memcpy(s->shift, t->net.shift, s->shape.n_units);
    copy_values(&s->netr, t->net.value + t->layout.netr);
    copy_values(&s->bank, t->net.value + t->layout.bank);
    copy_values(&s->nete, t->net.value + t->layout.nete);
    fill_masks(t, keep, s);
    drop_constant_masks(s);
    if (ted4_scene_steps(s, t->parallel, &e) != TED4_OK) {
        ted4_scene_free(s);
        *scene = NULL;
        free(keep);
        return ted4_trainer_fail(t, "prior refused: %s", ted4_status_id(e.code));
    }
    fill_symbols(t, keep, s);
    free(keep);
    return 0;
}
