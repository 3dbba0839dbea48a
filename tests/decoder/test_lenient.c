/* test_lenient.c - spec 3.3: lenient decoding of a truncated or damaged file gives the first tiles
 * of the original scene, whole tiles only, and never more than those before the first error; of a
 * valid file it gives the same scene.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "test.h"
#include "fuzz/fix_hashes.h"
#include "random_scene.h"
#include "run_json.h"
#include "tool/threads.h"

enum { N_FILES = 6, MAX_CHUNKS = 32, N_MUTATIONS = 2000 };

/* A valid file, its scene, and the ends of its tiles. */
typedef struct {
    uint8_t *data;
    size_t size;
    ted4_scene *scene;
    size_t tile_end[MAX_CHUNKS]; /* offset after each TILE */
    unsigned n_tiles;
} truth;

static truth file[N_FILES];

static void find_tiles(truth *f)
{
    for (size_t at = 12; at < f->size; at += ted4_chunk_size(f->data, f->size, at))
        if (memcmp(f->data + at, "TILE", 4) == 0) {
            assert_true(f->n_tiles < MAX_CHUNKS);
            f->tile_end[f->n_tiles++] = at + ted4_chunk_size(f->data, f->size, at);
        }
}

static int setup(void **state)
{
    (void)state;
    for (int i = 0; i < N_FILES; i++) {
        random_source r = random_seed((uint64_t)i + 100);
        ted4_header h = random_header(&r);
        ted4_scene *s;

        h.n_anchors = 64 * (uint32_t)(i + 1) + (i % 2 ? 17 : 0);
        h.tile_size = i == 4 ? 1000 : 64;
        h.feature_dim = h.slice[0] = 3; /* small, so that the file can be truncated at every byte */
        h.n_slices = 1;
        h.ar_width = 0;
        s = random_scene_of(&r, &h, i % 2);
        if (s == NULL || ted4_encode(s, 0, NULL, &file[i].data, &file[i].size, NULL) != TED4_OK ||
            ted4_decode(file[i].data, file[i].size, NULL, &file[i].scene, NULL) != TED4_OK)
            return -1;
        find_tiles(&file[i]);
        ted4_scene_free(s);
    }
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    for (int i = 0; i < N_FILES; i++) {
        ted4_scene_free(file[i].scene);
        free(file[i].data);
    }
    return 0;
}

/* Asserts that every value of anchors 0 .. n - 1 is the same. */
static void assert_beginning(const ted4_scene *whole, const ted4_scene *part)
{
    const size_t n = part->head.n_anchors, all = whole->head.n_anchors;

    assert_true(n <= all);
    assert_memory_equal(part->position, whole->position, 6 * n);
    assert_memory_equal(part->dynamic, whole->dynamic, n);
    assert_memory_equal(part->offset_bits, whole->offset_bits, 2 * n);
    for (int t = 0; t < TED4_TYPES; t++) {
        assert_int_equal(part->shape.dim[t], whole->shape.dim[t]);
        if (part->shape.dim[t] > 0)
            assert_memory_equal(part->step_index[t], whole->step_index[t], n);
        for (size_t c = 0; c < part->shape.dim[t]; c++)
            assert_memory_equal(part->symbol[t] + c * n, whole->symbol[t] + c * all, 2 * n);
    }
}

static uint32_t anchors_of(const truth *f, unsigned n_tiles)
{
    const uint64_t n = (uint64_t)n_tiles * f->scene->head.tile_size;

    return n < f->scene->head.n_anchors ? (uint32_t)n : f->scene->head.n_anchors;
}

static void cut_at(const truth *f, size_t size, const ted4_options *o)
{
    unsigned n = 0;
    ted4_salvage what;
    ted4_scene *s;
    ted4_error e;

    while (n < f->n_tiles && f->tile_end[n] <= size)
        n++;
    assert_int_equal(ted4_decode_lenient(f->data, size, o, &s, &what), TED4_E_CON_TRUNCATED);
    assert_int_equal(ted4_decode(f->data, size, NULL, &(ted4_scene *) { NULL }, &e),
                     TED4_E_CON_TRUNCATED);
    assert_int_equal(what.verdict.code, e.code);
    assert_int_equal(what.verdict.offset, e.offset);
    assert_int_equal(what.n_tiles, n);
    assert_int_equal(what.stop.code, TED4_E_CON_TRUNCATED);
    assert_int_equal(what.stop.offset, size);
    assert_int_equal(s != NULL, n > 0);
    if (s == NULL)
        return;
    assert_int_equal(what.tiles_declared, f->n_tiles);
    assert_int_equal(what.anchors_declared, f->scene->head.n_anchors);
    assert_int_equal(s->head.n_anchors, anchors_of(f, n));
    assert_beginning(f->scene, s);
    ted4_scene_free(s);
}

