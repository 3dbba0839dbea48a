/* heads.c - computes the records of a block from its features (spec 11.4 to 11.6). Results that
 * cannot have changed since the last query are not computed again; plan() in recon.c decides.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "recon/recon.h"

#define LEAST_NORM 0x1p-20f

/* Lists the records of a block: w->from gets their indices into [K][32], w->to their record
 * numbers. Returns their number. */
static size_t list_records(const ted4_recon *r, size_t block, ted4_recon_scratch *w)
{
    const uint32_t *first = r->first + block * TED4_ROW;
    const uint16_t *kept = r->kept + block * TED4_ROW;
    size_t n = 0;

    for (uint32_t j = 0; j < TED4_ROW; j++) {
        uint32_t to = first[j];

        for (uint32_t k = 0; k < r->head.n_offsets; k++)
            if (kept[j] >> k & 1) {
                w->from[n] = k * TED4_ROW + j;
                w->to[n++] = to++;
            }
    }
    return n;
}

/* Copies one channel [K][32] to its n records, and updates w->worst so that values that are not
 * finite are found. */
static void put(ted4_recon_scratch *w, size_t n, const float *value, float *out)
{
    uint32_t worst = w->worst;

    for (size_t i = 0; i < n; i++) {
        const float x = value[w->from[i]];
        const uint32_t size = ted4_float_bits(x) & 0x7fffffffu;

        worst = size > worst ? size : worst;
        out[w->to[i]] = x;
    }
    w->worst = worst;
}

/* n holds squared norms. Replaces each by the divisor: the norm, or 1 if the norm is below
 * LEAST_NORM. none[j] is set to 1 in that case, else to 0. */
static void norm_row(float *n, int32_t *none)
{
    for (int j = 0; j < TED4_ROW; j++)
        n[j] = sqrtf(n[j]);
    for (int j = 0; j < TED4_ROW; j++) {
        none[j] = n[j] < LEAST_NORM;
        n[j] = none[j] ? 1.0f : n[j];
    }
}

/* Computes the view directions of the anchors of a block, three rows (spec 11.5). */
static void view_direction(const ted4_recon_job *q, size_t block, float *dir)
{
    const float *p = ted4_recon_row(q->r, block, q->r->rows.position);
    float n[TED4_ROW];
    int32_t none[TED4_ROW];

    for (int c = 0; c < 3; c++)
        for (int j = 0; j < TED4_ROW; j++)
            dir[c * TED4_ROW + j] = p[c * TED4_ROW + j] - q->camera[c];
    for (int j = 0; j < TED4_ROW; j++) {
        const float x = dir[j], y = dir[TED4_ROW + j], z = dir[2 * TED4_ROW + j];

        n[j] = x * x + y * y + z * z;
    }
    norm_row(n, none);
    for (int c = 0; c < 3; c++)
        for (int j = 0; j < TED4_ROW; j++) {
            const float v = dir[c * TED4_ROW + j] / n[j];

            dir[c * TED4_ROW + j] = none[j] ? (c == 2 ? 1.0f : 0.0f) : v;
        }
}

static void opacity_head(const ted4_recon *r, const float *x, size_t n, ted4_recon_scratch *w)
{
    const size_t size = (size_t)r->head.n_offsets * TED4_ROW;

    ted4_recon_network(r, TED4_NET_OPACITY, x, w, w->y);
    for (size_t i = 0; i < size; i++)
        w->value[i] = ted4_max(0.0f, 2.0f * ted4_sigmoid(2.0f * w->y[i]) - 1.0f);
    put(w, n, w->value, r->opacity);
}

static void colour_head(const ted4_recon *r, const float *x, size_t n, ted4_recon_scratch *w)
{
    const size_t n_offsets = r->head.n_offsets;

    ted4_recon_network(r, TED4_NET_COLOUR, x, w, w->y);
    for (size_t c = 0; c < 3; c++) {
        for (size_t k = 0; k < n_offsets; k++)
            for (size_t j = 0; j < TED4_ROW; j++)
                w->value[k * TED4_ROW + j] = ted4_sigmoid(w->y[(3 * k + c) * TED4_ROW + j]);
        put(w, n, w->value, r->out.colour[c]);
    }
}

/* Normalises the rotations of one offset, rows y[4], to unit quaternions in place. */
static void normalise_rotation(float *y)
{
    float n[TED4_ROW];
    int32_t none[TED4_ROW];

    for (int j = 0; j < TED4_ROW; j++) {
        const float a = y[j], b = y[TED4_ROW + j], c = y[2 * TED4_ROW + j], d = y[3 * TED4_ROW + j];

        n[j] = a * a + b * b + c * c + d * d;
    }
    norm_row(n, none);
    for (int c = 0; c < 4; c++)
        for (int j = 0; j < TED4_ROW; j++) {
            const float v = y[c * TED4_ROW + j] / n[j];

            y[c * TED4_ROW + j] = none[j] ? (c == 0 ? 1.0f : 0.0f) : v;
        }
}

