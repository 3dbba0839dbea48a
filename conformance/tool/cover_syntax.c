/* cover_syntax.c - goals for values of syntax elements. In valid files: the least and the greatest
 * value of the range, their neighbours, one other value, and every value of a small range. In files
 * that are refused at the element: the values just outside the range.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdio.h>
#include <string.h>
#include "base/bytes.h"
#include "cover.h"
#include "ted4.h"

/* width: bytes in the file. high: the bound of level 1 if levels bound the element, so that small
 * files reach it. */
typedef struct {
    const char *name;
    unsigned width;
    uint32_t low, high;
    int levelled; /* 1: a value above high needs a higher level, but is no hdr.range */
} element;

static const element table[] = { { "minor", 1, 0, 255, 1 },
                                 { "n_anchors", 4, 1, UINT32_MAX, 1 },
                                 { "tile_size", 4, 64, 65536, 0 },
                                 { "n_offsets", 1, 1, 16, 0 },
                                 { "feature_dim", 1, 1, 128, 0 },
                                 { "motion", 1, 0, 3, 0 },
                                 { "phi_dim", 1, 0, 32, 0 },
                                 { "bank_rows", 4, 0, 64, 1 },
                                 { "bank_dim", 2, 0, 512, 0 },
                                 { "deform_layers", 1, 0, 8, 0 },
                                 { "deform_width", 2, 0, 512, 0 },
                                 { "temporal_mask", 1, 0, 1, 0 },
                                 { "offset_mask", 1, 0, 1, 0 },
                                 { "activation", 1, 0, 1, 0 },
                                 { "view", 1, 0, 2, 0 },
                                 { "head_layers", 1, 0, 4, 0 },
                                 { "head_width", 2, 0, 512, 0 },
                                 { "scale_domain", 1, 0, 1, 0 },
                                 { "prior", 1, 0, 1, 0 },
                                 { "pe_octaves", 1, 0, 16, 0 },
                                 { "hyper_layers", 1, 0, 4, 0 },
                                 { "hyper_width", 2, 0, 512, 0 },
                                 { "n_slices", 1, 1, 16, 0 },
                                 { "slice", 1, 1, 128, 0 },
                                 { "ar_width", 2, 0, 512, 0 },
                                 { "context_bits", 1, 0, 12, 0 },
                                 { "step", 4, 0x35800000, 0x44800000, 0 },
                                 { "frames", 4, 1, UINT32_MAX, 1 },
                                 { "rate_num", 4, 1, 16777215, 0 },
                                 { "rate_den", 4, 1, 16777215, 0 },
                                 { "background", 1, 0, 255, 1 },
                                 { "reserved", 1, 0, 0, 0 },
                                 { "shift", 1, 0, 20, 1 },
                                 { "mode", 1, 0, 2, 1 },
                                 { "profile", 1, 0, 1, 1 },
                                 { "unit_exponent", 1, 0, 255, 1 },
                                 { "dynamic_prob", 2, 1, 65535, 1 },
                                 { "offset_prob", 2, 1, 65535, 1 } };

enum { N_TABLE = sizeof table / sizeof *table, FEW = 20 };

static const char group[] = "values of syntax elements",
                  outside[] = "values just outside of HEAD's ranges";

static int is_last(const element *e)
{
    return strcmp(e->name, "n_anchors") == 0; /* no file can have its greatest value */
}

static void set_goals(conf_cover *c, const element *e)
{
    const uint32_t span = e->high - e->low;

    if (span <= FEW) {
        for (uint32_t v = e->low; v <= e->high; v++)
            conf_goal(c, group, "%s = %u", e->name, v);
    } else {
        conf_goal(c, group, "%s = %u", e->name, e->low);
        conf_goal(c, group, "%s = %u", e->name, e->low + 1);
        conf_goal(c, group, "%s between", e->name);
        if (!is_last(e) && strcmp(e->name, "frames") != 0)
            conf_goal(c, group, "%s = %u", e->name, e->high - 1);
        if (!is_last(e))
            conf_goal(c, group, "%s = %u", e->name, e->high);
    }
    if (!e->levelled && e->low > 0)
        conf_goal(c, outside, "%s = %u", e->name, e->low - 1);
    if (!e->levelled)
        conf_goal(c, outside, "%s = %u", e->name, e->high + 1);
}

