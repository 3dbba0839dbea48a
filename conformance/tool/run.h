/* run.h - `ted4conf run`: checks a decoder against the suite.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_RUN_H
#define CONF_RUN_H

#include "judge.h"

typedef struct {
    const char *suite;               /* folder of SUITE.json, vectors/, recipes/ */
    const char *decoder;             /* command */
    const char *list;                /* file of ids; NULL: all */
    const char *second;              /* NAME=VALUE for the second run; NULL: nothing changes */
    const char *json, *junit, *html; /* files to write; NULL: none */
    int jobs, once, demand, large, quiet;
    double timeout;  /* seconds per run */
    uint64_t memory; /* bytes of address space per run; 0: no limit */
} conf_run_options;

/* The results of a run. */
typedef struct {
    const conf_run_options *options;
    json_t *capabilities;   /* NULL: none */
    conf_verdict handshake; /* the problem with the capabilities */
    conf_entry *entry;      /* [n] */
    conf_verdict *verdict;  /* [n] */
    double *ms;             /* [n] */
    size_t n, count[CONF_OUTCOMES], valid_passed;
    char reason[400]; /* why the decoder does not conform, if that is not a vector's; or "" */
    int passed;       /* the verdict on the decoder */
} conf_run_result;

/* Returns the exit code: 0 the decoder conforms, 1 it does not, 3 wrong usage. */
int conf_run(const conf_run_options *o);

/* run_report.c */
void conf_run_write_json(const conf_run_result *r);
void conf_run_write_junit(const conf_run_result *r);
void conf_run_write_html(const conf_run_result *r);

#endif
