/* validate_case.h - collects the findings of a validator, asserts what holds for every byte string
 * (spec 3.6), and makes scenes to write files of. For test_validate.c and test_advise.c.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_VALIDATE_CASE_H
#define TED4_VALIDATE_CASE_H

#include "fuzz/counting.h"
#include "fuzz/fix_hashes.h"
#include "norm/coder.h"
#include "random_scene.h"
#include "read/collect.h"
#include "read/finding.h"
#include "test.h"

enum { MOST_FINDINGS = 400 };

/* The findings of a validator. */
typedef struct {
    ted4_finding list[MOST_FINDINGS];
    int n, errors;
} findings;

static inline void keep(void *user, const ted4_finding *f)
{
    findings *all = user;

    assert_true(all->n < MOST_FINDINGS);
    assert_non_null(f->id);
    assert_non_null(f->text);
    assert_non_null(f->rule);
    assert_int_equal(strncmp(f->rule, "R-", 2), 0);
    assert_int_equal(strlen(f->rule), 9);
    all->errors += f->severity == TED4_ERROR;
    assert_int_equal(f->severity == TED4_ERROR, strncmp(f->id, "adv.", 4) != 0);
    all->list[all->n++] = *f;
}

#define ANYWHERE SIZE_MAX

/* Returns the number of findings with this id at this offset. */
static inline int has(const findings *all, const char *id, size_t offset)
{
    int n = 0;

    for (int i = 0; i < all->n; i++)
        n += strcmp(all->list[i].id, id) == 0 &&
             (offset == ANYWHERE || all->list[i].offset == offset);
    return n;
}

/* Validates, and asserts what holds for every byte string. */
static inline findings *validate(const uint8_t *data, size_t size)
{
    static findings all;
    counting_memory memory = { 0 };
    ted4_options o = { .allocator = counting_allocator(&memory) };
    ted4_scene *s;
    ted4_error e;
    const ted4_status verdict = ted4_decode(data, size, &o, &s, &e);

    all.n = all.errors = 0;
    assert_int_equal(ted4_validate(data, size, &o, keep, &all), verdict);
    assert_int_equal(all.errors > 0, verdict != TED4_OK);
    if (verdict != TED4_OK) {
        assert_string_equal(all.list[0].id, ted4_status_id(e.code));
        assert_int_equal(all.list[0].offset, e.offset);
    }
    for (int i = 0; i < all.n; i++) {
        assert_true(all.list[i].offset <= size);
        if (all.list[i].severity == TED4_ERROR)
            assert_int_equal(has(&all, all.list[i].id, all.list[i].offset), 1);
    }
    if (ted4_status_verdict(verdict) == TED4_INVALID) {
        static findings alone;
        ted4_findings f = {
            .data = data, .size = size, .sink = keep, .user = &alone, .verdict = e
        };

        alone.n = alone.errors = 0;
        assert_int_equal(ted4_collect(&f, &o), TED4_OK);
        assert_true(f.found);
        assert_int_equal(alone.errors + 1, all.errors);
    }
    ted4_scene_free(s);
    assert_int_equal(memory.held, 0);
    return &all;
}

static inline uint8_t *encoded(const ted4_scene *s, int level, size_t *size)
{
    uint8_t *data = NULL;

    assert_int_equal(ted4_encode(s, level, NULL, &data, size, NULL), TED4_OK);
    return data;
}

static inline size_t chunk_at(const uint8_t *data, size_t size, const char *type, int number)
{
    for (size_t at = 12; at < size; at += ted4_chunk_size(data, size, at))
        if (memcmp(data + at, type, 4) == 0 && number-- == 0)
            return at;
    fail();
    return 0;
}

/* A scene that gives no reason for a finding of R-ENC-004. */
static inline ted4_scene *useful(uint64_t seed, const ted4_header *h)
{
    random_source r = random_seed(seed);
    ted4_scene *s = random_scene_of(&r, h, 0);

    assert_non_null(s);
    for (size_t i = 0; i < h->n_anchors; i++)
        if (s->offset_bits[i] == 0)
            s->offset_bits[i] = 1;
    for (size_t i = 0; h->activation && i < h->n_anchors; i++)
        if (s->symbol[TED4_TAU][i] <= 0)
            s->symbol[TED4_TAU][i] = 1;
    random_tidy(s);
    return s;
}

#endif
