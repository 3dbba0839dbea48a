/* test_dataset.c - scenes of every layout, written by the test, load as the dataset they describe.
 * Real scenes: test_dataset_real.c. Errors: test_dataset_errors.c. Pictures, lens, cache:
 * test_image_file.c.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>

#include "test.h"
#include "data/data_util.h"
#include "data/point_cloud.h"
#include "data/raw_scene.h"
#include "larger.h"
#include "tiny_scene.h"

static void near(double a, double b, double tolerance)
{
    if (!(fabs(a - b) <= tolerance))
        fail_msg("%.9g is not %.9g", a, b);
}

static void load(ted4_dataset *d, const tiny_folder *f, const ted4_dataset_options *o)
{
    assert_string_equal(tiny_load(d, f, o), "");
}

/* Asserts that the points fill the cube centre +- half. */
static void expect_cube(const ted4_dataset *d, double x, double y, double z, double half)
{
    const double centre[3] = { x, y, z };
    double below[3] = { -99, -99, -99 }, high[3] = { -99, -99, -99 }; /* below: -low */

    assert_int_equal(d->random_points, 1);
    assert_int_equal(d->n_points, TED4_RANDOM_POINTS);
    for (size_t i = 0; i < 3 * d->n_points; i++) {
        below[i % 3] = larger(below[i % 3], -(double)d->points[i]);
        high[i % 3] = larger(high[i % 3], (double)d->points[i]);
    }
    for (int k = 0; k < 3; k++) {
        near(-below[k], centre[k] - half, 0.002 * half);
        near(high[k], centre[k] + half, 0.002 * half);
    }
}

/* COLMAP */

/* Rotation by 90 degrees about z (down turns to -right), so that a transposed matrix is
 * detected. */
#define QUARTER "0.70710678118654752 0 0 0.70710678118654752"

static void colmap_text(const tiny_folder *f, const char *camera, int n, const char *name_format)
{
    tiny_string s = { "# comment\n\n", 11 };

    tiny_text(f, "sparse/0/cameras.txt", camera);
    for (int i = n; i > 0; i--) { /* not in order of the names */
        char name[64], file[80];
        snprintf(name, sizeof name, name_format, i * 3);
        snprintf(file, sizeof file, "images/%s", name);
        tiny_picture(f, file, TINY_W, TINY_H, i);
        tiny_add(&s, "%d " QUARTER " 1 2 %d 1 %s\n", i, i, name);
        tiny_add(&s, i % 2 ? "\n" : "1.5 2.5 -1 3 4 7\n");
    }
    tiny_text(f, "sparse/0/images.txt", s.text);
    tiny_text(f, "sparse/0/points3D.txt",
              "# none\n1 0.5 -1.5 2 10 20 30 0.1 1 2\n2 4 5 6 1 2 3 0.1\n");
}

static const char pinhole[] = "# c\n1 PINHOLE 16 12 20 21 7.5 6.5\n";

static void check_colmap(ted4_dataset *d)
{
    const double R[9] = { 0, -1, 0, 1, 0, 0, 0, 0, 1 };

    assert_string_equal(d->layout, "colmap");
    assert_int_equal(d->n_pictures, 14);
    assert_int_equal(d->n_frames, 14);
    assert_int_equal(d->n_cameras, 1);
    assert_int_equal(d->random_points, 0);
    assert_int_equal(d->n_points, 2);
    near(d->points[4], 5, 0);
    assert_int_equal(d->point_rgb[1], 20);
    for (size_t i = 0; i < 14; i++) {
        /* In order of the names; indices 4 and 12 are held out and moved to the end. */
        const size_t index = i >= 12 ? 4 + 8 * (i - 12) : i < 4 ? i : i < 11 ? i + 1 : i + 2;
        const ted4_picture *p = &d->pictures[i];
        assert_int_equal(p->frame, index);
        assert_int_equal(p->is_test, i >= 12);
        assert_int_equal(p->camera.width, TINY_W);
        near(p->camera.fx, 20, 0);
        near(p->camera.fy, 21, 0);
        near(p->camera.cx, 7.5, 0);
        near(p->camera.cy, 6.5, 0);
        for (int k = 0; k < 9; k++)
            near(p->camera.R[k], R[k], 1e-12);
        near(p->camera.t[2], (double)index + 1, 0);
        ted4_message m;
        const uint8_t *px = ted4_dataset_pixels(d, i, &m);
        assert_non_null(px);
        assert_int_equal(px[2], index + 1);
        assert_int_equal(px[3 * (TINY_W * 2 + 5)], 5 * 255 / TINY_W);
        ted4_dataset_release(d, i);
    }
}

