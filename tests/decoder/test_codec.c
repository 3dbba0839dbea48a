/* test_codec.c - encoding of scenes and decoding of the result: spec 5 to 10, 13 to 15 as a whole.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdlib.h>
#include <xxhash.h>

#include "test.h"
#include "base/level.h"
#include "norm/limits.h"
#include "use_kernels.h"
#include "random_scene.h"

enum { SCENES = 120, CHANGES = 20000 };

typedef struct {
    uint8_t *data;
    size_t size;
} file;

static file encode(const ted4_scene *s, const ted4_parallel *p)
{
    ted4_error e;
    file f;

    assert_string_equal(ted4_status_id(ted4_encode(s, 0, p, &f.data, &f.size, &e)), "ok");
    return f;
}

static ted4_scene *decode(file f, const ted4_options *o)
{
    ted4_scene *s;
    ted4_error e;

    assert_string_equal(ted4_status_id(ted4_decode(f.data, f.size, o, &s, &e)), "ok");
    return s;
}

static void same_blob(const ted4_blob *a, const ted4_blob *b)
{
    assert_int_equal(a->n, b->n);
    if (a->n > 0)
        assert_memory_equal(a->values, b->values, a->n * sizeof *a->values);
}

static void same_scene(const ted4_scene *a, const ted4_scene *b)
{
    const size_t n = a->head.n_anchors;

    assert_memory_equal(&a->head, &b->head, sizeof a->head);
    assert_memory_equal(a->shift, b->shift, a->shape.n_units);
    same_blob(&a->nete, &b->nete);
    same_blob(&a->netr, &b->netr);
    same_blob(&a->bank, &b->bank);
    assert_memory_equal(a->position, b->position, 6 * n);
    assert_memory_equal(a->dynamic, b->dynamic, n);
    assert_memory_equal(a->offset_bits, b->offset_bits, 2 * n);
    for (int t = 0; t < TED4_TYPES; t++)
        if (a->shape.dim[t] > 0) {
            assert_memory_equal(a->step_index[t], b->step_index[t], n);
            assert_memory_equal(a->symbol[t], b->symbol[t], 2 * n * a->shape.dim[t]);
        }
}

static void same_file(file a, file b)
{
    assert_int_equal(a.size, b.size);
    assert_memory_equal(a.data, b.data, a.size);
}

/* Uses threads, and starts with the last index. */
static void run_backwards(void *user, size_t n, void (*body)(void *arg, size_t i), void *arg)
{
    (void)user;
#pragma omp parallel for num_threads(3) schedule(dynamic, 1)
    for (size_t i = 0; i < n; i++)
        body(arg, n - 1 - i);
}

static const ted4_parallel backwards = { run_backwards, NULL };

static void round_trip(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < SCENES; seed++) {
        const ted4_options o = { .parallel = &backwards };
        ted4_scene *s = random_scene(seed), *t;
        file f, again;

        assert_non_null(s);
        f = encode(s, NULL);
        again = encode(s, &backwards);
        same_file(f, again);
        free(again.data);
        t = decode(f, seed % 2 ? &o : NULL);
        same_scene(s, t);
        assert_int_equal(t->level, f.data[11]);
        again = encode(t, NULL); /* canonical: the bytes that were parsed */
        same_file(f, again);
        free(again.data);
        free(f.data);
        ted4_scene_free(s);
        ted4_scene_free(t);
    }
}

/* Several tiles of many lanes, the last tile not full, decoded with the kernels of each level. */
static void large(void **state)
{
    random_source r = random_seed(1);
    const ted4_header h = random_paper_header(9000);
    ted4_scene *s = random_scene_of(&r, &h, 1), *t;
    const file f = encode(s, &backwards);

    (void)state;
    for (int level = TED4_LEVEL_PLAIN; level <= (int)ted4_level_of_machine(); level++) {
        use_kernels(ted4_level_name((ted4_level)level));
        t = decode(f, NULL);
        same_scene(s, t);
        ted4_scene_free(t);
    }
    use_kernels(NULL);
    ted4_scene_free(s);
    free(f.data);
}

