/* build_header.c - `set NAME VALUE...`: builds the header of a scene (spec 6.1).
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stddef.h>
#include <string.h>
#include "build.h"

typedef struct {
    const char *name;
    size_t offset, width;
} field;

#define FIELD(name)                                                        \
    {                                                                      \
#name, offsetof(ted4_header, name), sizeof((ted4_header *)0)->name \
    }

static const field fields[] = { FIELD(n_anchors),    FIELD(tile_size),     FIELD(n_offsets),
                                FIELD(feature_dim),  FIELD(motion),        FIELD(phi_dim),
                                FIELD(bank_rows),    FIELD(bank_dim),      FIELD(deform_layers),
                                FIELD(deform_width), FIELD(temporal_mask), FIELD(offset_mask),
                                FIELD(activation),   FIELD(view),          FIELD(head_layers),
                                FIELD(head_width),   FIELD(scale_domain),  FIELD(prior),
                                FIELD(pe_octaves),   FIELD(hyper_layers),  FIELD(hyper_width),
                                FIELD(ar_width),     FIELD(context_bits),  FIELD(frames),
                                FIELD(rate_num),     FIELD(rate_den),      FIELD(exponent) };

/* The smallest valid header: no motion, no masks, one slice, no view dependence. */
static void smallest(ted4_header *h)
{
    memset(h, 0, sizeof *h);
    h->n_anchors = 6;
    h->tile_size = 64;
    h->n_offsets = 2;
    h->feature_dim = 3;
    h->prior = TED4_PRIOR_FACTORISED;
    h->n_slices = 1;
    h->slice[0] = 3;
    h->context_bits = 8;
    for (int t = 0; t < TED4_TYPES; t++)
        h->step[t] = 0.125f;
    h->frames = 4;
    h->rate_num = 30;
    h->rate_den = 1;
}

static void store(void *to, size_t width, long long v)
{
    if (width == 1)
        *(uint8_t *)to = (uint8_t)v;
    else if (width == 2)
        *(uint16_t *)to = (uint16_t)v;
    else
        *(uint32_t *)to = (uint32_t)v;
}

/* set slices 2 3: also sets the number of slices and the dimension of the feature. */
static void set_slices(ted4_header *h, const conf_line *l)
{
    unsigned sum = 0;

    h->n_slices = (uint8_t)(l->n - 2);
    for (int i = 2; i < l->n && i < 2 + TED4_MAX_SLICES; i++) {
        h->slice[i - 2] = (uint8_t)conf_line_number(l, i, 1, TED4_MAX_FEATURE);
        sum += h->slice[i - 2];
    }
    h->feature_dim = (uint8_t)sum;
    if (h->n_slices > 1 && h->ar_width == 0)
        h->ar_width = 3;
}

/* set slices_of_one N */
static void set_many_slices(ted4_header *h, const conf_line *l)
{
    h->n_slices = h->feature_dim = (uint8_t)conf_line_number(l, 2, 1, TED4_MAX_SLICES);
    memset(h->slice, 1, h->n_slices);
    h->ar_width = h->n_slices > 1 ? 3 : 0;
}

static void set_step(ted4_header *h, const conf_line *l)
{
    if (l->n == 3)
        for (int t = 0; t < TED4_TYPES; t++)
            h->step[t] = conf_word_float(l, 2);
    else
        h->step[conf_word_type(l, 2)] = conf_word_float(l, 3);
}

/* set motion bank: also sets the minimum that this motion needs, unless earlier lines of the recipe
 * set more. */
static void set_motion(ted4_header *h, const conf_line *l)
{
    static const char *const name[] = { "none", "bank", "concat", "inr" };

    for (uint8_t m = 0; m < 4; m++)
        if (conf_word_is(l, 2, name[m]))
            h->motion = m;
    if (h->motion == TED4_MOTION_NONE)
        return;
    h->deform_layers = h->deform_layers > 0 ? h->deform_layers : 1;
    h->deform_width = h->deform_width > 0 ? h->deform_width : 3;
    if (h->motion == TED4_MOTION_INR) {
        h->phi_dim = 0;
        h->bank_rows = h->bank_dim = 0;
        return;
    }
    h->phi_dim = h->phi_dim > 0 ? h->phi_dim : 2;
    h->bank_rows = h->bank_rows > 0 ? h->bank_rows : 3;
    h->bank_dim = h->bank_dim > 0 ? h->bank_dim : 2;
}

static void set_inr(ted4_header *h)
{
    h->prior = TED4_PRIOR_INR;
    h->pe_octaves = 1;
    h->hyper_layers = 1;
    h->hyper_width = 3;
}

