/* test_scene.c - the project's own scenes: cameras, motion, points and files. For shapes see
 * test_scene_shapes.c. Links tools/scene/ray_*.o.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <dirent.h>
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "test.h"
#include "larger.h"
#include "tools/scene/ray_set.h"
#include "tools/scene/ray_texture.h"
#include "temporary.h"

enum { W = 48, H = 36, SIZE = W * H * 3, ALL_FILES = 3 };

/* ---- cameras ---- */

static void check_camera(const ted4_ray_camera *c)
{
    const double(*const m)[4] = c->matrix;

    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            const double dot = m[0][i] * m[0][j] + m[1][i] * m[1][j] + m[2][i] * m[2][j];
            assert_true(fabs(dot - (i == j)) < 1e-14);
        }
        assert_true(m[3][i] == 0);
    }
    assert_true(m[3][3] == 1);
    assert_true(m[2][1] > 0);
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        assert_true(fabs(m[j][0] * m[k][1] - m[k][0] * m[j][1] - m[i][2]) < 1e-9);
    }
    assert_true(fabs(c->focal - 0.5 * c->width / tan(0.5 * ted4_ray_angle_x)) < 1e-9 * c->width);
}

static double azimuth_of(const ted4_ray_camera *c)
{
    return atan2(c->matrix[0][2], -c->matrix[1][2]);
}

static void test_cameras(void **state)
{
    ted4_ray_camera train[12], c;

    (void)state;
    for (int i = 0; i < 12; i++) {
        ted4_ray_camera_train(&train[i], i, 12, 160, 120);
        check_camera(&train[i]);
    }
    for (int i = 0; i < 2; i++) {
        double below = -9, above = 9;
        ted4_ray_camera_test(&c, i, 2, 12, 160, 120);
        check_camera(&c);
        for (int k = 0; k < 12; k++) {
            const double a = azimuth_of(&train[k]);
            if (a < azimuth_of(&c))
                below = larger(below, a);
            else
                above = fmin(above, a);
        }
        assert_true(above - below > 0.05);
        assert_true(above - below < 0.2);
        assert_true(fabs(azimuth_of(&c) - (above + below) / 2) < 1e-9);
    }
    ted4_ray_camera_train(&c, 0, 1, 64, 200);
    check_camera(&c);
    ted4_ray_camera_test(&c, 3, 5, 1, 64, 200);
    check_camera(&c);
}

/* A bright ball of radius 0.12 changes the picture of the empty room only around its projection. */
static void test_marker(void **state)
{
    static uint8_t plain[SIZE * 4], marked[SIZE * 4];
    const double at[3] = { -0.4, -0.3, 1.3 };
    ted4_ray_object o = { .kind = RAY_SPHERE,
                          .size = v3(.12f, .12f, .12f),
                          .rot = { 1, 0, 0, 0, 1, 0, 0, 0, 1 },
                          .pos = v3((float)at[0], (float)at[1], (float)at[2]),
                          .colour = { { 30, 0, 30 } } };

    (void)state;
    for (int i = 0; i < 3; i++) {
        double sum[3] = { 0 }, pixel[2];
        ted4_ray_camera c;
        ted4_ray_world w;

        ted4_ray_camera_train(&c, i, 3, 2 * W, 2 * H);
        ted4_ray_world_empty(&w, 1);
        ted4_ray_render(&w, &c, plain);
        assert_non_null(ted4_ray_add(&w, &o));
        ted4_ray_render(&w, &c, marked);
        for (int p = 0; p < 4 * W * H; p++) {
            if (marked[3 * p] == 255 && marked[3 * p + 1] < 9 && plain[3 * p + 1] >= 9) {
                sum[0] += p % (2 * W) + 0.5;
                sum[1] += p / (2 * W) + 0.5;
                sum[2]++;
            }
        }
        assert_true(ted4_ray_project(&c, at, pixel) > 0);
        assert_true(sum[2] > 8);
        assert_true(fabs(sum[0] / sum[2] - pixel[0]) < 0.4);
        assert_true(fabs(sum[1] / sum[2] - pixel[1]) < 0.4);
        assert_int_equal(ted4_ray_look(&w, &c, pixel[0], pixel[1]).object, 0);
    }
}

