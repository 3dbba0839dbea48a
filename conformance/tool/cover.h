/* cover.h - `ted4conf cover`: what the published vectors reach, counted against what there is to
 * reach.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_COVER_H
#define CONF_COVER_H

#include "suite.h"

typedef struct {
    const char *suite;       /* folder of the suite */
    const char *spec;        /* folder of the specification, for its index of rules */
    const char *json, *html; /* files to write; NULL: none */
    int verbose;             /* print every goal that is reached, too */
} conf_cover_options;

/* Goals in groups, in the order in which they were set. */
typedef struct {
    json_t *groups;  /* {group: {goal: [first vector, number of vectors]}}; owned */
    json_t *orphans; /* texts: rules without vectors, vectors without rules */
} conf_cover;

/* cover_goals.c: a thing to be reached. */
void conf_goal(conf_cover *c, const char *group, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* A vector reaches it; one that is no goal is passed over. */
void conf_reach(conf_cover *c, const char *group, const char *vector, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/* cover_rules.c: rules of the specification, errors, pairs of features. */
void conf_cover_rules(conf_cover *c, const char *spec, const char *suite, const conf_entry *e,
                      size_t n);
/* cover_syntax.c: values of every syntax element, in valid files and just outside. */
void conf_cover_syntax(conf_cover *c, const conf_entry *e, const conf_bytes *file);
void conf_cover_syntax_goals(conf_cover *c);
/* cover_model.c: tables, coder, extremes of the integer arithmetic, of a valid file. */
void conf_cover_model(conf_cover *c, const conf_entry *e, const conf_bytes *file);
void conf_cover_model_goals(conf_cover *c);

/* cover_triples.c: triples of features that can stand together, and those that a valid vector has.
 */
typedef struct {
    size_t possible, reached;
} conf_triples;
conf_triples conf_cover_triples(const conf_entry *e, size_t n);

/* Exit code: 0: everything is reached; 1: not. */
int conf_cover_run(const conf_cover_options *o);

#endif