static void test_colmap_text(void **state)
{
    (void)state;
    ted4_dataset d;
    tiny_folder f = tiny_new();

    colmap_text(&f, pinhole, 14, "a1_%05d.png");
    load(&d, &f, &tiny_options);
    check_colmap(&d);
    ted4_dataset_free(&d);
    tiny_free(&f);
}

static void write_colmap_binary(const tiny_folder *f)
{
    tiny_record c = { { 0 }, 0 }, s = { { 0 }, 0 }, p = { { 0 }, 0 };
    const double pose[7] = { sqrt(0.5), 0, 0, sqrt(0.5), 1, 2, 0 };

    tiny_put(&c, 1, 8), tiny_put(&c, 1, 4), tiny_put(&c, 1, 4), tiny_put(&c, TINY_W, 8),
        tiny_put(&c, TINY_H, 8);
    tiny_put_real(&c, 20), tiny_put_real(&c, 21), tiny_put_real(&c, 7.5), tiny_put_real(&c, 6.5);
    tiny_put(&s, 14, 8);
    for (int i = 14; i > 0; i--) {
        char name[32], file[48];
        snprintf(name, sizeof name, "a1_%05d.png", 3 * i);
        snprintf(file, sizeof file, "images/%s", name);
        tiny_picture(f, file, TINY_W, TINY_H, i);
        tiny_put(&s, (uint64_t)i, 4);
        for (int k = 0; k < 7; k++)
            tiny_put_real(&s, k < 6 ? pose[k] : i);
        tiny_put(&s, 1, 4);
        memcpy(s.bytes + s.n, name, strlen(name) + 1);
        s.n += strlen(name) + 1;
        tiny_put(&s, 2, 8);
        for (int k = 0; k < 6; k++)
            tiny_put(&s, 0, 8); /* two observations */
    }
    tiny_put(&p, 2, 8);
    for (int i = 0; i < 2; i++) {
        tiny_put(&p, 9, 8);
        for (int k = 0; k < 3; k++)
            tiny_put_real(&p, i == 0 ? 0.5 : 4 + k);
        tiny_put(&p, i == 0 ? 0x1e140a : 0x030201, 3);
        tiny_put_real(&p, 0.1);
        tiny_put(&p, 1, 8), tiny_put(&p, 0, 8);
    }
    tiny_bytes(f, "sparse/cameras.bin", c.bytes, c.n);
    tiny_bytes(f, "sparse/images.bin", s.bytes, s.n);
    tiny_bytes(f, "sparse/points3D.bin", p.bytes, p.n);
}

static void test_colmap_binary(void **state)
{
    (void)state;
    ted4_dataset d;
    tiny_folder f = tiny_new();

    write_colmap_binary(&f);
    load(&d, &f, &tiny_options);
    check_colmap(&d);
    ted4_dataset_free(&d);
    tiny_free(&f);
}

/* Two folders are two cameras that share frames; names without a number all belong to frame 0; the
 * pictures may be the reduced copies. */
