/* test_belongs.c - which files ted4eval considers to belong to which scenes, and which pictures its
 * contact sheet shows.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "test.h"
#include "tool/belongs.h"
#include "tool/sheet.h"

enum { FRAMES = 8, CAMERAS = 12, MOST = 200 };

typedef struct {
    ted4_dataset d;
    ted4_info file;
    ted4_picture picture[MOST];
} pair;

/* Cameras on a circle of radius 10 around the origin that look at it, and a file of a cube there, 4
 * wide. */
static void make_pair(pair *p)
{
    memset(p, 0, sizeof *p);
    p->d = (ted4_dataset) { .pictures = p->picture,
                            .n_pictures = CAMERAS,
                            .n_frames = FRAMES,
                            .n_cameras = CAMERAS,
                            .rate = 30 };
    for (int i = 0; i < CAMERAS; i++) {
        const double a = 2 * 3.14159265358979 * i / CAMERAS;

        /* The forward direction is the third row: towards the origin. */
        p->picture[i].camera =
            (ted4_camera) { .width = 80,
                            .height = 60,
                            .fx = 80,
                            .fy = 80,
                            .cx = 40,
                            .cy = 30,
                            .R = { -sin(a), cos(a), 0, 0, 0, -1, -cos(a), -sin(a), 0 },
                            .t = { 0, 0, 10 } };
    }
    p->file.frames = FRAMES;
    p->file.rate_num = 30;
    p->file.rate_den = 1;
    p->file.exponent = 1;
}

/* what: part of the reason, or NULL if the file belongs to the scene. */
static void expect(const pair *p, const char *what)
{
    char why[256] = "";
    const int belongs = ted4_belongs_scene(&p->file, &p->d, why, sizeof why);

    if (belongs != (what == NULL) || (what != NULL && strstr(why, what) == NULL))
        fail_msg("%d \"%s\", expected \"%s\"", belongs, why, what == NULL ? "" : what);
}

static void test_scene(void **state)
{
    pair p;

    (void)state;
    make_pair(&p);
    expect(&p, NULL);
    p.file.frames = 1;
    expect(&p, "1 time in the file, 8 in the scene (--max-frames reads the first ones)");
    make_pair(&p);
    p.file.rate_num = 25;
    expect(&p, "25 frames per second in the file, 30 in the scene");
    p.d.rate = 0; /* unknown */
    expect(&p, NULL);
    /* The cube is outside nearly all pictures. */
    make_pair(&p);
    p.file.origin[2] = 9;
    expect(&p, "only 0 of 12 pictures look at where it lies");
    p.file.origin[2] = 5;
    expect(&p, NULL); /* its lower end is still visible */
    p.d.n_pictures = 1;
    p.file.origin[2] = 9;
    expect(&p, "only 0 of 1 picture look at where it lies");
    p.d.n_pictures = CAMERAS;
    p.file.origin[2] = 5;
    /* The cube is behind half of the cameras or more. */
    p.file.origin[2] = 0;
    p.file.origin[0] = 60;
    expect(&p, "of 12 pictures");
    /* Cameras inside a large cube see it, whatever their direction; a small cube in the middle of
     * the cameras is visible, too. */
    p.file.exponent = 7;
    expect(&p, NULL);
    p.file.origin[0] = 0;
    p.file.exponent = -3;
    expect(&p, NULL);
}

/* why: of pictures of the split, or NULL if the file has learnt from such pictures. */
static void expect_size(const pair *p, const ted4_camera_list *taken, int test, const char *why)
{
    char text[256] = "";
    const int belongs = ted4_belongs_size(taken, &p->d, test, text, sizeof text);

    assert_int_equal(belongs, why == NULL);
    assert_string_equal(text, why == NULL ? "" : why);
}

static void test_size(void **state)
{
    ted4_listed_camera camera[2] = { { .view = { .width = 40, .height = 30 } },
                                     { .view = { .width = 20, .height = 60 } } };
    const ted4_camera_list none = { 0 }, taken = { .camera = camera, .n = 2 };
    pair p;

    (void)state;
    make_pair(&p);
    p.picture[5].is_test = 1;
    expect_size(&p, &none, 0, NULL);
    expect_size(&p, &taken, 0,
                "these pictures have 80x60 pixels, those of its training 40x30: give --downscale "
                "as the training did, or --trained-downscale");
    camera[1].view.width = 80;
    expect_size(&p, &taken, 0, NULL);
    expect_size(&p, &taken, 1, NULL);
    /* One picture of a size that was seen is enough, if it is of the split. */
    camera[1].view.height = 61;
    p.picture[5].camera.height = 61;
    expect_size(&p, &taken, 1, NULL);
    expect_size(&p, &taken, 0,
                "these pictures have 80x60 pixels, those of its training 40x30: give --downscale "
                "as the training did, or --trained-downscale");
    p.picture[7].camera.height = 61;
    expect_size(&p, &taken, 0, NULL);
}

