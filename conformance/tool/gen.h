/* gen.h - `ted4conf gen`: makes all vectors and the manifest from the recipes.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_GEN_H
#define CONF_GEN_H

typedef struct {
    const char *suite;  /* folder of recipes/, the stored files and SUITE.json */
    const char *output; /* folder for the vectors; NULL: suite/vectors */
    const char *only;   /* make only ids with this prefix, and no manifest; NULL: all */
    int verify;         /* compare with the existing files instead of writing */
    int demand;         /* also write the files that are made on demand only */
    int large; /* also make the large vectors; otherwise their existing descriptors are used */
} conf_gen_options;

/* Returns the exit code: 0 on success; 1 if a vector is not what its recipe expects, or differs
 * from the existing one. */
int conf_gen(const conf_gen_options *o);

#endif