static void test_colmap_names(void **state)
{
    (void)state;
    ted4_dataset d;
    tiny_folder f = tiny_new();

    tiny_text(&f, "sparse/0/cameras.txt", "1 SIMPLE_PINHOLE 33 24 40 16.5 12\n");
    tiny_text(&f, "sparse/0/images.txt",
              "1 1 0 0 0 0 0 0 1 b/7.png\n\n2 1 0 0 0 0 0 0 1 a/7.png\n\n"
              "3 1 0 0 0 0 0 0 1 a/9.png\n\n4 1 0 0 0 0 0 0 1 b/9.png\n\n");
    tiny_picture(&f, "images/a/7.png", 16, 12, 0), tiny_picture(&f, "images/a/9.png", 16, 12, 0);
    tiny_picture(&f, "images/b/7.png", 16, 12, 0), tiny_picture(&f, "images/b/9.png", 16, 12, 0);
    load(&d, &f, &tiny_options);
    for (size_t i = 0; i < 4; i++) {
        assert_int_equal(d.pictures[i].frame, i % 2);
        assert_int_equal(d.pictures[i].camera_id, i / 2);
    }
    near(d.pictures[0].camera.fx, 40 * 16.0 / 33, 1e-12);
    near(d.pictures[0].camera.cx, 8, 1e-12);
    near(d.pictures[0].camera.fy, 20, 1e-12);
    ted4_dataset_free(&d);
    tiny_text(&f, "sparse/0/images.txt", "1 1 0 0 0 0 0 0 1 one.png\n\n2 1 0 0 0 0 0 0 1 two.png");
    tiny_picture(&f, "images/one.png", 33, 24, 0), tiny_picture(&f, "images/two.png", 33, 24, 0);
    load(&d, &f, &tiny_options);
    assert_int_equal(d.n_frames, 1);
    assert_int_equal(d.random_points, 1);
    ted4_dataset_free(&d);
    tiny_free(&f);
}

/* Blender */

static void write_blender(const tiny_folder *f, const char *time_a, const char *time_b)
{
    tiny_string s = { "", 0 };
    const uint8_t px[4 * 4] = { 200, 100, 0, 255, 200, 100, 0, 0, 199, 100, 0, 128, 0, 0, 0, 255 };

    tiny_png(f, "train/r_0.png", 2, 2, PNG_FORMAT_RGBA, px);
    tiny_png(f, "test/r_0.png", 2, 2, PNG_FORMAT_RGBA, px);
    tiny_add(
        &s,
        "{\"camera_angle_x\": 1.5707963267948966, \"frames\": [{\"file_path\": \"./train/r_0\"%s,"
        "\"transform_matrix\": [[0,0,1,5],[1,0,0,6],[0,1,0,7],[0,0,0,1]]}]}",
        time_a);
    tiny_text(f, "transforms_train.json", s.text);
    s.n = 0;
    tiny_add(
        &s,
        "{\"camera_angle_x\": 1.5707963267948966, \"frames\": [{\"file_path\": \"./test/r_0\"%s,"
        "\"transform_matrix\": " TINY_POSE "}]}",
        time_b);
    tiny_text(f, "transforms_test.json", s.text);
}

static void test_blender(void **state)
{
    (void)state;
    ted4_dataset d;
    ted4_message m;
    tiny_folder f = tiny_new();
    ted4_dataset_options o = tiny_options;

    write_blender(&f, "", "");
    load(&d, &f, &o);
    assert_string_equal(d.layout, "blender");
    assert_int_equal(d.n_frames, 1);
    assert_int_equal(d.n_cameras, 2);
    assert_int_equal(d.pictures[1].is_test, 1);
    assert_int_equal(d.background[0], 255);
    const ted4_camera *c = &d.pictures[0].camera;
    near(c->fx, 1, 1e-12);
    near(c->cx, 1, 0);
    /* The camera at (5, 6, 7), with right = +y, up = +z and backward = +x, looks along -x. Its
     * coordinates of the world point (4, 8, 10) are (2, -3, 1). */
    const double world[3] = { 4, 8, 10 }, expected[3] = { 2, -3, 1 };
    for (int i = 0; i < 3; i++)
        near(c->R[3 * i] * world[0] + c->R[3 * i + 1] * world[1] + c->R[3 * i + 2] * world[2] +
                 c->t[i],
             expected[i], 1e-12);
    const uint8_t white[12] = { 200, 100, 0, 255, 255, 255, 227, 177, 127, 0, 0, 0 };
    const uint8_t black[12] = { 200, 100, 0, 0, 0, 0, 100, 50, 0, 0, 0, 0 };
    assert_memory_equal(ted4_dataset_pixels(&d, 0, &m), white, 12);
    ted4_dataset_release(&d, 0);
    expect_cube(&d, 0, 0, 0, 1.3);
    ted4_dataset_free(&d);
    o.white = 0;
    load(&d, &f, &o);
    assert_memory_equal(ted4_dataset_pixels(&d, 0, &m), black, 12);
    ted4_dataset_release(&d, 0);
    ted4_dataset_free(&d);
    write_blender(&f, ",\"time\": 1.0", ",\"time\": 0.0");
    load(&d, &f, &o);
    assert_int_equal(d.n_frames, 2);
    assert_int_equal(d.pictures[0].frame, 1);
    ted4_dataset_free(&d);
    tiny_free(&f);
}

