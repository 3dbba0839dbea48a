/* test_camera_colour_init.c - train/densify/camera_colour_init.h: the maps of cameras are found
 * from the initial points alone, even if a third of each camera's view of the points is occluded.
 * The part that all cameras share is found from the points' own colours, if these agree with the
 * pictures. Where the data do not suffice, the identity remains.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>

#include "test.h"
#include "larger.h"
#include "tiny_scene.h"
#include "train/densify/camera_colour_init.h"
#include "train/math/random.h"
#include "train/model/normalise.h"

enum { W = 64, H = 48, CAMERAS = 6, FRAMES = 3, N = TED4_COLOUR_VALUES };

#define FOCAL    60.0
#define DISTANCE 3.0

/* The true map of camera k, multiplied by size: of each value, the middle half of the cameras has
 * mean 0. */
static float truth(int k, int value, float size)
{
    static const float of_camera[CAMERAS] = { -0.12f, -0.04f, -0.01f, 0.01f, 0.04f, 0.10f };

    return of_camera[(k + value) % CAMERAS] * (value % 4 == 0 && value < 9 ? 1.0f : 0.3f) * size;
}

/* The colour of the plane z = 0, at which cameras look along -z. */
static void painted(double x, double y, double rgb[3])
{
    for (int c = 0; c < 3; c++)
        rgb[c] = 0.5 + 0.15 * sin(2.1 * x + 1.3 * c) + 0.15 * cos(2.7 * y - 2.0 * c);
}

static double camera_x(int k)
{
    return 0.15 * (k - 0.5 * (CAMERAS - 1));
}

/* hidden: share of blocks of 4x4 pixels that show something else; they differ from frame to frame
 * and from camera to camera. */
static void picture(const tiny_folder *f, const char *name, int k, int frame, double hidden,
                    float tint)
{
    uint8_t px[W * H * 3];

    for (int i = 0; i < W * H; i++) {
        const uint64_t block = (uint64_t)((i / W / 4 * W + i % W / 4) * FRAMES + frame),
                       key = (uint64_t)k + 1;
        const double x = camera_x(k) + (i % W + 0.5 - 0.5 * W) * DISTANCE / FOCAL;
        const double y = -(i / W + 0.5 - 0.5 * H) * DISTANCE / FOCAL;
        const int away = (double)ted4_uniform(key, 8 * block) < hidden;
        double rgb[3];

        painted(x, y, rgb);
        for (uint64_t c = 0; c < 3 && away; c++)
            rgb[c] = 0.1 + 0.8 * (double)ted4_uniform(key, 8 * block + 1 + c);
        for (int c = 0; c < 3; c++) {
            double sum = rgb[c] + (double)truth(k, 9 + c, tint);

            for (int j = 0; j < 3; j++)
                sum += rgb[j] * (double)truth(k, 3 * j + c, tint);
            px[3 * i + c] = (uint8_t)(255 * fmin(fmax(sum, 0), 1) + 0.5);
        }
    }
    tiny_png(f, name, W, H, PNG_FORMAT_RGB, px);
}

/* Stands for colours of points that single cameras gave, dark ones and bright ones, as structure
 * from motion does it: the gain is 0.82 for 44 %, 1 for 32 % and 1.25 for 24 % of them. */
static const double by_cameras[3] = { 1, 1, 1 };

/* Writes points whose colours are gain times those of the plane, by channel; NULL: nearly black. */
static void points(const tiny_folder *f, int n, const double *gain)
{
    static tiny_string s;

    s.n = 0;
    tiny_add(&s,
             "ply\nformat ascii 1.0\nelement vertex %d\nproperty float x\nproperty float "
             "y\nproperty float z\n"
             "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n",
             n);
    for (uint64_t i = 0; i < (uint64_t)n; i++) {
        const double x = 2.4 * (double)ted4_uniform(7, 2 * i) - 1.2,
                     y = 1.8 * (double)ted4_uniform(7, 2 * i + 1) - 0.9;
        double rgb[3];

        painted(x, y, rgb);
        const double of = gain != by_cameras ? 1 : i % 25 < 11 ? 0.82 : i % 25 < 19 ? 1 : 1.25;

        for (int c = 0; c < 3; c++)
            rgb[c] = gain != NULL ? 255 * of * gain[c] * rgb[c] : 9;
        tiny_add(&s, "%.4f %.4f 0 %.0f %.0f %.0f\n", x, y, rgb[0], rgb[1], rgb[2]);
    }
    tiny_text(f, "points.ply", s.text);
}

