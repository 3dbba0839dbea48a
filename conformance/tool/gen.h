/* gen.h - `ted4conf gen`: all vectors and the manifest, from the recipes.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_GEN_H
#define CONF_GEN_H

typedef struct {
    const char *suite;  /* folder of recipes/, kept content and SUITE.json */
    const char *output; /* folder for the vectors; NULL: suite/vectors */
    const char *only;   /* make only ids that begin so; NULL: all. Then no manifest is written */
    int verify;         /* compare with what is there instead of writing */
    int demand;         /* also write what is made on demand only */
    int large; /* also make what is large by nature; else its descriptor is taken as it is */
} conf_gen_options;

/* Exit code: 0 fine; 1: a vector is not what its recipe expects, or differs from the one that is
 * there. */
int conf_gen(const conf_gen_options *o);

#endif
