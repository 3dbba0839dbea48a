/* load.c - converts the integers of a scene to blocks of binary32 rows, once for all queries
 * (spec 10.4, 11.1).
 * SPDX-License-Identifier: BSD-2-Clause */
#include "norm/half.h"
#include "norm/tables.h"
#include "recon/recon.h"

typedef struct {
    ted4_recon *r;
    const struct ted4_scene *s;
} load_job;

int ted4_recon_moves(const struct ted4_scene *s, size_t i)
{
    if (s->head.motion == TED4_MOTION_NONE)
        return 0;
    return !s->head.temporal_mask || s->dynamic[i] != 0;
}

void ted4_recon_load_lanes(ted4_recon *r, const struct ted4_scene *s)
{
    size_t next[2] = { 0, r->n_static_blocks * TED4_ROW };
    uint32_t record = 0;

    for (uint32_t i = 0; i < r->head.n_anchors; i++) {
        const size_t lane = next[ted4_recon_moves(s, i)]++;

        r->anchor[lane] = i;
        r->first[lane] = record;
        for (uint32_t k = 0; k < r->head.n_offsets; k++)
            if (s->offset_bits[i] >> k & 1) {
                r->kept[lane] |= (uint16_t)(1u << k);
                r->out.id[record++] = i * r->head.n_offsets + k;
            }
    }
}

/* Writes the values of components first to first + n - 1 of a type, for the 32 lanes of a block, to
 * row and the rows behind it. */
static void load_type(const load_job *l, size_t block, ted4_type type, unsigned first, unsigned n,
                      float *row)
{
    const struct ted4_scene *s = l->s;
    const uint32_t *anchor = l->r->anchor + block * TED4_ROW;

    for (size_t j = 0; j < TED4_ROW; j++) {
        const size_t i = anchor[j];
        const float q = s->head.step[type] * ted4_bits_float(ted4_step[s->step_index[type][i]]);

        for (size_t c = 0; c < n; c++)
            row[c * TED4_ROW + j] = (float)s->symbol[type][(first + c) * s->head.n_anchors + i] * q;
    }
}

/* Computes S from l (spec 11.1) in place, for n rows. */
static void scale_rows(const ted4_recon *r, float *row, size_t n)
{
    for (size_t i = 0; i < n * TED4_ROW; i++)
        row[i] = r->head.scale_domain == TED4_SCALE_LOG2 ? ted4_pow2(row[i])
                                                         : ted4_max(row[i], 0x1p-20f);
}

static void load_tau(const load_job *l, size_t block)
{
    float *tau = ted4_recon_row(l->r, block, l->r->rows.tau);

    load_type(l, block, TED4_TAU, 0, 4, tau);
    for (int c = 1; c < 4; c += 2)
        for (int j = 0; j < TED4_ROW; j++)
            tau[c * TED4_ROW + j] = ted4_max(ted4_pow2(tau[c * TED4_ROW + j]), 0x1p-12f);
}

/* Writes the rows of an anchor that F_deform reads: phi, or E(p). */
static void load_motion(const load_job *l, size_t block)
{
    const ted4_recon *r = l->r;
    const unsigned n = r->n_motion_rows;
    float *row = r->motion + (block - r->n_static_blocks) * n * TED4_ROW;

    if (r->head.motion != TED4_MOTION_INR) {
        load_type(l, block, TED4_PHI, 0, n, row);
        return;
    }
    for (size_t j = 0; j < TED4_ROW; j++) {
        const uint16_t *p = l->s->position + 3 * (size_t)r->anchor[block * TED4_ROW + j];
        float code[TED4_POINT_INPUTS];
        int32_t x[3];

        for (int c = 0; c < 3; c++)
            x[c] = ted4_half_q24(p[c]);
        ted4_recon_encode(x, 3, code);
        for (size_t c = 0; c < TED4_POINT_INPUTS; c++)
            row[c * TED4_ROW + j] = code[c];
    }
}

static void load_block(void *arg, size_t block)
{
    const load_job *l = arg;
    const ted4_recon *r = l->r;
    float *position = ted4_recon_row(r, block, r->rows.position);
    float *shift = ted4_recon_row(r, block, r->rows.shift);
    float size[3 * TED4_ROW];

    for (size_t j = 0; j < TED4_ROW; j++)
        for (size_t c = 0; c < 3; c++)
            position[c * TED4_ROW + j] =
                ted4_half_to_float(l->s->position[3 * (size_t)r->anchor[block * TED4_ROW + j] + c]);
    load_type(l, block, TED4_FEATURE, 0, r->head.feature_dim,
              ted4_recon_row(r, block, r->rows.feature));
    load_type(l, block, TED4_SCALING, 0, 3, size);
    scale_rows(r, size, 3);
    load_type(l, block, TED4_OFFSET, 0, 3u * r->head.n_offsets, shift);
    for (size_t k = 0; k < r->head.n_offsets; k++)
        for (size_t i = 0; i < 3 * TED4_ROW; i++)
            shift[k * 3 * TED4_ROW + i] *= size[i];
    load_type(l, block, TED4_SCALING, 3, 3, ted4_recon_row(r, block, r->rows.size));
    scale_rows(r, ted4_recon_row(r, block, r->rows.size), 3);
    if (r->head.activation)
        load_tau(l, block);
    if (block >= r->n_static_blocks)
        load_motion(l, block);
}

void ted4_recon_load_blocks(ted4_recon *r, const struct ted4_scene *s, const ted4_parallel *p)
{
    load_job l = { r, s };

    ted4_parallel_for(p, r->n_blocks, load_block, &l);
}
