/* replay.c - see replay.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "replay.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "answer.h"
#include "judge.h"
#include "ways.h"

static int by_size(const void *a, const void *b)
{
    const json_int_t x =
        json_integer_value(json_object_get(((const conf_entry *)a)->descriptor, "bytes"));
    const json_int_t y =
        json_integer_value(json_object_get(((const conf_entry *)b)->descriptor, "bytes"));

    return x != y ? (x < y ? -1 : 1)
                  : strcmp(((const conf_entry *)a)->id, ((const conf_entry *)b)->id);
}

/* What the validator has found. */
typedef struct {
    const char *first; /* identifier of the first error; NULL: none */
    size_t at;
} first_error;

static void note(void *user, const ted4_finding *f)
{
    first_error *e = user;

    if (f->severity == TED4_ERROR && e->first == NULL)
        *e = (first_error) { f->id, f->offset };
}

/* R-VAL-001: the expected error comes first; a valid file has no errors. */
static void judge_validator(const json_t *d, const conf_bytes *file, conf_verdict *v)
{
    const conf_knobs knobs = conf_knobs_of(d);
    const ted4_options o = { .max_bytes = knobs.memory, .max_work = knobs.work };
    const json_t *const expect = json_object_get(d, "expect"), *const offset = json_object_get(
                                                                   expect, "offset");
    const char *const id = json_string_value(json_object_get(expect, "error"));
    first_error e = { NULL, 0 };
    int good;

    (void)ted4_validate(file->data, file->size, &o, note, &e);
    good = id == NULL ? e.first == NULL : e.first != NULL && strcmp(id, e.first) == 0;
    if (!good || (offset != NULL && (json_int_t)e.at != json_integer_value(offset))) {
        v->outcome = CONF_FAIL;
        snprintf(v->reason, sizeof v->reason, "the validator finds %s at %zu",
                 e.first != NULL ? e.first : "nothing", e.at);
    }
}

static void judge_ways(const json_t *d, const conf_bytes *file, conf_verdict *v)
{
    const char *const way = conf_ways_differ(file, conf_knobs_of(d));

    if (way != NULL) {
        v->outcome = CONF_FAIL;
        snprintf(v->reason, sizeof v->reason, "something else %s", way);
    }
}

/* Judges lenient mode as far as its result is specified. */
static void judge(const json_t *capabilities, const json_t *d, const conf_bytes *file,
                  conf_verdict *v)
{
    const int saved = json_object_get(d, "salvage") != NULL, invalid = conf_expects(d, "invalid");
    json_t *const answer = (saved || !invalid ? conf_answer_lenient : conf_answer)(
        file, json_object_get(d, "queries"), conf_knobs_of(d));

    conf_judge(capabilities, d, answer, v);
    if (saved && v->outcome == CONF_PASS)
        conf_judge_salvage(capabilities, d, answer, v);
    json_decref(answer);
}

int conf_replay(const conf_replay_options *o)
{
    json_t *capabilities = json_pack("{s:i, s:[s,s,s,s,s,s], s:s, s:[], s:[s,s]}", "max_level", 31,
                                     "tiers", "T0", "T1", "T2", "T3", "T4", "T5", "class", "X",
                                     "declines", "knobs", "max_alloc_total", "max_work");
    char path[CONF_PATH];
    conf_entry *e;
    size_t n, n_bad = 0, n_run = 0;

    conf_path(path, "%s/vectors", o->suite);
    e = conf_suite_load(path, o->list, &n);
    if (n > 0)
        qsort(e, n, sizeof *e, by_size); /* small files first */
    for (size_t i = 0; i < n && !(o->stop && n_bad > 0); i++) {
        conf_verdict v = { CONF_MISSING, "no descriptor" };
        conf_bytes file = { NULL, 0, 0 };

        if (e[i].descriptor != NULL && !conf_read(e[i].file, &file))
            continue; /* made on demand: not stored */
        if (o->names) {
            printf("at %s\n", e[i].id);
            fflush(stdout); /* a caller then sees which vector the decoder crashes at */
        }
        if (e[i].descriptor != NULL)
            judge(capabilities, e[i].descriptor, &file, &v);
        if (o->validate && v.outcome == CONF_PASS)
            judge_validator(e[i].descriptor, &file, &v);
        if (o->ways && v.outcome == CONF_PASS)
            judge_ways(e[i].descriptor, &file, &v);
        n_run++;
        if (v.outcome != CONF_PASS) {
            n_bad++;
            printf("%s: %s: %s\n", conf_outcome_name[v.outcome], e[i].id, v.reason);
        }
        conf_free(&file);
    }
    printf("%zu run, %zu failed\n", n_run, n_bad);
    conf_suite_free(e, n);
    json_decref(capabilities);
    return n_bad > 0 || n_run == 0;
}