static void covariance_head(const ted4_recon_job *q, size_t block, const float *x, size_t n,
                            ted4_recon_scratch *w)
{
    const ted4_recon *r = q->r;
    const size_t n_offsets = r->head.n_offsets, channel = n_offsets * TED4_ROW;
    const float *size = ted4_recon_row(r, block, r->rows.size);

    ted4_recon_network(r, TED4_NET_COVARIANCE, x, w, w->y);
    for (size_t k = 0; k < n_offsets; k++) {
        float *y = w->y + 7 * k * TED4_ROW;

        for (size_t c = 0; c < 3; c++)
            for (size_t j = 0; j < TED4_ROW; j++)
                w->value[c * channel + k * TED4_ROW + j] =
                    size[c * TED4_ROW + j] * ted4_sigmoid(y[c * TED4_ROW + j]) * q->unit;
        normalise_rotation(y + 3 * TED4_ROW);
        for (size_t c = 3; c < 7; c++)
            memcpy(w->value + c * channel + k * TED4_ROW, y + c * TED4_ROW, TED4_ROW * sizeof *y);
    }
    for (size_t c = 0; c < 3; c++)
        put(w, n, w->value + c * channel, r->out.scale[c]);
    for (size_t c = 0; c < 4; c++)
        put(w, n, w->value + (3 + c) * channel, r->out.rot[c]);
}

/* Computes the means of records from p', given in point (spec 11.6). */
static void place_records(const ted4_recon_job *q, size_t block, const float *point, size_t n,
                          ted4_recon_scratch *w)
{
    const ted4_recon *r = q->r;
    const float *shift = ted4_recon_row(r, block, r->rows.shift);

    for (size_t c = 0; c < 3; c++) {
        for (size_t k = 0; k < r->head.n_offsets; k++)
            for (size_t j = 0; j < TED4_ROW; j++)
                w->value[k * TED4_ROW + j] =
                    r->head.origin[c] +
                    (point[c * TED4_ROW + j] + shift[(3 * k + c) * TED4_ROW + j]) * q->unit;
        put(w, n, w->value, r->out.mean[c]);
    }
}

/* Computes the activation A of spec 11.4, and sets the opacity of the records to opacity times A.
 */
static void activate(const ted4_recon_job *q, size_t block, size_t n, ted4_recon_scratch *w)
{
    const float *tau = ted4_recon_row(q->r, block, q->r->rows.tau);
    const float *a_s = tau, *b_s = tau + TED4_ROW, *a_f = tau + 2 * TED4_ROW,
                *b_f = tau + 3 * TED4_ROW;
    float activation[TED4_ROW];

    for (int j = 0; j < TED4_ROW; j++) {
        const int early = q->t<a_s[j], late = q->t> a_f[j];
        const float a = early ? a_s[j] : a_f[j], b = early ? b_s[j] : b_f[j];
        const float u = (q->t - a) / b;
        const float fading = ted4_pow2(-(u * u) * TED4_LOG2E);

        activation[j] = early | late ? fading : 1.0f;
    }
    for (size_t i = 0; i < n; i++)
        q->r->out.opacity[w->to[i]] = q->r->opacity[w->to[i]] * activation[w->from[i] % TED4_ROW];
}

void ted4_recon_block(const ted4_recon_job *q, size_t block, ted4_recon_scratch *w)
{
    const ted4_recon *r = q->r;
    const int moving = block >= r->n_static_blocks;
    const unsigned todo = q->todo[moving];
    const size_t n_feature = (size_t)r->head.feature_dim * TED4_ROW;
    const float *f = ted4_recon_row(r, block, r->rows.feature);
    const float *point = ted4_recon_row(r, block, r->rows.position);
    const float *moved = w->seen;

    if (todo == 0)
        return;
    const size_t n = list_records(r, block, w);

    memcpy(w->seen, f, n_feature * sizeof *f);
    if (r->head.view != TED4_VIEW_NONE &&
        todo & (TED4_DO_OPACITY | TED4_DO_COLOUR | TED4_DO_COVARIANCE))
        view_direction(q, block, w->seen + n_feature);
    if (todo & TED4_DO_OPACITY)
        opacity_head(r, w->seen, n, w);
    if (todo & TED4_DO_COLOUR)
        colour_head(r, w->seen, n, w);
    if (todo & TED4_DO_ACTIVATION)
        activate(q, block, n, w);
    if (moving && todo & (TED4_DO_MEAN | TED4_DO_COVARIANCE)) {
        ted4_recon_move(r, block, w);
        memcpy(w->moved + n_feature, w->seen + n_feature, 3 * TED4_ROW * sizeof *w->seen);
        moved = w->moved;
        point = w->point;
    }
    if (todo & TED4_DO_COVARIANCE)
        covariance_head(q, block, moved, n, w);
    if (todo & TED4_DO_MEAN)
        place_records(q, block, point, n, w);
}