/* Tests every truncation; with threads, only those that cost little more. */
static void truncations(void **state)
{
    ted4_parallel p;
    ted4_options o = { .parallel = &p };

    (void)state;
    ted4_threads_init(&p, 2);
    for (int i = 0; i < N_FILES; i++)
        for (size_t size = 0; size < file[i].size; size++)
            cut_at(&file[i], size, size % 16 == 0 ? &o : NULL);
    ted4_threads_finish(&p);
}

static void whole_files(void **state)
{
    (void)state;
    for (int i = 0; i < N_FILES; i++) {
        ted4_salvage what;
        ted4_scene *s;
        ted4_info info, want;

        assert_int_equal(ted4_decode_lenient(file[i].data, file[i].size, NULL, &s, &what), TED4_OK);
        ted4_scene_info(s, &info);
        ted4_scene_info(file[i].scene, &want);
        assert_memory_equal(&info, &want, sizeof info);
        assert_int_equal(what.stop.code, TED4_OK);
        assert_int_equal(what.n_tiles, file[i].n_tiles);
        ted4_scene_free(s);
    }
}

/* Changes bytes anywhere, with chunk hashes corrected or not: at most the whole tiles before the
 * first error are delivered, and they equal the original if nothing before them was changed. */
static void damage(void **state)
{
    random_source r = random_seed(5);
    unsigned saved = 0;

    (void)state;
    for (int i = 0; i < N_MUTATIONS; i++) {
        const truth *f = &file[random_in(&r, 0, N_FILES - 1)];
        const size_t at = random_in(&r, 0, (uint32_t)f->size - 1);
        ted4_salvage what;
        ted4_scene *s, *strict;
        ted4_error e;
        uint8_t *const copy = malloc(f->size);

        assert_non_null(copy);
        memcpy(copy, f->data, f->size);
        copy[at] ^= (uint8_t)random_in(&r, 1, 255);
        if (i % 2 == 1)
            ted4_fix_hashes(copy, f->size);
        (void)ted4_decode_lenient(copy, f->size, NULL, &s, &what);
        (void)ted4_decode(copy, f->size, NULL, &strict, &e);
        ted4_scene_free(strict);
        assert_int_equal(what.verdict.code, e.code);
        assert_int_equal(what.verdict.offset, e.offset);
        if (e.code != TED4_OK && s != NULL) {
            saved++;
            assert_true(what.n_tiles > 0);
            assert_int_not_equal(what.stop.code, TED4_OK);
            assert_true(what.stop.offset >= f->tile_end[what.n_tiles - 1]);
            if (at >= f->tile_end[what.n_tiles - 1])
                assert_beginning(f->scene, s);
        }
        ted4_scene_free(s);
        free(copy);
    }
    assert_true(saved > N_MUTATIONS / 16);
}

/* The reduced scene is a valid scene: it can be written to a file, with its hash, and queried, and
 * its records are the first ones of the complete scene. */
static void queries(void **state)
{
    const truth *f = &file[5];
    const ted4_query q = { 1, 3, { 0.5f, 0, -2 } };
    ted4_gaussians part, whole;
    ted4_info before, after;
    ted4_recon *a, *b;
    ted4_salvage what;
    ted4_scene *s, *again;
    uint8_t *data;
    size_t size;

    (void)state;
    assert_int_equal(ted4_decode_lenient(f->data, f->tile_end[2] + 3, NULL, &s, &what),
                     TED4_E_CON_TRUNCATED);
    ted4_scene_info(s, &before);
    assert_int_equal(ted4_encode(s, 0, NULL, &data, &size, NULL), TED4_OK);
    assert_int_equal(ted4_decode(data, size, NULL, &again, NULL), TED4_OK);
    ted4_scene_info(again, &after);
    assert_memory_equal(before.hash, after.hash, sizeof after.hash);
    assert_beginning(f->scene, again);
    ted4_scene_free(again);
    free(data);
    assert_int_equal(ted4_recon_new(&a, s, NULL), TED4_OK);
    assert_int_equal(ted4_recon_new(&b, f->scene, NULL), TED4_OK);
    assert_int_equal(ted4_recon_query(a, &q, NULL, &part), TED4_OK);
    assert_int_equal(ted4_recon_query(b, &q, NULL, &whole), TED4_OK);
    assert_true(part.n > 0);
    assert_true(part.n < whole.n);
    assert_memory_equal(part.id, whole.id, part.n * sizeof *part.id);
    assert_memory_equal(part.mean[1], whole.mean[1], part.n * sizeof(float));
    assert_memory_equal(part.opacity, whole.opacity, part.n * sizeof(float));
    ted4_recon_free(a);
    ted4_recon_free(b);
    ted4_scene_free(s);
}

