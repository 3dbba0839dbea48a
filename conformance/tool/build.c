/* build.c - see build.h: the steps in order, and what words mean.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "build.h"

#include <stdlib.h>
#include <string.h>
#include "base/bytes.h"
#include "write/encode.h"

const char *const conf_type_name[TED4_TYPES] = { "feature", "scaling", "offset", "phi", "tau" };

int conf_word_is(const conf_line *l, int i, const char *text)
{
    return i < l->n && strcmp(l->word[i], text) == 0;
}

float conf_word_float(const conf_line *l, int i)
{
    char *end;
    float v;

    if (i >= l->n)
        conf_line_bad(l, "a value is missing");
    if (l->word[i][0] == ':')
        v = ted4_bits_float((uint32_t)strtoul(l->word[i] + 1, &end, 16));
    else
        v = strtof(l->word[i], &end);
    if (*end != '\0')
        conf_line_bad(l, "no binary32");
    return v;
}

int conf_word_type(const conf_line *l, int i)
{
    for (int t = 0; t < TED4_TYPES; t++)
        if (conf_word_is(l, i, conf_type_name[t]))
            return t;
    conf_line_bad(l, "no attribute type");
}

int conf_is_scene_line(const conf_line *l)
{
    static const char *const name[] = { "set",     "seed", "level",     "nete",
                                        "unit",    "out",  "value",     "netr",
                                        "bank",    "pack", "positions", "dynamic",
                                        "offsets", "prob", "symbols",   "symbol" };

    for (size_t i = 0; i < sizeof name / sizeof *name; i++)
        if (conf_word_is(l, 0, name[i]))
            return 1;
    return 0;
}

void conf_build_file(conf_build *b, const conf_recipe *r, conf_bytes *file)
{
    const conf_line *const seed = conf_line_find(r, "seed"), *const level =
                                                                 conf_line_find(r, "level");
    uint8_t *out;
    size_t size;
    ted4_error e = { TED4_OK, 0 };

    memset(b, 0, sizeof *b);
    b->recipe = r;
    b->chance.state = seed != NULL ? conf_seed(seed->rest) : conf_seed(r->id);
    b->level = level != NULL ? (int)conf_line_number(level, 1, 0, 31) : 0;
    conf_build_header(b);
    b->scene = ted4_scene_new(&b->head, NULL);
    if (b->scene == NULL)
        conf_die("%s: no memory", r->id);
    conf_build_nets(b);
    conf_build_positions(b);
    conf_build_masks(b);
    if (ted4_scene_steps(b->scene, NULL, &e) != TED4_OK)
        conf_die("%s: networks: %s at %zu", r->id, ted4_status_id(e.code), e.offset);
    conf_build_symbols(b);
    conf_build_pack(b);
    if (ted4_encode(b->scene, b->level, NULL, &out, &size, &e) != TED4_OK)
        conf_die("%s: %s at %zu: no valid scene", r->id, ted4_status_id(e.code), e.offset);
    memset(file, 0, sizeof *file);
    conf_add(file, out, size);
    free(out);
}

void conf_build_end(conf_build *b)
{
    ted4_scene_free(b->scene);
    b->scene = NULL;
}
