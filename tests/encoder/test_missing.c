/* test_missing.c - list entries whose picture is missing are left out, counted, and reported in one
 * warning; a picture that exists but is damaged is still an error. Covers every layout that lists
 * pictures.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "test.h"
#include "refuse.h"
#include "tiny_scene.h"

static void gone(const tiny_folder *f, const char *name)
{
    must(remove(tiny_path(f, name)) == 0, name);
}

/* Writes 20 frames at different times, with camera_angle_x, and with D-NeRF's names without
 * extension if there are two files. */
static void write_transforms(const tiny_folder *f, const char *file, const char *part, int first,
                             int n, const char *more)
{
    tiny_string s = { "", 0 };

    tiny_add(&s, "{\"camera_angle_x\": 1, %s \"frames\": [", more);
    for (int i = first; i < first + n; i++) {
        char name[64];
        snprintf(name, sizeof name, "%s/r_%02d.png", part, i);
        tiny_picture(f, name, TINY_W, TINY_H, i);
        tiny_add(&s,
                 "%s{\"file_path\": \"./%s/r_%02d\", \"time\": %g, \"transform_matrix\": "
                 "[[1,0,0,%d],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}",
                 i > first ? "," : "", part, i, i / 19.0, i);
    }
    tiny_add(&s, "]}");
    tiny_text(f, file, s.text);
}

static void test_transforms(void **state)
{
    tiny_folder f = tiny_new();
    ted4_dataset d;

    (void)state;
    write_transforms(&f, "transforms_train.json", "train", 0, 16, "");
    write_transforms(&f, "transforms_test.json", "test", 16, 4, "");
    gone(&f, "train/r_03.png");
    assert_int_equal(warned(&f, "1 of 20 entries has no picture: ",
                            "transforms_train.json: frames[3]: ./train/r_03"),
                     19);
    gone(&f, "train/r_07.png"), gone(&f, "test/r_17.png");
    assert_int_equal(warned(&f, "3 of 20 entries have no picture; the first: ",
                            "transforms_train.json: frames[3]: ./train/r_03"),
                     17);
    /* The remaining entries keep their time and pose. */
    assert_string_equal(tiny_load(&d, &f, &tiny_options), "");
    assert_string_equal(d.layout, "D-NeRF");
    for (size_t i = 0; i < d.n_pictures; i++) {
        const int number = atoi(strrchr(d.pictures[i].path, '_') + 1);
        assert_int_equal(d.pictures[i].frame, number);
        assert_true(d.pictures[i].camera.t[0] == -number);
        assert_int_equal(d.pictures[i].is_test, number >= 16);
    }
    ted4_dataset_free(&d);
    /* The file exists but is damaged. */
    tiny_text(&f, "train/r_05.png", "GIF89a.......");
    refuse(&f, "transforms_train.json: frames[5]", "neither PNG nor JPEG");
    for (int i = 0; i < 16; i++) {
        char name[64];
        snprintf(name, sizeof name, "train/r_%02d.png", i);
        (void)remove(tiny_path(&f, name));
    }
    refuse(&f, "none is left to train on; 17 of 20 entries have no picture, the first: ",
           "frames[0]: ./train/r_00");
    tiny_free(&f);
}

/* Lists of names still select the right frames if some of the preceding frames have no picture. */
static void test_lists(void **state)
{
    tiny_folder f = tiny_new();
    ted4_dataset d;

    (void)state;
    write_transforms(&f, "transforms.json", "images", 0, 8,
                     "\"train_filenames\": [\"images/r_01\", \"images/r_02\", \"images/r_06\"],"
                     "\"test_filenames\": [\"images/r_05\", \"images/r_00\"],");
    gone(&f, "images/r_00.png"), gone(&f, "images/r_02.png"), gone(&f, "images/r_03.png");
    assert_int_equal(warned(&f, "3 of 8 entries", "frames[0]: ./images/r_00"), 3);
    assert_string_equal(tiny_load(&d, &f, &tiny_options), "");
    assert_non_null(strstr(d.pictures[0].path, "r_01"));
    assert_non_null(strstr(d.pictures[1].path, "r_06"));
    assert_non_null(strstr(d.pictures[2].path, "r_05"));
    assert_int_equal(d.pictures[1].is_test, 0);
    assert_int_equal(d.pictures[2].is_test, 1);
    ted4_dataset_free(&d);
    tiny_free(&f);
}