static void write_scene(const tiny_folder *f, int n_points, const double *gain, double hidden,
                        float tint)
{
    static tiny_string s;

    s.n = 0;
    tiny_add(&s,
             "{\"fl_x\": %g, \"w\": %d, \"h\": %d, \"fps\": 5, \"ply_file_path\": \"points.ply\", "
             "\"frames\": [",
             FOCAL, W, H);
    for (int i = 0; i < FRAMES * CAMERAS; i++) {
        const int k = i % CAMERAS, frame = i / CAMERAS;
        char name[64];

        snprintf(name, sizeof name, "images/c%d_f%d.png", k, frame);
        picture(f, name, k, frame, hidden, tint);
        tiny_add(&s,
                 "%s{\"file_path\": \"%s\", \"time\": %.17g, \"transform_matrix\": "
                 "[[1,0,0,%.9f],[0,1,0,0],[0,0,1,%.9f],[0,0,0,1]]}",
                 i > 0 ? "," : "", name, (double)frame / (FRAMES - 1), camera_x(k), DISTANCE);
    }
    tiny_add(&s, "]}");
    tiny_text(f, "transforms.json", s.text);
    points(f, n_points, gain);
}

/* Largest difference between a value of a map and the true one, if the scene's colours are gain
 * times those of the plane. */
static double worst(const ted4_colour *c, const double *gain)
{
    double most = 0;

    for (int k = 0; k < CAMERAS; k++)
        for (int i = 0; i < N; i++) {
            const float one = i < 9 && i % 4 == 0, of = i < 9 ? (float)gain[i / 3] : 1.0f;

            most = larger(most, fabsf(c->value[k][i] - ((one + truth(k, i, 1)) / of - one)));
        }
    return most;
}

static void load(ted4_dataset *d, const tiny_folder *f)
{
    const ted4_dataset_options o = { .downscale = 1, .seed = 3, .cache_bytes = 1 << 20 };
    ted4_message m;

    if (ted4_dataset_load(d, f->path, &o, &m) != 0)
        fail_msg("%s", m.text);
    assert_int_equal(d->n_cameras, CAMERAS);
}

/* Makes a trainer and matches its cameras' colours. */
static void match_cameras(ted4_trainer *t, ted4_dataset *d)
{
    memset(t, 0, sizeof *t);
    t->data = d;
    ted4_normalise_scene(&t->layout.head, d);
    assert_int_equal(ted4_colour_init(&t->colour, d), 0);
    assert_int_equal(ted4_camera_colour_init(t), 0);
}

static void matched(int n_points, const double *gain, double hidden, float tint, ted4_trainer *t,
                    ted4_dataset *d, tiny_folder *f)
{
    *f = tiny_new();
    write_scene(f, n_points, gain, hidden, tint);
    load(d, f);
    match_cameras(t, d);
}

static const double none[3] = { 1, 1, 1 };

static void test_found(void **state)
{
    static const double hidden[3] = { 0, 0.15, 0.3 };
    /* Largest errors measured: 0.0025, 0.0052, 0.0136. */
    static const float bound[3] = { 0.005f, 0.01f, 0.025f };

    (void)state;
    for (int i = 0; i < 3; i++) {
        ted4_trainer t;
        ted4_dataset d;
        tiny_folder f;

        matched(600, NULL, hidden[i], 1, &t, &d, &f);
        assert_int_equal(t.colour.matched, 1);
        assert_true(worst(&t.colour, none) < bound[i]);
        ted4_colour_finish(&t.colour);
        ted4_dataset_free(&d);
        tiny_free(&f);
    }
}

/* The points show that the middle of all cameras is too dark in red and too bright in green;
 * training keeps this gauge. */
