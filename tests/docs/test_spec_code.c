/* test_spec_code.c - the code and tables that the specification prints (spec 4.5), compiled into a
 * decoder of their own (spec_model.h), against the reference decoder: the same integers and records
 * of valid streams. (For verdicts: test_spec_pass2.c.)
 * SPDX-License-Identifier: BSD-2-Clause */
#include "spec_tiers.h" /* first: its fail() is a function, that of cmocka a macro */
#include <stdio.h>
#include <xxhash.h>

#include "test.h"
#include "random_scene.h"
#include "recon/strict.h"

enum { N_VALID = 40, N_HASHED = 3000 };

static void hashes(void **state)
{
    static uint8_t bytes[N_HASHED];

    (void)state;
    for (size_t i = 0; i < N_HASHED; i++)
        bytes[i] = (uint8_t)(i * 2654435761u >> 13);
    for (size_t n = 9; n < N_HASHED; n++)
        assert_int_equal(xxh3_64(bytes, n), XXH3_64bits(bytes, n));
    for (size_t n = 0; n<N_HASHED; n += n> 0 ? 1 : 9) {
        const XXH128_hash_t theirs = XXH3_128bits(bytes, n);
        const struct hash128 ours = xxh3_128(bytes, n);

        assert_int_equal(theirs.low64, ours.low);
        assert_int_equal(theirs.high64, ours.high);
    }
}

static void functions(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < 1u << 22; i++) {
        const uint32_t bits = i << 10 | (i * 2654435761u >> 22);
        const float x = ted4_bits_float(bits), a = pow2(x), b = ted4_pow2(x);

        assert_true(x != x ? a != a && b != b : ted4_float_bits(a) == ted4_float_bits(b));
    }
    for (int32_t x = -70000; x < 70000; x += 7)
        for (int r = 0; r < 20; r++) {
            assert_int_equal(floor_shift(x, r), ted4_floor_shift(x, (unsigned)r));
            assert_int_equal(round_shift(x, r), ted4_round_shift(x, (unsigned)r));
        }
}

static uint8_t *encoded(const ted4_scene *s, size_t *size)
{
    uint8_t *data = NULL;

    assert_int_equal(ted4_encode(s, 0, NULL, &data, size, NULL), TED4_OK);
    return data;
}

static void same_scene(const spec_model *m, const ted4_scene *s)
{
    const size_t n = s->head.n_anchors;

    assert_int_equal(m->p.s.h.n_anchors, n);
    assert_memory_equal(m->p.s.position, s->position, 6 * n);
    assert_memory_equal(m->p.s.dynamic, s->dynamic, n);
    assert_memory_equal(m->p.s.offset_bits, s->offset_bits, 2 * n);
    for (int t = 0; t < TED4_TYPES; t++) {
        assert_int_equal(type_dim(&m->p.s.h, t), s->shape.dim[t]);
        if (s->shape.dim[t] == 0)
            continue;
        assert_memory_equal(m->p.s.step_index[t], s->step_index[t], n);
        assert_memory_equal(m->p.s.symbol[t], s->symbol[t], 2 * n * s->shape.dim[t]);
    }
    assert_memory_equal(m->p.s.netr, s->netr.values, 4 * s->netr.n);
    if (s->bank.n > 0)
        assert_memory_equal(m->p.s.bank, s->bank.values, 4 * s->bank.n);
}

static void same_record(const ted4_gaussians *g, size_t i, const float *record)
{
    const float *const channel[14] = { g->mean[0],   g->mean[1],  g->mean[2], g->scale[0],
                                       g->scale[1],  g->scale[2], g->rot[0],  g->rot[1],
                                       g->rot[2],    g->rot[3],   g->opacity, g->colour[0],
                                       g->colour[1], g->colour[2] };

    for (int c = 0; c < 14; c++)
        assert_int_equal(ted4_float_bits(channel[c][i]), ted4_float_bits(record[c]));
}

/* finite: did the reference decoder find the records finite? */
static void same_query(const spec_model *m, const ted4_query *q, const ted4_gaussians *g,
                       int finite)
{
    float record[16][14];
    size_t i = 0;
    int all_finite = 1;

    for (size_t a = 0; a < (size_t)m->p.s.h.n_anchors; a++) {
        const int n = anchor_records(&m->p.s, m->p.net_r, a, q->num, q->den, q->camera, record);

        for (int k = 0; k < n; k++, i++) {
            for (int c = 0; c < 14; c++)
                all_finite &= isfinite(record[k][c]) != 0;
            if (finite)
                same_record(g, i, record[k]);
        }
    }
    assert_int_equal(all_finite, finite);
    if (finite)
        assert_int_equal(i, g->n);
}

/* A tier as ted4_dump_syntax and ted4_dump_tier give it. */
static void gather(void *user, const void *bytes, size_t size)
{
    spec_bytes *b = user;

    for (size_t i = 0; i < size; i++)
        spec_put(b, ((const uint8_t *)bytes)[i], 1);
}

