/* mutants.h - `ted4conf mutants`: faults seeded into the decoder, which the published vectors have
 * to find.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_MUTANTS_H
#define CONF_MUTANTS_H

typedef struct {
    const char
        *suite; /* holds mutants.list, mutants-equivalent.list, mutants.csv, MUTANTS.md, vectors */
    const char *vectors; /* folder that holds a folder vectors with all files, those made on demand
                            too; NULL: suite */
    const char *build;   /* folder of a build of ted4conf */
    const char
        *compile; /* command that compiles: flags, without -c and -o; NULL: nothing can be run */
    const char *libraries; /* behind the objects when linking */
    const char *only;      /* ids that begin so; NULL: all */
    int jobs;
    double timeout; /* seconds for one replay */
    int check;      /* run and write nothing */
} conf_mutant_options;

/* Runs what has no result that holds, keeps results in mutants.csv, writes MUTANTS.md. Exit code: 0
 * when enough are killed. check: says how many results hold; 0. A list that does not fit the
 * sources, or an unchanged program that does not pass, ends the program. */
int conf_mutants(const conf_mutant_options *o);

#endif