/* ---- motion ---- */

static void picture(ted4_ray_scene s, int frame, int n_frames, uint8_t *rgb)
{
    ted4_ray_camera c;
    ted4_ray_world w;

    ted4_ray_camera_train(&c, 1, 3, W, H);
    ted4_ray_world_at(&w, s, 1, frame, n_frames);
    ted4_ray_render(&w, &c, rgb);
}

/* Returns the share of bytes that differ by more than 16. */
static double changed(const uint8_t *a, const uint8_t *b)
{
    int n = 0;

    for (int i = 0; i < SIZE; i++)
        n += abs(a[i] - b[i]) > 16;
    return (double)n / SIZE;
}

static void test_motion(void **state)
{
    static uint8_t a[SIZE], b[SIZE];

    (void)state;
    for (int s = 0; s <= RAY_FAIR; s++) {
        picture((ted4_ray_scene)s, 0, 9, a);
        picture((ted4_ray_scene)s, 4, 9, b);
        if (s == RAY_STILL)
            assert_memory_equal(a, b, SIZE);
        else
            assert_true(changed(a, b) > 0.03);
    }
    picture(RAY_POP, 8, 16, a);
    picture(RAY_POP, 10, 16, b);
    assert_memory_equal(a, b, SIZE);
    picture(RAY_POP, 11, 16, b);
    assert_true(changed(a, b) > 0.03);
}

/* Returns the number of pixels that show the last object, which is the one that moves. */
static int seen(ted4_ray_scene s, int frame, int n_frames)
{
    ted4_ray_camera c;
    ted4_ray_world w;
    int n = 0;

    ted4_ray_camera_train(&c, 1, 3, W, H);
    ted4_ray_world_at(&w, s, 1, frame, n_frames);
    for (int i = 0; i < W * H; i++)
        n += ted4_ray_look(&w, &c, i % W + 0.5, i / W + 0.5).object == w.n - 1;
    return n;
}

static void test_occlusion(void **state)
{
    int least = W * H;

    (void)state;
    for (int j = 0; j < 9; j++) {
        const int n = seen(RAY_OCCLUDER, j, 16);
        least = n < least ? n : least;
    }
    assert_int_equal(least, 0);
    assert_true(seen(RAY_OCCLUDER, 0, 16) > W * H / 60);
    assert_true(seen(RAY_OCCLUDER, 15, 16) > W * H / 60);
    assert_true(seen(RAY_BEND, 8, 16) > W * H / 30);
}

/* ---- points ---- */

/* A point lies on a surface that its own camera sees, and has the colour of that surface. */
static void test_points_on_surfaces(void **state)
{
    ted4_ray_options o = { .scene = RAY_STILL,
                           .width = W,
                           .height = H,
                           .n_train = 3,
                           .n_test = 1,
                           .n_frames = 5,
                           .seed = 1 };

    (void)state;
    for (int s = 0; s <= RAY_FAIR; s++) {
        int near = 0, moving = 0;
        o.scene = (ted4_ray_scene)s;
        for (int i = 0; i < 400; i++) {
            const ted4_ray_point p = ted4_ray_point_at(&o, i);
            const double world[3] = { (double)p.point.x, (double)p.point.y, (double)p.point.z };
            double pixel[2];
            ted4_ray_camera c;
            ted4_ray_world w;

            assert_true(p.camera >= 0);
            assert_true(p.camera < 3);
            assert_true(p.frame >= 0);
            assert_true(p.frame < 5);
            ted4_ray_camera_train(&c, p.camera, 3, W, H);
            ted4_ray_world_at(&w, o.scene, o.seed, p.frame, o.n_frames);
            assert_true(ted4_ray_project(&c, world, pixel) > 0);
            const ted4_ray_sight r = ted4_ray_look(&w, &c, pixel[0], pixel[1]);
            near += v3_length(v3_sub(r.point, p.point)) < 0.09f;
            moving += r.object >= 6;
        }
        assert_true(near > 375);
        assert_true(moving > 8);
    }
}

