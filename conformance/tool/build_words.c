/* build_words.c - see build.h: what the words of scene lines mean.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "build.h"

#include <stdlib.h>
#include <string.h>
#include "base/bytes.h"

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
    static const char *const name[] = { "set",       "seed",    "level",   "nete", "unit",
                                        "out",       "value",   "netr",    "bank", "pack",
                                        "positions", "dynamic", "offsets", "prob", "symbols",
                                        "symbol",    "profile" };

    for (size_t i = 0; i < sizeof name / sizeof *name; i++)
        if (conf_word_is(l, 0, name[i]))
            return 1;
    return 0;
}