/* nerfstudio */

static void write_nerfstudio(const tiny_folder *f)
{
    tiny_string s = { "", 0 };

    tiny_add(&s, "{\"fl_x\": 30, \"cx\": 7, \"w\": 16, \"h\": 12, \"fps\": 25, \"ply_file_path\": "
                 "\"cloud.ply\","
                 "\"applied_transform\": [[0,0,2,1],[2,0,0,2],[0,2,0,3]], \"frames\": [");
    for (int i = 9; i >= 0; i--) {
        char name[32];
        snprintf(name, sizeof name, "images/p%d.png", i);
        tiny_picture(f, name, TINY_W, TINY_H, i);
        tiny_add(&s,
                 "{\"file_path\": \"%s\", \"time\": %.6f, \"camera\": %s%s, \"transform_matrix\": "
                 "[[1,0,0,3],[0,1,0,6],[0,0,1,9],[0,0,0,1]]}%s\n",
                 name, i / 2 / 4.0, i % 2 ? "\"odd\"" : "0",
                 i == 3 ? ", \"fl_x\": 31, \"fl_y\": 32, \"cy\": 5" : "", i > 0 ? "," : "]}");
    }
    tiny_text(f, "transforms.json", s.text);
    tiny_text(f, "cloud.ply",
              "ply\nformat ascii 1.0\nelement vertex 1\nproperty double x\nproperty double y\n"
              "property double z\nend_header\n3 6 9\n");
}

static void test_nerfstudio(void **state)
{
    (void)state;
    ted4_dataset d;
    tiny_folder f = tiny_new();

    write_nerfstudio(&f);
    load(&d, &f, &tiny_options);
    assert_string_equal(d.layout, "nerfstudio");
    assert_int_equal(d.n_pictures, 10);
    assert_int_equal(d.n_frames, 5);
    assert_int_equal(d.n_cameras, 2);
    assert_int_equal(d.background[0], 0);
    near(d.rate, 25, 0);
    assert_int_equal(d.pictures[9].is_test, 1);
    assert_int_equal(d.pictures[9].frame, 2);
    assert_int_equal(d.pictures[8].is_test, 0);
    assert_int_equal(d.pictures[3].frame, 1);
    assert_int_equal(d.pictures[3].camera_id, 1);
    near(d.pictures[3].camera.fx, 31, 0);
    near(d.pictures[3].camera.fy, 32, 0);
    near(d.pictures[3].camera.cy, 5, 0);
    near(d.pictures[2].camera.fy, 30, 0);
    near(d.pictures[2].camera.cy, 6, 0);
    near(d.pictures[2].camera.cx, 7, 0);
    /* applied: (x, y, z) -> (2z + 1, 2x + 2, 2y + 3), so camera and point at (3, 6, 9) come from
     * (2, 3, 1). */
    double centre[3];
    const double expected[3] = { 2, 3, 1 };
    ted4_pose_centre(d.pictures[0].camera.R, d.pictures[0].camera.t, centre);
    for (int k = 0; k < 3; k++) {
        near(centre[k], expected[k], 1e-12);
        near(d.points[k], expected[k], 1e-6);
    }
    /* The camera looks along -z of the applied world, which is -y of the dataset's world; its
     * right, x there, is z here. */
    near(d.pictures[0].camera.R[7], -1, 1e-12);
    near(d.pictures[0].camera.R[2], 1, 1e-12);
    ted4_dataset_free(&d);
    tiny_free(&f);
}