/* Nothing is saved that needs more memory than allowed. */
static void memory(void **state)
{
    const truth *f = &file[5];
    const ted4_options o = { .max_bytes = 4096 };
    ted4_salvage what;
    ted4_scene *s;

    (void)state;
    assert_int_equal(ted4_decode_lenient(f->data, f->tile_end[2] + 3, &o, &s, &what),
                     TED4_E_CON_TRUNCATED);
    assert_null(s);
    assert_int_equal(what.stop.code, TED4_E_LIMIT_MEMORY);
    assert_int_equal(ted4_decode_lenient(f->data, f->size, &o, &s, &what), TED4_E_LIMIT_MEMORY);
    assert_null(s);
}

/* Nothing is saved that a limit on work forbids. */
static void work(void **state)
{
    const truth *f = &file[5];
    const ted4_options o = { .max_work = f->size };
    ted4_salvage what;
    ted4_scene *s;

    (void)state;
    assert_int_equal(ted4_decode_lenient(f->data, f->tile_end[2] + 3, &o, &s, &what),
                     TED4_E_CON_TRUNCATED);
    assert_null(s);
    assert_int_equal(what.stop.code, TED4_E_LIMIT_WORK);
    assert_int_equal(ted4_decode_lenient(f->data, f->size, &o, &s, &what), TED4_E_LIMIT_WORK);
    assert_null(s);
    assert_int_equal(what.stop.code, TED4_E_LIMIT_WORK);
}

/* ted4dec gives warnings if something was saved, and refuses the file if nothing was, or if lenient
 * decoding was not asked for. */
static void program(void **state)
{
    const truth *f = &file[5];
    json_t *o, *saved;

    (void)state;
    if (getenv("TED4_BUILD") == NULL) {
        print_message("skipped: TED4_BUILD is not set\n");
        skip();
    }
    assert_int_equal(
        run_json("ted4dec --json -q --lenient --test", f->data, f->tile_end[2] + 3, &o), 2);
    saved = json_object_get(o, "salvage");
    assert_string_equal(json_string_value(json_object_get(o, "verdict")), "invalid");
    assert_string_equal(json_string_value(json_object_get(o, "error")), "con.truncated");
    assert_int_equal(json_integer_value(json_object_get(saved, "tiles")), 3);
    assert_int_equal(json_integer_value(json_object_get(saved, "tiles_declared")), f->n_tiles);
    assert_int_equal(json_integer_value(json_object_get(saved, "anchors")), 3 * 64);
    assert_int_equal(json_integer_value(json_object_get(saved, "anchors_declared")),
                     f->scene->head.n_anchors);
    json_decref(o);
    assert_int_equal(run_json("ted4dec --json -q --test", f->data, f->tile_end[2] + 3, &o), 1);
    assert_null(json_object_get(o, "salvage"));
    json_decref(o);
    assert_int_equal(
        run_json("ted4dec --json -q --lenient --test", f->data, f->tile_end[0] - 1, &o), 1);
    json_decref(o);
    assert_int_equal(run_json("ted4dec --json -q --max-work 5000 --test", f->data, f->size, &o), 3);
    assert_string_equal(json_string_value(json_object_get(o, "error")), "limit.work");
    json_decref(o);
    assert_int_equal(run_json("ted4dec --json -q --max-memory 5000 --test", f->data, f->size, &o),
                     3);
    assert_string_equal(json_string_value(json_object_get(o, "error")), "limit.memory");
    json_decref(o);
    assert_int_equal(run_json("ted4dec --json -q --lenient --test", f->data, f->size, &o), 0);
    assert_string_equal(json_string_value(json_object_get(o, "verdict")), "valid");
    json_decref(o);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(truncations), cmocka_unit_test(whole_files), cmocka_unit_test(damage),
        cmocka_unit_test(queries),     cmocka_unit_test(memory),      cmocka_unit_test(work),
        cmocka_unit_test(program),
    };

    return cmocka_run_group_tests(tests, setup, teardown);
}
