/* test_camera_lens.c - lenses of transforms files: ted4dec and ted4edit read them as ted4enc does;
 * what is not a perspective camera is refused, and distortion is noticed.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "data/transforms.h"
#include "temporary.h"
#include "test.h"
#include "tool/camera_list.h"

enum { WIDTH = 64, HEIGHT = 48 };

static char folder[TEMPORARY_SIZE];
static ted4_camera_list list;
static char why[256];

/* Loads a file of one frame with these members at the top and in the frame. */
static int load(const char *top, const char *frame)
{
    char path[TEMPORARY_SIZE + 16];
    FILE *f;

    snprintf(path, sizeof path, "%s/t.json", folder);
    f = fopen(path, "w");
    assert_non_null(f);
    fprintf(f,
            "{%s \"w\": %d, \"h\": %d, \"frames\": [{%s \"transform_matrix\": "
            "[[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}]}",
            top, WIDTH, HEIGHT, frame);
    assert_int_equal(fclose(f), 0);
    return ted4_camera_list_load(&list, path, why, sizeof why);
}

static json_t *object(const char *members)
{
    char text[600];

    snprintf(text, sizeof text, "{%s \"-\": 0}", members);
    return json_loads(text, 0, NULL);
}

/* Reads the lens as the encoder does. */
static int read_lens(const char *top, const char *frame, ted4_lens *l)
{
    json_t *const root = object(top), *const one = object(frame);
    char path[] = "t.json";
    ted4_message m;
    ted4_transforms t = { .path = path, .root = root, .frame = one, .where = "frame 0", .m = &m };

    assert_true(root != NULL && one != NULL);
    memset(l, 0, sizeof *l);
    l->width = WIDTH;
    l->height = HEIGHT;
    const int result = ted4_transforms_lens(&t, l);

    json_decref(root);
    json_decref(one);
    return result;
}

#define ANGLE   "\"camera_angle_x\": 0.9,"
#define ANGLE_Y "\"camera_angle_y\": 0.5,"
#define K_LIST  "\"K\": [[200, 0, 30], [0, 210, 20], [0, 0, 1]],"

static const struct {
    const char *top, *frame;
    int distorted;
} same[] = {
    { ANGLE, "", 0 },
    { "", ANGLE, 0 },
    { ANGLE, K_LIST, 0 },
    { K_LIST ANGLE, "", 0 },
    { K_LIST, "", 0 },
    { "", "\"intrinsics\": [70, 71, 31, 23],", 0 },
    { "\"intrinsic_matrix\": [70, 0, 31, 0, 71, 23, 0, 0, 1],", "", 0 },
    { "", "\"camera_intrinsics\": [[70, 0, 31], [0, 71, 23], [0, 0, 1]],", 0 },
    { K_LIST, ANGLE, 0 },
    { K_LIST "\"fl_x\": 90,", "", 0 },
    { "\"fl_x\": 90, \"fl_y\": 95, \"cx\": 1,", K_LIST, 0 },
    { "\"fl_y\": 95, \"cx\": 3,", "\"fl_x\": 90,", 0 },
    { "\"fl_x\": 80,", "\"fl_x\": 90, \"fl_y\": 91, \"cy\": 2,", 0 },
    { K_LIST "\"cx\": 12,", "\"cy\": 13,", 0 },
    { "\"fl_x\": 80, \"k1\": 0, \"p2\": 0,", "", 0 },
    { "\"fl_x\": 80, \"k1\": 0.1,", "", 1 },
    { "\"fl_x\": 80, \"k1\": 0.1,", "\"k1\": 0,", 0 },
    { "\"camera_model\": \"OPENCV\", \"fl_x\": 80,", "\"p2\": 0.001,", 1 },
    { "", "\"K\": [70, 2, 31, 0, 71, 23, 0, 0, 1],", 1 },
    { "\"camera_model\": \"OPENCV_FISHEYE\", \"fl_x\": 80,", "\"camera_model\": \"PINHOLE\",", 0 },
    { "\"is_fisheye\": false, \"fl_x\": 80,", "\"is_fisheye\": false,", 0 },
    { ANGLE ANGLE_Y, "", 0 },
    { "", ANGLE ANGLE_Y, 0 },
    { ANGLE ANGLE_Y "\"fl_y\": 90,", "", 0 },
    { ANGLE ANGLE_Y, "\"fl_y\": 90,", 0 },
    { ANGLE ANGLE_Y, "\"fl_x\": 90,", 0 },
    { ANGLE ANGLE_Y, ANGLE, 0 },
    { ANGLE, ANGLE_Y, 0 },
    { "\"fl_x\": 80," ANGLE ANGLE_Y, "", 0 },
    { "\"fl_x\": 80, \"fl_y\": 90, \"camera_angle_y\": 7,", "", 0 },
    { K_LIST ANGLE_Y, "", 0 },
};

