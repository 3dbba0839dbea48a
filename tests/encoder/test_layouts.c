/* test_layouts.c - a tiny scene written in every layout loads as the same dataset: cameras, times,
 * splits, points, pixels; then features of single layouts (lens terms, reduced pictures, splits by
 * position, arrays of numbers). Links tools/scene/ray_*.o.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>

#include "test.h"
#include "data/undistort.h"
#include "tools/scene/ray_set.h"
#include "larger.h"
#include "tiny_scene.h"

enum {
    W = 48,
    H = 36,
    TRAIN = 2,
    TEST = 1,
    CAMERAS = TRAIN + TEST,
    FRAMES = 3,
    PICTURES = CAMERAS * FRAMES
};

static const ted4_ray_options scene = { .scene = RAY_TURN,
                                        .width = W,
                                        .height = H,
                                        .n_train = TRAIN,
                                        .n_test = TEST,
                                        .n_frames = FRAMES,
                                        .seed = 3 };
static tiny_folder reference_folder;
static ted4_dataset reference;

static void near(double a, double b, double tolerance)
{
    if (!(fabs(a - b) <= tolerance))
        fail_msg("%.12g is not %.12g", a, b);
}

static tiny_folder write_scene(ted4_ray_layout layout, int n_frames, int video)
{
    tiny_folder f = tiny_new();
    ted4_ray_options o = scene;
    ted4_ray_message m;

    o.layout = layout;
    o.n_frames = n_frames;
    o.video = video;
    if (ted4_ray_write(&o, f.path, NULL, &m) != 0)
        fail_msg("%s", m.text);
    return f;
}

static void load(ted4_dataset *d, const tiny_folder *f)
{
    assert_string_equal(tiny_load(d, f, &tiny_options), "");
}

/* Index of the reference's picture with the same pose and frame. */
static size_t twin(const ted4_dataset *r, const ted4_picture *p)
{
    for (size_t i = 0; i < r->n_pictures; i++) {
        const ted4_camera *a = &r->pictures[i].camera;
        double worst = 0;
        for (int k = 0; k < 12; k++)
            worst = larger(worst, k < 9 ? fabs(a->R[k] - p->camera.R[k])
                                        : fabs(a->t[k - 9] - p->camera.t[k - 9]));
        if (worst < 1e-6 && r->pictures[i].frame == p->frame)
            return i;
    }
    fail_msg("%s: no picture of the reference has this pose and frame %u", p->path,
             (unsigned)p->frame);
    return 0;
}

static void same_pixels(ted4_dataset *d, size_t i, ted4_dataset *r, size_t j, int tolerance)
{
    ted4_message m;
    const uint8_t *a = ted4_dataset_pixels(d, i, &m), *b = ted4_dataset_pixels(r, j, &m);

    assert_non_null(a);
    assert_non_null(b);
    for (int k = 0; k < W * H * 3; k++)
        if (abs(a[k] - b[k]) > tolerance)
            fail_msg("%s: byte %d is %d, expected %d", d->pictures[i].path, k, a[k], b[k]);
    ted4_dataset_release(d, i);
    ted4_dataset_release(r, j);
}

static void same_points(const ted4_dataset *d)
{
    assert_int_equal(d->random_points, 0);
    assert_int_equal(d->n_points, reference.n_points);
    assert_memory_equal(d->points, reference.points, 3 * d->n_points * sizeof *d->points);
    assert_memory_equal(d->point_rgb, reference.point_rgb, 3 * d->n_points);
}

/* Asserts that d equals the reference. tolerance: of pixel values. split: whether the layout holds
 * out the test camera. */
static void same_scene(ted4_dataset *d, int tolerance, int split)
{
    int found[PICTURES] = { 0 };

    assert_int_equal(d->n_pictures, PICTURES);
    assert_int_equal(d->n_frames, FRAMES);
    assert_int_equal(d->n_cameras, CAMERAS);
    for (size_t i = 0; i < d->n_pictures; i++) {
        const size_t j = twin(&reference, &d->pictures[i]);
        const ted4_camera *a = &d->pictures[i].camera, *b = &reference.pictures[j].camera;
        assert_int_equal(found[j]++, 0);
        assert_int_equal(a->width, W);
        assert_int_equal(a->height, H);
        near(a->fx, b->fx, 1e-6 * b->fx);
        near(a->fy, b->fy, 1e-6 * b->fy);
        near(a->cx, b->cx, 1e-9);
        near(a->cy, b->cy, 1e-9);
        if (split)
            assert_int_equal(d->pictures[i].is_test, reference.pictures[j].is_test);
        same_pixels(d, i, &reference, j, tolerance);
    }
    same_points(d);
}