/* Projects points of the still scene into the picture of another camera: where nothing occludes
 * them the colours agree, except at edges. */
static void test_points_colours(void **state)
{
    static uint8_t rgb[SIZE * 9];
    const ted4_ray_options o = { .scene = RAY_STILL,
                                 .width = W,
                                 .height = H,
                                 .n_train = 3,
                                 .n_test = 1,
                                 .n_frames = 5,
                                 .seed = 1 };
    ted4_ray_camera c;
    ted4_ray_world w;
    int shown = 0, alike = 0;

    (void)state;
    ted4_ray_camera_train(&c, 1, 3, 3 * W, 3 * H);
    ted4_ray_world_at(&w, RAY_STILL, o.seed, 2, 5);
    ted4_ray_render(&w, &c, rgb);
    for (int i = 0; i < 900; i++) {
        const ted4_ray_point p = ted4_ray_point_at(&o, i);
        const double world[3] = { (double)p.point.x, (double)p.point.y, (double)p.point.z };
        double pixel[2];

        if (ted4_ray_project(&c, world, pixel) <= 0 || pixel[0] < 0 || pixel[1] < 0 ||
            pixel[0] >= c.width || pixel[1] >= c.height)
            continue;
        if (v3_length(v3_sub(ted4_ray_look(&w, &c, pixel[0], pixel[1]).point, p.point)) > 0.06f)
            continue;
        const uint8_t *const q = rgb + 3 * ((int)pixel[1] * c.width + (int)pixel[0]);
        shown++;
        alike += abs(q[0] - p.rgb[0]) + abs(q[1] - p.rgb[1]) + abs(q[2] - p.rgb[2]) < 75;
    }
    assert_true(shown > 400);
    assert_true(alike > shown * 7 / 10);
}

/* ---- files ---- */

static void run_openmp(void *user, size_t n, void (*body)(void *arg, size_t i), void *arg)
{
    const int threads = *(const int *)user;

#pragma omp parallel for schedule(dynamic) num_threads(threads)
    for (size_t i = 0; i < n; i++)
        body(arg, i);
}

/* Returns the contents of folder/name, or fails the test. Free the result. */
static char *slurp(const char *folder, const char *name, size_t *size)
{
    char path[512];
    char *const bytes = malloc(1 << 18);

    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *const f = fopen(path, "rb");
    assert_non_null(bytes);
    assert_non_null(f);
    *size = fread(bytes, 1, 1 << 18, f);
    assert_true(*size > 0);
    assert_true(*size < 1 << 18);
    fclose(f);
    return bytes;
}

/* Compares the files of folder/part in two sets and removes them; returns their number. */
static int compare_and_remove(const char *a, const char *b, const char *part)
{
    char folder[512], name[800], path[1400];
    int n = 0;

    snprintf(folder, sizeof folder, "%s/%s", a, part);
    DIR *const d = opendir(folder);
    assert_non_null(d);
    for (const struct dirent *e = readdir(d); e != NULL; e = readdir(d)) {
        size_t size[2];
        if (strchr(e->d_name, '.') == NULL || e->d_name[0] == '.')
            continue;
        snprintf(name, sizeof name, "%s/%s", part, e->d_name);
        char *const x = slurp(a, name, &size[0]), *const y = slurp(b, name, &size[1]);
        assert_int_equal(size[0], size[1]);
        assert_memory_equal(x, y, size[0]);
        free(x);
        free(y);
        snprintf(path, sizeof path, "%s/%s", a, name);
        remove(path);
        snprintf(path, sizeof path, "%s/%s", b, name);
        remove(path);
        n++;
    }
    closedir(d);
    remove(folder);
    snprintf(folder, sizeof folder, "%s/%s", b, part);
    remove(folder);
    return n;
}