/* Returns the size of the TILE payloads. */
static size_t tile_bytes(file f)
{
    size_t sum = 0;

    for (size_t at = 12; at < f.size; at += 20 + ted4_load32(f.data + at + 8))
        if (memcmp(f.data + at, "TILE", 4) == 0)
            sum += ted4_load32(f.data + at + 8);
    return sum;
}

/* The coder loses about 0.002 bits per symbol: its states are at least one slot total, and no more
 * (spec 9.2). */
static void count_is_size(void **state)
{
    random_source r = random_seed(2);
    const ted4_header h = random_paper_header(6000);
    ted4_scene *s = random_scene_of(&r, &h, 0);
    const file f = encode(s, NULL);
    const double size = (double)tile_bytes(f);
    ted4_bits one, many;
    double sum;

    (void)state;
    assert_int_equal(ted4_count(s, NULL, &one, NULL), TED4_OK);
    assert_int_equal(ted4_count(s, &backwards, &many, NULL), TED4_OK);
    assert_memory_equal(&one, &many, sizeof one);
    sum = one.frame + one.mask;
    for (int t = 0; t < TED4_TYPES; t++)
        sum += one.type[t];
    assert_true(fabs(sum - one.total) < 1e-6 * sum);
    assert_true(size > one.total / 8 - 8);
    assert_true(size < one.total / 8 * 1.0028 + 16);
    ted4_scene_free(s);
    free(f.data);
}

static void truncations(void **state)
{
    (void)state;
    for (uint64_t seed = 3; seed < 7; seed++) {
        ted4_scene *s = random_scene(seed), *t;
        const file f = encode(s, NULL);
        ted4_error e;

        for (size_t n = 0; n < f.size; n++) {
            assert_int_equal(ted4_decode(f.data, n, NULL, &t, &e), TED4_E_CON_TRUNCATED);
            assert_null(t);
            assert_int_equal(e.offset, n);
        }
        f.data[0] ^= 1;
        assert_int_equal(ted4_decode(f.data, f.size, NULL, &t, &e), TED4_E_CON_MAGIC);
        ted4_scene_free(s);
        free(f.data);
    }
}

/* Corrects the hash of the chunk that contains byte at, if the chunk can be found. */
static void fix_hash(file f, size_t at)
{
    size_t p = 12;

    while (p + 20 <= f.size) {
        const uint64_t n = ted4_load32(f.data + p + 8);

        if (n > f.size - p - 20)
            return;
        if (at < p + 20 + n) {
            ted4_store64(f.data + p + 12 + n, XXH3_64bits(f.data + p, 12 + (size_t)n));
            return;
        }
        p += 20 + (size_t)n;
    }
}

/* Replaces bytes by random ones, in most cases with the chunk's hash corrected. The file must be
 * refused, or give the same integers. */
static void changes(void **state)
{
    random_source r = random_seed(4);
    size_t accepted = 0;

    (void)state;
    for (uint64_t seed = 0; seed < 20; seed++) {
        ted4_scene *s = random_scene(seed + 40), *t;
        const file f = encode(s, NULL);
        const file g = { malloc(f.size), f.size };
        uint8_t hash[16];

        ted4_scene_hash(s, hash);
        for (int n = 0; n < CHANGES / 20; n++) {
            const size_t at = random_u32(&r) % f.size;

            memcpy(g.data, f.data, f.size);
            g.data[at] ^= (uint8_t)random_in(&r, 1, 255);
            if (n % 4 > 0)
                fix_hash(g, at);
            if (ted4_decode(g.data, g.size, NULL, &t, NULL) != TED4_OK)
                continue;
            assert_memory_equal(t->hash, hash, 16);
            ted4_scene_free(t);
            accepted++;
        }
        free(g.data);
        free(f.data);
        ted4_scene_free(s);
    }
    assert_true(accepted > 0);
    assert_true(accepted < CHANGES);
}

/* An allocator that fails once, at call number fail_at, and counts the blocks in use. */
typedef struct {
    long n, fail_at, out;
} counter;