static void test_same(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof same / sizeof same[0]; i++) {
        ted4_lens want;

        assert_int_equal(read_lens(same[i].top, same[i].frame, &want), 0);
        if (load(same[i].top, same[i].frame) != 0)
            fail_msg("case %zu: %s", i, why);
        const ted4_view *const v = &list.camera[0].view;

        if (!(fabs((double)v->fx - want.fx) <= 1e-4 && fabs((double)v->fy - want.fy) <= 1e-4 &&
              fabs((double)v->cx - want.cx) <= 1e-4 && fabs((double)v->cy - want.cy) <= 1e-4))
            fail_msg("case %zu: %g %g %g %g, ted4enc has %g %g %g %g", i, (double)v->fx,
                     (double)v->fy, (double)v->cx, (double)v->cy, want.fx, want.fy, want.cx,
                     want.cy);
        if (list.distorted != same[i].distorted)
            fail_msg("case %zu: distorted %d", i, list.distorted);
        ted4_camera_list_free(&list);
    }
}

static const struct {
    const char *top, *frame, *why;
} bad[] = {
    { "", "", "frame 0 needs fl_x, K or camera_angle_x" },
    { "\"K\": [1, 2, 3],", "", "frame 0 has a K other than" },
    { "\"K\": [70, 0, 31, 0, 71, 23, 0, 0, 2],", "", "frame 0 has a K other than" },
    { "\"fl_x\": \"80\",", "", "frame 0 has a lens with a field that is no number" },
    { "\"fl_x\": 80,", "\"k2\": [],", "frame 0 has a lens with a field that is no number" },
    { "\"camera_angle_x\": 3.2,", "", "frame 0 has a camera_angle_x" },
    { "\"fl_x\": 80, \"camera_model\": \"OPENCV_FISHEYE\",", "", "frame 0 has a camera_model" },
    { "\"fl_x\": 80,", "\"camera_model\": \"EQUIRECTANGULAR\",", "frame 0 has a camera_model" },
    { "\"fl_x\": 80, \"camera_model\": 1,", "", "frame 0 has a camera_model" },
    { "\"fl_x\": 80, \"is_fisheye\": true,", "", "frame 0 is_fisheye" },
    { "\"fl_x\": 80,", "\"is_fisheye\": true,", "frame 0 is_fisheye" },
    { "\"fl_x\": 80, \"is_fisheye\": true,", "\"is_fisheye\": false,", "frame 0 is_fisheye" },
    { ANGLE "\"camera_angle_y\": 3.2,", "", "frame 0 has a camera_angle_y" },
    { ANGLE, "\"camera_angle_y\": 0,", "frame 0 has a camera_angle_y" },
    { ANGLE "\"camera_angle_y\": \"1\",", "", "frame 0 has a lens with a field that" },
    { ANGLE_Y, "", "frame 0 needs fl_x, K or camera_angle_x" },
    { "\"fl_x\": 80, \"k4\": 0.1,", "", "frame 0 has k4, k5 or k6" },
};

static void test_refused(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        ted4_lens want;

        assert_int_equal(read_lens(bad[i].top, bad[i].frame, &want), -1);
        if (load(bad[i].top, bad[i].frame) != -1 || strncmp(why, bad[i].why, strlen(bad[i].why)))
            fail_msg("case %zu: %s", i, why);
    }
}

/* A camera that sees a mirror image is none. */
static void test_mirror(void **state)
{
    static const char name[] = "t.json";
    char path[TEMPORARY_SIZE + 16];
    FILE *f;

    (void)state;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    f = fopen(path, "w");
    assert_non_null(f);
    fprintf(f, "{\"fl_x\": 80, \"w\": 8, \"h\": 8, \"frames\": [{\"transform_matrix\": "
               "[[-1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}]}");
    assert_int_equal(fclose(f), 0);
    assert_int_equal(ted4_camera_list_load(&list, path, why, sizeof why), -1);
    assert_string_equal(why, "frame 0 has a transform_matrix that is a mirror image");
}

/* A byte order mark before the text is skipped; a piece of one is not text. */
static void test_mark(void **state)
{
    static const struct {
        const char *text;
        int result;
    } cases[] = {
        { "\xef\xbb\xbf{\"fl_x\": 80, \"w\": 8, \"h\": 8, \"frames\": [{\"transform_matrix\": "
          "[[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}]}",
          0 },
        { "\xef\xbb\xbf", -1 },
        { "\xef\xbb", -1 },
        { "", -1 },
    };

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char path[TEMPORARY_SIZE + 16];
        FILE *f;

        snprintf(path, sizeof path, "%s/t.json", folder);
        f = fopen(path, "w");
        assert_non_null(f);
        fputs(cases[i].text, f);
        assert_int_equal(fclose(f), 0);
        assert_int_equal(ted4_camera_list_load(&list, path, why, sizeof why), cases[i].result);
        if (cases[i].result != 0)
            assert_non_null(strstr(why, "line 1: "));
        ted4_camera_list_free(&list);
    }
}

static int set_up(void **state)
{
    (void)state;
    temporary_folder(folder, "camera_lens");
    return 0;
}

static int tear_down(void **state)
{
    char path[TEMPORARY_SIZE + 16];

    (void)state;
    snprintf(path, sizeof path, "%s/t.json", folder);
    remove(path);
    return rmdir(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(test_same), cmocka_unit_test(test_refused),
                                        cmocka_unit_test(test_mirror),
                                        cmocka_unit_test(test_mark) };

    return cmocka_run_group_tests(tests, set_up, tear_down);
}
