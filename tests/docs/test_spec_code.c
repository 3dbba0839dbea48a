/* test_spec_code.c - the code and tables that the specification prints (spec 4.5), compiled into a
 * separate decoder (spec_model.h), compared with the reference decoder: the same integers and
 * records of valid files, the same verdict, identifier and offset for damaged ones.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "spec_tiers.h" /* before cmocka, whose fail() is a macro */
#include <stdio.h>
#include <xxhash.h>

#include "test.h"
#include "random_scene.h"
#include "recon/strict.h"
#include "vector_files.h"

enum {
    N_VALID = 40,
    N_DAMAGED = 20,
    N_DAMAGES = 200,
    N_EDGES = 10,
    N_HASHED = 3000,
    MAX_CHUNKS = 32
};

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

    assert_int_equal(m->s.h.n_anchors, n);
    assert_memory_equal(m->s.position, s->position, 6 * n);
    assert_memory_equal(m->s.dynamic, s->dynamic, n);
    assert_memory_equal(m->s.offset_bits, s->offset_bits, 2 * n);
    for (int t = 0; t < TED4_TYPES; t++) {
        assert_int_equal(type_dim(&m->s.h, t), s->shape.dim[t]);
        if (s->shape.dim[t] == 0)
            continue;
        assert_memory_equal(m->s.step_index[t], s->step_index[t], n);
        assert_memory_equal(m->s.symbol[t], s->symbol[t], 2 * n * s->shape.dim[t]);
    }
    assert_memory_equal(m->s.netr, s->netr.values, 4 * s->netr.n);
    if (s->bank.n > 0)
        assert_memory_equal(m->s.bank, s->bank.values, 4 * s->bank.n);
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

