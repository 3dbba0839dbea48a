/* callers.c - see callers.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "callers.h"

#include <string.h>

enum { CALLERS = 4 };

/* The last is the first again: by then a ted4_recon has computed other times and directions. */
static const ted4_query QUERIES[] = {
    { 0, 1, { 0, 0, 0 } },
    { 1, 2, { 1, -2, 3 } },
    { 1, 1, { -4, 0.5f, 0.25f } },
    { 0, 1, { 0, 0, 0 } },
};

enum { ASKED = sizeof QUERIES / sizeof QUERIES[0] };

/* What a caller gets. A hash is 0 if there is nothing to hash. */
typedef struct {
    ted4_error verdict;
    uint8_t scene[16], records[ASKED][16];
    ted4_status status[ASKED];
} outcome;

/* threads: lent to the library, or NULL. */
static void ask(const ted4_scene *s, const ted4_parallel *threads, outcome *r)
{
    const ted4_options o = { .parallel = threads, .max_work = UINT64_MAX };
    ted4_recon *recon;
    ted4_gaussians g;

    if (ted4_recon_new(&recon, s, &o) != TED4_OK)
        conf_die("no memory");
    for (int i = 0; i < ASKED; i++)
        if ((r->status[i] = ted4_recon_query(recon, &QUERIES[i], threads, &g)) == TED4_OK)
            ted4_gaussians_hash(&g, r->records[i]);
    ted4_recon_free(recon);
}

/* Decodes and asks. The caller frees *s, which is NULL unless the file is valid. */
static void decode(const conf_bytes *file, conf_knobs knobs, const ted4_parallel *threads,
                   ted4_scene **s, outcome *r)
{
    const ted4_options o = { .max_bytes = knobs.memory,
                             .max_work = knobs.work,
                             .parallel = threads };
    ted4_info info;

    memset(r, 0, sizeof *r);
    (void)ted4_decode(file->data, file->size, &o, s, &r->verdict);
    if (*s == NULL)
        return;
    ted4_scene_info(*s, &info);
    memcpy(r->scene, info.hash, sizeof r->scene);
    ask(*s, threads, r);
}

static int same(const outcome *a, const outcome *b)
{
    return a->verdict.code == b->verdict.code && a->verdict.offset == b->verdict.offset &&
           memcmp(a->scene, b->scene, sizeof a->scene) == 0 &&
           memcmp(a->status, b->status, sizeof a->status) == 0 &&
           memcmp(a->records, b->records, sizeof a->records) == 0;
}

typedef struct {
    const conf_bytes *file;
    conf_knobs knobs;
    const ted4_scene *shared;
    outcome result[CALLERS];
} job;

static void decode_alone(void *arg, size_t i)
{
    job *j = arg;
    ted4_scene *s;

    decode(j->file, j->knobs, NULL, &s, &j->result[i]);
    ted4_scene_free(s);
}

static void ask_shared(void *arg, size_t i)
{
    job *j = arg;

    ask(j->shared, NULL, &j->result[i]);
}

static int all_same(const job *j, const outcome *expected)
{
    for (int i = 0; i < CALLERS; i++)
        if (!same(&j->result[i], expected))
            return 0;
    return 1;
}

/* A scene of expected: each caller has a ted4_recon of its own made of it. */
static int same_when_shared(const ted4_scene *s, const outcome *expected, const ted4_parallel *team)
{
    job j = { .shared = s };

    for (int i = 0; i < CALLERS; i++) {
        j.result[i].verdict = expected->verdict;
        memcpy(j.result[i].scene, expected->scene, sizeof expected->scene);
    }
    ted4_parallel_for(team, CALLERS, ask_shared, &j);
    return all_same(&j, expected);
}

const char *conf_callers_differ(const conf_bytes *file, conf_knobs knobs, const ted4_parallel *team)
{
    job j = { .file = file, .knobs = knobs };
    outcome plain, lent;
    ted4_scene *s;
    int good;

    decode(file, knobs, NULL, &s, &plain);
    good = s == NULL || same_when_shared(s, &plain, team);
    ted4_scene_free(s);
    if (!good)
        return "when several callers ask one scene";
    ted4_parallel_for(team, CALLERS, decode_alone, &j);
    if (!all_same(&j, &plain))
        return "when several callers decode at once";
    if (knobs.memory > 0) /* threads need more memory */
        return NULL;
    decode(file, knobs, team, &s, &lent);
    ted4_scene_free(s);
    return same(&lent, &plain) ? NULL : "with threads of the caller";
}
