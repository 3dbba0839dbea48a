/* options.h - what can be chosen about training, from options.def.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_OPTIONS_H
#define TED4_OPTIONS_H

#include <stdint.h>
#include <stdio.h>

#define TED4_KIND_I int
#define TED4_KIND_F double

typedef struct {
    uint32_t seed;
#define TED4_OPTION(kind, stage, name, lo, hi, a, b, c, d, e, help) TED4_KIND_##kind name;
#include "options.def"
#undef TED4_OPTION
} ted4_train_options;

/* "draft" .. "paper" and seed 0; -1: no such preset. */
int ted4_options_preset(ted4_train_options *o, const char *preset);
/* "name=value" as --set takes it. 0, or -1 with why filled. */
int ted4_options_set(ted4_train_options *o, const char *text, char *why, size_t why_size);
/* Presets and options by number, in the order of their table; NULL beyond its end. value: what o
 * has. stage: the first that it touches. */
const char *ted4_options_preset_name(int i);
const char *ted4_options_name(int i);
double ted4_options_value(const ted4_train_options *o, int i);
int ted4_options_stage(int i);
enum {
    TED4_OPTIONS = 0
#define TED4_OPTION(kind, stage, name, lo, hi, a, b, c, d, e, help) +1
#include "options.def"
#undef TED4_OPTION
};
/* The table of names, presets and help. */
void ted4_options_help(FILE *out);
/* A hash of the values that decide the state at the end of stage 1 or 2: a checkpoint belongs to
 * them. */
uint64_t ted4_options_hash(const ted4_train_options *o, int stage);

#endif
