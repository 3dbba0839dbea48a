/* test_scene.c - the project's own scenes: geometry against brute force, cameras, motion, points
 * and files. Links tools/scene/ray_*.o.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <dirent.h>
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "tools/scene/ray_set.h"
#include "tools/scene/ray_texture.h"
#include "temporary.h"

enum { W = 48, H = 36, SIZE = W * H * 3, ALL_FILES = 3 };

static float uniform(uint32_t *state, float low, float high)
{
    *state += 1;
    return low + (high - low) * ray_random((int)*state, 0, 0, 2026);
}

static vec3 in_cube(uint32_t *state, float half)
{
    const float x = uniform(state, -half, half), y = uniform(state, -half, half);

    return v3(x, y, uniform(state, -half, half));
}

/* ---- arithmetic against libm ---- */

static void test_math(void **state)
{
    (void)state;
    for (int i = -2000; i <= 2000; i++) {
        const double t = i / 811.0;
        assert_true(fabs(ted4_ray_sin(t) - sin(2 * RAY_PI * t)) < 1e-14);
        assert_true(fabs(ted4_ray_cos(t) - cos(2 * RAY_PI * t)) < 1e-14);
        const float y = (float)sin(t * 3), x = (float)cos(t * 3);
        assert_true(fabsf(ted4_ray_atan2(y, x) - atan2f(y, x)) < 1e-6f);
    }
    for (int i = 0; i <= 1000; i++) {
        const double x = i / 1000.0;
        const double y = x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1 / 2.4) - 0.055;
        assert_true(fabs(ted4_ray_srgb((float)x) - 255 * y) < 0.51);
    }
    assert_int_equal(ted4_ray_srgb(-1), 0);
    assert_int_equal(ted4_ray_srgb(7), 255);
    assert_int_equal(ray_floor(-0.5f), -1);
    assert_int_equal(ray_floor(3), 3);
}

/* ---- shapes ---- */

/* One solid of each kind, askew and off the origin. */
static ted4_ray_object askew(int kind)
{
    static const float rot[9] = { 0.36f, 0.48f, -0.8f, -0.8f, 0.6f, 0, 0.48f, 0.64f, 0.6f };
    ted4_ray_object o = { .kind = (ted4_ray_kind)kind,
                          .size = v3(0.5f, 0.3f, 0.7f),
                          .pos = v3(0.3f, -0.2f, 0.1f) };

    memcpy(o.rot, rot, sizeof rot);
    if (o.kind == RAY_BAR) {
        o.size = v3(0.2f, 0.17f, 1.4f);
        o.bend = -0.8f;
        o.twist = 0.15f;
    }
    ted4_ray_bound(&o);
    return o;
}

/* Written from the definitions in ray_shape.h. The bar's edges have a radius of 0.02. */
static int is_inside(const ted4_ray_object *o, vec3 point)
{
    const vec3 p = ray_unrotate(o->rot, v3_sub(point, o->pos)), s = o->size;
    vec3 q;

    switch (o->kind) {
    case RAY_SPHERE: return v3_length(p) < s.x;
    case RAY_BOX: return fabsf(p.x) < s.x && fabsf(p.y) < s.y && fabsf(p.z) < s.z;
    case RAY_CYLINDER: return sqrtf(p.x * p.x + p.y * p.y) < s.x && fabsf(p.z) < s.z;
    case RAY_BAR: break;
    }
    q = ted4_ray_unbend(o, p);
    q = v3(fabsf(q.x) - s.x + 0.02f, fabsf(q.y) - s.y + 0.02f,
           fabsf(q.z - s.z / 2) - s.z / 2 + 0.02f);
    return v3_length(v3(ray_max(q.x, 0), ray_max(q.y, 0), ray_max(q.z, 0))) < 0.02f;
}

