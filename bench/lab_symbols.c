/* lab_symbols.c - counts escapes, and values at the ends of their ranges, in the coded part of a
 * decoded file: see lab_facts.h. The tiles are walked once more with a coder that only counts.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <string.h>
#include "base/bytes.h"
#include "lab_facts.h"
#include "norm/gaussian.h"
#include "norm/scene.h"
#include "read/observe.h"
#include "tool/cli.h"

typedef struct {
    ted4_coder base; /* must be first */
    lab_symbols *count;
} census;

static int bit(ted4_coder *c, uint32_t prob, int value)
{
    (void)c;
    (void)prob;
    return value;
}

static void gauss(ted4_coder *c, size_t n, const int32_t *mu, const uint8_t *sigma, int16_t *k)
{
    lab_symbols *const y = ((census *)c)->count;

    y->symbols += n;
    for (size_t i = 0; i < n; i++) {
        y->escapes += ted4_gauss_of(mu[i], sigma[i], k[i]).escape >= 0;
        y->symbol_ends += k[i] == 32767 || k[i] == -32767;
        y->sigma_ends += sigma[i] == 0 || sigma[i] == TED4_N_SIGMA - 1;
    }
}

/* spec 10.3: the contexts that slices read: all slices except the last one. */
static void count_contexts(const ted4_scene *s, lab_symbols *y)
{
    const ted4_header *const h = &s->head;
    const size_t n = h->n_anchors;
    const unsigned seen = h->feature_dim - h->slice[h->n_slices - 1u];

    for (size_t c = 0; c < seen; c++)
        for (size_t i = 0; i < n; i++) {
            const int16_t x = ted4_context(s->symbol[TED4_FEATURE][c * n + i],
                                           s->step_index[TED4_FEATURE][i], h->context_bits);

            y->context_ends += x == 32767 || x == -32767;
        }
    y->contexts = (uint64_t)seen * n;
}

static void count_steps(const ted4_scene *s, lab_symbols *y)
{
    for (int t = 0; t < TED4_TYPES; t++)
        for (size_t i = 0; s->shape.dim[t] > 0 && i < s->head.n_anchors; i++) {
            y->steps++;
            y->step_ends += s->step_index[t][i] == 0 || s->step_index[t][i] == 255;
        }
}

/* spec 11.4: base-2 logarithms of b_s and b_f at or below this value give the minimum. */
#define LOG2_LEAST_WIDTH -12.0f

static void count_widths(const ted4_scene *s, lab_symbols *y)
{
    const size_t n = s->head.n_anchors;

    for (size_t i = 0; s->shape.dim[TED4_TAU] > 0 && i < n; i++) {
        const float q = s->head.step[TED4_TAU] *
                        ted4_bits_float(ted4_step[s->step_index[TED4_TAU][i]]);

        for (size_t c = 1; c < 4; c += 2) {
            y->widths++;
            y->width_ends += (float)s->symbol[TED4_TAU][c * n + i] * q <= LOG2_LEAST_WIDTH;
        }
    }
}

int lab_count_symbols(const lab_session *s, lab_symbols *y)
{
    ted4_coder_ops ops = ted4_observe_ops;
    ted4_observation it;
    ted4_status verdict = ted4_observe_init(&it, s->scene, NULL);
    census c = { .count = y };

    memset(y, 0, sizeof *y);
    ops.bit = bit;
    ops.gauss = gauss;
    c.base.ops = &ops;
    for (unsigned tile = 0; verdict == TED4_OK && tile < s->scene->shape.n_tiles; tile++) {
        ted4_walk_tile(&c.base, &it.scene, &it.prior, tile, it.work);
        verdict = c.base.error.code;
    }
    ted4_observe_finish(&it);
    if (verdict != TED4_OK)
        return lab_failed("symbols", ted4_status_id(verdict));
    count_contexts(s->scene, y);
    count_steps(s->scene, y);
    count_widths(s->scene, y);
    return TED4_EXIT_FINE;
}
