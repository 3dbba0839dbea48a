/* test_recon.c - spec 11, 12.2, 15.3: reconstruction compared with recon_ref.h, bit for bit, in
 * every variant of the header; and with doubles; for any threads, any order of queries, any memory.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

#include "test.h"
#include "base/level.h"
#include "tool/threads.h"
#include "odd_threads.h"
#include "use_kernels.h"
#include "recon_ref.h"
#include "recon_scene.h"

enum { MAX_RECORDS = 4096 };

/* The first four are the states of a cache: new, another time, another camera, the same again. */
static const ted4_query queries[] = {
    { 0, 7, { 0.5f, -2.0f, 3.0f } },
    { 3, 7, { 0.5f, -2.0f, 3.0f } },
    { 3, 7, { -1.5f, 0.25f, 0.125f } },
    { 3, 7, { -1.5f, 0.25f, 0.125f } },
    { 16777214, 16777215, { -1.5f, 0.25f, 0.125f } },
    { 7, 7, { 100.0f, 0.0f, -8.0f } },
};
enum { N_QUERIES = sizeof queries / sizeof queries[0] };

static double wanted[MAX_RECORDS * REF_VALUES];

static void get_record(const ted4_gaussians *g, size_t i, float *v)
{
    for (int c = 0; c < 3; c++) {
        v[c] = g->mean[c][i];
        v[3 + c] = g->scale[c][i];
        v[11 + c] = g->colour[c][i];
    }
    for (int c = 0; c < 4; c++)
        v[6 + c] = g->rot[c][i];
    v[10] = g->opacity[i];
}

static void assert_same_bits(const ted4_gaussians *g, size_t n)
{
    assert_int_equal(g->n, n);
    for (size_t i = 0; i < n; i++) {
        float got[REF_VALUES];

        get_record(g, i, got);
        for (int c = 0; c < REF_VALUES; c++)
            assert_int_equal(ted4_float_bits(got[c]),
                             ted4_float_bits((float)wanted[i * REF_VALUES + c]));
    }
}

static void assert_near(const ted4_gaussians *g, size_t n)
{
    assert_int_equal(g->n, n);
    for (size_t i = 0; i < n; i++) {
        float got[REF_VALUES];

        get_record(g, i, got);
        for (int c = 0; c < REF_VALUES; c++) {
            const double want = wanted[i * REF_VALUES + c];

            assert_true(fabs((double)got[c] - want) <= 1e-4 * ref_max(1, fabs(want)));
        }
    }
}

static ted4_header base_header(void)
{
    ted4_header h = { .n_anchors = 75,
                      .tile_size = 64,
                      .n_offsets = 3,
                      .feature_dim = 6,
                      .prior = TED4_PRIOR_FACTORISED,
                      .n_slices = 1,
                      .slice = { 6 },
                      .frames = 8,
                      .rate_num = 30,
                      .rate_den = 1,
                      .origin = { 1.5f, -20.25f, 0.3f },
                      .exponent = 2 };
    return h;
}

static void set_motion(ted4_header *h, int motion)
{
    h->motion = (uint8_t)motion;
    if (motion != TED4_MOTION_NONE) {
        h->deform_layers = 2;
        h->deform_width = 9;
    }
    if (motion == TED4_MOTION_BANK || motion == TED4_MOTION_CONCAT) {
        h->phi_dim = 3;
        h->bank_rows = 5;
        h->bank_dim = 7;
    }
}

/* Sets variant v of all combinations of settings that affect reconstruction. Returns 0 if there is
 * no variant v. */
static int variant(unsigned v, ted4_header *h)
{
    *h = base_header();
    set_motion(h, (int)(v % 4));
    h->view = (uint8_t)(v / 4 % 3);
    h->head_layers = (uint8_t)(v / 12 % 3);
    h->head_width = h->head_layers > 0 ? 11 : 0;
    h->activation = v / 36 % 2;
    h->scale_domain = v / 72 % 2;
    h->offset_mask = v / 144 % 2;
    h->temporal_mask = v / 288 % 2;
    h->exponent = (int8_t)(v % 7 - 3);
    return !(h->motion == TED4_MOTION_NONE && h->temporal_mask);
}