static void *count_alloc(void *user, size_t size)
{
    counter *c = user;

    if (++c->n == c->fail_at)
        return NULL;
    c->out++;
    return malloc(size);
}

static void count_free(void *user, void *p)
{
    ((counter *)user)->out--;
    free(p);
}

static void memory_runs_out(void **state)
{
    ted4_scene *s = random_scene(8), *t;
    const file f = encode(s, NULL);
    counter c = { 0, 0, 0 };
    ted4_options o = { .allocator = { count_alloc, count_free, &c } };
    ted4_error e;
    long n;

    (void)state;
    for (n = 1;; n++) {
        c = (counter) { 0, n, 0 };
        if (ted4_decode(f.data, f.size, &o, &t, &e) == TED4_OK)
            break;
        assert_int_equal(e.code, TED4_E_LIMIT_MEMORY);
        assert_int_equal(c.out, 0);
    }
    assert_true(n > 10);
    ted4_scene_free(t);
    assert_int_equal(c.out, 0);
    for (o.max_bytes = 1;; o.max_bytes *= 2) {
        c = (counter) { 0, 0, 0 };
        if (ted4_decode(f.data, f.size, &o, &t, &e) == TED4_OK)
            break;
        assert_int_equal(e.code, TED4_E_LIMIT_MEMORY);
        assert_int_equal(c.out, 0);
    }
    ted4_scene_free(t);
    ted4_scene_free(s);
    free(f.data);
}

/* The trace names elements in file order, and the same elements every time. */
typedef struct {
    size_t offset, n;
    uint64_t sum;
} tracer;

static void trace(void *user, size_t offset, const char *element, int64_t index, int64_t value)
{
    tracer *t = user;

    assert_true(offset >= t->offset);
    t->offset = offset;
    t->n++;
    t->sum = t->sum * 31 + (uint64_t)value + (uint64_t)index + strlen(element);
}

static void traced(void **state)
{
    ted4_scene *s = random_scene(20);
    const file f = encode(s, NULL);
    tracer a = { 0, 0, 0 }, b = { 0, 0, 0 };
    ted4_options o = { .parallel = &backwards, .trace = trace, .trace_user = &a };

    (void)state;
    ted4_scene_free(decode(f, &o));
    o.trace_user = &b;
    o.parallel = NULL;
    ted4_scene_free(decode(f, &o));
    assert_memory_equal(&a, &b, sizeof a);
    assert_true(a.n > s->head.n_anchors);
    ted4_scene_free(s);
    free(f.data);
}

/* The byte string of spec 15.2, implemented a second time from the text, in one piece. */
static size_t hashed_string(const ted4_scene *s, uint8_t *p)
{
    const size_t n = s->head.n_anchors;
    uint8_t *const start = p;

    for (size_t i = 0; i < 3 * n; i++, p += 2)
        ted4_store16(p, s->position[i]);
    for (size_t from = 0; from < n; from += s->head.tile_size) {
        const size_t to = from + s->head.tile_size < n ? from + s->head.tile_size : n;

        for (size_t a = from; a < to; a++, p += 3) {
            p[0] = s->dynamic[a];
            ted4_store16(p + 1, s->offset_bits[a]);
        }
        for (int t = 0; t < TED4_TYPES; t++)
            for (size_t a = from; s->symbol[t] != NULL && a < to; a++)
                *p++ = s->step_index[t][a];
        for (int t = 0; t < TED4_TYPES; t++)
            for (size_t c = 0; c < s->shape.dim[t]; c++)
                for (size_t a = from; a < to; a++) {
                    if (t == TED4_OFFSET && !(s->offset_bits[a] >> c / 3 & 1))
                        continue;
                    if (t == TED4_PHI && !s->dynamic[a])
                        continue;
                    ted4_store16(p, (uint16_t)s->symbol[t][c * n + a]);
                    p += 2;
                }
    }
    return (size_t)(p - start);
}

