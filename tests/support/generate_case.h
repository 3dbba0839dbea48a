/* generate_case.h - random scenes for test_generate.c and test_generate_grad.c: a header, networks,
 * and blocks of anchors that include edge cases, in the binary32 that the generator reads and in
 * the double precision that the reference reads. Unused lanes hold NaN.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_GENERATE_CASE_H
#define TED4_GENERATE_CASE_H

#include <stdlib.h>

#include "generate_ref.h"
#include "random_source.h"
#include "train/model/model.h"
#include "train/splat/generator.h"

/* There are more visible blocks than the generator has chunks. In the first block all lanes are
 * used, in another none. */
enum {
    CASE_BLOCKS = 18,
    CASE_CHANNELS = 48,
    CASE_NET = 6000,
    CASE_OFFSETS = 3,
    CASE_SPLATS = CASE_BLOCKS * CASE_OFFSETS * TED4_LANES
};

typedef struct {
    ted4_layout layout;
    ted4_generate_input in;
    ref_query query;
    float net[CASE_NET];
    double exact_net[CASE_NET];
    _Alignas(64) float attr[CASE_BLOCKS][CASE_CHANNELS * TED4_LANES];
    _Alignas(64) float position[CASE_BLOCKS][3 * TED4_LANES];
    const float *attr_list[CASE_BLOCKS], *position_list[CASE_BLOCKS];
    uint32_t lanes[CASE_BLOCKS];
    random_source random;
} test_case;

/* Uniform in [-1, 1). */
static inline float case_random(test_case *t)
{
    return random_float(&t->random, -1, 1);
}

/* The header from which most tests start. */
static inline ted4_header case_header(int motion, int view)
{
    ted4_header h;

    memset(&h, 0, sizeof h);
    h.n_anchors = CASE_BLOCKS * TED4_LANES;
    h.tile_size = 64;
    h.n_offsets = CASE_OFFSETS;
    h.feature_dim = 5;
    h.n_slices = 1;
    h.slice[0] = 5;
    h.motion = (uint8_t)motion;
    if (motion == TED4_MOTION_BANK || motion == TED4_MOTION_CONCAT) {
        h.phi_dim = 3;
        h.bank_rows = 5;
        h.bank_dim = 6;
    }
    if (motion != TED4_MOTION_NONE) {
        h.deform_layers = 2;
        h.deform_width = 7;
        h.temporal_mask = 1;
    }
    h.offset_mask = 1;
    h.activation = 1;
    h.view = (uint8_t)view;
    h.head_layers = 1;
    h.head_width = 9;
    h.frames = 9;
    return h;
}

static inline void case_set(test_case *t, int lane, int channel, float value)
{
    t->attr[0][channel * TED4_LANES + lane] = value;
}

/* Sets anchors of visible block 0 to edge cases of the definitions. time: that of the query. */
static inline void case_awkward(test_case *t)
{
    const ref_channels at = ref_channels_of(&t->layout.head);
    const float time = (float)t->in.num / (float)t->in.den;

    if (t->layout.head.activation)
        for (int lane = 0; lane < 8; lane++) {
            /* Times before, just before and at the start; inside; at, just after and after the end;
             * and with an edge at its lower limit. */
            static const float start[] = { 0.4f, 1e-4f, 0, -0.3f, -0.5f, -0.5f, -0.9f, 0x1p-13f };
            static const float end[] = { 0.6f, 0.5f, 0.1f, 0.2f, 0, -1e-4f, -0.3f, 0.5f };

            case_set(t, lane, at.tau, time + start[lane]);
            case_set(t, lane, at.tau + 1, lane == 7 ? -14.0f : -1.0f);
            case_set(t, lane, at.tau + 2, time + end[lane]);
            case_set(t, lane, at.tau + 3, -0.5f);
        }
    for (int c = 0; c < 6; c++) {
        case_set(t, 8, at.scaling + c, t->layout.head.scale_domain ? -0.5f : -30.0f);
        case_set(t, 9, at.scaling + c, t->layout.head.scale_domain ? 0x1p-21f : -8.0f);
    }
    for (int k = 0; k < CASE_OFFSETS; k++) {
        case_set(t, 10, at.offset_logit + k, -5.0f);
        case_set(t, 11, at.offset_logit + k, -4.5f);
        case_set(t, 12, at.offset_logit + k, 12.0f);
    }
    case_set(t, 13, at.temporal_logit, -20.0f);
    case_set(t, 14, at.temporal_logit, -4.7f);
    case_set(t, 15, at.temporal_logit, -4.4f);
}