enum { N_VARIANTS = 576 };

/* A scene and its recon with the given options. */
static ted4_recon *start(struct ted4_scene *s, const ted4_header *h, uint64_t seed,
                         const ted4_options *o)
{
    ted4_recon *r;

    scene_make(s, h, seed);
    assert_int_equal(ted4_recon_new(&r, s, o), TED4_OK);
    return r;
}

static void every_variant_gives_the_bits_of_the_text(void **state)
{
    (void)state;
    for (unsigned v = 0; v < N_VARIANTS; v++) {
        struct ted4_scene s;
        ted4_header h;

        if (!variant(v, &h))
            continue;
        ted4_recon *r = start(&s, &h, v, NULL);

        for (int i = 0; i < N_QUERIES; i++) {
            ted4_gaussians g;

            assert_int_equal(ted4_recon_query(r, &queries[i], NULL, &g), TED4_OK);
            assert_same_bits(&g, ref_query(&s, &queries[i], 1, wanted));
        }
        ted4_recon_free(r);
        scene_finish(&s);
    }
}

static void every_variant_is_near_real_numbers(void **state)
{
    (void)state;
    for (unsigned v = 0; v < N_VARIANTS; v++) {
        struct ted4_scene s;
        ted4_header h;
        ted4_gaussians g;
        const ted4_query *q = &queries[v % N_QUERIES];

        if (!variant(v, &h))
            continue;
        ted4_recon *r = start(&s, &h, v + 1000, NULL);

        assert_int_equal(ted4_recon_query(r, q, NULL, &g), TED4_OK);
        assert_near(&g, ref_query(&s, q, 0, wanted));
        ted4_recon_free(r);
        scene_finish(&s);
    }
}

/* The sizes of a real file: tiles of the kernels, several blocks, 32 K records. */
static ted4_header large_header(void)
{
    ted4_header h = base_header();

    set_motion(&h, TED4_MOTION_BANK);
    h.n_anchors = 205;
    h.n_offsets = 10;
    h.feature_dim = h.slice[0] = 50;
    h.phi_dim = 8;
    h.bank_dim = h.deform_width = 65;
    h.temporal_mask = h.offset_mask = h.activation = 1;
    h.view = TED4_VIEW_FULL;
    h.head_layers = 1;
    h.head_width = 50;
    return h;
}

static void large_networks_give_the_bits_of_the_text(void **state)
{
    const ted4_header h = large_header();
    struct ted4_scene s;
    ted4_gaussians g;

    (void)state;
    ted4_recon *r = start(&s, &h, 3, NULL);

    assert_int_equal(ted4_recon_query(r, &queries[1], NULL, &g), TED4_OK);
    assert_same_bits(&g, ref_query(&s, &queries[1], 1, wanted));
    ted4_recon_free(r);
    scene_finish(&s);
}

static void threads_and_order_change_nothing(void **state)
{
    ted4_header h = large_header();
    ted4_parallel lenders[4] = { { odd_backwards, NULL } };
    uint8_t want[N_QUERIES][16], got[16];
    struct ted4_scene s;

    (void)state;
    h.n_anchors = 2000;
    for (int i = 1; i < 4; i++)
        ted4_threads_init(&lenders[i], i);
    ted4_recon *r = start(&s, &h, 5, NULL);

    for (int i = 0; i < N_QUERIES; i++) {
        ted4_gaussians g;

        assert_int_equal(ted4_recon_query(r, &queries[i], NULL, &g), TED4_OK);
        ted4_gaussians_hash(&g, want[i]);
    }
    ted4_recon_free(r);
    for (int i = 0; i < 4; i++) {
        const ted4_options o = { .parallel = &lenders[i] };

        assert_int_equal(ted4_recon_new(&r, &s, &o), TED4_OK);
        for (int k = N_QUERIES - 1; k >= 0; k--) {
            ted4_gaussians g;

            assert_int_equal(ted4_recon_query(r, &queries[k], &lenders[i], &g), TED4_OK);
            ted4_gaussians_hash(&g, got);
            assert_memory_equal(got, want[k], 16);
        }
        ted4_recon_free(r);
    }
    scene_finish(&s);
}

