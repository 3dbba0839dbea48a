/* ways.c - see ways.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "ways.h"

#include <stdlib.h>
#include <string.h>
#include "memory_bound.h"
#include "norm/scene.h"

/* The reference decoder decodes at most so many tiles at the same time (spec 13.3). */
enum { MOST_TILES = 16 };

/* The result of decoding a file. A hash is 0 if there is nothing to hash. */
typedef struct {
    ted4_salvage what;
    uint8_t scene[16], copy[16], records[16];
} outcome;

/* Stands in for a caller's threads: processes the last index first. */
static void backwards(void *user, size_t n, void (*body)(void *arg, size_t i), void *arg)
{
    (void)user;
    while (n-- > 0)
        body(arg, n);
}

static void on_element(void *user, size_t offset, const char *element, int64_t index, int64_t value)
{
    (void)user, (void)offset, (void)element, (void)index, (void)value;
}

static void throw_away(void *user, const void *bytes, size_t size)
{
    (void)user, (void)bytes, (void)size;
}

static void overhear(void *user, const ted4_finding *f)
{
    (void)user, (void)f;
}

static void take_records(const ted4_scene *s, const ted4_parallel *threads, outcome *r)
{
    const ted4_options o = { .parallel = threads, .max_work = UINT64_MAX };
    const ted4_query q = { 0, 1, { 0, 0, 0 } };
    ted4_recon *recon;
    ted4_gaussians g;

    if (ted4_recon_new(&recon, s, threads != NULL ? &o : NULL) != TED4_OK)
        conf_die("no memory");
    if (ted4_recon_query(recon, &q, threads, &g) == TED4_OK)
        ted4_gaussians_hash(&g, r->records);
    ted4_recon_free(recon);
}

/* Copies the integers into a scene as encoders fill it, and hashes it (15.2). */
static void take_copy(const ted4_scene *s, outcome *r)
{
    const size_t n = s->head.n_anchors;
    ted4_scene *const copy = ted4_scene_new(&s->head, NULL);

    if (copy == NULL)
        conf_die("no memory");
    memcpy(copy->position, s->position, 3 * n * sizeof *s->position);
    memcpy(copy->dynamic, s->dynamic, n);
    memcpy(copy->offset_bits, s->offset_bits, n * sizeof *s->offset_bits);
    for (int t = 0; t < TED4_TYPES; t++)
        if (s->shape.dim[t] > 0) {
            memcpy(copy->step_index[t], s->step_index[t], n);
            memcpy(copy->symbol[t], s->symbol[t], n * s->shape.dim[t] * sizeof *s->symbol[t]);
        }
    ted4_scene_hash(copy, r->copy);
    ted4_scene_free(copy);
}

static outcome decode(const conf_bytes *file, const ted4_options *o)
{
    const ted4_parallel *const threads = o != NULL ? o->parallel : NULL;
    outcome r = { .scene = { 0 } };
    ted4_scene *s;
    ted4_info info;

    (void)ted4_decode_lenient(file->data, file->size, o, &s, &r.what);
    if (s == NULL)
        return r;
    ted4_scene_info(s, &info);
    memcpy(r.scene, info.hash, sizeof r.scene);
    take_copy(s, &r);
    take_records(s, threads, &r);
    ted4_scene_free(s);
    return r;
}

static int same_error(ted4_error a, ted4_error b)
{
    return a.code == b.code && a.offset == b.offset;
}

static int same(const outcome *a, const outcome *b)
{
    return same_error(a->what.verdict, b->what.verdict) && same_error(a->what.stop, b->what.stop) &&
           a->what.n_tiles == b->what.n_tiles && a->what.tiles_declared == b->what.tiles_declared &&
           a->what.anchors_declared == b->what.anchors_declared &&
           memcmp(a->scene, b->scene, sizeof a->scene) == 0 &&
           memcmp(a->records, b->records, sizeof a->records) == 0;
}

/* Checks that the verdict is the same without an error report, and that tiers, advice and salvage
 * work with these options or without any. */
