/* test_hold_out.c - cameras that the caller names are held out, in every layout, instead of those
 * that the layout specifies; an unknown name gives an error that lists the known names. Links
 * tools/scene/ray_*.o.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "test.h"
#include "tools/scene/ray_set.h"
#include "tiny_scene.h"

enum { TRAIN = 3, TEST = 1, FRAMES = 4 };

static tiny_folder write_scene(ted4_ray_layout layout)
{
    const ted4_ray_options o = { .scene = RAY_TURN,
                                 .width = 16,
                                 .height = 12,
                                 .n_train = TRAIN,
                                 .n_test = TEST,
                                 .n_frames = FRAMES,
                                 .seed = 3,
                                 .layout = layout };
    tiny_folder f = tiny_new();
    ted4_ray_message m;

    if (ted4_ray_write(&o, f.path, NULL, &m) != 0)
        fail_msg("%s", m.text);
    return f;
}

static const char *load(ted4_dataset *d, const tiny_folder *f, const char *const *names, size_t n)
{
    ted4_dataset_options o = tiny_options;

    o.hold_out = names;
    o.n_hold_out = n;
    return tiny_load(d, f, &o);
}

/* Asserts that exactly the pictures whose path contains one of two texts are held out, of 16
 * pictures by 4 cameras at 4 frames. */
static void held(const tiny_folder *f, const char *const *names, size_t n, const char *first,
                 const char *second)
{
    ted4_dataset d;
    size_t tests = 0;

    assert_string_equal(load(&d, f, names, n), "");
    assert_int_equal(d.n_pictures, (TRAIN + TEST) * FRAMES);
    for (size_t i = 0; i < d.n_pictures; i++) {
        const char *path = d.pictures[i].path + strlen(f->path);
        const int expected = strstr(path, first) != NULL ||
                             (second != NULL && strstr(path, second) != NULL);
        if (d.pictures[i].is_test != expected)
            fail_msg("%s: is_test %d", path, d.pictures[i].is_test);
        tests += d.pictures[i].is_test;
    }
    assert_int_equal(tests, FRAMES * (second != NULL ? 2 : 1));
    ted4_dataset_free(&d);
}

static void refused(const tiny_folder *f, const char *name, const char *what)
{
    ted4_dataset d;
    const char *text = load(&d, f, &name, 1);

    if (*text == 0 || strstr(text, "--hold-out ") == NULL || strstr(text, what) == NULL ||
        strchr(text, '\n') != NULL)
        fail_msg("got \"%s\", expected \"%s\"", text, what);
    assert_null(d.pictures);
}

/* Layouts whose cameras have names. */
static void test_labels(void **state)
{
    /* Names of two cameras, and parts of their pictures' paths; then all names, as the error lists
     * them. */
    static const struct {
        ted4_ray_layout layout;
        const char *name[2], *path[2], *all;
    } cases[] = {
        { RAY_NERFSTUDIO,
          { "0", "2" },
          { "train_r_000", "train_r_002" },
          "expected one of: 0, 1, 2, 3" },
        { RAY_HYPERNERF,
          { "0", "2" },
          { "train_r_000", "train_r_002" },
          "expected one of: 0, 1, 2, 3" },
        { RAY_COLMAP, { "cam01", "cam03" }, { "cam01", "cam03" }, "cam00, cam01, cam02, cam03" },
        { RAY_COLMAP_TEXT,
          { "1/cam01/", "cam03" },
          { "cam01", "cam03" },
          "cam00, cam01, cam02, cam03" },
        { RAY_NEU3D, { "cam02", "cam01" }, { "cam02", "cam01" }, "cam00, cam01, cam02, cam03" },
        { RAY_CALIBRATION,
          { "cam03", "cam01" },
          { "cam03", "cam01" },
          "cam00, cam01, cam02, cam03" },
    };

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        tiny_folder f = write_scene(cases[i].layout);
        held(&f, cases[i].name, 1, cases[i].path[0], NULL);
        held(&f, cases[i].name, 2, cases[i].path[0], cases[i].path[1]);
        refused(&f, "cam99", cases[i].all);
        refused(&f, "", "no camera or picture of this name");
        tiny_free(&f);
    }
}

