/* mutant_list.h - seeded faults as mutants.list holds them, and what came of them as mutants.csv
 * does. A fault is one textual change to one source file:
 *     mutant ID FILE
 *     < the line as it is, without its indentation
 *     > the line as it becomes
 *     = why no vector tells it from the original, where that is known
 * A row of mutants.csv is ID,KEY,VERDICT,VECTOR,BY. It holds for as long as what it stands on is
 * the same (the key): the mutant's text, the code of its file, comments and spacing aside, and
 *     killed                   the vector that killed it: the hash of its file, and what is
 *                              expected of it. A suite that grows loses no kill;
 *     survived, no compile     the code of all of the decoder that mutants reach, and all vectors.
 * A kill is taken to outlast changes of other files of the decoder.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_MUTANT_LIST_H
#define CONF_MUTANT_LIST_H

#include "suite.h"

enum { CONF_MUTANT_LINE = 400 };

typedef struct {
    char id[64], file[200], from[CONF_MUTANT_LINE], to[CONF_MUTANT_LINE], why[CONF_MUTANT_LINE];
    uint64_t code;             /* hash of the file's code */
    char verdict[16];          /* "": no result that holds; "killed", "survived", "no compile" */
    char vector[96];           /* that killed it */
    char by[CONF_MUTANT_LINE]; /* what the replay said of it */
} conf_mutant;

typedef struct {
    conf_mutant *m; /* owned */
    size_t n;
    uint64_t all;       /* hash of the decoder's code and of all vectors */
    conf_entry *vector; /* owned: of the suite */
    size_t n_vectors;
} conf_mutant_list;

/* All zero before. A line that is of no kind, an id that is there twice, and a text that does not
 * stand exactly once in its file end the program. */
void conf_mutant_list_read(conf_mutant_list *l, const char *path);
void conf_mutant_list_free(conf_mutant_list *l);
/* The file with its line changed, added to out, or unchanged when m->from is not there. Gives how
 * often it is. */
int conf_mutant_apply(const conf_mutant *m, conf_bytes *out);

/* Hashes what results stand on; then takes verdicts from rows that hold. */
void conf_mutant_results_read(conf_mutant_list *l, const char *suite);
void conf_mutant_results_add(const conf_mutant_list *l, const conf_mutant *m, const char *suite);
/* Mutants with that verdict. */
size_t conf_mutant_count(const conf_mutant_list *l, const char *verdict);

#endif
