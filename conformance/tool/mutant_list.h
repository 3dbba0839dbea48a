/* mutant_list.h - seeded faults, as mutants.list stores them, and their results, as mutants.csv
 * stores them. A fault is one textual change to one source file:
 *     mutant ID FILE       FILE may be left out: that of the mutant before
 *     < the line as it is, without its indentation; if FILE is left out, this line may be too: that
 *       of the mutant before
 *     > the line as it becomes
 *     @ where it is judged (mutant_place.h); without this line, by plain kernels in one thread
 *     = why no vector distinguishes it from the original, where that is known
 *     ! PROGRAM ...    test programs that judge it, in this order, below tests/ (only where no
 *                      vectors do: tests/mutants/encoder_mutants.c)
 * A row of mutants.csv is ID,KEY,VERDICT,VECTOR,BY. A result holds as long as its key matches. The
 * key covers the mutant's text and place, the code of its file without comments and spacing, and
 *     killed                   the vector that killed it: the hash of its file and its expected
 *                              answer, so that a growing suite loses no kill;
 *     survived, no compile     the code of every decoder file that is used there, and all vectors.
 * A kill is assumed to survive changes to other files of the decoder.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_MUTANT_LIST_H
#define CONF_MUTANT_LIST_H

#include "mutant_place.h"
#include "suite.h"

enum { CONF_MUTANT_LINE = 400 };

typedef struct {
    char id[64], file[200], from[CONF_MUTANT_LINE], to[CONF_MUTANT_LINE], why[CONF_MUTANT_LINE];
    const conf_place *place;
    uint64_t code; /* hash of the file's code */
    char programs[CONF_MUTANT_LINE];
    char verdict[16];          /* "": no valid result; "killed", "survived", "no compile" */
    char vector[96];           /* the vector, or the program, that killed it */
    char by[CONF_MUTANT_LINE]; /* the message of the replay */
} conf_mutant;

typedef struct conf_mutant_list {
    conf_mutant *m; /* owned */
    size_t n;
    uint64_t all;       /* hash of the decoder's code and of all vectors */
    uint64_t beyond;    /* hash of the code that only other places than the first use; 0: none is
                           named */
    conf_entry *vector; /* owned: the vectors of the suite */
    size_t n_vectors;
    /* Returns the hash of what the verdict of m depends on besides the code of its file, or 0 if
     * that no longer exists. NULL: the suite of vectors, as above. */
    uint64_t (*ground)(const struct conf_mutant_list *l, const conf_mutant *m);
} conf_mutant_list;

/* *l must be all zero. Ends the program on a line of unknown kind, on a duplicate id, and on a text
 * that does not occur exactly once in its file. */
void conf_mutant_list_read(conf_mutant_list *l, const char *path);
void conf_mutant_list_free(conf_mutant_list *l);
/* Appends to out the file with the mutant's line replaced, or unchanged if m->from does not occur.
 * Returns the number of occurrences. */
int conf_mutant_apply(const conf_mutant *m, conf_bytes *out);

/* Returns a hash of the code of source files, without comments and spacing. files: words for a
 * shell, run in the project's root. Ends the program if there is no code in them. */
uint64_t conf_mutant_code_of(const char *files);
/* Computes the hashes that the keys need, then takes the verdicts of all rows that still hold. */
void conf_mutant_results_read(conf_mutant_list *l, const char *suite);
void conf_mutant_results_add(const conf_mutant_list *l, const conf_mutant *m, const char *suite);
/* Writes mutants.csv anew: the rows of mutants that have a verdict, in the order of the list.
 * Leaves it alone if there is none. */
void conf_mutant_results_keep(const conf_mutant_list *l, const char *suite);
/* Returns the number of mutants with that verdict. */
size_t conf_mutant_count(const conf_mutant_list *l, const char *verdict);
/* Appends the table of counts to out. complete: all that can be judged is judged, so that the share
 * of kills is one of the whole list: kills stay valid longer than survivals. */
void conf_mutant_print_counts(const conf_mutant_list *l, int complete, conf_bytes *out);

#endif
