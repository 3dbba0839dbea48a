/* test_starved.c - branches of norm/ and read/ that no file takes. Every allocation fails, alone
 * and together with all later ones, in everything that the library does with a file: the result is
 * a verdict, no output, and no leak. Also what only writing takes of walks that readers and writers
 * share, and mistakes of callers who write scenes.
 * conformance/branches-excluded.txt lists these branches, and `make conformance-branches` checks
 * that this test takes each.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdio.h>

#include "test.h"
#include "fuzz/counting.h"
#include "fuzz/fix_hashes.h"
#include "norm/octree.h"
#include "random_scene.h"

typedef struct {
    uint8_t *data;
    size_t size;
} file;

static void throw_away(void *user, const void *bytes, size_t size)
{
    (void)user, (void)bytes, (void)size;
}

static void overhear(void *user, const ted4_finding *f)
{
    (void)f;
    ++*(int *)user;
}

/* The caller's threads, so that several tiles need memory at the same time. */
static void in_order(void *user, size_t n, void (*body)(void *arg, size_t i), void *arg)
{
    (void)user;
    for (size_t i = 0; i < n; i++)
        body(arg, i);
}

static const ted4_parallel threads = { in_order, NULL };

/* An operation on a file, which returns its verdict. */
typedef ted4_status deed(const file *f, const ted4_options *o);

static ted4_status decodes(const file *f, const ted4_options *o)
{
    ted4_scene *s;
    ted4_error e;
    const ted4_status verdict = ted4_decode(f->data, f->size, o, &s, &e);

    assert_int_equal(s != NULL, verdict == TED4_OK);
    assert_int_equal(e.code, verdict);
    ted4_scene_free(s);
    return verdict;
}

/* If lenient decoding stopped for lack of memory, that counts as well. */
static ted4_status salvages(const file *f, const ted4_options *o)
{
    ted4_salvage what;
    ted4_scene *s;

    (void)ted4_decode_lenient(f->data, f->size, o, &s, &what);
    ted4_scene_free(s);
    return what.stop.code;
}

static ted4_status validates(const file *f, const ted4_options *o)
{
    int n = 0;
    const ted4_status verdict = ted4_validate(f->data, f->size, o, overhear, &n);

    assert_true(n > 0 || verdict == TED4_OK);
    return verdict;
}

static ted4_status dumps_syntax(const file *f, const ted4_options *o)
{
    ted4_error e;

    return ted4_dump_syntax(f->data, f->size, o, throw_away, NULL, &e);
}

static ted4_status dumps_tiers(const file *f, const ted4_options *o)
{
    ted4_scene *s;
    ted4_status verdict = ted4_decode(f->data, f->size, NULL, &s, NULL);

    for (int tier = 1; tier <= 4 && verdict == TED4_OK; tier++)
        verdict = ted4_dump_tier(s, tier, o, throw_away, NULL);
    ted4_scene_free(s);
    return verdict;
}

/* Makes a scene for writing, as large as the file's. */
static ted4_status makes_scene(const file *f, const ted4_options *o)
{
    ted4_scene *s, *made;
    ted4_status verdict = ted4_decode(f->data, f->size, NULL, &s, NULL);

    if (verdict != TED4_OK)
        return verdict;
    made = ted4_scene_new(&s->head, o);
    ted4_scene_free(s);
    ted4_scene_free(made);
    return made != NULL ? TED4_OK : TED4_E_LIMIT_MEMORY;
}

/* Lets allocation after allocation fail, until there is none left to fail: then the result is that
 * with unlimited memory. A file that is wrong for another reason may keep that verdict. */
static void starve(deed *act, const file *f, int fail_on)
{
    const ted4_options rich = { .parallel = &threads };
    const ted4_status wanted = act(f, &rich);
    int calm = 0, failed = 0;

    for (uint64_t n = 1; !calm; n++) {
        counting_memory memory = { .fail_at = n, .fail_on = fail_on };
        const ted4_options o = { .allocator = counting_allocator(&memory), .parallel = &threads };
        const ted4_status verdict = act(f, &o);

        calm = memory.n < n;
        failed += verdict == TED4_E_LIMIT_MEMORY;
        assert_int_equal(memory.held, 0);
        if (verdict != wanted && (calm || verdict != TED4_E_LIMIT_MEMORY))
            fail_msg("allocation %d fails: %s", (int)n, ted4_status_id(verdict));
    }
    assert_true(failed > 0 || wanted != TED4_OK);
}

static void starve_all(const file *f)
{
    static deed *const all[] = { decodes,      salvages,    validates,
                                 dumps_syntax, dumps_tiers, makes_scene };

    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        starve(all[i], f, 0);
        starve(all[i], f, 1);
    }
}

static file encode(const ted4_scene *s)
{
    file f;
    ted4_error e;

    assert_int_equal(ted4_encode(s, 0, NULL, &f.data, &f.size, &e), TED4_OK);
    return f;
}

static file read_vector(const char *id)
{
    char path[256];
    file f = { malloc(1 << 20), 0 };
    FILE *in;

    snprintf(path, sizeof path, "conformance/vectors/%s.ted4", id);
    in = fopen(path, "rb");
    assert_non_null(in);
    f.size = fread(f.data, 1, 1 << 20, in);
    fclose(in);
    return f;
}

/* A scene that moves, with two slices, four tiles, all masks and networks. */
static ted4_scene *example(void)
{
    random_source r = random_seed(8);
    ted4_header h = random_small_header(200);

    return random_scene_of(&r, &h, 0);
}

