/* options.h - the training options, defined in options.def.
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

/* Sets all options to a preset, "draft" .. "paper", and the seed to 0. Returns 0, or -1 if there is
 * no such preset. */
int ted4_options_preset(ted4_train_options *o, const char *preset);
/* Sets one option from "name=value", as --set takes it. Returns 0, or -1 with why filled. */
int ted4_options_set(ted4_train_options *o, const char *text, char *why, size_t why_size);
/* Presets and options by number, in the order of their table. Names are NULL beyond its end. value:
 * the option's value in o. stage: the first stage that the option affects. */
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
/* Prints the table of names, presets and help. */
void ted4_options_help(FILE *out);
/* Returns a hash of the values that determine the state at the end of stage 1 or 2; it identifies
 * the options that a checkpoint belongs to. */
uint64_t ted4_options_hash(const ted4_train_options *o, int stage);

#endif
