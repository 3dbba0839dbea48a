/* test_transforms.c - transforms files as other programs write them: intrinsics per frame and in
 * several forms, names of pictures in any form, missing files, times that do not follow the frames,
 * and how the layout is named.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>

#include "test.h"
#include "data/picture_path.h"
#include "refuse.h"
#include "tiny_scene.h"

#define POSE ", \"transform_matrix\": " TINY_POSE "}"

static void near(double a, double b)
{
    if (!(fabs(a - b) <= 1e-9))
        fail_msg("%.12g is not %.12g", a, b);
}

static ted4_dataset load(const tiny_folder *f)
{
    ted4_dataset d;

    assert_string_equal(tiny_load(&d, f, &tiny_options), "");
    return d;
}

typedef struct {
    const char *frame;
    int w, h;
    double fx, fy, cx, cy;
} lens_case;

static void check_lenses(const tiny_folder *f, const char *top, const lens_case *cases, int n)
{
    tiny_string s = { "", 0 };

    tiny_add(&s, "{%s \"frames\": [", top);
    for (int i = 0; i < n; i++) {
        char name[64];
        snprintf(name, sizeof name, "images/%03d.png", i);
        tiny_picture(f, name, cases[i].w, cases[i].h, i);
        tiny_add(&s, "%s{\"file_path\": \"images/%03d.png\"%s" POSE, i > 0 ? "," : "", i,
                 cases[i].frame);
    }
    tiny_add(&s, "]}");
    tiny_text(f, "transforms.json", s.text);
    ted4_dataset d = load(f);
    assert_int_equal(d.n_pictures, n);
    assert_int_equal(d.n_warnings, 0);
    for (size_t i = 0; i < d.n_pictures; i++) {
        const lens_case *k = &cases[atoi(strrchr(d.pictures[i].path, '/') + 1)];
        const ted4_camera *c = &d.pictures[i].camera;
        assert_int_equal(c->width, k->w);
        assert_int_equal(c->height, k->h);
        near(c->fx, k->fx);
        near(c->fy, k->fy);
        near(c->cx, k->cx);
        near(c->cy, k->cy);
    }
    ted4_dataset_free(&d);
}

/* Pictures of different sizes, each with its own lens. */
static void test_lenses(void **state)
{
    const double third = 8 / tan(0.5), half = 10 / tan(0.25);
    const lens_case own[] = {
        { ", \"fl_x\": 20, \"fl_y\": 21, \"cx\": 7, \"cy\": 5, \"w\": 16, \"h\": 12", 16, 12, 20,
          21, 7, 5 },
        { ", \"fl_x\": 30, \"w\": 20, \"h\": 14, \"k1\": 0, \"k3\": 0.0", 20, 14, 30, 30, 10, 7 },
        { ", \"K\": [[22, 0, 6], [0, 23, 4], [0, 0, 1]]", 12, 8, 22, 23, 6, 4 },
        { ", \"intrinsics\": [22, 0, 6, 0, 23, 4, 0, 0, 1], \"w\": 24, \"h\": 16", 12, 8, 11, 11.5,
          3, 2 },
        { ", \"intrinsics\": [22, 23, 6, 4]", 13, 9, 22, 23, 6, 4 },
        { ", \"camera_angle_x\": 1", 16, 10, third, third, 8, 5 },
        { ", \"camera_angle_x\": 0.5, \"cx\": 9", 20, 10, half, half, 9, 5 },
        { ", \"camera_angle_x\": 0.5, \"camera_angle_y\": 1", 20, 16, half, third, 10, 8 },
    };
    /* A frame's own matrix overrides all top-level fields for focal length and centre; a single
     * field of a frame overrides that field. */
    const lens_case above[] = {
        { ", \"K\": [[22, 0, 6], [0, 23, 4], [0, 0, 1]]", 16, 12, 22, 23, 6, 4 },
        { ", \"camera_angle_x\": 1", 16, 12, third, third, 7, 6 },
        { ", \"fl_x\": 40", 16, 12, 40, 41, 7, 6 },
        { ", \"cx\": 3", 16, 12, 40.5, 41, 3, 6 },
    };
    tiny_folder f = tiny_new();

    (void)state;
    check_lenses(&f, "", own, 8);
    check_lenses(&f, "\"fl_x\": 40.5, \"fl_y\": 41, \"cx\": 7, \"w\": 16, \"h\": 12,", above, 4);
    tiny_free(&f);
}