static void kernels_give_the_same_hash(void **state)
{
    const ted4_header h = large_header();
    uint8_t hash[TED4_LEVELS][16];
    struct ted4_scene s;

    (void)state;
    scene_make(&s, &h, 9);
    for (int level = TED4_LEVEL_PLAIN; level <= (int)ted4_level_of_machine(); level++) {
        ted4_recon *r;
        ted4_gaussians g;

        use_kernels(ted4_level_name((ted4_level)level));
        assert_int_equal(ted4_recon_new(&r, &s, NULL), TED4_OK);
        assert_int_equal(ted4_recon_query(r, &queries[2], NULL, &g), TED4_OK);
        ted4_gaussians_hash(&g, hash[level]);
        ted4_recon_free(r);
        assert_memory_equal(hash[level], hash[TED4_LEVEL_PLAIN], 16);
    }
    use_kernels(NULL);
    scene_finish(&s);
}

static void records_have_stable_ids(void **state)
{
    ted4_header h = large_header();
    struct ted4_scene s;
    ted4_gaussians g;
    size_t n = 0;

    (void)state;
    ted4_recon *r = start(&s, &h, 11, NULL);

    assert_int_equal(ted4_recon_query(r, &queries[0], NULL, &g), TED4_OK);
    for (uint32_t i = 0; i < h.n_anchors; i++)
        for (uint32_t k = 0; k < h.n_offsets; k++)
            if (s.offset_bits[i] >> k & 1)
                assert_int_equal(g.id[n++], i * h.n_offsets + k);
    assert_int_equal(g.n, n);
    ted4_recon_free(r);
    scene_finish(&s);
}

static void no_record_at_all(void **state)
{
    ted4_header h = base_header();
    struct ted4_scene s;
    ted4_gaussians g;
    ted4_recon *r;

    (void)state;
    h.offset_mask = 1;
    scene_make(&s, &h, 1);
    memset(s.offset_bits, 0, h.n_anchors * sizeof *s.offset_bits);
    assert_int_equal(ted4_recon_new(&r, &s, NULL), TED4_OK);
    assert_int_equal(ted4_recon_query(r, &queries[0], NULL, &g), TED4_OK);
    assert_int_equal(g.n, 0);
    ted4_recon_free(r);
    scene_finish(&s);
}

/* R-REC-001. Each head in turn gets a bias that makes one record of one offset infinite or NaN. */
static void what_is_not_finite_is_refused(void **state)
{
    (void)state;
    for (int net = TED4_NET_DEFORM; net < TED4_NETS_R; net++) {
        ted4_header h = base_header();
        struct ted4_scene s;
        ted4_recon *r;
        ted4_gaussians g;

        set_motion(&h, TED4_MOTION_CONCAT);
        h.view = TED4_VIEW_FULL;
        h.head_layers = 1;
        h.head_width = 4;
        scene_make(&s, &h, 17);
        const ted4_net_shape *n = &s.shape.netr[net];
        float *w = s.netr.values + n->first, *b1 = w + n->dim[0] * n->dim[1];

        /* Hidden units of 1e38 give infinity minus infinity in one output. */
        for (unsigned i = 0; i < n->dim[1]; i++)
            b1[i] = 1e38f;
        float *last = b1 + n->dim[1];

        for (unsigned l = 1; l + 1 < n->n_layers; l++)
            last += (n->dim[l] + 1) * n->dim[l + 1];
        last[0] = 1e38f;
        last[1] = -1e38f;
        assert_int_equal(ted4_recon_new(&r, &s, NULL), TED4_OK);
        for (int again = 0; again < 2; again++) {
            assert_int_equal(ted4_recon_query(r, &queries[0], NULL, &g), TED4_E_REC_NONFINITE);
            assert_int_equal(g.n, 0);
        }
        ted4_recon_free(r);
        scene_finish(&s);
    }
}