static int verdict_stays(const conf_bytes *file, const ted4_options *o, ted4_status verdict)
{
    ted4_scene *s;
    ted4_error e;
    int good = ted4_decode(file->data, file->size, o, &s, NULL) == verdict;

    ted4_scene_free(s);
    return good && ted4_validate(file->data, file->size, o, overhear, NULL) == verdict &&
           ted4_dump_syntax(file->data, file->size, o, throw_away, NULL, &e) == verdict;
}

/* An allocator that keeps count, in bytes: of what is held, and of the most that was held or asked
 * for. What is too much for any vector is refused. */
typedef struct {
    uint64_t held, most;
} meter;

enum { METER_HEADER = 16, METER_MOST = 1 << 30 };

static void *meter_alloc(void *user, size_t size)
{
    meter *const m = user;
    char *p;

    m->most = m->held + size > m->most ? m->held + size : m->most;
    if (size > METER_MOST || (p = malloc(size + METER_HEADER)) == NULL)
        return NULL;
    memcpy(p, &size, sizeof size);
    m->held += size;
    return p + METER_HEADER;
}

static void meter_free(void *user, void *p)
{
    meter *const m = user;
    size_t size;

    memcpy(&size, (char *)p - METER_HEADER, sizeof size);
    m->held -= size;
    free((char *)p - METER_HEADER);
}

/* Returns 1 if decoding the file, with the caller's threads (or NULL), takes no more memory than
 * spec 13.3 allows, and neither does the query of a valid file. */
static int memory_holds(const conf_bytes *file, const ted4_parallel *threads)
{
    static const ted4_query q = { 0, 1, { 0, 0, 0 } };
    meter memory = { 0, 0 };
    const ted4_options o = { .allocator = { meter_alloc, meter_free, &memory },
                             .parallel = threads,
                             .max_bytes = UINT64_MAX };
    uint64_t n_values, n_tiles;
    ted4_recon *recon;
    ted4_gaussians g;
    ted4_info info;
    ted4_scene *s;
    int good;

    if (ted4_decode(file->data, file->size, &o, &s, NULL) != TED4_OK)
        return threads != NULL || memory.most <= conf_memory_paid(file->size);
    n_values = s->nete.n + s->netr.n + s->bank.n;
    n_tiles = threads == NULL ? 1 : s->shape.n_tiles < MOST_TILES ? s->shape.n_tiles : MOST_TILES;
    good = memory.most <= conf_memory_decode(&s->head, file->size, n_values, n_tiles);
    memory.most = memory.held = 0;
    ted4_scene_info(s, &info);
    if (ted4_recon_new(&recon, s, &o) != TED4_OK)
        conf_die("no memory");
    (void)ted4_recon_query(recon, &q, threads, &g);
    good &= memory.most <= conf_memory_query(&s->head, n_values, info.n_gaussians);
    ted4_recon_free(recon);
    ted4_scene_free(s);
    return good;
}

const char *conf_ways_differ(const conf_bytes *file, conf_knobs knobs)
{
    static const ted4_parallel threads = { backwards, NULL };
    ted4_options o = { .max_bytes = knobs.memory, .max_work = knobs.work };
    const outcome plain = decode(file, &o);
    outcome other;

    if (memcmp(plain.scene, plain.copy, sizeof plain.scene) != 0)
        return "of a copy";
    o.trace = on_element;
    other = decode(file, &o);
    if (!same(&plain, &other))
        return "with a trace";
    o.trace = NULL;
    o.parallel = &threads;
    other = decode(file, &o);
    if (knobs.memory == 0 && !same(&plain, &other)) /* threads need more memory */
        return "with threads";
    if (knobs.memory > 0 || knobs.work > 0)
        return NULL;
    if (!memory_holds(file, NULL) || !memory_holds(file, &threads))
        return "about memory";
    other = decode(file, NULL);
    return !same(&plain, &other) ? "without options"
           : !verdict_stays(file, &o, plain.what.verdict.code) ||
                   !verdict_stays(file, NULL, plain.what.verdict.code)
               ? "by another function"
               : NULL;
}