/* Cameras without a name are named by the pictures they took. */
static void test_pictures(void **state)
{
    static const char *const good[] = { "train/r_001_02.png", "r_001_02", "train/r_001_00" };
    tiny_folder f = write_scene(RAY_BLENDER);

    (void)state;
    for (int i = 0; i < 3; i++)
        held(&f, good + i, 1, "train/r_001", NULL);
    held(&f, good, 3, "train/r_001", NULL);
    held(&f, (const char *const[]) { "r_001_02", "r_002_00" }, 2, "train/r_001", "train/r_002");
    refused(&f, "r_000_00", "pictures of several cameras are called so");
    refused(&f, "001_02",
            "expected one of: train/r_000_00.png, r_001_00.png, r_002_00.png, test/r_000_00.png");
    held(&f, (const char *const[]) { "test/r_000_00.png" }, 1, "test/r_000", NULL);
    tiny_free(&f);
    f = write_scene(RAY_NEU3D);
    held(&f, (const char *const[]) { "cam01/images/0000.png" }, 1, "cam01", NULL);
    refused(&f, "0000.png", "pictures of several cameras are called so");
    tiny_free(&f);
}

/* COLMAP may have one camera for each picture, or several in a folder. The folder is the name of
 * all of them, and a picture or a label that of one. */
static void test_folders(void **state)
{
    static const char *const pictures[] = { "left/0.png", "left/1.png", "right/0.png",
                                            "right/1.png" };
    static const struct {
        const char *name, *held; /* of pictures: 1 for those held out */
    } cases[] = {
        { "left", "1100" },       { "right", "0011" },    { "1/left/", "1000" },
        { "left/1.png", "0100" }, { "3/right/", "0011" }, { "right/0", "0011" },
    };
    tiny_folder f = tiny_new();

    (void)state;
    tiny_text(&f, "sparse/0/cameras.txt",
              "1 SIMPLE_PINHOLE 16 12 9 8 6\n2 SIMPLE_PINHOLE 16 12 9 8 6\n"
              "3 SIMPLE_PINHOLE 16 12 9 8 6\n");
    tiny_text(&f, "sparse/0/images.txt",
              "1 1 0 0 0 0 0 0 1 left/0.png\n\n2 1 0 0 0 0 0 0 2 left/1.png\n\n"
              "3 1 0 0 0 0 0 0 3 right/0.png\n\n4 1 0 0 0 0 0 0 3 right/1.png\n\n");
    for (int i = 0; i < 4; i++) {
        char path[32];

        snprintf(path, sizeof path, "images/%s", pictures[i]);
        tiny_picture(&f, path, TINY_W, TINY_H, i);
    }
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        ted4_dataset d;

        assert_string_equal(load(&d, &f, &cases[i].name, 1), "");
        for (size_t k = 0; k < d.n_pictures; k++)
            for (int p = 0; p < 4; p++)
                if (strstr(d.pictures[k].path, pictures[p]) != NULL &&
                    d.pictures[k].is_test != cases[i].held[p] - '0')
                    fail_msg("%s: %s: is_test %d", cases[i].name, pictures[p],
                             d.pictures[k].is_test);
        ted4_dataset_free(&d);
    }
    refused(&f, "middle", "expected one of: left, right");
    tiny_free(&f);
}

/* Asserts what is said of cameras when only the first times are kept; NULL: nothing. */
static void lost(const tiny_folder *f, uint32_t most, const char *warning)
{
    ted4_dataset_options o = tiny_options;
    ted4_dataset d;

    o.max_frames = most;
    assert_string_equal(tiny_load(&d, f, &o), "");
    assert_int_equal(d.n_warnings, warning != NULL);
    if (warning != NULL)
        assert_string_equal(d.warnings[0], warning);
    ted4_dataset_free(&d);
}