/* A query that failed must leave no stale records. */
static void a_good_query_may_follow_a_bad_one(void **state)
{
    ted4_header h = base_header();
    ted4_query bad = queries[0];
    struct ted4_scene s;
    ted4_gaussians g;

    (void)state;
    h.view = TED4_VIEW_COLOUR;
    bad.camera[1] = NAN;
    ted4_recon *r = start(&s, &h, 19, NULL);

    assert_int_equal(ted4_recon_query(r, &queries[0], NULL, &g), TED4_OK);
    assert_int_equal(ted4_recon_query(r, &bad, NULL, &g), TED4_E_REC_NONFINITE);
    assert_int_equal(ted4_recon_query(r, &queries[1], NULL, &g), TED4_OK);
    assert_same_bits(&g, ref_query(&s, &queries[1], 1, wanted));
    ted4_recon_free(r);
    scene_finish(&s);
}

/* A camera at an anchor has no direction: (0, 0, 1). Covariance weights of 0 have no rotation: (1,
 * 0, 0, 0). */
static void directions_and_rotations_of_no_length(void **state)
{
    ted4_header h = base_header();
    ted4_query q = queries[0];
    struct ted4_scene s;
    ted4_gaussians g;
    ted4_recon *r;

    (void)state;
    h.view = TED4_VIEW_FULL;
    memset(h.origin, 0, sizeof h.origin);
    scene_make(&s, &h, 23);
    for (int c = 0; c < 3; c++)
        q.camera[c] = 4 * ted4_half_to_float(s.position[3 * 40 + c]);
    for (unsigned c = 3; c < 7; c++)
        memset(s.netr.values + s.shape.netr[TED4_NET_COVARIANCE].first + c * 9, 0,
               9 * sizeof(float));
    memset(s.netr.values + s.shape.netr[TED4_NET_COVARIANCE].first + 9 * 21 + 3, 0,
           4 * sizeof(float));
    assert_int_equal(ted4_recon_new(&r, &s, NULL), TED4_OK);
    assert_int_equal(ted4_recon_query(r, &q, NULL, &g), TED4_OK);
    assert_same_bits(&g, ref_query(&s, &q, 1, wanted));
    assert_true(g.rot[0][0] == 1);
    assert_true(g.rot[1][0] == 0);
    assert_true(g.rot[2][0] == 0);
    assert_true(g.rot[3][0] == 0);
    ted4_recon_free(r);
    scene_finish(&s);
}

static void times_out_of_range_are_refused(void **state)
{
    static const struct {
        uint32_t num, den;
        ted4_status want;
    } cases[] = {
        { 0, 0, TED4_E_QUERY },
        { 2, 1, TED4_E_QUERY },
        { 0, 1u << 24, TED4_E_QUERY },
        { 0, UINT32_MAX, TED4_E_QUERY },
        { (1u << 24) - 1, (1u << 24) - 1, TED4_OK },
        { 1, 1, TED4_OK },
    };
    const ted4_header h = base_header();
    struct ted4_scene s;
    ted4_recon *r = start(&s, &h, 29, NULL);

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const ted4_query q = { cases[i].num, cases[i].den, { 0, 0, 0 } };
        ted4_gaussians g;

        assert_int_equal(ted4_recon_query(r, &q, NULL, &g), cases[i].want);
    }
    ted4_recon_free(r);
    scene_finish(&s);
}

/* An allocator that fails after a number of blocks and counts the blocks in use. */
typedef struct {
    long left, out;
} counter;