/* First change of inside along the ray by small steps, or far. */
static float brute_meet(const ted4_ray_object *o, vec3 from, vec3 d, float far)
{
    const float step = 0.002f;
    const int start = is_inside(o, from);

    for (float t = step; t < far; t += step) {
        if (is_inside(o, v3_along(from, d, t)) != start)
            return t;
    }
    return far;
}

/* Rays that pass within a step of an edge may be seen by one side only: a few in a thousand. */
static void test_shapes(void **state)
{
    uint32_t seed = 1;

    (void)state;
    for (int kind = RAY_SPHERE; kind <= RAY_BAR; kind++) {
        const ted4_ray_object o = askew(kind);
        int hits = 0, wrong = 0;

        for (int i = 0; i < 600; i++) {
            const vec3 from = v3_add(o.centre, v3_scale(v3_unit(in_cube(&seed, 1)), 2));
            const vec3 d = v3_unit(v3_sub(v3_add(o.centre, in_cube(&seed, 0.7f)), from));
            const float t = ted4_ray_meet(&o, from, d, 0, 4), b = brute_meet(&o, from, d, 4);

            hits += b < 4;
            wrong += fabsf(t - b) > 0.004f;
        }
        assert_true(hits > 100 && hits < 590);
        assert_true(wrong <= 4);
    }
}

/* The surface is on the boundary, its normal points outwards, and both lie in the bounding
 * sphere. */
static void test_surfaces(void **state)
{
    uint32_t seed = 7;

    (void)state;
    for (int kind = RAY_SPHERE; kind <= RAY_BAR; kind++) {
        const ted4_ray_object o = askew(kind);
        int hits = 0, wrong = 0;

        for (int i = 0; i < 1000; i++) {
            const vec3 from = v3_add(o.centre, v3_scale(v3_unit(in_cube(&seed, 1)), 2));
            const vec3 d = v3_unit(v3_sub(v3_add(o.centre, in_cube(&seed, 0.6f)), from));
            const float t = ted4_ray_meet(&o, from, d, 0, 4);
            if (t == 4)
                continue;
            const vec3 p = v3_along(from, d, t);
            const ted4_ray_surface s = ted4_ray_surface_at(&o, p);
            hits++;
            wrong += !is_inside(&o, v3_along(p, s.normal, -0.003f)) ||
                     is_inside(&o, v3_along(p, s.normal, 0.003f));
            assert_true(fabsf(v3_length(s.normal) - 1) < 1e-4f);
            assert_true(v3_dot(s.normal, d) < 0.2f);
            assert_true(v3_length(v3_sub(p, o.centre)) < o.reach * 1.001f);
        }
        assert_true(hits > 200);
        assert_true(wrong <= hits / 50);
    }
}

static void test_shape_values(void **state)
{
    ted4_ray_object o = { .kind = RAY_SPHERE,
                          .size = v3(0.5f, 0.5f, 0.5f),
                          .pos = v3(0, 0, 1),
                          .rot = { 1, 0, 0, 0, 1, 0, 0, 0, 1 } };
    const vec3 down = v3(0, 0, -1);

    (void)state;
    ted4_ray_bound(&o);
    assert_true(fabsf(ted4_ray_meet(&o, v3(0, 0, 4), down, 0, 9) - 2.5f) < 1e-6f);
    assert_true(fabsf(ted4_ray_meet(&o, v3(0, 0, 1), down, 0, 9) - 0.5f) < 1e-6f);
    assert_true(ted4_ray_meet(&o, v3(0, 0, 4), down, 0, 2) == 2);
    assert_true(ted4_ray_meet(&o, v3(0, 0, 4), down, 3.6f, 9) == 9);
    assert_true(ted4_ray_meet(&o, v3(0.6f, 0, 4), down, 0, 9) == 9);
    o.kind = RAY_CYLINDER;
    assert_true(fabsf(ted4_ray_meet(&o, v3(0.4f, 0, 4), down, 0, 9) - 2.5f) < 1e-6f);
    assert_true(fabsf(ted4_ray_meet(&o, v3(-3, 0, 1), v3(1, 0, 0), 0, 9) - 2.5f) < 1e-6f);
    assert_true(ted4_ray_meet(&o, v3(0.6f, 0, 4), down, 0, 9) == 9);
    o.kind = RAY_BOX;
    assert_true(fabsf(ted4_ray_meet(&o, v3(0.4f, -0.4f, 4), down, 0, 9) - 2.5f) < 1e-6f);
    assert_true(ted4_ray_meet(&o, v3(0.6f, 0.4f, 4), down, 0, 9) == 9);
}