/* Writes a COLMAP scene of four pictures at different times, each with a camera of its own. */
static tiny_folder write_colmap(const char *const pictures[4])
{
    tiny_folder f = tiny_new();
    tiny_string cameras = { "", 0 }, images = { "", 0 };

    for (int i = 0; i < 4; i++) {
        char path[32];

        snprintf(path, sizeof path, "images/%s", pictures[i]);
        tiny_picture(&f, path, TINY_W, TINY_H, i);
        tiny_add(&cameras, "%d SIMPLE_PINHOLE 16 12 9 8 6\n", i);
        tiny_add(&images, "%d 1 0 0 0 0 0 0 %d %s\n\n", i, i, pictures[i]);
    }
    tiny_text(&f, "sparse/0/cameras.txt", cameras.text);
    tiny_text(&f, "sparse/0/images.txt", images.text);
    return f;
}

/* Cameras that have no picture in the first times are told of by the names that hold them out.
 * COLMAP's cameras that belong to single pictures are not. */
static void test_lost(void **state)
{
    static const char *const folders[] = { "left/0.png", "left/1.png", "right/2.png",
                                           "right/3.png" },
                             *const single[] = { "0.png", "1.png", "2.png", "3.png" };
    tiny_folder f = write_colmap(folders), g = write_colmap(single);

    (void)state;
    lost(&f, 3, NULL);
    lost(&f, 1, "--max-frames 1 leaves out camera right, which has no picture in the first times");
    lost(&g, 2, NULL);
    tiny_free(&f);
    tiny_free(&g);
}

/* Pictures that the layout's own split leaves out are used again. Holding out all cameras is an
 * error, since nothing would remain. */
static void test_whole(void **state)
{
    tiny_folder f = write_scene(RAY_NERFSTUDIO);
    ted4_dataset d;
    const char *const all[] = { "0", "1", "2", "3" };

    (void)state;
    assert_non_null(strstr(load(&d, &f, all, 4), "all 16 pictures are held out"));
    tiny_free(&f);
    f = tiny_new();
    tiny_string s = { "", 0 };
    tiny_add(&s, "{\"fl_x\": 9, \"train_filenames\": [\"p0.png\"], \"frames\": [");
    for (int i = 0; i < 300; i++) {
        if (i < 3)
            tiny_picture(&f, i == 0 ? "p0.png" : i == 1 ? "p1.png" : "p2.png", TINY_W, TINY_H, i);
        tiny_add(&s,
                 "%s{\"file_path\": \"p%d.png\", \"camera\": %d, \"transform_matrix\": " TINY_POSE
                 "}",
                 i > 0 ? "," : "", i % 3, i);
    }
    tiny_add(&s, "]}");
    tiny_text(&f, "transforms.json", s.text);
    assert_string_equal(load(&d, &f, all + 2, 1), "");
    assert_int_equal(d.n_pictures, 300);
    assert_int_equal(d.pictures[299].is_test, 1);
    assert_int_equal(d.pictures[298].is_test, 0);
    ted4_dataset_free(&d);
    refused(&f, "x", ", ... (300 in all)");
    tiny_free(&f);
    /* Without a split, HyperNeRF leaves out two ids in four. */
    f = write_scene(RAY_HYPERNERF);
    s.n = 0;
    tiny_add(&s, "{\"ids\": [");
    for (int i = 0; i < TRAIN * FRAMES; i++)
        tiny_add(&s, "%s\"train_r_%03d_%02d\"", i > 0 ? "," : "", i / FRAMES, i % FRAMES);
    tiny_add(&s, "]}");
    tiny_text(&f, "dataset.json", s.text);
    assert_string_equal(load(&d, &f, NULL, 0), "");
    assert_int_equal(d.n_pictures, 2 * TRAIN);
    ted4_dataset_free(&d);
    assert_string_equal(load(&d, &f, all + 1, 1), "");
    assert_int_equal(d.n_pictures, TRAIN * FRAMES);
    ted4_dataset_free(&d);
    tiny_free(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(test_labels),
                                        cmocka_unit_test(test_pictures),
                                        cmocka_unit_test(test_folders), cmocka_unit_test(test_lost),
                                        cmocka_unit_test(test_whole) };

    return cmocka_run_group_tests_name("hold out", tests, NULL, NULL);
}