static void hash_of_the_text(void **state)
{
    uint8_t *string = malloc(1 << 22);

    (void)state;
    for (uint64_t seed = 0; seed < 40; seed++) {
        ted4_scene *s = random_scene(seed);
        const size_t n = hashed_string(s, string);
        XXH128_canonical_t hash;
        uint8_t ours[16];

        XXH128_canonicalFromHash(&hash, XXH3_128bits(string, n));
        ted4_scene_hash(s, ours);
        assert_memory_equal(hash.digest, ours, 16);
        ted4_scene_free(s);
    }
    free(string);
}

static void info(void **state)
{
    ted4_scene *s = random_scene(21), *t;
    const file f = encode(s, NULL);
    ted4_info i;
    size_t kept = 0;

    (void)state;
    t = decode(f, NULL);
    ted4_scene_info(t, &i);
    for (size_t a = 0; a < s->head.n_anchors; a++)
        for (unsigned k = 0; k < s->head.n_offsets; k++)
            kept += s->offset_bits[a] >> k & 1;
    assert_int_equal(i.n_gaussians, kept);
    assert_int_equal(i.n_anchors, s->head.n_anchors);
    assert_int_equal(i.level, ted4_level_lowest(&s->head, &s->shape, f.size));
    assert_memory_equal(i.hash, f.data + f.size - 24, 16);
    ted4_scene_free(s);
    ted4_scene_free(t);
    free(f.data);
}

static const char *encoding(const ted4_scene *s, int level)
{
    file f;
    ted4_error e;
    const ted4_status verdict = ted4_encode(s, level, NULL, &f.data, &f.size, &e);

    free(f.data);
    return ted4_status_id(verdict);
}

/* The encoder refuses what no decoder would accept, with the same identifier. */
static void illegal_scenes(void **state)
{
    random_source r = random_seed(30);
    ted4_header h = random_paper_header(100);
    ted4_scene *s;
    uint16_t p;

    (void)state;
    h.n_offsets = 9;
    s = random_scene_of(&r, &h, 0);
    assert_string_equal(encoding(s, 1), "lvl.exceeded"); /* too many frames */
    assert_string_equal(encoding(s, 2), "ok");
    assert_string_equal(encoding(s, 31), "ok");
    assert_string_equal(encoding(s, 7), "con.level");
    s->head.ar_width = 0;
    assert_string_equal(encoding(s, 0), "hdr.combination");
    s->head.ar_width = h.ar_width;
    s->head.feature_dim = 200;
    assert_string_equal(encoding(s, 0), "hdr.range");
    s->head.feature_dim = h.feature_dim;
    p = s->position[0];
    s->position[0] = 0x7c00;
    assert_string_equal(encoding(s, 0), "pos.value");
    s->position[0] = p;
    s->step_index[TED4_TAU][5] ^= 1;
    assert_string_equal(encoding(s, 0), "syn.hash");
    s->step_index[TED4_TAU][5] ^= 1;
    s->symbol[TED4_TAU][7] = 9;
    s->symbol[TED4_TAU][207] = 8;
    assert_string_equal(encoding(s, 0), "att.tau-order");
    s->symbol[TED4_TAU][207] = 9;
    assert_string_equal(encoding(s, 0), "ok");
    s->offset_bits[3] |= 1 << 9;
    assert_string_equal(encoding(s, 0), "syn.hash");
    s->offset_bits[3] &= 511;
    s->symbol[TED4_SCALING][0] = -32768;
    assert_string_equal(encoding(s, 0), "ent.symbol-range");
    s->symbol[TED4_SCALING][0] = 0;
    s->netr.values[3] = -0.0f;
    assert_string_equal(encoding(s, 0), "net.value");
    ted4_scene_free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(round_trip),    cmocka_unit_test(large),
        cmocka_unit_test(count_is_size), cmocka_unit_test(truncations),
        cmocka_unit_test(changes),       cmocka_unit_test(memory_runs_out),
        cmocka_unit_test(traced),        cmocka_unit_test(hash_of_the_text),
        cmocka_unit_test(info),          cmocka_unit_test(illegal_scenes),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
