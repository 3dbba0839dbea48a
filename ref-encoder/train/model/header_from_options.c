/* header_from_options.c - makes the header of the file from the training options
 * (header_from_options.h).
 * SPDX-License-Identifier: BSD-2-Clause */
#include "header_from_options.h"

#include <math.h>
#include <string.h>

#include "data/flicker.h"
#include "data/frame_rate.h"
#include "normalise.h"

/* Frames per second, for a scene that does not give its rate. */
enum { UNKNOWN_RATE = 30 };

/* Divides the feature into n slices whose sizes grow like 1, 2, 3, ... (50 channels in four
 * slices: 5, 10, 15, 20), because the early slices are the context of all later ones. */
static void make_slices(ted4_header *h, int n)
{
    const int whole = n * (n + 1) / 2;
    int done = 0;

    h->n_slices = 0;
    for (int i = 1; i <= n; i++) {
        const int upto = (h->feature_dim * i * (i + 1) / 2 + whole / 2) / whole;

        if (upto > done)
            h->slice[h->n_slices++] = (uint8_t)(upto - done);
        done = upto;
    }
}

/* Returns the number of rows of the bank: one per two frames, but at least two, because a single
 * row is the same at all times. */
static uint32_t rows_of(uint32_t frames)
{
    const uint32_t half = (frames + 1) / 2;

    return half < 2 ? 2 : half;
}

static void make_header_time(ted4_header *h, const ted4_train_options *o, const ted4_dataset *d)
{
    const int still = d->n_frames <= 1;

    h->frames = d->n_frames;
    h->rate_num = UNKNOWN_RATE;
    h->rate_den = 1;
    if (d->rate != 0 && ted4_frame_rate(d->rate, &h->rate_num, &h->rate_den) != 0)
        h->rate_num = h->rate_den = 0; /* not valid: ted4_header_wrong reports it */
    h->activation = (uint8_t)(still ? 0 : o->activation);
    h->motion = (uint8_t)(still ? TED4_MOTION_NONE : o->motion);
    if (h->motion == TED4_MOTION_NONE)
        return;
    h->temporal_mask = (uint8_t)o->temporal_mask;
    h->deform_layers = (uint8_t)o->deform_layers;
    h->deform_width = (uint16_t)o->deform_width;
    if (h->motion == TED4_MOTION_INR)
        return;
    h->phi_dim = (uint8_t)o->phi;
    h->bank_rows = o->bank_rows > 0 ? (uint32_t)o->bank_rows : rows_of(d->n_frames);
    h->bank_dim = (uint16_t)o->bank_dim;
}

int ted4_header_settle(ted4_train_options *o, const ted4_dataset *d)
{
    const double flicker = ted4_dataset_flicker(d);

    if (isnan(flicker))
        return -1;
    if (o->bank_rows == 0 && flicker >= TED4_FLICKER_SEEN)
        o->bank_rows = (int)d->n_frames;
    return 0;
}

void ted4_header_stage2(ted4_header *h, const ted4_train_options *o)
{
    const double step[TED4_TYPES] = { o->step_feature, o->step_scaling, o->step_offset, o->step_phi,
                                      o->step_tau };

    h->tile_size = (uint32_t)o->tile;
    h->offset_mask = (uint8_t)o->offset_mask;
    h->prior = o->factorised ? TED4_PRIOR_FACTORISED : TED4_PRIOR_INR;
    h->pe_octaves = (uint8_t)(o->factorised ? 0 : o->octaves);
    h->hyper_layers = (uint8_t)(o->factorised ? 0 : o->hyper_layers);
    h->hyper_width = (uint16_t)(h->hyper_layers > 0 ? o->hyper_width : 0);
    make_slices(h, o->slices);
    h->ar_width = (uint16_t)(h->n_slices > 1 ? o->ar_width : 0);
    h->context_bits = 8;
    for (int y = 0; y < TED4_TYPES; y++)
        h->step[y] = (float)step[y];
}

void ted4_header_make(ted4_header *h, const ted4_train_options *o, const ted4_dataset *d)
{
    memset(h, 0, sizeof *h);
    h->n_offsets = (uint8_t)o->offsets;
    h->feature_dim = (uint8_t)o->feature;
    make_header_time(h, o, d);
    h->view = (uint8_t)o->view;
    h->head_layers = (uint8_t)o->head_layers;
    h->head_width = (uint16_t)(o->head_layers > 0 ? o->head_width : 0);
    h->scale_domain = TED4_SCALE_LOG2;
    ted4_header_stage2(h, o);
    memcpy(h->background, d->background, sizeof h->background);
    ted4_normalise_scene(h, d);
}

void ted4_header_without_motion(ted4_header *h)
{
    h->motion = TED4_MOTION_NONE;
    h->temporal_mask = h->phi_dim = h->deform_layers = 0;
    h->bank_rows = 0;
    h->bank_dim = h->deform_width = 0;
}
