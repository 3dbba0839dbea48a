/* test_spec_resources.c - the formulas of spec 13.3 and 13.4, as the text prints them, compared
 * with what decoding and queries use: a budget of M_E and M_R is enough; W_E and W_R are exactly
 * the work that is compared with a limit; and the elements of HEAD are traced with the order, width
 * and name in the table of 6.1, all others under names of annex J.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "spec_model.h" /* before cmocka, whose fail() is a macro */
#include <stdio.h>

#include "test.h"
#include "random_scene.h"
#include "tool/threads.h"

enum { N_SCENES = 30, N_PAPER = 1000, REFERENCE_TILES = 16 };

static uint8_t *encoded(const ted4_scene *s, size_t *size)
{
    uint8_t *data = NULL;

    assert_int_equal(ted4_encode(s, 0, NULL, &data, size, NULL), TED4_OK);
    return data;
}

/* Decodes and queries a scene under memory budgets that follow from its header. */
static void fits(const uint8_t *data, size_t size, const ted4_parallel *p, uint64_t tiles)
{
    spec_model m = { .n_blocks = 0 };
    ted4_options o = { .parallel = p };
    ted4_scene *s;
    ted4_recon *r;
    ted4_info info;
    uint64_t v;

    spec_model_decode(&m, data, size);
    assert_null(m.p.v.id);
    v = m.p.n_nete + m.p.n_netr + m.p.n_bank;
    o.max_bytes = memory_e(&m.p.s.h, size, v, tiles < m.p.n_tiles ? tiles : m.p.n_tiles);
    assert_int_equal(ted4_decode(data, size, &o, &s, NULL), TED4_OK);
    ted4_scene_info(s, &info);
    o.max_bytes = memory_r(&m.p.s.h, v, info.n_gaussians);
    assert_int_equal(ted4_recon_new(&r, s, &o), TED4_OK);
    ted4_recon_free(r);
    ted4_scene_free(s);
    spec_model_free(&m);
}

static void memory(void **state)
{
    random_source r = random_seed(7);
    const ted4_header paper = random_paper_header(N_PAPER);
    ted4_parallel p;

    (void)state;
    ted4_threads_init(&p, 2);
    for (uint64_t seed = 0; seed <= N_SCENES; seed++) {
        ted4_scene *s = seed < N_SCENES ? random_scene(seed) : random_scene_of(&r, &paper, 0);
        size_t size;
        uint8_t *data = encoded(s, &size);

        fits(data, size, NULL, 1);
        fits(data, size, &p, REFERENCE_TILES);
        ted4_scene_free(s);
        free(data);
    }
    ted4_threads_finish(&p);
}

/* Decodes and queries a scene under limits on work that follow from its header. */
static void works(const uint8_t *data, size_t size)
{
    spec_model m = { .n_blocks = 0 };
    ted4_options o = { .max_work = 0 };
    uint64_t a_e = 0, a_r = 0, least;
    ted4_scene *s;
    ted4_recon *r;
    ted4_error e;
    ted4_info info;

    spec_model_decode(&m, data, size);
    for (int i = 0; i < m.p.s.h.n_slices; i++)
        a_e += spec_products(&m.p.net_e[i]);
    for (int i = 0; i < NETS_R; i++)
        a_r += spec_products(&m.p.net_r[i]);
    least = work_e(&m.p.s.h, size, m.p.n_nete + m.p.n_netr + m.p.n_bank, a_e);
    o.max_work = least - 1;
    assert_int_equal(ted4_decode(data, size, &o, &s, &e), TED4_E_LIMIT_WORK);
    assert_null(s);
    o.max_work = least;
    assert_int_equal(ted4_decode(data, size, &o, &s, &e), TED4_OK);
    ted4_scene_info(s, &info);
    least = work_r(&m.p.s.h, a_r, info.n_gaussians);
    o.max_work = least - 1;
    assert_int_equal(ted4_recon_new(&r, s, &o), TED4_E_LIMIT_WORK);
    assert_null(r);
    o.max_work = least;
    assert_int_equal(ted4_recon_new(&r, s, &o), TED4_OK);
    ted4_recon_free(r);
    ted4_scene_free(s);
    spec_model_free(&m);
}

static void work(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < N_SCENES; seed++) {
        ted4_scene *s = random_scene(seed);
        size_t size;
        uint8_t *data = encoded(s, &size);

        works(data, size);
        ted4_scene_free(s);
        free(data);
    }
}

/* Elements of HEAD as 6.1 lists them for one header. */
typedef struct {
    const char *name;
    int64_t index;
    size_t width;
} head_element;

enum { MAX_HEAD = 96 };

static size_t head_elements(const struct header *h, head_element *e)
{
    size_t n = 0;

#define ELEMENT(element, count, bytes, is_signed, low, high, conditional, condition, level) \
    for (int64_t i = 0; i < (count); i++)                                                   \
        e[n++] = (head_element) { #element, i, bytes };
#define REAL(element, count, bounded)     \
    for (int64_t i = 0; i < (count); i++) \
        e[n++] = (head_element) { #element, i, 4 };
#include "spec/head.inc"
#undef ELEMENT
#undef REAL
    return n;
}

/* The elements that the decoder traces, which are compared with the tables. */
typedef struct {
    const head_element *head;
    size_t n_head, seen, next_at;
    int in_head, good;
} traced;

static int in_annex_j(const char *name)
{
    static const char *const known[] = {
#define ID(element, number) #element,
#include "spec/elements.inc"
#undef ID
    };

    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (strcmp(known[i], name) == 0)
            return 1;
    return 0;
}

static void hold(void *user, size_t at, const char *name, int64_t index, int64_t value)
{
    traced *t = user;

    (void)value;
    t->good &= in_annex_j(name);
    if (strcmp(name, "chunk_size") == 0 && t->seen == 0) {
        t->in_head = 1;
        t->next_at = at + 4;
        return;
    }
    if (strcmp(name, "chunk_hash") == 0)
        t->in_head = 0;
    if (!t->in_head)
        return;
    if (t->seen < t->n_head) {
        const head_element *e = &t->head[t->seen];

        t->good &= strcmp(e->name, name) == 0 && e->index == index && at == t->next_at;
        t->next_at += e->width;
    }
    t->seen++;
}

static void syntax(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < N_SCENES; seed++) {
        head_element head[MAX_HEAD];
        traced t = { .head = head, .good = 1 };
        spec_model m = { .n_blocks = 0 };
        ted4_options o = { .trace = hold, .trace_user = &t };
        ted4_scene *s = random_scene(seed), *back;
        size_t size;
        uint8_t *data = encoded(s, &size);

        spec_model_decode(&m, data, size);
        t.n_head = head_elements(&m.p.s.h, head);
        assert_int_equal(ted4_decode(data, size, &o, &back, NULL), TED4_OK);
        assert_true(t.good);
        assert_int_equal(t.seen, t.n_head);
        spec_model_free(&m);
        ted4_scene_free(back);
        ted4_scene_free(s);
        free(data);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(memory), cmocka_unit_test(work),
                                        cmocka_unit_test(syntax) };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
