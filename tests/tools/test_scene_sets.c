/* test_scene_sets.c - folders of the scenes in which methods fail: what a reader finds in them,
 * held-out times, stated cameras compared with true ones, truth.json; and that the first scenes
 * keep their bytes. Links tools/scene/ray_*.o.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <jansson.h>
#include <math.h>
#include <xxhash.h>

#include "test.h"
#include "larger.h"
#include "tools/scene/ray_rig.h"
#include "tiny_scene.h"

enum { W = 48, H = 32, SIZE = W * H * 3 };

static ted4_ray_options plan(ted4_ray_scene s)
{
    ted4_ray_options o = ted4_ray_defaults(s);

    o.width = W;
    o.height = H;
    return o;
}

static tiny_folder write_set(const ted4_ray_options *o)
{
    tiny_folder f = tiny_new();
    ted4_ray_message m;

    if (ted4_ray_write(o, f.path, NULL, &m) != 0)
        fail_msg("%s", m.text);
    return f;
}

/* The defaults of the lab: the expected table, written a second time. */
static const struct {
    const char *name;
    int n_train, n_test, n_frames, held;
} sets[] = {
    { "hide", 6, 2, 16, 0 },    { "blink", 6, 2, 16, 2 },   { "fast", 6, 2, 16, 2 },
    { "split", 6, 2, 16, 2 },   { "tints", 6, 2, 16, 2 },   { "flicker", 6, 2, 16, 0 },
    { "bare", 6, 2, 16, 2 },    { "far", 6, 2, 16, 2 },     { "wide", 6, 2, 16, 2 },
    { "pair", 2, 1, 16, 2 },    { "long", 3, 1, 600, 75 },  { "wires", 6, 2, 16, 2 },
    { "shaken", 6, 2, 16, 2 },  { "change", 6, 2, 16, 2 },  { "empty", 6, 2, 16, 2 },
    { "moment", 8, 2, 1, 0 },   { "alone", 1, 1, 24, 3 },   { "edge", 6, 2, 16, 2 },
    { "dusk", 6, 2, 16, 2 },    { "tints4", 4, 4, 16, 2 },  { "things0", 6, 2, 16, 2 },
    { "things1", 6, 2, 16, 2 }, { "things2", 6, 2, 16, 2 }, { "things4", 6, 2, 16, 2 },
    { "things8", 6, 2, 16, 2 }, { "rest", 6, 2, 32, 4 },    { "toys", 10, 2, 16, 0 },
    { "relay", 5, 2, 117, 0 },
};

/* Returns a member of truth.json, which must be a list of n entries if n is not negative. */
static const json_t *member(const json_t *truth, const char *name, int n)
{
    const json_t *const v = json_object_get(truth, name);

    if (v == NULL)
        fail_msg("truth.json has no %s", name);
    if (n >= 0)
        assert_int_equal(json_array_size(v), n);
    return v;
}

static void check_truth(const tiny_folder *f, const ted4_ray_options *o, int held)
{
    json_t *const truth = json_load_file(tiny_path(f, "truth.json"), 0, NULL);

    assert_non_null(truth);
    assert_string_equal(json_string_value(member(truth, "scene", -1)),
                        ted4_ray_scene_name(o->scene));
    assert_int_equal(json_integer_value(member(truth, "frames", -1)), o->n_frames);
    member(truth, "lamp", o->n_frames);
    member(truth, "solids", o->n_frames);
    member(truth, "turned_away", o->scene == RAY_EMPTY);
    const json_t *const times = member(truth, "held_times", held);
    for (int i = 0; i < held; i++)
        assert_int_equal(json_integer_value(json_array_get(times, (size_t)i)), 8 * i + 4);
    const json_t *const cameras = member(truth, "cameras", o->n_train + o->n_test);
    for (int i = 0; i < o->n_train + o->n_test; i++) {
        const json_t *const c = json_array_get(cameras, (size_t)i);
        const int same = json_equal(json_object_get(c, "true"), json_object_get(c, "stated"));
        assert_int_equal(same, o->scene != RAY_SHAKEN || i >= o->n_train);
        assert_int_equal(json_array_size(json_object_get(c, "colour")), 3);
    }
    json_decref(truth);
}

/* Every set, with pictures as small as possible, is read as the table says. Training pictures have
 * none of the held-out times, test pictures have all times, or these if the cameras are the same.
 */