static const char *const special[] = { "grid = 6",
                                       "grid = 7",
                                       "grid = 8",
                                       "grid = 9",
                                       "grid = 10",
                                       "grid = 11",
                                       "grid = 12",
                                       "grid = 16",
                                       "exponent = -30",
                                       "exponent = -29",
                                       "exponent = 0",
                                       "exponent = 29",
                                       "exponent = 30",
                                       "origin zero",
                                       "origin negative",
                                       "origin least normal",
                                       "origin largest",
                                       "position zero",
                                       "position one",
                                       "position minus one",
                                       "position subnormal",
                                       "position least normal",
                                       "position between",
                                       "chunk ancillary with flags 0",
                                       "chunk ancillary with flags 2",
                                       "chunk empty",
                                       "substream empty",
                                       "size zero",
                                       "level 1",
                                       "level 2",
                                       "level 3",
                                       "level 4",
                                       "level 31",
                                       "tile_index = 0",
                                       "tile_index = 1",
                                       "tile_index between",
                                       "value of a blob zero",
                                       "value of a blob negative",
                                       "value of a blob least normal",
                                       "value of a blob largest" };

void conf_cover_syntax_goals(conf_cover *c)
{
    for (int i = 0; i < N_TABLE; i++)
        set_goals(c, &table[i]);
    for (size_t i = 0; i < sizeof special / sizeof *special; i++)
        conf_goal(c, group, "%s", special[i]);
    conf_goal(c, outside, "exponent = -31");
    conf_goal(c, outside, "exponent = 31");
}

typedef struct {
    conf_cover *c;
    const char *id;
    uint32_t chunk_flags;
    int ancillary; /* the chunk has an unknown type */
} observer;

static void reach(const observer *l, const char *what)
{
    conf_reach(l->c, group, l->id, "%s", what);
}

static void reach_position(const observer *l, unsigned h)
{
    reach(l, h == 0                  ? "position zero"
             : h == 0x3c00           ? "position one"
             : h == 0xbc00           ? "position minus one"
             : (h & 0x7c00) == 0     ? "position subnormal"
             : (h & 0x7fff) == 0x400 ? "position least normal"
                                     : "position between");
}

static void reach_float(const observer *l, const char *name, uint32_t u)
{
    char text[64];

    snprintf(text, sizeof text, "%s %s", name,
             u == 0                           ? "zero"
             : (u & 0x7fffffff) == 0x800000   ? "least normal"
             : (u & 0x7fffffff) == 0x7f7fffff ? "largest"
             : u >> 31                        ? "negative"
                                              : "between");
    reach(l, text);
    if (u >> 31) {
        snprintf(text, sizeof text, "%s negative", name);
        reach(l, text);
    }
}

static int known_type(uint32_t type)
{
    static const char *const name[] = { "HEAD", "NETE", "NETR", "BANK", "POSN", "TILE", "ENDS" };

    for (size_t i = 0; i < sizeof name / sizeof *name; i++)
        if (ted4_load32((const uint8_t *)name[i]) == type)
            return 1;
    return 0;
}

static void note_special(observer *l, const char *name, int64_t value)
{
    if (strcmp(name, "exponent") == 0)
        conf_reach(l->c, group, l->id, "exponent = %d", (int)(int8_t)value);
    if (strcmp(name, "origin") == 0)
        reach_float(l, "origin", (uint32_t)value);
    if (strcmp(name, "nete") == 0 || strcmp(name, "netr") == 0 || strcmp(name, "bank") == 0)
        reach_float(l, "value of a blob", (uint32_t)value);
    if (strcmp(name, "position") == 0)
        reach_position(l, (unsigned)value);
    if (strcmp(name, "grid") == 0)
        conf_reach(l->c, group, l->id, "grid = %d", (int)value);
    if (strcmp(name, "level") == 0)
        conf_reach(l->c, group, l->id, "level %d", (int)value);
    if (strcmp(name, "tile_index") == 0)
        conf_reach(l->c, group, l->id, value < 2 ? "tile_index = %d" : "tile_index between",
                   (int)value);
    if (strcmp(name, "size") == 0 && value == 0)
        reach(l, "size zero");
    if (strstr(name, "_substream") != NULL && value == 0)
        reach(l, "substream empty");
    if (strcmp(name, "chunk_type") == 0)
        l->ancillary = !known_type((uint32_t)value);
    if (strcmp(name, "chunk_flags") == 0 && l->ancillary)
        conf_reach(l->c, group, l->id, "chunk ancillary with flags %d", (int)value);
    if (strcmp(name, "chunk_size") == 0 && value == 0)
        reach(l, "chunk empty");
}

