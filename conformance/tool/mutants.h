/* mutants.h - `ted4conf mutants`: mutation testing. Faults are seeded into the decoder, and the
 * published vectors must detect them.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_MUTANTS_H
#define CONF_MUTANTS_H

enum { CONF_MUTANT_FLAGS = 8 };

typedef struct {
    const char *suite;   /* contains mutants.list, mutants-equivalent.list, mutants.csv, MUTANTS.md,
                            vectors */
    const char *vectors; /* folder whose subfolder vectors holds all files, also those made on
                            demand; NULL: suite */
    const char *build;   /* build folder of ted4conf */
    const char
        *compile; /* compile command with its flags, without -c and -o; NULL: nothing can be run */
    const char *flags[CONF_MUTANT_FLAGS]; /* "SUFFIX=FLAGS": flags that sources whose names end so
                                             need besides; ends with NULL unless full */
    const char *libraries;                /* linker arguments after the objects */
    const char *only;                     /* only ids with this prefix; NULL: all */
    int jobs;
    double timeout; /* seconds per replay */
    int check;      /* neither run nor write anything */
} conf_mutant_options;

/* Runs every mutant without a valid result, stores the results in mutants.csv, drops those that no
 * longer hold, and writes MUTANTS.md. Returns the exit code, 0 if enough mutants are killed. With
 * check, it only prints the number of valid results and returns 0. Ends the program if the list
 * does not match the sources, or if the unchanged decoder fails. */
int conf_mutants(const conf_mutant_options *o);

#endif