static void test_sets(void **state)
{
    (void)state;
    assert_int_equal(sizeof sets / sizeof sets[0], RAY_SCENES - RAY_HIDE);
    for (int i = 0; i < RAY_SCENES - RAY_HIDE; i++) {
        ted4_ray_options o = ted4_ray_defaults((ted4_ray_scene)(RAY_HIDE + i));
        const int in_turns = o.scene == RAY_RELAY, same = o.scene == RAY_TINTS4;
        const int times = same ? sets[i].held : sets[i].n_frames;
        ted4_dataset d;
        size_t test = 0;

        assert_string_equal(ted4_ray_scene_name(o.scene), sets[i].name);
        o.width = o.height = 8;
        tiny_folder f = write_set(&o);
        assert_string_equal(tiny_load(&d, &f, &tiny_options), "");
        for (size_t k = 0; k < d.n_pictures; k++) {
            test += d.pictures[k].is_test;
            if (!d.pictures[k].is_test && sets[i].held > 0)
                assert_int_not_equal(d.pictures[k].frame % 8, 4);
        }
        assert_int_equal(test, in_turns ? 33 : sets[i].n_test * times);
        assert_int_equal(d.n_pictures - test,
                         in_turns ? 84 : sets[i].n_train * (sets[i].n_frames - sets[i].held));
        assert_int_equal(d.n_cameras, sets[i].n_train + (same ? 0 : sets[i].n_test));
        assert_int_equal(d.n_frames, sets[i].n_frames);
        assert_int_equal(d.n_points, TED4_RAY_POINTS);
        check_truth(&f, &o, sets[i].held);
        ted4_dataset_free(&d);
        tiny_free(&f);
    }
}

/* Held-out times in every layout that has lists; in the other layouts with several times, all
 * pictures are present. */
static void test_layouts(void **state)
{
    (void)state;
    for (int l = 0; l < RAY_LLFF; l++) {
        ted4_ray_options o = ted4_ray_defaults(RAY_BLINK);
        ted4_dataset d;
        size_t train = 0;

        o.width = o.height = 8;
        o.n_train = 2;
        o.n_test = 1;
        o.layout = (ted4_ray_layout)l;
        tiny_folder f = write_set(&o);
        assert_string_equal(tiny_load(&d, &f, &tiny_options), "");
        for (size_t k = 0; k < d.n_pictures; k++)
            train += !d.pictures[k].is_test;
        assert_int_equal(d.n_pictures, ted4_ray_has_lists(o.layout) ? 44 : 48);
        if (ted4_ray_has_lists(o.layout))
            assert_int_equal(train, 28);
        ted4_dataset_free(&d);
        tiny_free(&f);
    }
}

/* ---- cameras ---- */

static double distance(const double a[3], const double b[3])
{
    return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) +
                (a[2] - b[2]) * (a[2] - b[2]));
}

static void centre_of(const ted4_ray_camera *c, double x[3])
{
    for (int i = 0; i < 3; i++)
        x[i] = c->matrix[i][3];
}

/* A point of a disturbed or moved scene has the same position relative to its stated camera as the
 * point of the plain scene relative to the true camera. Files store points in single precision: the
 * error at a distance of 1,000 units is 3e-5 units, and 8e-4 pixels. */
static void check_points(const ted4_ray_options *o, const ted4_ray_options *plain)
{
    for (int i = 0; i < 200; i++) {
        const ted4_ray_point a = ted4_ray_point_at(o, i), b = ted4_ray_point_at(plain, i);
        const double p[3] = { (double)a.point.x, (double)a.point.y, (double)a.point.z };
        const double q[3] = { (double)b.point.x, (double)b.point.y, (double)b.point.z };
        double at[2], expected[2];
        ted4_ray_camera c;

        ted4_ray_camera_stated(o, a.camera, &c);
        const double depth = ted4_ray_project(&c, p, at);
        ted4_ray_camera_of(plain, b.camera, &c);
        assert_true(
            fabs(depth / (ted4_ray_plan_of(o->scene)->scale * ted4_ray_project(&c, q, expected)) -
                 1) < 1e-4);
        assert_true(fabs(at[0] - expected[0]) < 0.01);
        assert_true(fabs(at[1] - expected[1]) < 0.01);
        assert_memory_equal(a.rgb, b.rgb, 3);
    }
}

static void test_shaken(void **state)
{
    const ted4_ray_options o = plan(RAY_SHAKEN);
    ted4_ray_options plain = o;
    double mean[6] = { 0 }, size = 0;

    (void)state;
    plain.pose_error = 0;
    for (int i = 0; i < o.n_train + o.n_test; i++) {
        ted4_ray_camera is, stated;
        double turn[3], move[3], a[3], b[3], trace = 0;
        ted4_ray_camera_of(&o, i, &is);
        ted4_ray_camera_stated(&o, i, &stated);
        if (i >= o.n_train) {
            assert_memory_equal(is.matrix, stated.matrix, sizeof is.matrix);
            continue;
        }
        ted4_ray_pose_error(&o, i, turn, move);
        for (int k = 0; k < 3; k++) {
            mean[k] += turn[k];
            mean[3 + k] += move[k];
            for (int r = 0; r < 3; r++)
                trace += is.matrix[r][k] * stated.matrix[r][k];
        }
        const double angle = acos((trace - 1) / 2) * 180 / RAY_PI;
        centre_of(&is, a);
        centre_of(&stated, b);
        assert_true(angle > 0.1);
        assert_true(angle < 0.9);
        assert_true(distance(a, b) > 0.005);
        assert_true(distance(a, b) < 0.06);
        assert_true(fabs(angle * RAY_PI / 180 -
                         sqrt(turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2])) < 1e-8);
        size += angle / o.n_train;
    }
    assert_true(size > 0.25);
    assert_true(size < 0.55);
    for (int k = 0; k < 6; k++)
        assert_true(fabs(mean[k]) < 1e-12);
    check_points(&o, &plain);
}