/* finite: whether the reference decoder found the records finite. */
static void same_query(const spec_model *m, const ted4_query *q, const ted4_gaussians *g,
                       int finite)
{
    float record[16][14];
    size_t i = 0;
    int all_finite = 1;

    for (size_t a = 0; a < (size_t)m->s.h.n_anchors; a++) {
        const int n = anchor_records(&m->s, m->net_r, a, q->num, q->den, q->camera, record);

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

/* Collects the pieces of a tier that ted4_dump_syntax and ted4_dump_tier deliver. */
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
        assert_null(t.model.v.id);
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

/* Finds the offsets of the chunks of a valid file, and its end. Returns the number of chunks. */
static size_t chunks_of(const uint8_t *data, size_t size, size_t at[MAX_CHUNKS + 1])
{
    size_t n = 0;

    at[0] = 12;
    while (at[n] < size && n < MAX_CHUNKS) {
        at[n + 1] = at[n] + 20 + ted4_load32(data + at[n] + 8);
        n++;
    }
    return n;
}

static void fix_hash(uint8_t *chunk)
{
    const size_t n = 12 + (size_t)ted4_load32(chunk + 8);
    const uint64_t h = XXH3_64bits(chunk, n);

    ted4_store32(chunk + n, (uint32_t)h);
    ted4_store32(chunk + n + 4, (uint32_t)(h >> 32));
}

/* Changes a byte slightly, flips one of its bits, or sets it to a special value. */
static void change_byte(random_source *r, uint8_t *p)
{
    static const uint8_t special[] = { 0, 1, 2, 31, 63, 127, 128, 255 };

    switch (random_in(r, 0, 3)) {
    case 0: *p ^= (uint8_t)(1u << random_in(r, 0, 7)); break;
    case 1: *p = (uint8_t)(*p + 1); break;
    case 2: *p = (uint8_t)(*p - 1); break;
    default: *p = special[random_in(r, 0, 7)]; break;
    }
}

/* Damages the file once; data has room for 2 size + 64 bytes. Returns the new size. */
static size_t damage(random_source *r, uint8_t *data, size_t size)
{
    size_t at[MAX_CHUNKS + 1];
    const size_t n = chunks_of(data, size, at), c = random_in(r, 0, (uint32_t)n - 1),
                 length = at[c + 1] - at[c];

    switch (random_in(r, 0, 14)) {
    case 0: /* any byte, with the hash corrected or not */
        change_byte(r, data + random_in(r, 0, (uint32_t)size - 1));
        return size;
    case 1: /* the file is truncated */ return random_in(r, 0, (uint32_t)size - 1);
    case 2: /* a chunk twice */
        memmove(data + at[c + 1] + length, data + at[c + 1], size - at[c + 1]);
        memcpy(data + at[c + 1], data + at[c], length);
        return size + length;
    case 3: /* a chunk is removed */
        memmove(data + at[c], data + at[c + 1], size - at[c + 1]);
        return size - length;
    case 4: /* type, flags, with the hash corrected */
        change_byte(r, data + at[c] + random_in(r, 0, 7));
        fix_hash(data + at[c]);
        return size;
    case 5: /* a byte is appended to a payload */
        memmove(data + at[c + 1] + 1, data + at[c + 1], size - at[c + 1]);
        data[at[c + 1]] = 0;
        ted4_store32(data + at[c] + 8, (uint32_t)length - 20 + 1);
        fix_hash(data + at[c]);
        return size + 1;
    case 6: /* a byte is removed */
        if (length == 20)
            return size;
        memmove(data + at[c + 1] - 1, data + at[c + 1], size - at[c + 1]);
        ted4_store32(data + at[c] + 8, (uint32_t)length - 20 - 1);
        fix_hash(data + at[c]);
        return size - 1;
    case 7: /* the file header */ change_byte(r, data + random_in(r, 0, 11)); return size;
    case 8: /* HEAD */
        change_byte(r, data + at[0] + 12 + random_in(r, 0, (uint32_t)(at[1] - at[0]) - 21));
        fix_hash(data + at[0]);
        return size;
    case 9: /* the first bytes of a payload */
        if (length > 20)
            change_byte(r, data + at[c] + 12 +
                               random_in(r, 0, (uint32_t)(length < 60 ? length : 60) - 21));
        fix_hash(data + at[c]);
        return size;
    default: /* some bytes of a payload, with the hash corrected */
        for (uint32_t i = random_in(r, 1, 3); i > 0 && length > 20; i--)
            change_byte(r, data + at[c] + 12 + random_in(r, 0, (uint32_t)length - 21));
        fix_hash(data + at[c]);
        return size;
    }
}

static void same_verdict(const uint8_t *data, size_t size, unsigned *seen)
{
    spec_model m = { .n_blocks = 0 };
    ted4_error e = { TED4_OK, 0 };
    ted4_scene *s;
    const ted4_status status = ted4_decode(data, size, NULL, &s, &e);

    spec_model_decode(&m, data, size);
    if (strcmp(m.v.id == NULL ? "ok" : m.v.id, ted4_status_id(status)) != 0 ||
        (status != TED4_OK && e.offset != m.v.offset)) {
        printf("text: %s at %llu; decoder: %s at %zu\n", m.v.id == NULL ? "ok" : m.v.id,
               (unsigned long long)m.v.offset, ted4_status_id(status), e.offset);
        fail();
    }
    seen[status]++;
    spec_model_free(&m);
    ted4_scene_free(s);
}

static void damaged_streams(void **state)
{
    unsigned seen[TED4_N_STATUS] = { 0 };
    int n_kinds = 0;

    (void)state;
    for (uint64_t seed = 0; seed < N_DAMAGED; seed++) {
        random_source r = random_seed(1000 + seed);
        ted4_scene *s = random_scene(seed);
        size_t size;
        uint8_t *data = encoded(s, &size), *copy = malloc(2 * size + 64);

        for (int i = 0; i < N_DAMAGES; i++) {
            memcpy(copy, data, size);
            same_verdict(copy, damage(&r, copy, size), seen);
        }
        ted4_scene_free(s);
        free(copy);
        free(data);
    }
    for (int i = TED4_OK + 1; i < TED4_N_STATUS; i++)
        n_kinds += seen[i] > 0;
    assert_true(n_kinds >= 24);
}

static unsigned published[TED4_N_STATUS];

static void visit_vector(const uint8_t *data, size_t size, const char *path)
{
    (void)path;
    same_verdict(data, size, published);
}

/* The suite, except large vectors and those that need much work, because the printed code is
 * slow. */
static void vectors(void **state)
{
    (void)state;
    assert_true(each_vector("-size -60k ! -path '*/limit/*'", visit_vector) > 1000);
    assert_true(published[TED4_OK] > 300);
}

/* An entry of HEAD: its offset in the payload, and values at and beyond the ends of its range and
 * of the level's bounds. */
typedef struct {
    size_t at, width;
    int64_t value[8];
} head_entry;

enum { MAX_ENTRIES = 96 };

static size_t head_entries(const spec_model *m, head_entry *e)
{
    const struct header *h = &m->s.h;
    size_t n = 0, at = 0;

#define ELEMENT(name, count, bytes, is_signed, low, high, conditional, condition, level) \
    for (int64_t i = 0; i < (count); i++, at += bytes)                                   \
        e[n++] = (head_entry) { at,                                                      \
                                bytes,                                                   \
                                { 0, (low)-1, low, (low) + 1, high, (high) + 1,          \
                                  (int64_t)m->bound[BOUND_##level],                      \
                                  (int64_t)m->bound[BOUND_##level] + 1 } };
#define REAL(name, count, bounded)                                                               \
    for (int64_t i = 0; i < (count); i++, at += 4)                                               \
        e[n++] = (head_entry) { at,                                                              \
                                4,                                                               \
                                { 0, 0x80000000, 0x357fffff, 0x35800000, 0x44800000, 0x44800001, \
                                  0x7f800000, 1 } };
#include "spec/head.inc"
#undef ELEMENT
#undef REAL
    return n;
}

/* Every element of HEAD at both ends of its range, at every level. */
static void edges_of_head(void **state)
{
    static const uint8_t level[] = { 1, 2, 3, 4, 31 };
    unsigned seen[TED4_N_STATUS] = { 0 };

    (void)state;
    for (uint64_t seed = 0; seed < N_EDGES; seed++) {
        ted4_scene *s = random_scene(2 * seed);
        head_entry e[MAX_ENTRIES];
        spec_model m = { .n_blocks = 0 };
        size_t size, n;
        uint8_t *data = encoded(s, &size), *copy = malloc(size);

        data[11] = level[seed % sizeof level];
        spec_model_decode(&m, data, size);
        n = head_entries(&m, e);
        for (size_t i = 0; i < n; i++)
            for (int k = 0; k < 8; k++) {
                memcpy(copy, data, size);
                for (size_t b = 0; b < e[i].width; b++)
                    copy[24 + e[i].at + b] = (uint8_t)(e[i].value[k] >> 8 * b);
                fix_hash(copy + 12);
                same_verdict(copy, size, seen);
            }
        spec_model_free(&m);
        ted4_scene_free(s);
        free(copy);
        free(data);
    }
    assert_true(seen[TED4_E_HDR_RANGE] > 100);
    assert_true(seen[TED4_E_HDR_COMBINATION] > 50);
    assert_true(seen[TED4_E_LVL_EXCEEDED] > 5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(edges_of_head),   cmocka_unit_test(hashes),
        cmocka_unit_test(functions),       cmocka_unit_test(valid_streams),
        cmocka_unit_test(damaged_streams), cmocka_unit_test(vectors),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