static void test_colmap(void **state)
{
    tiny_folder f = tiny_new();
    tiny_string s = { "", 0 };
    ted4_dataset d;

    (void)state;
    tiny_text(&f, "sparse/0/cameras.txt", "1 PINHOLE 16 12 9 9 8 6\n");
    tiny_text(&f, "images/readme.txt", "");
    for (int i = 0; i < 50; i++) {
        char name[64];
        snprintf(name, sizeof name, "images/p%02d.png", i);
        tiny_add(&s, "%d 1 0 0 0 %d 0 0 1 p%02d.png\n\n", i + 1, i, i);
        if (i % 3 != 1)
            tiny_picture(&f, name, TINY_W, TINY_H, i);
    }
    tiny_text(&f, "sparse/0/images.txt", s.text);
    assert_int_equal(
        warned(&f, "17 of 50 entries have no picture; the first: COLMAP image \"p01.png\": ",
               "images/p01.png"),
        33);
    /* Every eighth of the existing pictures is held out. The numbers in names give the order of
     * frames; gaps between them are closed, as with other names. */
    assert_string_equal(tiny_load(&d, &f, &tiny_options), "");
    assert_int_equal(d.n_frames, 33);
    assert_int_equal(d.pictures[32].is_test, 1);
    assert_non_null(strstr(d.pictures[29].path, "p06.png"));
    ted4_dataset_free(&d);
    must(mkdir(tiny_path(&f, "images/p01.png"), 0777) == 0, "p01.png");
    refuse(&f, "COLMAP image \"p01.png\"", "a folder, expected a picture");
    tiny_free(&f);
}

/* Pictures that the model lacks are counted, and another model beside it is named. */
static void test_unlisted(void **state)
{
    static const char *const listed[] = { "a/0.png", "a/1.png", "b/deep/0.png" }, *const more[] = {
        "a/1.jpg", "b/deep/1.png", "2.png", "a/.3.png"
    };
    tiny_folder f = tiny_new();
    tiny_string s = { "", 0 };
    ted4_dataset d;
    char text[700];

    (void)state;
    tiny_text(&f, "sparse/0/cameras.txt", "1 PINHOLE 16 12 9 9 8 6\n");
    for (int i = 0; i < 3; i++) {
        snprintf(text, sizeof text, "images/%s", listed[i]);
        tiny_picture(&f, text, TINY_W, TINY_H, i);
        tiny_add(&s, "%d 1 0 0 0 %d 0 0 1 %s\n\n", i, i, listed[i]);
    }
    tiny_text(&f, "sparse/0/images.txt", s.text);
    tiny_text(&f, "sparse/1/cameras.txt", "1 PINHOLE 16 12 9 9 8 6\n");
    tiny_text(&f, "images/readme.txt", "");
    must(mkdir(tiny_path(&f, "images/c.png"), 0777) == 0, "c.png");
    must(symlink("nowhere.png", tiny_path(&f, "images/d.png")) == 0, "d.png");
    assert_string_equal(tiny_load(&d, &f, &tiny_options), "");
    assert_int_equal(d.n_warnings, 0);
    ted4_dataset_free(&d);
    for (int i = 0; i < 4; i++) {
        snprintf(text, sizeof text, "images/%s", more[i]);
        tiny_picture(&f, text, TINY_W, TINY_H, i);
    }
    assert_string_equal(tiny_load(&d, &f, &tiny_options), "");
    assert_int_equal(d.n_warnings, 1);
    snprintf(text, sizeof text,
             "3 of 6 pictures in %s are not in the model %s; the model %s is not used",
             tiny_path(&f, "images"), tiny_path(&f, "sparse/0"), tiny_path(&f, "sparse/1"));
    assert_string_equal(d.warnings[0], text);
    ted4_dataset_free(&d);
    gone(&f, "images/a/1.jpg"), gone(&f, "images/2.png");
    gone(&f, "sparse/1/cameras.txt");
    snprintf(text, sizeof text, "1 of 4 pictures in %s is not in the model %s",
             tiny_path(&f, "images"), tiny_path(&f, "sparse/0"));
    assert_string_equal(tiny_load(&d, &f, &tiny_options), "");
    assert_int_equal(d.n_warnings, 1);
    assert_string_equal(d.warnings[0], text);
    ted4_dataset_free(&d);
    /* Reduced copies are not looked at: they may be of another format than the model says. */
    must(rename(tiny_path(&f, "images"), tiny_path(&f, "images_2")) == 0, "images_2");
    assert_string_equal(tiny_load(&d, &f, &tiny_options), "");
    assert_int_equal(d.n_warnings, 0);
    ted4_dataset_free(&d);
    tiny_free(&f);
}