static void test_layouts(void **state)
{
    /* The name under which each layout is recognised. Its split is given by: a list, a list, 1 of
     * 8, 1 of 8, a list, the first camera, times. */
    static const char *const names[RAY_LLFF] = { "D-NeRF",    "nerfstudio", "colmap",     "colmap",
                                                 "hypernerf", "neu3d",      "calibration" };
    static const int split[RAY_LLFF] = { 1, 1, 0, 0, 1, 1, 0 };

    (void)state;
    for (int l = 0; l < RAY_LLFF; l++) {
        tiny_folder f = write_scene((ted4_ray_layout)l, FRAMES, 0);
        ted4_dataset d;
        load(&d, &f);
        assert_string_equal(d.layout, names[l]);
        same_scene(&d, 0, split[l]);
        ted4_dataset_free(&d);
        tiny_free(&f);
    }
}

/* A checkpoint refuses a scene whose digest has changed since training began, so a digest may
 * change only if a loader was wrong. */
static void test_digests(void **state)
{
    static const uint64_t known[RAY_LLFF] = {
        0xb5436a4db0da7991, 0xb5436a4db0da7991, 0x91a33f4aee0502c2, 0x91a33f4aee0502c2,
        0xb5436a4db0da7991, 0xb5436a4db0da7991, 0xf5be6c1c9b13f240,
    };

    (void)state;
    for (int l = 0; l < RAY_LLFF; l++) {
        tiny_folder f = write_scene((ted4_ray_layout)l, FRAMES, 0);
        ted4_dataset d;
        load(&d, &f);
        if (ted4_dataset_digest(&d) != known[l])
            fail_msg("%s: digest %llx, expected %llx", ted4_ray_layout_name((ted4_ray_layout)l),
                     (unsigned long long)ted4_dataset_digest(&d), (unsigned long long)known[l]);
        ted4_dataset_free(&d);
        tiny_free(&f);
    }
}

/* Videos */

static int has_ffmpeg(void)
{
    return system("ffmpeg -version >/dev/null 2>&1") == 0;
}

static void test_videos(void **state)
{
    static const ted4_ray_layout layouts[] = { RAY_NEU3D, RAY_CALIBRATION };
    tiny_folder cache;

    (void)state;
    if (!has_ffmpeg()) {
        print_message("skipped: no ffmpeg here\n");
        skip();
    }
    cache = tiny_new();
    setenv("XDG_CACHE_HOME", cache.path, 1);
    for (int l = 0; l < 2; l++) {
        tiny_folder f = write_scene(layouts[l], FRAMES, 1);
        ted4_dataset d, again, few;
        ted4_dataset_options o = tiny_options;
        assert_false(ted4_is_folder(tiny_path(&f, "cam00")));
        load(&d, &f);
        assert_non_null(strstr(d.pictures[0].path, cache.path));
        same_scene(&d, 1, l == 0);
        /* The second time, frames come from the folder, which is rebuilt if a frame is missing. */
        must(remove(d.pictures[1].path) == 0, d.pictures[1].path);
        load(&again, &f);
        assert_string_equal(again.pictures[1].path, d.pictures[1].path);
        same_scene(&again, 1, l == 0);
        o.max_frames = 2;
        assert_string_equal(tiny_load(&few, &f, &o), "");
        assert_int_equal(few.n_frames, 2);
        assert_int_equal(few.n_pictures, 2 * CAMERAS);
        ted4_dataset_free(&few);
        ted4_dataset_free(&again);
        ted4_dataset_free(&d);
        tiny_free(&f);
    }
    tiny_free(&cache);
}

/* Features of single layouts */

/* The frames at times 4 and 12 of all cameras are held out. */
static void test_calibration_split(void **state)
{
    tiny_folder f = write_scene(RAY_CALIBRATION, 13, 0);
    ted4_dataset d;

    (void)state;
    load(&d, &f);
    assert_int_equal(d.n_frames, 13);
    near(d.rate, 30, 0);
    for (size_t i = 0; i < d.n_pictures; i++)
        assert_int_equal(d.pictures[i].is_test, d.pictures[i].frame % 8 == 4);
    ted4_dataset_free(&d);
    tiny_free(&f);
}

/* Every eighth picture is held out, in the order of their names, from the first one on: of nine,
 * two. */