static inline void case_anchor(test_case *t, int visible, int lane)
{
    const ref_channels at = ref_channels_of(&t->layout.head);
    float *a = t->attr[visible] + lane;

    for (int c = 0; c < at.n; c++)
        a[c * TED4_LANES] = case_random(t);
    for (int c = 0; c < 6; c++)
        a[(at.scaling + c) * TED4_LANES] += t->layout.head.scale_domain ? 1.5f : -1.0f;
    if (t->layout.head.activation)
        a[(at.tau + 2) * TED4_LANES] += a[at.tau * TED4_LANES] + 1.0f;
    for (int c = at.offset_logit; c < at.n; c++)
        a[c * TED4_LANES] *= 7.0f;
    for (int c = 0; c < 3; c++)
        t->position[visible][c * TED4_LANES + lane] = rintf(case_random(t) * 1024.0f) / 1024.0f;
}

/* Fills *t: time num / den, with anchors and networks drawn from the seed. */
static inline void case_make(test_case *t, const ted4_header *h, uint32_t num, uint32_t den,
                             uint32_t seed)
{
    size_t n_used;

    memset(t, 0, sizeof *t);
    t->random = random_seed(seed);
    ted4_layout_make(&t->layout, h);
    n_used = t->layout.nete;
    for (size_t i = 0; i < n_used; i++)
        t->exact_net[i] = t->net[i] = 0.7f * case_random(t);
    t->in = (ted4_generate_input) {
        .layout = &t->layout,
        .net = t->net,
        .n_visible = CASE_BLOCKS,
        .attr = t->attr_list,
        .position = t->position_list,
        .lanes = t->lanes,
        .num = num,
        .den = den,
        .camera = { 0.25f, -0.5f, 2.0f },
        .activation = 1,
    };
    for (int i = 0; i < CASE_BLOCKS; i++) {
        t->attr_list[i] = t->attr[i];
        t->position_list[i] = t->position[i];
        t->lanes[i] = i == 0 ? 0xffffffffu : i == 5 ? 0 : 0x9e3779b9u * (uint32_t)i >> (i & 3);
        for (int lane = 0; lane < TED4_LANES; lane++)
            case_anchor(t, i, lane);
    }
    case_awkward(t);
    for (int i = 0; i < CASE_BLOCKS; i++)
        for (int lane = 0; lane < TED4_LANES; lane++)
            if ((t->lanes[i] >> lane & 1) == 0) {
                for (int c = 0; c < t->layout.n_channels; c++)
                    t->attr[i][c * TED4_LANES + lane] = NAN;
                for (int c = 0; c < 3; c++)
                    t->position[i][c * TED4_LANES + lane] = NAN;
            }
    /* Put one anchor at the camera's position. */
    for (int c = 0; c < 3; c++)
        t->position[0][c * TED4_LANES + 16] = t->in.camera[c];
    t->query = (ref_query) { *h, num, den, { 0 }, 1, t->exact_net, t->layout.bank };
    for (int c = 0; c < 3; c++)
        t->query.camera[c] = t->in.camera[c];
}

static inline void case_channels(const test_case *t, int visible, int lane, double *channel,
                                 double *position)
{
    for (int c = 0; c < t->layout.n_channels; c++)
        channel[c] = t->attr[visible][c * TED4_LANES + lane];
    for (int c = 0; c < 3; c++)
        position[c] = t->position[visible][c * TED4_LANES + lane];
}

/* Returns array c of the splats, in the reference's order. */
static inline const float *case_member(const ted4_splats *s, int c)
{
    return c < 3     ? s->mean[c]
           : c < 6   ? s->scale[c - 3]
           : c < 10  ? s->rot[c - 6]
           : c == 10 ? s->opacity
                     : s->colour[c - 11];
}

#endif