static void same_tiers(const spec_tiers *t, const ted4_scene *s, const uint8_t *data, size_t size)
{
    for (int i = 0; i < N_TIERS; i++) {
        spec_bytes b = { NULL, 0, 0 };

        if (i == 0)
            assert_int_equal(ted4_dump_syntax(data, size, NULL, gather, &b, NULL), TED4_OK);
        else
            assert_int_equal(ted4_dump_tier(s, i, NULL, gather, &b), TED4_OK);
        assert_int_equal(b.size, t->tier[i].size);
        assert_memory_equal(b.data, t->tier[i].data, b.size);
        free(b.data);
    }
}

static int same_queries(const spec_model *m, const ted4_scene *s)
{
    static const ted4_query queries[] = {
        { 0, 1, { 0.5f, -1.0f, 2.0f } },
        { 1, 3, { 0.25f, 0.0f, 0.0f } },
        { 5, 7, { 1e3f, 2.0f, -3.0f } },
        { 1, 1, { 0.0f, 0.0f, 0.0f } },
    };
    ted4_recon *r;
    int n_finite = 0;

    assert_int_equal(ted4_recon_new(&r, s, NULL), TED4_OK);
    for (size_t i = 0; i < sizeof queries / sizeof *queries; i++) {
        ted4_gaussians g;
        const ted4_status status = ted4_recon_query(r, &queries[i], NULL, &g);

        assert_true(status == TED4_OK || status == TED4_E_REC_NONFINITE);
        same_query(m, &queries[i], &g, status == TED4_OK);
        n_finite += status == TED4_OK;
    }
    ted4_recon_free(r);
    return n_finite;
}

static void valid_streams(void **state)
{
    int n_finite = 0;

    (void)state;
    for (uint64_t seed = 0; seed < N_VALID; seed++) {
        ted4_scene *s = random_scene(seed), *back;
        spec_tiers t = { .model.n_blocks = 0 };
        size_t size;
        uint8_t *data = encoded(s, &size);

        spec_tiers_make(&t, data, size);
        assert_null(t.model.p.v.id);
        assert_int_equal(ted4_decode(data, size, NULL, &back, NULL), TED4_OK);
        same_scene(&t.model, back);
        same_tiers(&t, back, data, size);
        n_finite += same_queries(&t.model, back);
        spec_tiers_free(&t);
        ted4_scene_free(back);
        ted4_scene_free(s);
        free(data);
    }
    assert_true(n_finite > 2 * N_VALID);
}

/* The pattern that is printed beside a hexadecimal floating-point number is that of the number. */
static void patterns(void **state)
{
    static const char *const chapter[] = { "spec/11-reconstruction.md", "spec/12-arithmetic.md" };
    int n = 0;

    (void)state;
    for (size_t i = 0; i < sizeof chapter / sizeof *chapter; i++) {
        char line[1024];
        FILE *const f = fopen(chapter[i], "r");
        int code = 0;

        assert_non_null(f);
        while (fgets(line, sizeof line, f) != NULL) {
            const char *const number = strstr(line, "0x1"), *const beside = strstr(line, "/* 0x");

            if (strncmp(line, "```", 3) == 0)
                code = strcmp(line, "```c\n") == 0;
            if (!code || number == NULL || strcspn(number, "p") > 12)
                continue;
            assert_non_null(beside);
            assert_int_equal(strtoul(beside + 3, NULL, 16), ted4_float_bits(strtof(number, NULL)));
            n++;
        }
        fclose(f);
    }
    assert_int_equal(n, 11);
}

/* 12.2: one operation in binary64, rounded to binary32, is the binary32 operation. */
static void rounded_twice(void **state)
{
    random_source r = random_seed(21);

    (void)state;
    for (int i = 0; i < 1 << 20; i++) {
        /* some pairs close in exponent, some with subnormal results */
        const uint32_t x = random_u32(&r), near = x ^ (random_u32(&r) & 0x00ffffff);
        const float a = ted4_bits_float(x), b = ted4_bits_float(i % 3 ? random_u32(&r) : near);

        if (!isfinite(a) || !isfinite(b))
            continue;
        assert_int_equal(ted4_float_bits((float)((double)a + b)), ted4_float_bits(a + b));
        assert_int_equal(ted4_float_bits((float)((double)a - b)), ted4_float_bits(a - b));
        assert_int_equal(ted4_float_bits((float)((double)a * b)), ted4_float_bits(a * b));
        if (b != 0)
            assert_int_equal(ted4_float_bits((float)((double)a / b)), ted4_float_bits(a / b));
        if (a >= 0)
            assert_int_equal(ted4_float_bits((float)sqrt(a)), ted4_float_bits(sqrtf(a)));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hashes),        cmocka_unit_test(functions),
        cmocka_unit_test(patterns),      cmocka_unit_test(rounded_twice),
        cmocka_unit_test(valid_streams),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