static void test_llff_split(void **state)
{
    ted4_ray_options o = scene;
    ted4_ray_message m;
    tiny_folder f = tiny_new();
    ted4_dataset d;

    (void)state;
    o.layout = RAY_LLFF;
    o.n_frames = 1;
    o.n_train = 8;
    if (ted4_ray_write(&o, f.path, NULL, &m) != 0)
        fail_msg("%s", m.text);
    load(&d, &f);
    assert_int_equal(d.n_pictures, 9);
    for (size_t i = 0; i < 9; i++) {
        int before = 0;

        for (size_t k = 0; k < 9; k++)
            before += strcmp(d.pictures[k].path, d.pictures[i].path) < 0;
        assert_int_equal(d.pictures[i].is_test, (before % 8 == 0));
    }
    ted4_dataset_free(&d);
    tiny_free(&f);
}

/* The pictures in images/camNN/, a table of float32, and a limit on the number of frames. */
static void test_neu3d_forms(void **state)
{
    tiny_folder f = tiny_new();
    ted4_dataset d;
    ted4_dataset_options o = tiny_options;
    tiny_record r = { { 0 }, 0 };
    const char head[] = "{'shape': (2, 17,), 'fortran_order': False, 'descr': '<f4', }\n";
    /* Camera 1 stands at (5, 6, 7), with right = +y, up = +z and back = +x. */
    const float row[17] = { 0, 0, 1, 5, 24, 0, 1, 0, 6, 32, -1, 0, 0, 7, 20, 1, 9 };

    (void)state;
    memcpy(r.bytes, "\x93NUMPY\x02\0", r.n = 8);
    tiny_put(&r, sizeof head - 1, 4);
    memcpy(r.bytes + r.n, head, sizeof head - 1);
    r.n += sizeof head - 1;
    for (int i = 0; i < 34; i++) {
        uint32_t bits;
        memcpy(&bits, &row[i % 17], 4);
        tiny_put(&r, bits, 4);
    }
    tiny_bytes(&f, "poses_bounds.npy", r.bytes, r.n);
    for (int i = 0; i < 8; i++) {
        char name[64];
        snprintf(name, sizeof name, "images/cam%02d/%04d.png", i / 4 * 7, i % 4 + 9998);
        tiny_picture(&f, name, TINY_W, TINY_H, i);
    }
    o.max_frames = 3;
    assert_string_equal(tiny_load(&d, &f, &o), "");
    assert_int_equal(d.n_pictures, 6);
    assert_int_equal(d.n_frames, 3);
    assert_int_equal(d.pictures[0].is_test, 0);
    assert_int_equal(d.pictures[3].is_test, 1);
    assert_non_null(strstr(d.pictures[2].path, "cam07/10000.png"));
    const ted4_camera *c = &d.pictures[0].camera;
    const double world[3] = { 4, 8, 10 }, expected[3] = { 2, -3, 1 };
    for (int i = 0; i < 3; i++)
        near(c->R[3 * i] * world[0] + c->R[3 * i + 1] * world[1] + c->R[3 * i + 2] * world[2] +
                 c->t[i],
             expected[i], 1e-6);
    near(c->fx, 10, 1e-9);
    near(c->cy, 6, 1e-9);
    ted4_dataset_free(&d);
    tiny_free(&f);
}

/* Writes six pictures at half size, whose cameras have all lens terms. */
static void write_lenses(const tiny_folder *f)
{
    tiny_string meta = { "", 0 };

    for (int i = 0; i < 6; i++) {
        tiny_string s = { "", 0 };
        char name[64];
        snprintf(name, sizeof name, "rgb/2x/%d.png", i);
        tiny_picture(f, name, TINY_W, TINY_H, i);
        tiny_add(&s,
                 "{\"orientation\": [[1,0,0],[0,1,0],[0,0,1]], \"position\": [1,2,3], "
                 "\"focal_length\": 20, \"principal_point\": [15, 13],"
                 "\"skew\": 4, \"pixel_aspect_ratio\": 1.1, \"radial_distortion\": [0.1, -0.2, "
                 "0.3], \"%s\": [0.01, -0.02],"
                 "\"image_size\": [32, 24]}",
                 i == 0 ? "tangential" : "tangential_distortion");
        snprintf(name, sizeof name, "camera/%d.json", i);
        tiny_text(f, name, s.text);
        tiny_add(&meta, "%s\"%d\": {\"%s\": %d}", i > 0 ? ", " : "{", i,
                 i == 2 ? "time_id" : "warp_id", 10 * i);
    }
    tiny_add(&meta, "}");
    tiny_text(f, "metadata.json", meta.text);
    tiny_text(f, "dataset.json",
              "{\"ids\": [\"0\", \"1\", \"2\", \"3\", \"4\", \"5\"], \"val_ids\": []}");
}