/* A pipe in place of a picture, from which nothing can be read, counts as missing. */
static void test_pipe(void **state)
{
    tiny_folder f = tiny_new();
    ted4_dataset_options o = tiny_options;
    ted4_dataset d;

    (void)state;
    alarm(20); /* where the pipe is opened, the program would wait for ever */
    tiny_text(&f, "sparse/0/cameras.txt", "1 PINHOLE 16 12 9 9 8 6\n");
    tiny_text(&f, "sparse/0/images.txt", "1 1 0 0 0 0 0 0 1 0.png\n\n2 1 0 0 0 0 0 0 1 1.png\n\n");
    tiny_picture(&f, "images/0.png", TINY_W, TINY_H, 0);
    must(mkfifo(tiny_path(&f, "images/1.png"), 0666) == 0, "1.png");
    assert_int_equal(
        warned(&f, "1 of 2 entries has no picture: COLMAP image \"1.png\": ", "images/1.png"), 1);
    tiny_free(&f);
    f = tiny_new();
    tiny_text(&f, "cams.json",
              "{\"cameras\": [{\"name\": \"a\", \"w\": 16, \"h\": 12, "
              "\"K\": [[9,0,8],[0,9,6],[0,0,1]], \"w2c\": " TINY_POSE "}]}");
    tiny_picture(&f, "images/a/0.png", TINY_W, TINY_H, 0);
    must(mkfifo(tiny_path(&f, "images/a/1.png"), 0666) == 0, "1.png");
    tiny_picture(&f, "images/a/2.png", TINY_W, TINY_H, 2);
    tiny_picture(&f, "images/a/3.png", TINY_W, TINY_H, 3);
    assert_int_equal(warned(&f, "clips lack pictures by the numbers in their names: 1 of 4; ",
                            "a has none of number 1"),
                     3);
    o.max_frames = 3;
    assert_string_equal(tiny_load(&d, &f, &o), "");
    assert_int_equal(d.n_pictures, 2);
    ted4_dataset_free(&d);
    /* What exists but is no picture is still an error. */
    gone(&f, "images/a/1.png");
    must(mkdir(tiny_path(&f, "images/a/1.png"), 0777) == 0, "1.png");
    refuse(&f, "images/a/1.png: ", "a folder, expected a picture");
    must(rmdir(tiny_path(&f, "images/a/1.png")) == 0, "1.png");
    must(symlink("nowhere.png", tiny_path(&f, "images/a/1.png")) == 0, "1.png");
    refuse(&f, "images/a/1.png: ", "No such file");
    alarm(0);
    tiny_free(&f);
}

static void test_hypernerf(void **state)
{
    static const char camera[] = "{\"orientation\": [[1,0,0],[0,1,0],[0,0,1]], \"position\": "
                                 "[0,0,1], \"focal_length\": 9,"
                                 "\"principal_point\": [8, 6], \"image_size\": [16, 12]}";
    tiny_folder f = tiny_new();

    (void)state;
    tiny_text(&f, "dataset.json",
              "{\"ids\": [\"a\", \"b\", \"c\"], \"train_ids\": [\"a\", \"b\"], \"val_ids\": "
              "[\"c\"]}");
    tiny_text(&f, "metadata.json",
              "{\"a\": {\"warp_id\": 0}, \"b\": {\"warp_id\": 1}, \"c\": {\"warp_id\": 2}}");
    tiny_text(&f, "camera/a.json", camera), tiny_text(&f, "camera/b.json", camera),
        tiny_text(&f, "camera/c.json", camera);
    tiny_picture(&f, "rgb/1x/a.png", TINY_W, TINY_H, 0),
        tiny_picture(&f, "rgb/1x/c.png", TINY_W, TINY_H, 0);
    assert_int_equal(warned(&f, "1 of 3 entries has no picture: ", "dataset.json: \"b\": "), 2);
    gone(&f, "rgb/1x/a.png"), gone(&f, "rgb/1x/c.png");
    refuse(&f, "none of 3 entries has a picture; the first: ", "dataset.json: \"a\": ");
    tiny_free(&f);
}

/* One camera has no clip: the others keep their poses. */
static void test_calibration(void **state)
{
    tiny_folder f = tiny_new();
    tiny_string s = { "", 0 };
    ted4_dataset d;

    (void)state;
    tiny_add(&s, "{\"cameras\": [");
    for (int i = 0; i < 4; i++) {
        char name[64];
        tiny_add(&s,
                 "%s{\"name\": \"eye%d\", \"w\": 16, \"h\": 12, \"K\": [[9,0,8],[0,9,6],[0,0,1]],"
                 "\"w2c\": [[1,0,0,%d],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}",
                 i > 0 ? "," : "", i, i);
        for (int k = 0; k < 3 && i != 1; k++) {
            snprintf(name, sizeof name, "eye%d/images/%d.png", i, k);
            tiny_picture(&f, name, TINY_W, TINY_H, k);
        }
    }
    tiny_add(&s, "]}");
    tiny_text(&f, "cams.json", s.text);
    assert_int_equal(
        warned(&f, "1 of 4 entries has no picture: ", "cams.json: cameras[1]: eye1: no such video"),
        9);
    assert_string_equal(tiny_load(&d, &f, &tiny_options), "");
    assert_int_equal(d.n_cameras, 3);
    assert_true(d.pictures[3].camera.t[0] == 2);
    ted4_dataset_free(&d);
    tiny_free(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_transforms),  cmocka_unit_test(test_lists),
        cmocka_unit_test(test_colmap),      cmocka_unit_test(test_hypernerf),
        cmocka_unit_test(test_calibration), cmocka_unit_test(test_unlisted),
        cmocka_unit_test(test_pipe),
    };

    return cmocka_run_group_tests_name("missing pictures", tests, NULL, NULL);
}