/* Every way to name a picture, and the file that is meant. */
static void test_names(void **state)
{
    static const struct {
        const char *name, *file;
    } cases[] = {
        { "images/a0.png", "images/a0.png" },
        { "./images/a1.png", "images/a1.png" },
        { "images/a2", "images/a2.png" },
        { "images/a3", "images/a3.PNG" },
        { "a4.png", "images/a4.png" },
        { "a5", "rgb/a5.png" },
        { "./a6", "frames/a6.JPG" },
        { "images\\\\a7.png", "images/a7.png" },
        { ".\\\\images\\\\a8", "images/a8.JPEG" },
        { "/elsewhere/scene/images/a9.png", "images/a9.png" },
        { "C:\\\\other\\\\b0.png", "b0.png" },
        { "images/b1.jpg", "images/b1.png" },
        { "scene/images/b2.PNG", "images/b2.png" },
        { "images/b3.1", "images/b3.1.png" },
        { "images//b4.png", "images/b4.png" },
        { "../x/images/b5.png", "images/b5.png" },
    };
    enum { N = sizeof cases / sizeof cases[0] };
    tiny_folder f = tiny_new();
    tiny_string s = { "", 0 };

    (void)state;
    tiny_add(&s, "{\"fl_x\": 9, \"train_filenames\": [");
    for (int i = 0; i < N; i++)
        tiny_add(&s, "%s\"%s\"", i > 0 ? "," : "", cases[i].name);
    tiny_add(&s, "], \"frames\": [");
    for (int i = 0; i < N; i++) {
        tiny_picture(&f, cases[i].file, TINY_W, TINY_H, i);
        tiny_add(&s, "%s{\"file_path\": \"%s\"" POSE, i > 0 ? "," : "", cases[i].name);
    }
    tiny_add(&s, "]}");
    tiny_text(&f, "transforms.json", s.text);
    ted4_dataset d = load(&f);
    if (d.n_warnings > 0)
        fail_msg("%s", d.warnings[0]);
    assert_int_equal(d.n_pictures, N);
    for (size_t i = 0; i < N; i++) {
        ted4_message m;
        const uint8_t *px = ted4_dataset_pixels(&d, i, &m);
        assert_non_null(px);
        if (px[2] != i)
            fail_msg("%s: took %s", cases[i].name, d.pictures[i].path);
        ted4_dataset_release(&d, i);
    }
    ted4_dataset_free(&d);
    tiny_free(&f);
}

/* A picture that lies in no folder may lie in images/. One that lies in a folder does not, also if
 * the folder's name is as short as that of the present one. */
static void test_short_folders(void **state)
{
    static const char *const names[] = { "p.png", "./p.png", "a/p.png", "ab/p.png", "./a/p.png" };
    tiny_folder f = tiny_new();

    (void)state;
    tiny_picture(&f, "images/p.png", TINY_W, TINY_H, 0);
    for (int i = 0; i < 5; i++) {
        char *path = NULL;
        const int found = ted4_picture_find(f.path, names[i], NULL, &path);

        if (found != (i < 2))
            fail_msg("%s: %d", names[i], found);
        free(path);
    }
    tiny_free(&f);
}

/* Writes ten frames. Time of frame i: from + i * step; step < 0: no times. */
static void write_part(const tiny_folder *f, const char *file, const char *part, const char *top,
                       double from, double step)
{
    tiny_string s = { "", 0 };

    tiny_add(&s, "{%s \"frames\": [", top);
    for (int i = 0; i < 10; i++) {
        char name[64];
        snprintf(name, sizeof name, "%s/r_%d.png", part, i);
        tiny_picture(f, name, TINY_W, TINY_H, i);
        tiny_add(&s, "%s{\"file_path\": \"%s/r_%d\"", i > 0 ? "," : "", part, i);
        if (step >= 0)
            tiny_add(&s, ", \"time\": %.9g", from + i * step);
        tiny_add(&s, POSE);
    }
    tiny_add(&s, "]}");
    tiny_text(f, file, s.text);
}

#define ANGLE "\"camera_angle_x\": 1,"

static size_t tests_of(const ted4_dataset *d)
{
    size_t n = 0;

    for (size_t i = 0; i < d->n_pictures; i++)
        n += d->pictures[i].is_test;
    return n;
}

