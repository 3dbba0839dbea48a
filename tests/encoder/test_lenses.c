/* test_lenses.c - one distorted picture in every layout whose cameras have lens terms: each loader
 * must convert its own conventions to the same lens for the undistortion (data/undistort.h, which
 * test_image_file.c tests). The picture shows where it was sampled.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>

#include "test.h"
#include "tiny_scene.h"

/* OpenCV's lens model, but with the centre of the first pixel at 0.5. */
typedef struct {
    double f, g, cx, cy, skew, k[3], p1, p2;
} lens;

#define CENTRE 7.5, 6.25

/* The position in the picture of the undistorted pixel (x, y). */
static void distorted(const lens *l, double x, double y, double *a, double *b)
{
    const double u = (x - l->cx) / l->f, v = (y - l->cy) / l->g, s = u * u + v * v;
    const double radial = 1 + l->k[0] * s + l->k[1] * s * s + l->k[2] * s * s * s;
    const double ud = u * radial + 2 * l->p1 * u * v + l->p2 * (s + 2 * u * u);
    const double vd = v * radial + 2 * l->p2 * u * v + l->p1 * (s + 2 * v * v);

    *a = l->f * ud + l->skew * vd + l->cx;
    *b = l->g * vd + l->cy;
}

/* Red grows by 255 / W per column, green by 255 / H per row. Beyond the centres of the outermost
 * pixels the value is not checked. */
static void check(const tiny_folder *f, const char *layout, const lens *l)
{
    ted4_dataset d;
    ted4_message m;
    int inside = 0;
    const char *wrong = tiny_load(&d, f, &tiny_options);

    if (*wrong != 0)
        fail_msg("%s: %s", layout, wrong);
    assert_string_equal(d.layout, layout);
    const uint8_t *px = ted4_dataset_pixels(&d, 0, &m);

    assert_non_null(px);
    for (int y = 0; y < TINY_H; y++)
        for (int x = 0; x < TINY_W; x++) {
            const uint8_t *at = px + 3 * (TINY_W * y + x);
            double a, b;

            distorted(l, x + 0.5, y + 0.5, &a, &b);
            if (a < 0.5 || b < 0.5 || a > TINY_W - 0.5 || b > TINY_H - 0.5)
                continue;
            inside++;
            if (!(fabs(at[0] - (a - 0.5) * 255 / TINY_W) <= 2 &&
                  fabs(at[1] - (b - 0.5) * 255 / TINY_H) <= 2))
                fail_msg("%s: pixel %d %d comes from %g %g, expected %g %g", layout, x, y,
                         at[0] * TINY_W / 255.0, at[1] * TINY_H / 255.0, a - 0.5, b - 0.5);
        }
    assert_true(inside > TINY_W * TINY_H / 2);
    ted4_dataset_release(&d, 0);
    ted4_dataset_free(&d);
}

static void test_hypernerf(void **state)
{
    static const lens l = { 10, 11, CENTRE, 1, { 0.1, -0.2, 0.3 }, 0.05, -0.08 };
    tiny_folder f = tiny_new();

    (void)state;
    tiny_picture(&f, "rgb/1x/a.png", TINY_W, TINY_H, 0);
    tiny_text(&f, "dataset.json", "{\"ids\": [\"a\"]}");
    tiny_text(&f, "metadata.json", "{\"a\": {\"warp_id\": 0}}");
    tiny_text(&f, "camera/a.json",
              "{\"orientation\": [[1,0,0],[0,1,0],[0,0,1]], \"position\": [0,0,0], "
              "\"focal_length\": 10, \"principal_point\": [7.5, 6.25],"
              "\"skew\": 1, \"pixel_aspect_ratio\": 1.1, \"radial_distortion\": [0.1, -0.2, 0.3], "
              "\"tangential_distortion\": [0.05, -0.08],"
              "\"image_size\": [16, 12]}");
    check(&f, "hypernerf", &l);
    tiny_free(&f);
}

/* In OpenCV the first pixel's centre is at 0; dist holds k1 k2 p1 p2, followed by k3. */
static void test_calibration(void **state)
{
    static const lens l[] = { { 10, 11, CENTRE, 1, { 0.1, -0.2, 0 }, 0.05, -0.08 },
                              { 10, 11, CENTRE, 1, { 0.1, -0.2, 0.3 }, 0.05, -0.08 } };
    static const char *const dist[] = { "0.1, -0.2, 0.05, -0.08", "0.1, -0.2, 0.05, -0.08, 0.3" };

    (void)state;
    for (int i = 0; i < 2; i++) {
        tiny_folder f = tiny_new();
        tiny_string s = { "", 0 };

        tiny_picture(&f, "one/images/0.png", TINY_W, TINY_H, 0);
        tiny_add(&s,
                 "{\"cameras\": [{\"name\": \"one\", \"w\": 16, \"h\": 12, \"K\": "
                 "[[10,1,7],[0,11,5.75],[0,0,1]], \"dist\": [%s], \"w2c\": %s}]}",
                 dist[i], TINY_POSE);
        tiny_text(&f, "cams.json", s.text);
        check(&f, "calibration", &l[i]);
        tiny_free(&f);
    }
}

static void test_nerfstudio(void **state)
{
    static const lens l = { 10, 11, CENTRE, 0, { 0.1, -0.2, 0 }, 0.05, -0.08 };
    tiny_folder f = tiny_new();

    (void)state;
    tiny_picture(&f, "images/a.png", TINY_W, TINY_H, 0);
    tiny_text(&f, "transforms.json",
              "{\"camera_model\": \"OPENCV\", \"fl_x\": 10, \"fl_y\": 11, \"cx\": 7.5, \"cy\": "
              "6.25, \"w\": 16, \"h\": 12,"
              "\"k1\": 0.1, \"k2\": -0.2, \"p1\": 0.05, \"p2\": -0.08,"
              "\"frames\": [{\"file_path\": \"images/a.png\", \"transform_matrix\": " TINY_POSE
              "}]}");
    check(&f, "nerfstudio", &l);
    tiny_free(&f);
}

static void test_colmap(void **state)
{
    static const struct {
        const char *camera;
        lens l;
    } cases[] = {
        { "SIMPLE_RADIAL 16 12 10 7.5 6.25 0.25", { 10, 10, CENTRE, 0, { 0.25, 0, 0 }, 0, 0 } },
        { "RADIAL 16 12 10 7.5 6.25 0.1 -0.3", { 10, 10, CENTRE, 0, { 0.1, -0.3, 0 }, 0, 0 } },
        { "OPENCV 16 12 10 11 7.5 6.25 0.1 -0.2 0.05 -0.08",
          { 10, 11, CENTRE, 0, { 0.1, -0.2, 0 }, 0.05, -0.08 } },
    };

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        tiny_folder f = tiny_new();
        tiny_string s = { "", 0 };

        tiny_picture(&f, "images/p1.png", TINY_W, TINY_H, 0);
        tiny_add(&s, "1 %s\n", cases[i].camera);
        tiny_text(&f, "sparse/0/cameras.txt", s.text);
        tiny_text(&f, "sparse/0/images.txt", "1 1 0 0 0 0 0 0 1 p1.png\n\n");
        tiny_text(&f, "sparse/0/points3D.txt", "1 0 0 3 9 9 9 0.1\n");
        check(&f, "colmap", &cases[i].l);
        tiny_free(&f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_hypernerf),
        cmocka_unit_test(test_calibration),
        cmocka_unit_test(test_nerfstudio),
        cmocka_unit_test(test_colmap),
    };

    return cmocka_run_group_tests_name("lenses", tests, NULL, NULL);
}