static void check_transforms(const char *folder, const ted4_ray_options *o)
{
    size_t size;
    char *const text = slurp(folder, "transforms_train.json", &size);
    json_t *const root = json_loadb(text, size, 0, NULL);
    json_t *const frames = json_object_get(root, "frames");
    ted4_ray_camera c;

    free(text);
    assert_true(json_real_value(json_object_get(root, "camera_angle_x")) == ted4_ray_angle_x);
    assert_int_equal(json_array_size(frames), o->n_train * o->n_frames);
    const json_t *const last = json_array_get(frames, json_array_size(frames) - 1);
    assert_string_equal(json_string_value(json_object_get(last, "file_path")), "./train/r_001_02");
    assert_true(json_number_value(json_object_get(last, "time")) == 1);
    ted4_ray_camera_train(&c, 1, o->n_train, W, H);
    for (int i = 0; i < 16; i++) {
        const json_t *const row =
            json_array_get(json_object_get(last, "transform_matrix"), (size_t)i / 4);
        assert_true(json_number_value(json_array_get(row, (size_t)i % 4)) ==
                    c.matrix[i / 4][i % 4]);
    }
    json_decref(root);
}

static void check_ply(const char *folder, const ted4_ray_options *o)
{
    size_t size;
    char *const ply = slurp(folder, "points3d.ply", &size);
    const char *const end = strstr(ply, "end_header\n");
    const ted4_ray_point p = ted4_ray_point_at(o, 2);
    float x;

    assert_non_null(end);
    assert_int_equal(size - (size_t)(end + 11 - ply), TED4_RAY_POINTS * 27);
    memcpy(&x, end + 11 + 2 * 27 + 4, sizeof x);
    assert_true(x == p.point.y);
    assert_memory_equal(end + 11 + 2 * 27 + 24, p.rgb, 3);
    free(ply);
}

/* Two sets, one made by one thread and one by two, have the same bytes. */
static void test_files(void **state)
{
    char a[TEMPORARY_SIZE], b[TEMPORARY_SIZE];
    const ted4_ray_options o = { .scene = RAY_TURN,
                                 .width = W,
                                 .height = H,
                                 .n_train = 2,
                                 .n_test = 1,
                                 .n_frames = 3,
                                 .seed = 5 };
    int threads = 2;
    const ted4_parallel two = { run_openmp, &threads };
    ted4_ray_message m;

    (void)state;
    temporary_folder(a, "ted4-scene-a");
    temporary_folder(b, "ted4-scene-b");
    assert_int_equal(ted4_ray_write(&o, a, NULL, &m), 0);
    assert_int_equal(ted4_ray_write(&o, b, &two, &m), 0);
    check_transforms(a, &o);
    check_ply(a, &o);
    assert_int_equal(compare_and_remove(a, b, "train"), o.n_train * o.n_frames);
    assert_int_equal(compare_and_remove(a, b, "test"), o.n_test * o.n_frames);
    assert_int_equal(compare_and_remove(a, b, "."), ALL_FILES);
    assert_int_equal(rmdir(a), 0);
    assert_int_equal(rmdir(b), 0);
}

/* If a file is in the place of a folder, the error names it. */
static void test_refusal(void **state)
{
    char file[TEMPORARY_SIZE], folder[TEMPORARY_SIZE + 8];
    const ted4_ray_options o = { .scene = RAY_STILL,
                                 .width = W,
                                 .height = H,
                                 .n_train = 1,
                                 .n_test = 0,
                                 .n_frames = 1,
                                 .seed = 1 };
    ted4_ray_message m = { "" };

    (void)state;
    close(temporary_file(file, "ted4-scene"));
    snprintf(folder, sizeof folder, "%s/set", file);
    assert_int_equal(ted4_ray_write(&o, folder, NULL, &m), -1);
    assert_non_null(strstr(m.text, file));
    assert_non_null(strstr(m.text, "Not a directory"));
    assert_int_equal(ted4_ray_write(&o, "", NULL, &m), -1);
    remove(file);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cameras),
        cmocka_unit_test(test_marker),
        cmocka_unit_test(test_motion),
        cmocka_unit_test(test_occlusion),
        cmocka_unit_test(test_points_on_surfaces),
        cmocka_unit_test(test_points_colours),
        cmocka_unit_test(test_files),
        cmocka_unit_test(test_refusal),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