static void test_pictures(void **state)
{
    uint8_t truth[300], drawn[300];
    ted4_belongs_sum s = { 0, 0 };
    char why[256];

    (void)state;
    for (int i = 0; i < 300; i++) {
        truth[i] = (uint8_t)((i / 3) % 2 * 100 + 50);
        drawn[i] = (uint8_t)(truth[i] + 30);
    }
    ted4_belongs_add(&s, truth, drawn, 100);
    assert_true(s.drawn == 300.0 * 900);
    assert_true(s.mean == 300.0 * 2500);
    assert_int_equal(ted4_belongs_pictures(&s, why, sizeof why), 1);
    /* Pictures of a single colour have no weight, but those whose colour is far from the true one
     * have a large one. */
    memset(truth, 9, sizeof truth);
    memset(drawn, 9, sizeof drawn);
    ted4_belongs_add(&s, truth, drawn, 100);
    assert_int_equal(ted4_belongs_pictures(&s, why, sizeof why), 1);
    memset(drawn, 255, sizeof drawn);
    ted4_belongs_add(&s, truth, drawn, 100);
    assert_int_equal(ted4_belongs_pictures(&s, why, sizeof why), 0);
    assert_non_null(strstr(why, "dB further"));
}

/* Makes pictures of so many cameras, camera by camera, each at so many times. Every second camera
 * is held out. */
static void add_pictures(pair *p, uint32_t cameras, uint32_t times)
{
    p->d.n_pictures = 0;
    for (uint32_t c = 0; c < cameras; c++)
        for (uint32_t f = 0; f < times; f++)
            p->picture[p->d.n_pictures++] = (ted4_picture) {
                .camera = { .width = 8, .height = 6 }, .frame = f, .camera_id = c, .is_test = c % 2
            };
}

static void expect_rows(const pair *p, int test, size_t n, const size_t *want)
{
    size_t row[4] = { MOST, MOST, MOST, MOST };

    assert_int_equal(ted4_sheet_choose(&p->d, test, 4, row), n);
    for (size_t i = 0; i < n; i++)
        assert_int_equal(row[i], want[i]);
}

static void test_sheet(void **state)
{
    pair p;

    (void)state;
    make_pair(&p);
    /* Six held-out cameras, 1 3 5 7 9 11, of 8 times each: the first, the last and two between
     * them, each at a later time. */
    add_pictures(&p, CAMERAS, FRAMES);
    expect_rows(&p, 1, 4, (size_t[]) { 8, 3 * 8 + 2, 7 * 8 + 4, 11 * 8 + 7 });
    expect_rows(&p, 0, 4, (size_t[]) { 0, 2 * 8 + 2, 6 * 8 + 4, 10 * 8 + 7 });
    /* One camera: four of its times. Two cameras: the first and last time of each. */
    add_pictures(&p, 2, FRAMES);
    expect_rows(&p, 1, 4, (size_t[]) { 8, 10, 12, 15 });
    add_pictures(&p, 4, FRAMES);
    expect_rows(&p, 1, 4, (size_t[]) { 8, 24, 15, 31 });
    /* Fewer pictures than rows: no picture is shown twice. */
    add_pictures(&p, 3, 1);
    expect_rows(&p, 1, 1, (size_t[]) { 1 });
    expect_rows(&p, 0, 2, (size_t[]) { 0, 2 });
    p.picture[2].camera.width = 9;
    expect_rows(&p, 0, 1, (size_t[]) { 0 });
    p.picture[1].is_test = 0;
    expect_rows(&p, 1, 0, NULL);
    add_pictures(&p, 6, 3);
    p.picture[0].is_test = p.picture[1].is_test = 1; /* only two of another camera */
    p.d.n_pictures = 5;
    expect_rows(&p, 1, 4, (size_t[]) { 0, 3, 1, 4 });
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(test_scene), cmocka_unit_test(test_size),
                                        cmocka_unit_test(test_pictures),
                                        cmocka_unit_test(test_sheet) };

    return cmocka_run_group_tests_name("which files belong to a scene", tests, NULL, NULL);
}