static void note(void *user, size_t offset, const char *name, int64_t index, int64_t value)
{
    observer *l = user;

    (void)offset;
    for (int i = 0; i < N_TABLE; i++)
        if (strcmp(table[i].name, name) == 0) {
            const element *e = &table[i];
            const uint32_t v = (uint32_t)value;

            if (e->high - e->low <= FEW || v <= e->low + 1 || v >= e->high - 1)
                conf_reach(l->c, group, l->id, "%s = %u", name, v);
            else
                conf_reach(l->c, group, l->id, "%s between", name);
            return;
        }
    if (index >= 0)
        note_special(l, name, value);
}

/* Notes the element at which a file is refused. The offsets of HEAD's elements in its payload
 * follow from the number of slices in HEAD. */
static void note_refused(conf_cover *c, const conf_entry *e, const conf_bytes *file)
{
    static const char *const order[] = {
        "n_anchors",     "tile_size",    "n_offsets",  "feature_dim",   "motion",
        "phi_dim",       "bank_rows",    "bank_dim",   "deform_layers", "deform_width",
        "temporal_mask", "offset_mask",  "activation", "view",          "head_layers",
        "head_width",    "scale_domain", "prior",      "pe_octaves",    "hyper_layers",
        "hyper_width",   "n_slices",     "slice",      "ar_width",      "context_bits",
        "step",          "frames",       "rate_num",   "rate_den",      "origin",
        "exponent",      "background",   "reserved"
    };
    const size_t wrong = (size_t)json_integer_value(
        json_object_get(json_object_get(e->descriptor, "expect"), "offset"));
    size_t at = 24, n_slices = 1;

    for (size_t i = 0; i < sizeof order / sizeof *order; i++) {
        const size_t times =
            strcmp(order[i], "slice") == 0                                           ? n_slices
            : strcmp(order[i], "step") == 0                                          ? 5
            : strcmp(order[i], "origin") == 0 || strcmp(order[i], "background") == 0 ? 3
                                                                                     : 1;
        unsigned width = strcmp(order[i], "origin") == 0 ? 4 : 1;

        for (int j = 0; j < N_TABLE; j++)
            if (strcmp(table[j].name, order[i]) == 0)
                width = table[j].width;
        for (size_t k = 0; k < times; k++, at += width)
            if (at == wrong && at + 4 <= file->size) {
                const uint8_t *p = file->data + at;
                const uint32_t v = width == 1 ? p[0] : width == 2 ? ted4_load16(p) : ted4_load32(p);

                if (strcmp(order[i], "exponent") == 0)
                    conf_reach(c, outside, e->id, "exponent = %d", (int)(int8_t)v);
                else
                    conf_reach(c, outside, e->id, "%s = %u", order[i], v);
            }
        if (strcmp(order[i], "n_slices") == 0)
            n_slices = file->data[at - 1];
    }
}

void conf_cover_syntax(conf_cover *c, const conf_entry *e, const conf_bytes *file)
{
    const char *const error =
        json_string_value(json_object_get(json_object_get(e->descriptor, "expect"), "error"));
    observer l = { .c = c, .id = e->id };
    const ted4_options o = { .trace = note, .trace_user = &l };
    ted4_scene *s;
    ted4_error why;

    if (error != NULL) {
        if (strcmp(error, "hdr.range") == 0)
            note_refused(c, e, file);
        return;
    }
    (void)ted4_decode(file->data, file->size, &o, &s, &why);
    ted4_scene_free(s);
}