/* Draws a small random header in range. */
static void set_random(conf_build *b)
{
    ted4_header *h = &b->head;
    conf_chance *c = &b->chance;
    unsigned left = (unsigned)conf_in(c, 1, 9), i = 0;

    h->n_anchors = (uint32_t)conf_in(c, 1, 90);
    h->tile_size = (uint32_t)conf_in(c, 64, 80);
    h->n_offsets = (uint8_t)conf_in(c, 1, 5);
    h->feature_dim = (uint8_t)left;
    h->motion = (uint8_t)conf_in(c, 0, 3);
    if (h->motion == TED4_MOTION_BANK || h->motion == TED4_MOTION_CONCAT) {
        h->phi_dim = (uint8_t)conf_in(c, 1, 4);
        h->bank_rows = (uint32_t)conf_in(c, 1, 6);
        h->bank_dim = (uint16_t)conf_in(c, 1, 5);
    }
    if (h->motion != TED4_MOTION_NONE) {
        h->deform_layers = (uint8_t)conf_in(c, 1, 3);
        h->deform_width = (uint16_t)conf_in(c, 1, 5);
        h->temporal_mask = (uint8_t)conf_in(c, 0, 1);
    }
    h->offset_mask = (uint8_t)conf_in(c, 0, 1);
    h->activation = (uint8_t)conf_in(c, 0, 1);
    h->view = (uint8_t)conf_in(c, 0, 2);
    h->head_layers = (uint8_t)conf_in(c, 0, 2);
    h->head_width = (uint16_t)(h->head_layers > 0 ? conf_in(c, 1, 5) : 0);
    h->scale_domain = (uint8_t)conf_in(c, 0, 1);
    h->prior = (uint8_t)conf_in(c, 0, 1);
    if (h->prior == TED4_PRIOR_INR) {
        h->pe_octaves = (uint8_t)conf_in(c, 0, 3);
        h->hyper_layers = (uint8_t)conf_in(c, 0, 2);
        h->hyper_width = (uint16_t)(h->hyper_layers > 0 ? conf_in(c, 1, 6) : 0);
    }
    for (; left > 0; i++) {
        h->slice[i] = (uint8_t)(i == 3 ? (int)left : conf_in(c, 1, (int)left));
        left -= h->slice[i];
    }
    h->n_slices = (uint8_t)i;
    h->ar_width = (uint16_t)(i > 1 ? conf_in(c, 1, 6) : 0);
    h->context_bits = (uint8_t)conf_in(c, 0, 12);
    h->frames = (uint32_t)conf_in(c, 1, 60);
    h->exponent = (int8_t)conf_in(c, -8, 8);
    for (int j = 0; j < 3; j++) {
        h->origin[j] = (float)conf_in(c, -64, 64) / 16;
        h->background[j] = (uint8_t)conf_in(c, 0, 255);
    }
}

static void set_origin(ted4_header *h, const conf_line *l)
{
    for (int i = 0; i < 3; i++)
        h->origin[i] = conf_word_float(l, 2 + i);
}

static void set_field(ted4_header *h, const conf_line *l)
{
    for (size_t i = 0; i < sizeof fields / sizeof *fields; i++)
        if (conf_word_is(l, 1, fields[i].name)) {
            store((char *)h + fields[i].offset, fields[i].width,
                  conf_line_number(l, 2, -128, UINT32_MAX));
            return;
        }
    conf_line_bad(l, "no such element");
}

static void set(conf_build *b, const conf_line *l)
{
    ted4_header *h = &b->head;

    if (conf_word_is(l, 1, "random"))
        set_random(b);
    else if (conf_word_is(l, 1, "slices"))
        set_slices(h, l);
    else if (conf_word_is(l, 1, "slices_of_one"))
        set_many_slices(h, l);
    else if (conf_word_is(l, 1, "rows_if_banked"))
        h->bank_rows = h->bank_rows > 0 ? (uint32_t)conf_line_number(l, 2, 1, UINT32_MAX) : 0;
    else if (conf_word_is(l, 1, "step"))
        set_step(h, l);
    else if (conf_word_is(l, 1, "motion"))
        set_motion(h, l);
    else if (conf_word_is(l, 1, "inr"))
        set_inr(h);
    else if (conf_word_is(l, 1, "origin"))
        set_origin(h, l);
    else if (conf_word_is(l, 1, "background"))
        for (int i = 0; i < 3; i++)
            h->background[i] = (uint8_t)conf_line_number(l, 2 + i, 0, 255);
    else
        set_field(h, l);
    if (conf_word_is(l, 1, "feature_dim") && h->n_slices == 1)
        h->slice[0] = h->feature_dim;
}

/* Sets the widths of absent parts to 0. */
static void tidy(ted4_header *h)
{
    if (h->head_layers == 0)
        h->head_width = 0;
    if (h->hyper_layers == 0)
        h->hyper_width = 0;
    if (h->n_slices == 1)
        h->ar_width = 0;
}

void conf_build_header(conf_build *b)
{
    smallest(&b->head);
    for (size_t i = 0; i < b->recipe->n; i++)
        if (conf_word_is(&b->recipe->line[i], 0, "set"))
            set(b, &b->recipe->line[i]);
    tidy(&b->head);
}