/* The same in profile Compact, on the grid of so many bits a coordinate. */
static ted4_scene *compact_example(uint32_t n_anchors, unsigned grid)
{
    random_source r = random_seed(8);
    ted4_header h = random_small_header(n_anchors);

    return random_compact_of(&r, &h, 0, grid);
}

static void whole_files(void **state)
{
    ted4_scene *const all[] = { example(), compact_example(200, 9), compact_example(200, 16) };

    (void)state;
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        file f = encode(all[i]);

        starve_all(&f);
        free(f.data);
        ted4_scene_free(all[i]);
    }
}

/* Files for what a validator and a lenient decoder do after an error: a truncated file, a damaged
 * tile, positions out of order. */
static void damaged_files(void **state)
{
    ted4_scene *s = example();
    file f = encode(s), g;

    (void)state;
    f.size -= 100;
    starve_all(&f);
    f.size += 100;
    f.data[f.size - 200] ^= 1;
    ted4_fix_hashes(f.data, f.size);
    starve_all(&f);
    g = read_vector("invalid/positions/NEG-position-equal");
    starve_all(&g);
    free(g.data);
    free(f.data);
    ted4_scene_free(s);
}

/* Vectors with deflated blobs, and with text for people. */
static void vectors(void **state)
{
    static const char *const id[] = { "valid/random/RND-pack-inr-0-netr",
                                      "valid/extension/EXT-meta-anything" };

    (void)state;
    for (size_t i = 0; i < sizeof id / sizeof *id; i++) {
        file f = read_vector(id[i]);

        starve_all(&f);
        free(f.data);
    }
}

/* Asserts that a scene is refused when it is written, or observed. */
static void expect_refused(const ted4_scene *s)
{
    uint8_t *data;
    size_t size;
    ted4_error e;

    assert_int_equal(ted4_encode(s, 0, NULL, &data, &size, &e), TED4_E_SYN_HASH);
    assert_int_equal(ted4_dump_tier(s, 3, NULL, throw_away, NULL), TED4_E_SYN_HASH);
}

/* Masks that the header does not code, and invalid ones that it codes. */
static void wrong_masks(void **state)
{
    for (uint8_t coded = 0; coded <= 1; coded++) {
        random_source r = random_seed(9);
        ted4_header h = random_small_header(70);
        ted4_scene *s;
        file f;
        uint8_t dynamic;
        uint16_t bits;

        (void)state;
        h.temporal_mask = h.offset_mask = coded;
        s = random_scene_of(&r, &h, 0);
        f = encode(s);
        ted4_scene_free(s);
        assert_int_equal(ted4_decode(f.data, f.size, NULL, &s, NULL),
                         TED4_OK); /* with probabilities */
        dynamic = s->dynamic[3];
        bits = s->offset_bits[3];
        s->dynamic[3] = coded ? 2 : 0;
        expect_refused(s);
        s->dynamic[3] = dynamic;
        s->offset_bits[3] = (uint16_t)(coded ? 1u << h.n_offsets : 1u);
        expect_refused(s);
        s->offset_bits[3] = bits;
        assert_int_equal(ted4_dump_tier(s, 3, NULL, throw_away, NULL), TED4_OK);
        ted4_scene_free(s);
        free(f.data);
    }
}

/* Returns the positions of the first two anchors in the list whose cells have one parent, so that
 * the tree is the same with either in the other's place. */
static uint16_t *siblings(const ted4_scene *s)
{
    for (size_t i = 0; i + 1 < s->head.n_anchors; i++) {
        uint16_t *p = s->position + 3 * i;

        if (ted4_octree_key(p, s->grid) >> 3 == ted4_octree_key(p + 3, s->grid) >> 3)
            return p;
    }
    fail_msg("no siblings");
    return NULL;
}

/* Positions of profile Compact that are no places of the grid, or whose order is not the tree's. */
static void wrong_places(void **state)
{
    static const uint16_t off[] = { 0x0001, 0x3c00 }; /* 2^-24; 1, the end of the last cell */
    ted4_scene *s = compact_example(1000, 6);
    uint16_t *p = siblings(s);
    uint8_t *data;
    size_t size;
    ted4_error e;

    (void)state;
    for (size_t i = 0; i <= sizeof off / sizeof *off; i++) {
        uint16_t was[6];

        memcpy(was, p, sizeof was);
        if (i < sizeof off / sizeof *off)
            p[0] = off[i];
        else { /* two anchors in each other's place */
            memcpy(p, was + 3, 3 * sizeof *p);
            memcpy(p + 3, was, 3 * sizeof *p);
        }
        assert_int_equal(ted4_encode(s, 0, NULL, &data, &size, &e), TED4_E_POS_COUNT);
        memcpy(p, was, sizeof was);
    }
    ted4_scene_free(s);
}

/* Shifts that no walk has checked. */
static void wrong_shift(void **state)
{
    ted4_scene *s = example();
    ted4_arena arena;
    ted4_prior p;
    ted4_error e = { TED4_OK, 0 };

    (void)state;
    ted4_arena_init(&arena, NULL);
    assert_int_equal(ted4_prior_init(&p, &s->head, &s->shape, &arena), TED4_OK);
    s->shift[5] = TED4_MAX_SHIFT + 1;
    assert_int_equal(ted4_prior_load(&p, s->nete.values, s->shift, &e), TED4_E_NET_SHIFT);
    assert_int_equal(e.offset, 5);
    ted4_arena_finish(&arena);
    ted4_scene_free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(whole_files),  cmocka_unit_test(damaged_files),
        cmocka_unit_test(vectors),      cmocka_unit_test(wrong_masks),
        cmocka_unit_test(wrong_places), cmocka_unit_test(wrong_shift),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