static void test_downscale(void **state)
{
    (void)state;
    ted4_dataset d;
    ted4_message m;
    tiny_folder f = tiny_new();
    ted4_dataset_options o = tiny_options;

    o.downscale = 5;
    colmap_text(&f, pinhole, 1, "%d.png");
    load(&d, &f, &o);
    const ted4_camera *c = &d.pictures[0].camera;
    assert_int_equal(c->width, 3);
    assert_int_equal(c->height, 2);
    near(c->fx, 4, 1e-12);
    near(c->cy, 1.3, 1e-12);
    const uint8_t *px = ted4_dataset_pixels(&d, 0, &m);
    assert_non_null(px);
    /* Red of columns 5..9: 79 95 111 127 143; green of rows 5..9: 106 127 148 170 191. */
    assert_int_equal(px[3 * 4], 111);
    assert_int_equal(px[3 * 4 + 1], 148);
    ted4_dataset_release(&d, 0);
    ted4_dataset_free(&d);
    tiny_free(&f);
}

/* Points */

static void test_ply(void **state)
{
    (void)state;
    ted4_point_cloud c = { NULL, NULL, 0 };
    ted4_message m;
    tiny_folder f = tiny_new();
    const char head[] =
        "ply\r\nformat binary_little_endian 1.0\ncomment x\nelement vertex 2\nproperty float nx\n"
        "property double x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar "
        "green\n"
        "property uchar blue\nelement face 0\nproperty list uchar int vertex_indices\nend_header\n";
    tiny_record r = { { 0 }, 0 };

    memcpy(r.bytes, head, r.n = sizeof head - 1);
    for (int i = 0; i < 2; i++) {
        tiny_put(&r, 0x7fc00000, 4);
        tiny_put_real(&r, 1.25 + i);
        tiny_put(&r, 0x40000000, 4), tiny_put(&r, 0xbf800000, 4);
        tiny_put(&r, 0x030201, 3);
    }
    tiny_bytes(&f, "fused.ply", r.bytes, r.n);
    assert_int_equal(ted4_ply_find(&c, f.path, &m), 0);
    assert_int_equal(c.n, 2);
    const float xyz[6] = { 1.25f, 2, -1, 2.25f, 2, -1 };
    assert_memory_equal(c.xyz, xyz, sizeof xyz);
    assert_int_equal(c.rgb[5], 3);
    ted4_point_cloud_free(&c);
    tiny_text(&f, "points3d.ply",
              "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
              "property float z\nproperty float red\nproperty float green\nproperty float "
              "blue\nend_header\n"
              "1 2 3 0.5 1 0\n4 5 6 0 0 0");
    assert_int_equal(ted4_ply_find(&c, f.path, &m), 0);
    assert_int_equal(c.rgb[0], 128);
    assert_int_equal(c.rgb[1], 255);
    near(c.xyz[5], 6, 0);
    ted4_point_cloud_free(&c);
    tiny_free(&f);
}

/* Colours by type and name: 16 bits per channel, or 8 bits in a wider type. */
static void test_ply_colours(void **state)
{
    static const struct {
        const char *type, *prefix, *values;
        uint8_t rgb[3];
    } cases[] = {
        { "ushort", "", "12850 5140 65535\n1 2 3 0 0 0", { 50, 20, 255 } },
        { "ushort", "", "50 20 255\n1 2 3 0 0 0", { 50, 20, 255 } },
        { "int", "", "0 0 0\n1 2 3 65535 257 0", { 0, 0, 0 } },
        { "uchar", "diffuse_", "10 20 30\n1 2 3 0 0 0", { 10, 20, 30 } },
    };
    ted4_point_cloud c = { NULL, NULL, 0 };
    ted4_message m;
    tiny_folder f = tiny_new();

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const char *const type = cases[i].type, *const prefix = cases[i].prefix;
        tiny_string s = { "", 0 };
        tiny_add(&s,
                 "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
                 "property float z\nproperty %s %sred\nproperty %s %sgreen\nproperty %s %sblue\n"
                 "end_header\n1 2 3 %s\n",
                 type, prefix, type, prefix, type, prefix, cases[i].values);
        tiny_text(&f, "points3d.ply", s.text);
        assert_int_equal(ted4_ply_find(&c, f.path, &m), 0);
        assert_memory_equal(c.rgb, cases[i].rgb, 3);
        ted4_point_cloud_free(&c);
    }
    tiny_free(&f);
}

/* Without a point cloud: random points in a box around what the cameras look at. Four cameras on a
 * circle of radius 10 look at (0, 0, 3). */