/* unbend undoes rebend; the axis keeps its length and ends where a circle's arc does, turned by
 * the twist. */
static void test_bar(void **state)
{
    const ted4_ray_object o = askew(RAY_BAR);
    uint32_t seed = 3;
    double length = 0;

    (void)state;
    for (int i = 0; i < 500; i++) {
        const vec3 q =
            v3(uniform(&seed, -.2f, .2f), uniform(&seed, -.2f, .2f), uniform(&seed, -.1f, 1.5f));
        assert_true(v3_length(v3_sub(ted4_ray_unbend(&o, ted4_ray_rebend(&o, q)), q)) < 1e-5f);
    }
    for (int i = 0; i < 100; i++)
        length += (double)v3_length(v3_sub(ted4_ray_rebend(&o, v3(0, 0, 0.014f * (float)(i + 1))),
                                           ted4_ray_rebend(&o, v3(0, 0, 0.014f * (float)i))));
    assert_true(fabs(length - 1.4) < 1e-3);
    const vec3 tip = ted4_ray_rebend(&o, v3(0, 0, 1.4f));
    assert_true(fabs((double)tip.x - (1 - cos(0.8 * 1.4)) / -0.8) < 1e-5);
    assert_true(fabs((double)tip.z - sin(0.8 * 1.4) / 0.8) < 1e-5);
    const vec3 corner = ted4_ray_rebend(&o, v3(0.1f, 0, 1.4f));
    assert_true(fabs((double)corner.y - 0.1 * sin(2 * RAY_PI * 0.15 * 1.4)) < 1e-6);
}

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
                below = fmax(below, a);
            else
                above = fmin(above, a);
        }
        assert_true(above - below > 0.05 && above - below < 0.2);
        assert_true(fabs(azimuth_of(&c) - (above + below) / 2) < 1e-9);
    }
    ted4_ray_camera_train(&c, 0, 1, 64, 200);
    check_camera(&c);
    ted4_ray_camera_test(&c, 3, 5, 1, 64, 200);
    check_camera(&c);
}

/* A bright ball of radius 0.12 changes the picture of the empty room around its projection. */
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

/* Share of bytes that differ by more than 16. */
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

/* Pixels in which the last object, the one that moves, is seen. */
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

/* A point is where its own camera sees a surface, and has the colour of it. */
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

            assert_true(p.camera >= 0 && p.camera < 3 && p.frame >= 0 && p.frame < 5);
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

/* Points of the still scene in a picture of another camera: where nothing hides them, the
 * colours agree but for edges. */
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

/* Contents of folder/name, or a failed test. Free it. */
static char *slurp(const char *folder, const char *name, size_t *size)
{
    char path[512];
    char *const bytes = malloc(1 << 18);

    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *const f = fopen(path, "rb");
    assert_non_null(bytes);
    assert_non_null(f);
    *size = fread(bytes, 1, 1 << 18, f);
    assert_true(*size > 0 && *size < 1 << 18);
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

/* Two sets, made by one thread and by two, have the same bytes. */
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

/* A file where a folder should be: an error that names it. */
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
        cmocka_unit_test(test_math),
        cmocka_unit_test(test_shapes),
        cmocka_unit_test(test_surfaces),
        cmocka_unit_test(test_shape_values),
        cmocka_unit_test(test_bar),
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
