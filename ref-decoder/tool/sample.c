/* sample.c - see sample.h. Colours depend on the direction from the camera to the anchor. For a
 * camera infinitely far away, this direction is the same for all anchors, so a query with a distant
 * camera samples the colour heads of all Gaussians in one direction.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "sample.h"

#include <math.h>
#include <stdlib.h>

#include "record.h"
#include "render/view.h"
#include "sh.h"
#include "widen.h"

/* Distance of that camera in normalised space, where anchors lie in [-1, 1]: directions are exact
 * to about 2^-20. */
#define FAR_AWAY 0x1p20

static const float OPACITY_MIN = 1.0f / 255.0f;

typedef struct {
    const ted4_sampler *sampler;
    ted4_query query;
    const size_t *kept;
    size_t n;
    ted4_status status;
} direction_job;

static int sample_direction(void *user, const double direction[3], float *const colour[3])
{
    direction_job *const j = user;
    const ted4_info *const info = j->sampler->info;
    ted4_gaussians g;

    for (int c = 0; c < 3; c++)
        j->query.camera[c] =
            (float)((double)info->origin[c] - ldexp(FAR_AWAY * direction[c], info->exponent));
    j->status = ted4_recon_query(j->sampler->recon, &j->query, j->sampler->parallel, &g);
    if (j->status != TED4_OK)
        return 1;
    for (int c = 0; c < 3; c++)
        for (size_t i = 0; i < j->n; i++)
            colour[c][i] = g.colour[c][j->kept[i]];
    return 0;
}

static ted4_status fit_colours(const ted4_sampler *s, const ted4_query *q, ted4_sample *out,
                               float *sh)
{
    const ted4_frame *const x = &out->frame;
    direction_job j = { s, *q, out->kept, x->n, TED4_OK };

    if (s->info->view == TED4_VIEW_NONE) {
        ted4_sh_constant(s->sh_degree, x->n, x->colour, sh);
        return TED4_OK;
    }
    switch (ted4_sh_fit(s->sh_degree, x->n, sample_direction, &j, sh, &out->sh_rms)) {
    case 0: return TED4_OK;
    case 1: return j.status;
    default: return TED4_E_LIMIT_MEMORY;
    }
}

/* Copies the columns of the kept records one after another and makes the frame point to them. */
static void copy_kept(ted4_sample *out, const ted4_gaussians *g)
{
    const float *const from[TED4_RECORD_FLOATS] = TED4_RECORD_COLUMNS(g);
    const float **const to[TED4_RECORD_FLOATS] = {
        &out->frame.mean[0],   &out->frame.mean[1],  &out->frame.mean[2], &out->frame.scale[0],
        &out->frame.scale[1],  &out->frame.scale[2], &out->frame.rot[0],  &out->frame.rot[1],
        &out->frame.rot[2],    &out->frame.rot[3],   &out->frame.opacity, &out->frame.colour[0],
        &out->frame.colour[1], &out->frame.colour[2]
    };
    const size_t n = out->frame.n;

    for (size_t k = 0; k < TED4_RECORD_FLOATS; k++) {
        float *const column = out->block + k * n;

        for (size_t i = 0; i < n; i++)
            column[i] = from[k][out->kept[i]];
        *to[k] = column;
    }
}

static ted4_status sample_kept(const ted4_sampler *s, const ted4_query *q, const ted4_gaussians *g,
                               ted4_sample *out)
{
    const size_t sh_floats = s->sh_degree < 0 ? 0 : 3 * (size_t)ted4_sh_count(s->sh_degree);
    const size_t record = (TED4_RECORD_FLOATS + sh_floats) * sizeof *out->block;
    size_t n = 0;

    out->kept = malloc((g->n + 1) * sizeof *out->kept);
    if (out->kept == NULL)
        return TED4_E_LIMIT_MEMORY;
    for (size_t i = 0; i < g->n; i++)
        if (s->keep_all || g->opacity[i] >= OPACITY_MIN)
            out->kept[n++] = i;
    out->frame.n = n;
    out->block = n < SIZE_MAX / record ? malloc((n + 1) * record) : NULL;
    if (out->block == NULL)
        return TED4_E_LIMIT_MEMORY;
    copy_kept(out, g);
    if (s->sh_degree < 0)
        return TED4_OK;
    out->frame.sh_degree = s->sh_degree;
    out->frame.sh = out->block + n * TED4_RECORD_FLOATS;
    return fit_colours(s, q, out, out->block + n * TED4_RECORD_FLOATS);
}

/* Widens what copy_kept has filled. */
static ted4_status widen(const ted4_sampler *s, ted4_sample *out)
{
    const size_t n = out->frame.n;
    const float near_z = (float)ldexp(TED4_VIEW_NEAR, s->info->exponent);
    float *const scale[3] = { out->block + 3 * n, out->block + 4 * n, out->block + 5 * n };

    return ted4_widen(s->widen, near_z, n, out->frame.mean, scale) == 0 ? TED4_OK
                                                                        : TED4_E_LIMIT_MEMORY;
}

/* Turns what copy_kept and fit_colours have filled. */
static void turn(const ted4_turn *t, ted4_sample *out)
{
    const size_t n = out->frame.n;
    float *column[TED4_RECORD_FLOATS];

    for (size_t k = 0; k < TED4_RECORD_FLOATS; k++)
        column[k] = out->block + k * n;
    ted4_turn_shapes(t, n, column, column + 6);
    if (out->frame.sh != NULL)
        ted4_sh_turn(out->frame.sh_degree, t->matrix, n, out->block + n * TED4_RECORD_FLOATS);
}

ted4_status ted4_sample_make(const ted4_sampler *s, uint32_t num, uint32_t den, ted4_sample *out)
{
    const ted4_query q = { num, den, { s->camera[0], s->camera[1], s->camera[2] } };
    ted4_gaussians g;
    ted4_status status = ted4_recon_query(s->recon, &q, s->parallel, &g);

    *out = (ted4_sample) { .frame.comment = "" };
    if (status == TED4_OK)
        status = sample_kept(s, &q, &g, out);
    if (status == TED4_OK && s->widen != NULL)
        status = widen(s, out);
    if (status == TED4_OK && s->turn != NULL)
        turn(s->turn, out);
    if (status != TED4_OK)
        ted4_sample_finish(out);
    return status;
}

void ted4_sample_finish(ted4_sample *s)
{
    free(s->block);
    free(s->kept);
    *s = (ted4_sample) { .frame.comment = "" };
}