static void *count_alloc(void *user, size_t size)
{
    counter *c = user;

    if (c->left-- <= 0)
        return NULL;
    c->out++;
    return malloc(size);
}

static void count_free(void *user, void *p)
{
    counter *c = user;

    c->out--;
    free(p);
}

static void memory_that_runs_out_is_given_back(void **state)
{
    const ted4_header h = large_header();
    struct ted4_scene s;
    counter c = { 0, 0 };
    ted4_status last = TED4_E_LIMIT_MEMORY;

    (void)state;
    scene_make(&s, &h, 31);
    for (long n = 0; last != TED4_OK && n < 1000; n++) {
        const ted4_options o = { .allocator = { count_alloc, count_free, &c } };
        ted4_recon *r;

        c = (counter) { n, 0 };
        last = ted4_recon_new(&r, &s, &o);
        assert_true(last == TED4_OK || (last == TED4_E_LIMIT_MEMORY && r == NULL));
        ted4_recon_free(r);
        assert_int_equal(c.out, 0);
    }
    assert_int_equal(last, TED4_OK);
    scene_finish(&s);
}

static void a_budget_is_kept(void **state)
{
    const ted4_header h = large_header();
    const ted4_options o = { .max_bytes = 200000 };
    struct ted4_scene s;
    ted4_recon *r;

    (void)state;
    scene_make(&s, &h, 37);
    assert_int_equal(ted4_recon_new(&r, &s, &o), TED4_E_LIMIT_MEMORY);
    assert_null(r);
    scene_finish(&s);
}

static void hash_is_that_of_little_endian_records(void **state)
{
    static const uint8_t empty[16] = { 0x99, 0xaa, 0x06, 0xd3, 0x01, 0x47, 0x98, 0xd8,
                                       0x60, 0x01, 0xc3, 0x24, 0x46, 0x8d, 0x49, 0x7f };
    enum { N = 200 };
    static float value[REF_VALUES][N];
    static uint8_t bytes[N * REF_VALUES * 4];
    ted4_gaussians g = { .n = 0 };
    XXH128_canonical_t want;
    uint8_t got[16];

    (void)state;
    for (size_t i = 0; i < N; i++)
        for (size_t c = 0; c < REF_VALUES; c++) {
            value[c][i] = (float)(i * 16 + c) * 0.1f;
            ted4_store32(bytes + 4 * (i * REF_VALUES + c), ted4_float_bits(value[c][i]));
        }
    ted4_gaussians_hash(&g, got);
    assert_memory_equal(got, empty, 16);
    for (int c = 0; c < 3; c++) {
        g.mean[c] = value[c];
        g.scale[c] = value[3 + c];
        g.colour[c] = value[11 + c];
    }
    for (int c = 0; c < 4; c++)
        g.rot[c] = value[6 + c];
    g.opacity = value[10];
    g.n = N;
    ted4_gaussians_hash(&g, got);
    XXH128_canonicalFromHash(&want, XXH3_128bits(bytes, sizeof bytes));
    assert_memory_equal(got, want.digest, 16);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_variant_gives_the_bits_of_the_text),
        cmocka_unit_test(every_variant_is_near_real_numbers),
        cmocka_unit_test(large_networks_give_the_bits_of_the_text),
        cmocka_unit_test(threads_and_order_change_nothing),
        cmocka_unit_test(kernels_give_the_same_hash),
        cmocka_unit_test(records_have_stable_ids),
        cmocka_unit_test(no_record_at_all),
        cmocka_unit_test(what_is_not_finite_is_refused),
        cmocka_unit_test(a_good_query_may_follow_a_bad_one),
        cmocka_unit_test(directions_and_rotations_of_no_length),
        cmocka_unit_test(times_out_of_range_are_refused),
        cmocka_unit_test(memory_that_runs_out_is_given_back),
        cmocka_unit_test(a_budget_is_kept),
        cmocka_unit_test(hash_is_that_of_little_endian_records),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
