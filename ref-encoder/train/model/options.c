/* options.c - reads, checks and describes the training options (options.h), all from one table.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "options.h"

#include <errno.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "train/math/random.h"

enum { N_PRESETS = 5 };

static const char *const preset_names[N_PRESETS] = { "draft", "fast", "medium", "slow", "paper" };

typedef struct {
    char kind;
    int stage;
    const char *name;
    size_t offset;
    double lo, hi, preset[N_PRESETS];
    const char *help;
} option;

static const option table[] = {
#define TED4_OPTION(kind, stage, name, lo, hi, a, b, c, d, e, help) \
    { #kind[0], stage, #name, offsetof(ted4_train_options, name), lo, hi, { a, b, c, d, e }, help },
#include "options.def"
#undef TED4_OPTION
};

enum { N_OPTIONS = TED4_OPTIONS };

static void store(ted4_train_options *o, const option *t, double value)
{
    char *at = (char *)o + t->offset;

    if (t->kind == 'I') {
        const int i = (int)value;

        memcpy(at, &i, sizeof i);
    } else {
        memcpy(at, &value, sizeof value);
    }
}

static double fetch(const ted4_train_options *o, const option *t)
{
    const char *at = (const char *)o + t->offset;
    double value;
    int i;

    if (t->kind == 'I') {
        memcpy(&i, at, sizeof i);
        return i;
    }
    memcpy(&value, at, sizeof value);
    return value;
}

int ted4_options_preset(ted4_train_options *o, const char *preset)
{
    for (int p = 0; p < N_PRESETS; p++) {
        if (strcmp(preset, preset_names[p]) != 0)
            continue;
        memset(o, 0, sizeof *o);
        for (int i = 0; i < N_OPTIONS; i++)
            store(o, &table[i], table[i].preset[p]);
        return 0;
    }
    return -1;
}

int ted4_options_set(ted4_train_options *o, const char *text, char *why, size_t why_size)
{
    const char *equal = strchr(text, '=');

    for (int i = 0; equal != NULL && i < N_OPTIONS; i++) {
        const option *t = &table[i];

        if (strlen(t->name) != (size_t)(equal - text) ||
            strncmp(text, t->name, strlen(t->name)) != 0)
            continue;

        char *end;

        errno = 0;
        const double value = strtod(equal + 1, &end);
        const int bad = equal[1] == '\0' || *end != '\0' || errno != 0 ||
                        !(value >= t->lo && value <= t->hi) ||
                        (t->kind == 'I' && value != (double)(int)value);

        if (bad) {
            snprintf(why, why_size, "%s: expected %s from %.8g to %.8g", text,
                     t->kind == 'I' ? "an integer" : "a number", t->lo, t->hi);
            return -1;
        }
        store(o, t, value);
        return 0;
    }
    snprintf(why, why_size, "%s: expected name=value with a name from --help", text);
    return -1;
}

const char *ted4_options_preset_name(int i)
{
    return i < N_PRESETS ? preset_names[i] : NULL;
}

const char *ted4_options_name(int i)
{
    return i < N_OPTIONS ? table[i].name : NULL;
}

double ted4_options_value(const ted4_train_options *o, int i)
{
    return fetch(o, &table[i]);
}

int ted4_options_stage(int i)
{
    return table[i].stage;
}

void ted4_options_help(FILE *out)
{
    fprintf(out, "  %-17s", "name");
    for (int p = 0; p < N_PRESETS; p++)
        fprintf(out, " %8s", preset_names[p]);
    fprintf(out, "  meaning\n");
    for (int i = 0; i < N_OPTIONS; i++) {
        fprintf(out, "  %-17s", table[i].name);
        for (int p = 0; p < N_PRESETS; p++)
            fprintf(out, " %8g", table[i].preset[p]);
        fprintf(out, "  %s\n", table[i].help);
    }
}

uint64_t ted4_options_hash(const ted4_train_options *o, int stage)
{
    uint64_t h = ted4_mix(o->seed);

    for (int i = 0; i < N_OPTIONS; i++) {
        const double value = fetch(o, &table[i]);
        uint64_t bits;

        if (table[i].stage > stage)
            continue;
        memcpy(&bits, &value, sizeof bits);
        h = ted4_mix(h ^ bits);
    }
    return h;
}