/* n: pictures; n_test: test pictures; layout: its name in the dataset. */
static void expect(const tiny_folder *f, size_t n, size_t n_test, const char *layout)
{
    ted4_dataset d = load(f);

    assert_int_equal(d.n_pictures, n);
    assert_int_equal(tests_of(&d), n_test);
    assert_string_equal(d.layout, layout);
    ted4_dataset_free(&d);
}

static void test_files(void **state)
{
    tiny_folder f = tiny_new();

    (void)state;
    write_part(&f, "transforms_train.json", "train", ANGLE, 0, -1);
    expect(&f, 10, 1, "blender"); /* alone: 1 of 8 */
    write_part(&f, "transforms_val.json", "val", ANGLE, 0, -1);
    expect(&f, 20, 10, "blender");
    must(remove(tiny_path(&f, "transforms_train.json")) == 0, "train");
    expect(&f, 10, 1, "blender");
    tiny_free(&f);
    f = tiny_new();
    write_part(&f, "transforms_train.json", "train", ANGLE, 0, 0.1);
    write_part(&f, "transforms_val.json", "val", ANGLE, 0, 0.1);
    write_part(&f, "transforms_test.json", "test", ANGLE, 0, 0.1);
    expect(&f, 20, 10, "D-NeRF"); /* val belongs to neither split */
    write_part(&f, "transforms_train.json", "train", "\"fl_x\": 12,", 0, 0.1);
    expect(&f, 20, 10, "D-NeRF");
    write_part(&f, "transforms_train.json", "train", "\"fl_x\": 12,", 0, -1);
    write_part(&f, "transforms_test.json", "test", "\"fl_x\": 12,", 0, -1);
    expect(&f, 20, 10, "blender");
    write_part(&f, "transforms_test.json", "test", "\"fl_x\": 12, \"camera_model\": \"OPENCV\",", 0,
               -1);
    expect(&f, 20, 10, "nerfstudio");
    tiny_free(&f);
    f = tiny_new();
    write_part(&f, "transforms.json", "images", "\"fl_x\": 12,", 0, -1);
    expect(&f, 10, 1, "nerfstudio");
    write_part(&f, "transforms.json", "images", ANGLE, 0, 0.1);
    expect(&f, 10, 1, "D-NeRF");
    tiny_free(&f);
}

/* Writes a file of n frames, frame i of which is the i-th word of names, at time from + i. */
static void write_named(const tiny_folder *f, const char *file, const char *top, int from,
                        const char *names)
{
    tiny_string s = { "", 0 };
    char word[64];
    int used = 0, n = 0;

    tiny_add(&s, "{" ANGLE "%s \"frames\": [", top);
    for (const char *at = names; sscanf(at, "%63s%n", word, &used) == 1; at += used, n++) {
        tiny_picture(f, word, TINY_W, TINY_H, n);
        tiny_add(&s, "%s{\"file_path\": \"%s\", \"time\": %d" POSE, n > 0 ? "," : "", word,
                 from + n);
    }
    tiny_add(&s, "]}");
    tiny_text(f, file, s.text);
}

/* Masks, which are not used, are told of once for each file. */
static void test_masks(void **state)
{
    tiny_folder f = tiny_new();
    ted4_dataset d;
    char name[600];

    (void)state;
    tiny_picture(&f, "a.png", TINY_W, TINY_H, 0), tiny_picture(&f, "b.png", TINY_W, TINY_H, 0);
    tiny_text(&f, "transforms.json",
              "{" ANGLE "\"frames\": [{\"file_path\": \"a.png\", \"mask_path\": \"m/a.png\"" POSE
              ", {\"file_path\": \"b.png\", \"mask_path\": \"m/b.png\"" POSE "]}");
    snprintf(name, sizeof name, "%s: masks are not used (mask_path)",
             tiny_path(&f, "transforms.json"));
    d = load(&f);
    assert_int_equal(d.n_warnings, 1);
    assert_string_equal(d.warnings[0], name);
    ted4_dataset_free(&d);
    tiny_text(&f, "transforms.json",
              "{" ANGLE "\"mask_path\": \"m.png\", \"frames\": [{\"file_path\": \"a.png\"" POSE
              ", {\"file_path\": \"b.png\"" POSE "]}");
    assert_int_equal(warned(&f, "transforms.json: ", "masks are not used (mask_path)"), 2);
    tiny_text(&f, "transforms.json",
              "{" ANGLE "\"frames\": [{\"file_path\": \"a.png\", \"mask_path\": null" POSE "]}");
    d = load(&f);
    assert_int_equal(d.n_warnings, 0);
    ted4_dataset_free(&d);
    tiny_free(&f);
}

