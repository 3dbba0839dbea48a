/* cover.h - `ted4conf cover`: measures the coverage of the published vectors against a list of
 * goals.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_COVER_H
#define CONF_COVER_H

#include "suite.h"

typedef struct {
    const char *suite;       /* folder of the suite */
    const char *spec;        /* folder of the specification with its index of rules */
    const char *json, *html; /* files to write; NULL: none */
    int verbose;             /* also print every goal that is reached */
} conf_cover_options;

/* Goals in groups, in the order in which they were added. */
typedef struct {
    json_t *groups;  /* {group: {goal: [first vector, number of vectors]}}; owned */
    json_t *orphans; /* texts: rules without vectors, and vectors without rules */
} conf_cover;

/* cover_goals.c: adds a goal. */
void conf_goal(conf_cover *c, const char *group, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* Records that a vector reaches the goal. A name that is not a goal is ignored. */
void conf_reach(conf_cover *c, const char *group, const char *vector, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/* cover_rules.c: rules of the specification, errors, and pairs of features. */
void conf_cover_rules(conf_cover *c, const char *spec, const char *suite, const conf_entry *e,
                      size_t n);
/* cover_syntax.c: values of every syntax element, in valid files and just outside their range. */
void conf_cover_syntax(conf_cover *c, const conf_entry *e, const conf_bytes *file);
void conf_cover_syntax_goals(conf_cover *c);
/* cover_model.c: tables, the coder, and extremes of the integer arithmetic of a valid file. */
void conf_cover_model(conf_cover *c, const conf_entry *e, const conf_bytes *file);
void conf_cover_model_goals(conf_cover *c);

/* cover_triples.c: counts triples of features that are possible together, and those that some valid
 * vector has. */
typedef struct {
    size_t possible, reached;
} conf_triples;
conf_triples conf_cover_triples(const conf_entry *e, size_t n);

/* Returns the exit code: 0 if every goal is reached, else 1. */
int conf_cover_run(const conf_cover_options *o);

#endif