static void test_random_points(void **state)
{
    (void)state;
    ted4_dataset d, e;
    tiny_folder f = tiny_new();
    tiny_string s = { "", 0 };

    tiny_picture(&f, "p.png", TINY_W, TINY_H, 0);
    tiny_add(&s, "{\"fl_x\": 10, \"frames\": [");
    for (int i = 0; i < 4; i++) {
        const double x = i == 0 ? 1 : i == 2 ? -1 : 0, y = i == 1 ? 1 : i == 3 ? -1 : 0;
        tiny_add(&s,
                 "{\"file_path\": \"p.png\", \"transform_matrix\": "
                 "[[%g,0,%g,%g],[%g,0,%g,%g],[0,1,0,3],[0,0,0,1]]}%s",
                 -y, x, 10 * x, x, y, 10 * y, i < 3 ? "," : "]}");
    }
    tiny_text(&f, "transforms.json", s.text);
    load(&d, &f, &tiny_options);
    load(&e, &f, &tiny_options);
    assert_int_equal(d.n_cameras, 4);
    expect_cube(&d, 0, 0, 3, 6);
    assert_memory_equal(d.points, e.points, 3 * d.n_points * sizeof *d.points);
    ted4_dataset_free(&d);
    ted4_dataset_free(&e);
    /* Two cameras that look ahead and outwards: their axes cross behind them. The places at a depth
     * of 1 on the axes are (+-(1 + sqrt(1/2)), 0, -sqrt(1/2)). */
    s.n = 0;
    tiny_add(&s, "{\"fl_x\": 10, \"frames\": [");
    for (int i = 0; i < 2; i++) {
        const double r = sqrt(0.5), side = i == 0 ? 1 : -1;
        tiny_add(&s,
                 "{\"file_path\": \"p.png\", \"transform_matrix\": "
                 "[[%.9g,0,%.9g,%g],[0,1,0,0],[%.9g,0,%.9g,0],[0,0,0,1]]}%s",
                 r, -r * side, side, r * side, r, i < 1 ? "," : "]}");
    }
    tiny_text(&f, "transforms.json", s.text);
    load(&d, &f, &tiny_options);
    expect_cube(&d, 0, 0, -1, 0.6 * hypot(1 + sqrt(0.5), 1 - sqrt(0.5)));
    ted4_dataset_free(&d);
    tiny_free(&f);
}

enum { TEXT = 2048 };

static void print_into(const ted4_dataset *d, char text[TEXT])
{
    FILE *const out = tmpfile();

    assert_non_null(out);
    ted4_dataset_print(d, out);
    rewind(out);
    text[fread(text, 1, TEXT - 1, out)] = 0;
    fclose(out);
}

static void test_print(void **state)
{
    (void)state;
    ted4_dataset d;
    tiny_folder f = tiny_new();
    char text[TEXT];

    write_nerfstudio(&f);
    load(&d, &f, &tiny_options);
    print_into(&d, text);
    assert_non_null(strstr(
        text, "layout      nerfstudio\npictures    9 train, 1 test\ncameras     2\nframes      5\n"
              "size        16 x 12 pixels\nfocal       30..31 x 30..32 pixels\n"));
    assert_non_null(strstr(text, "rate        25 frames/s\n"));
    /* Zero has no sign. */
    d.n_points = 1;
    for (int k = 0; k < 3; k++)
        d.points[k] = -0.0;
    print_into(&d, text);
    assert_non_null(strstr(text, "points      1\nbounds      [0, 0] x [0, 0] x [0, 0]\n"));
    /* A single frame has no frame rate, whatever its file says; no points have no bounds. */
    d.n_frames = 1;
    d.n_points = 0;
    print_into(&d, text);
    assert_null(strstr(text, "rate"));
    assert_non_null(strstr(text, "points      0\nbounds      none\n"));
    ted4_dataset_free(&d);
    tiny_free(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_colmap_text),  cmocka_unit_test(test_colmap_binary),
        cmocka_unit_test(test_colmap_names), cmocka_unit_test(test_blender),
        cmocka_unit_test(test_nerfstudio),   cmocka_unit_test(test_downscale),
        cmocka_unit_test(test_ply),          cmocka_unit_test(test_random_points),
        cmocka_unit_test(test_print),        cmocka_unit_test(test_ply_colours),
    };

    return cmocka_run_group_tests_name("dataset", tests, NULL, NULL);
}