/* Pictures that are held out and trained on, or listed several times, are told of. */
static void test_twice(void **state)
{
    static const char *const hold_out[] = { "b.png" };
    ted4_dataset_options named = tiny_options;
    tiny_folder f = tiny_new();
    ted4_dataset d;

    (void)state;
    write_named(&f, "transforms_train.json", "", 0, "b.png c.png a.png d.png");
    write_named(&f, "transforms_test.json", "", 4, "e.png ./c.png f.png b.png");
    assert_int_equal(
        warned(&f, "2 held-out pictures are training pictures too; the first: ", "/b.png"), 8);
    write_named(&f, "transforms_test.json", "", 4, "e.png f.png a.png");
    assert_int_equal(warned(&f, "1 held-out picture is a training picture too: ", "/a.png"), 7);
    write_named(&f, "transforms_test.json", "", 4, "e.png g.png e.png e.png");
    assert_int_equal(warned(&f, "2 entries name a picture again; the first: ", "/e.png"), 8);
    write_named(&f, "transforms_test.json", "", 4, "e.png f.png");
    write_named(&f, "transforms_train.json", "", 0, "b.png c.png b.png d.png");
    assert_int_equal(warned(&f, "1 entry names a picture again: ", "/b.png"), 6);
    must(remove(tiny_path(&f, "transforms_test.json")) == 0, "test");
    must(remove(tiny_path(&f, "transforms_train.json")) == 0, "train");
    /* The fifth picture in the order of names is held out. */
    write_named(&f, "transforms.json", "", 0, "c.png d.png d.png a.png e.png b.png");
    assert_int_equal(warned(&f, "1 held-out picture is a training picture too: ", "/d.png"), 6);
    write_named(&f, "transforms.json",
                "\"train_filenames\": [\"a.png\"], \"test_filenames\": [\"./b.png\"],", 0,
                "a.png b.png b.png");
    expect(&f, 2, 1, "nerfstudio");
    /* A camera that is held out by name may share its picture with another. */
    named.hold_out = hold_out;
    named.n_hold_out = 1;
    tiny_text(&f, "transforms.json",
              "{" ANGLE "\"frames\": [{\"file_path\": \"a.png\"" POSE
              ", {\"file_path\": \"b.png\", \"camera\": \"b.png\"" POSE
              ", {\"file_path\": \"b.png\", \"camera\": \"c\"" POSE "]}");
    assert_string_equal(tiny_load(&d, &f, &named), "");
    assert_int_equal(d.n_warnings, 1);
    assert_non_null(strstr(d.warnings[0], "1 held-out picture is a training picture too: "));
    ted4_dataset_free(&d);
    tiny_free(&f);
}

/* Test times lie between training times, with or without a common step. */
static void test_times(void **state)
{
    tiny_folder f = tiny_new();

    (void)state;
    write_part(&f, "transforms_train.json", "train", ANGLE, 0, 0.1);
    write_part(&f, "transforms_test.json", "test", ANGLE, 0.05, 0.05);
    ted4_dataset d = load(&f);
    assert_int_equal(d.n_warnings, 0);
    assert_int_equal(d.n_frames, 19);
    for (size_t i = 0; i < d.n_pictures; i++)
        assert_int_equal(d.pictures[i].frame, d.pictures[i].is_test ? i - 10 + 1 : 2 * i);
    ted4_dataset_free(&d);
    write_part(&f, "transforms_test.json", "test", ANGLE, 0.0000123, 0.0998765);
    d = load(&f);
    assert_int_equal(d.n_warnings, 1);
    assert_non_null(strstr(d.warnings[0], "times have no common step: of 20 pictures, "));
    for (size_t i = 0; i < d.n_pictures; i++) {
        const double time = d.pictures[i].is_test ? 0.0000123 + (double)(i - 10) * 0.0998765
                                                  : 0.1 * (double)i;
        assert_true(fabs(d.pictures[i].frame / (d.n_frames - 1.0) - time / 0.9) < 0.001);
    }
    ted4_dataset_free(&d);
    tiny_free(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_lenses),        cmocka_unit_test(test_names),
        cmocka_unit_test(test_short_folders), cmocka_unit_test(test_files),
        cmocka_unit_test(test_masks),         cmocka_unit_test(test_twice),
        cmocka_unit_test(test_times),
    };

    return cmocka_run_group_tests_name("transforms", tests, NULL, NULL);
}