static void test_gauge(void **state)
{
    static const double gain[3] = { 1.05, 0.96, 1.0 };
    ted4_trainer t;
    ted4_dataset d;
    tiny_folder f;

    (void)state;
    matched(600, gain, 0.15, 1, &t, &d, &f);
    assert_int_equal(t.colour.matched, 1);
    /* Measured: 0.0050. */
    assert_true(worst(&t.colour, gain) < 0.01);
    for (int k = 0; k < CAMERAS; k++)
        t.colour.value[k][4] += 0.3f;
    ted4_colour_centre(&t.colour);
    assert_true(worst(&t.colour, gain) < 0.01);
    ted4_colour_finish(&t.colour);
    ted4_dataset_free(&d);
    tiny_free(&f);
}

/* Points with the colours of single cameras say what lies between them, and not what most say. */
static void test_gauge_of_clusters(void **state)
{
    ted4_trainer t;
    ted4_dataset d;
    tiny_folder f;

    (void)state;
    matched(600, by_cameras, 0, 1, &t, &d, &f);
    assert_int_equal(t.colour.matched, 1);
    assert_true(worst(&t.colour, none) < 0.02);
    ted4_colour_finish(&t.colour);
    ted4_dataset_free(&d);
    tiny_free(&f);
}

/* Points whose colours are unrelated, or of which hardly any agrees, are not used. */
static void test_other_colours(void **state)
{
    static const double gain[2][3] = { { 0.72, 0.72, 0.72 }, { 0.4, 1.2, 0.7 } };

    (void)state;
    for (int i = 0; i < 2; i++) {
        ted4_trainer t;
        ted4_dataset d;
        tiny_folder f;

        matched(600, gain[i], 0, 1, &t, &d, &f);
        assert_true(worst(&t.colour, none) < 0.005);
        for (int k = 0; k < N; k++)
            assert_true(t.colour.middle[k] == 0.0f);
        ted4_colour_finish(&t.colour);
        ted4_dataset_free(&d);
        tiny_free(&f);
    }
}

static void check_alone(int n_points, float tint)
{
    ted4_trainer t;
    ted4_dataset d;
    tiny_folder f;

    matched(n_points, NULL, 0, tint, &t, &d, &f);
    assert_int_equal(t.colour.matched, 0);
    for (int k = 0; k < CAMERAS; k++)
        for (int i = 0; i < N; i++)
            assert_true(t.colour.value[k][i] == 0.0f);
    ted4_colour_finish(&t.colour);
    ted4_dataset_free(&d);
    tiny_free(&f);
}

static void test_few_points(void **state)
{
    (void)state;
    check_alone(50, 1);
}

static void test_no_tint(void **state)
{
    (void)state;
    check_alone(600, 0);
    check_alone(600, 0.05f);
}

/* Matches cameras whose pictures of frame 1 are held out. spoilt: these show something else. */
static void match_without_frame(int spoilt, ted4_colour_map maps[CAMERAS])
{
    ted4_trainer t;
    ted4_dataset d;
    tiny_folder f = tiny_new();

    write_scene(&f, 600, NULL, 0.15, 1);
    for (int k = 0; spoilt && k < CAMERAS; k++) {
        char name[64];

        snprintf(name, sizeof name, "images/c%d_f1.png", k);
        picture(&f, name, k, 1, 1, 0);
    }
    load(&d, &f);
    for (size_t i = 0; i < d.n_pictures; i++)
        d.pictures[i].is_test = d.pictures[i].frame == 1;
    match_cameras(&t, &d);
    assert_int_equal(t.colour.matched, 1);
    memcpy(maps, t.colour.value, CAMERAS * sizeof *maps);
    ted4_colour_finish(&t.colour);
    ted4_dataset_free(&d);
    tiny_free(&f);
}

/* Held-out pictures are not looked at. */
static void test_held_out(void **state)
{
    ted4_colour_map plain[CAMERAS], spoilt[CAMERAS];

    (void)state;
    match_without_frame(0, plain);
    match_without_frame(1, spoilt);
    assert_memory_equal(plain, spoilt, sizeof plain);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(test_found),
                                        cmocka_unit_test(test_gauge),
                                        cmocka_unit_test(test_gauge_of_clusters),
                                        cmocka_unit_test(test_other_colours),
                                        cmocka_unit_test(test_few_points),
                                        cmocka_unit_test(test_no_tint),
                                        cmocka_unit_test(test_held_out) };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