/* Red grows by 255 / W per column, green by 255 / H per row, so the undistorted picture shows where
 * it was sampled. */
static void check_sampling(ted4_dataset *d)
{
    const double f = 10, g = 11, cx = 7.5, cy = 6.5, k[3] = { 0.1, -0.2, 0.3 }, p1 = 0.01,
                 p2 = -0.02;
    ted4_message m;
    const uint8_t *px = ted4_dataset_pixels(d, 0, &m);

    assert_non_null(px);
    for (int y = 2; y < TINY_H - 2; y++)
        for (int x = 2; x < TINY_W - 2; x++) {
            const double u = (x + 0.5 - cx) / f, v = (y + 0.5 - cy) / g, s = u * u + v * v;
            const double radial = 1 + k[0] * s + k[1] * s * s + k[2] * s * s * s;
            const double a = u * radial + 2 * p1 * u * v + p2 * (s + 2 * u * u);
            const double b = v * radial + 2 * p2 * u * v + p1 * (s + 2 * v * v);
            const uint8_t *at = px + 3 * (TINY_W * y + x);
            near(at[0], (f * a + 2 * b + cx - 0.5) * 255 / TINY_W, 2);
            near(at[1], (g * b + cy - 0.5) * 255 / TINY_H, 2);
        }
    ted4_dataset_release(d, 0);
}

static void test_hypernerf_forms(void **state)
{
    tiny_folder f = tiny_new();
    ted4_dataset d;
    ted4_dataset_options o = tiny_options;
    tiny_record r = { { 0 }, 0 };
    const char head[] = "{'descr': '<f8', 'fortran_order': False, 'shape': (1, 3), }\n";

    (void)state;
    write_lenses(&f);
    memcpy(r.bytes, "\x93NUMPY\x01\0", r.n = 8);
    tiny_put(&r, sizeof head - 1, 2);
    memcpy(r.bytes + r.n, head, sizeof head - 1);
    r.n += sizeof head - 1;
    for (int i = 0; i < 3; i++)
        tiny_put_real(&r, 1.5 * i);
    tiny_bytes(&f, "points.npy", r.bytes, r.n);
    for (int downscale = 1; downscale <= 4; downscale++) {
        o.downscale = downscale;
        if (downscale == 3) { /* 2x copies can be reduced only by even factors */
            assert_non_null(strstr(tiny_load(&d, &f, &o), "a reduction by 3"));
            continue;
        }
        assert_string_equal(tiny_load(&d, &f, &o), "");
        /* Ids 0 and 4 train, 2 is held out, 1, 3 and 5 are left out; times 0, 20, 40. */
        assert_int_equal(d.n_pictures, 3);
        assert_int_equal(d.n_frames, 3);
        assert_int_equal(d.pictures[1].frame, 2);
        assert_int_equal(d.pictures[2].frame, 1);
        assert_int_equal(d.pictures[2].is_test, 1);
        assert_int_equal(d.pictures[0].camera.width, downscale == 4 ? TINY_W / 2 : TINY_W);
        near(d.pictures[0].camera.fx, downscale == 4 ? 5 : 10, 1e-9);
        near(d.pictures[0].camera.fy, downscale == 4 ? 5.5 : 11, 1e-9);
        near(d.pictures[0].camera.t[1], -2, 1e-9);
        assert_int_equal(d.n_points, 1);
        near(d.points[2], 3, 0);
        if (downscale < 3)
            check_sampling(&d);
        ted4_dataset_free(&d);
    }
    tiny_free(&f);
}

static int setup(void **state)
{
    ted4_ray_message m;

    (void)state;
    reference_folder = tiny_new();
    must(ted4_ray_write(&scene, reference_folder.path, NULL, &m) == 0, "reference");
    must(*tiny_load(&reference, &reference_folder, &tiny_options) == 0, "reference");
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    ted4_dataset_free(&reference);
    tiny_free(&reference_folder);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_layouts),         cmocka_unit_test(test_digests),
        cmocka_unit_test(test_videos),          cmocka_unit_test(test_calibration_split),
        cmocka_unit_test(test_llff_split),      cmocka_unit_test(test_neu3d_forms),
        cmocka_unit_test(test_hypernerf_forms),
    };

    return cmocka_run_group_tests_name("layouts", tests, setup, teardown);
}