/* The pictures of far and wide are the same, but their positions in the files differ. */
static void test_far_and_wide(void **state)
{
    static const double origin[3] = { 0, 0, 0 };
    static uint8_t a[SIZE], b[SIZE];
    const ted4_ray_options far = plan(RAY_FAR), wide = plan(RAY_WIDE), plain = plan(RAY_BARE);
    double low = INFINITY, high = -INFINITY;
    ted4_ray_camera c;
    ted4_ray_world w;

    (void)state;
    for (int i = 0; i < far.n_train + far.n_test; i++) {
        double x[3];
        ted4_ray_camera_stated(&far, i, &c);
        centre_of(&c, x);
        assert_true(fabs(distance(x, origin) - 1000) < 6);
        ted4_ray_camera_of(&far, i, &c);
        ted4_ray_world_at(&w, RAY_FAR, 1, 7, 16);
        ted4_ray_render(&w, &c, a);
        ted4_ray_camera_of(&wide, i, &c);
        ted4_ray_world_at(&w, RAY_WIDE, 1, 7, 16);
        ted4_ray_render(&w, &c, b);
        assert_memory_equal(a, b, SIZE);
    }
    assert_true(fabs((double)(w.room_high.x - w.room_low.x) * ted4_ray_plan_of(RAY_WIDE)->scale -
                     1000) < 1e-3);
    for (int i = 0; i < TED4_RAY_POINTS; i++) {
        const double x = (double)ted4_ray_point_at(&wide, i).point.x;
        low = fmin(low, x);
        high = larger(high, x);
    }
    assert_true(high - low > 950);
    assert_true(high - low < 1010);
    ted4_ray_options turn = plain;
    turn.scene = RAY_TURN;
    check_points(&far, &turn);
    check_points(&wide, &turn);
}

static double azimuth_of(const ted4_ray_options *o, int number)
{
    ted4_ray_camera c;

    ted4_ray_camera_of(o, number, &c);
    return atan2(c.matrix[0][2], -c.matrix[1][2]) * 180 / RAY_PI;
}

/* Two cameras near the middle of the arc, with the test camera between them. */
static void test_pair(void **state)
{
    const ted4_ray_options o = plan(RAY_PAIR);

    (void)state;
    assert_true(azimuth_of(&o, 1) - azimuth_of(&o, 0) > 10);
    assert_true(azimuth_of(&o, 1) - azimuth_of(&o, 0) < 20);
    assert_true(fabs(azimuth_of(&o, 2) - (azimuth_of(&o, 0) + azimuth_of(&o, 1)) / 2) < 1e-6);
}

/* ---- the first scenes ---- */

static uint64_t digest_of(uint64_t digest, const tiny_folder *f, const char *name)
{
    const size_t size = tiny_size(f, name);
    uint8_t *const bytes = malloc(size);
    FILE *const in = fopen(tiny_path(f, name), "rb");

    must(bytes != NULL && in != NULL && fread(bytes, 1, size, in) == size, name);
    fclose(in);
    digest = XXH3_64bits_withSeed(bytes, size, digest);
    free(bytes);
    return digest;
}

/* Published results refer to these six scenes: pictures (their pixels, since the bytes of a png
 * depend on zlib), poses and points must never change. */
static void test_first_scenes(void **state)
{
    static const uint64_t expected[RAY_FAIR + 1] = { 0x7ebe707bb353771a, 0x8279dfb403aee29c,
                                                     0xfcd9521557f18fc5, 0x6296e30d4d1a2f63,
                                                     0x0276803685b99907, 0xb25d7b32f1a3ee94 };
    static uint8_t rgb[SIZE];

    (void)state;
    for (int s = 0; s <= RAY_FAIR; s++) {
        ted4_ray_options o = plan((ted4_ray_scene)s);
        uint64_t digest = 0;
        ted4_ray_camera c;
        ted4_ray_world w;

        o.n_train = 3;
        tiny_folder f = write_set(&o);
        for (int frame = 0; frame < o.n_frames; frame += 5) {
            ted4_ray_camera_of(&o, 1, &c);
            ted4_ray_world_at(&w, o.scene, o.seed, frame, o.n_frames);
            ted4_ray_render(&w, &c, rgb);
            digest = XXH3_64bits_withSeed(rgb, SIZE, digest);
        }
        digest = digest_of(digest, &f, "transforms_train.json");
        digest = digest_of(digest, &f, "transforms_test.json");
        digest = digest_of(digest, &f, "points3d.ply");
        assert_int_equal(access(tiny_path(&f, "truth.json"), F_OK), -1);
        tiny_free(&f);
        if (digest != expected[s])
            fail_msg("%s: 0x%016llx", ted4_ray_scene_name(o.scene), (unsigned long long)digest);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sets),   cmocka_unit_test(test_layouts),
        cmocka_unit_test(test_shaken), cmocka_unit_test(test_far_and_wide),
        cmocka_unit_test(test_pair),   cmocka_unit_test(test_first_scenes),
    };

    return cmocka_run_group_tests_name("scene sets", tests, NULL, NULL);
}
