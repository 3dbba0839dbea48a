/* replay.c - see replay.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "replay.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "answer.h"
#include "callers.h"
#include "judge.h"
#include "ways.h"
#include "tool/threads.h"

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

/* team: threads, or NULL: other options instead. */
static void judge_ways(const json_t *d, const conf_bytes *file, const ted4_parallel *team,
                       conf_verdict *v)
{
    const conf_knobs knobs = conf_knobs_of(d);
    const char *const way = team != NULL ? conf_callers_differ(file, knobs, team)
                                         : conf_ways_differ(file, knobs);

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

/* Reads the file of a vector. Returns 1; 0 if it is made on demand and not stored; or -1, with the
 * verdict filled, if the vector cannot be judged. */
static int fetch(const conf_entry *e, conf_bytes *file, conf_verdict *v)
{
    *v = (conf_verdict) { CONF_MISSING, "no descriptor" };
    if (e->descriptor == NULL)
        return -1;
    if (conf_read(e->file, file))
        return 1;
    if (json_object_get(e->descriptor, "demand") != NULL)
        return 0;
    snprintf(v->reason, sizeof v->reason, "%.300s is not there", e->file);
    return -1;
}

/* team: NULL if only one thread is asked for. */
static void judge_one(const conf_replay_options *o, const ted4_parallel *team,
                      const json_t *capabilities, const json_t *d, const conf_bytes *file,
                      conf_verdict *v)
{
    judge(capabilities, d, file, v);
    if (o->validate && v->outcome == CONF_PASS)
        judge_validator(d, file, v);
    if (o->ways && v->outcome == CONF_PASS)
        judge_ways(d, file, NULL, v);
    if (team != NULL && v->outcome == CONF_PASS)
        judge_ways(d, file, team, v);
}

int conf_replay(const conf_replay_options *o)
{
    json_t *capabilities = json_pack("{s:i, s:[s,s,s,s,s,s], s:s, s:[], s:[s,s]}", "max_level", 31,
                                     "tiers", "T0", "T1", "T2", "T3", "T4", "T5", "class", "X",
                                     "declines", "knobs", "max_alloc_total", "max_work");
    char path[CONF_PATH];
    ted4_parallel team;
    conf_entry *e;
    size_t n, n_bad = 0, n_run = 0;

    ted4_threads_init(&team, o->threads > 0 ? o->threads : 1);
    conf_path(path, "%s/vectors", o->suite);
    e = conf_suite_load(path, o->list, &n);
    if (n > 0)
        qsort(e, n, sizeof *e, by_size); /* small files first */
    for (size_t i = 0; i < n && !(o->stop && n_bad > 0); i++) {
        conf_verdict v;
        conf_bytes file = { NULL, 0, 0 };
        const int there = fetch(&e[i], &file, &v);

        if (there == 0)
            continue;
        if (o->names) {
            printf("at %s\n", e[i].id);
            fflush(stdout); /* a caller then sees which vector the decoder crashes at */
        }
        if (there > 0)
            judge_one(o, o->threads > 1 ? &team : NULL, capabilities, e[i].descriptor, &file, &v);
        n_run++;
        if (v.outcome != CONF_PASS) {
            n_bad++;
            printf("%s: %s: %s\n", conf_outcome_name[v.outcome], e[i].id, v.reason);
        }
        conf_free(&file);
    }
    ted4_threads_finish(&team);
    conf_suite_free(e, n);
    json_decref(capabilities);
    if (n_run == 0)
        conf_die("%s: no vector has a file", path);
    printf("%zu run, %zu failed\n", n_run, n_bad);
    return n_bad > 0;
}
