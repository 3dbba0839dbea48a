/* test_layout_errors.c - every error in a scene of the layouts hypernerf, neu3d and calibration, or
 * in a video, gives one message that says where and what, and leaves an empty dataset. The other
 * layouts: test_dataset_errors.c.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>

#include "test.h"
#include "refuse.h"
#include "tiny_scene.h"

static void accept(const tiny_folder *f)
{
    ted4_dataset d;

    assert_string_equal(tiny_load(&d, f, &tiny_options), "");
    ted4_dataset_free(&d);
}

/* hypernerf */

#define EYE   "\"orientation\": [[1,0,0],[0,1,0],[0,0,1]],"
#define PLACE "\"position\": [0,0,1],"
#define LENS  "\"focal_length\": 9, \"principal_point\": [8, 6], \"image_size\": [16, 12]"
#define IDS   "{\"ids\": [\"a\"], \"train_ids\": [\"a\"], \"val_ids\": [\"b\"]}"
#define WARPS "{\"a\": {\"warp_id\": 0}, \"b\": {\"warp_id\": 1}}"

static void hypernerf(const tiny_folder *f, const char *dataset, const char *metadata,
                      const char *camera)
{
    tiny_text(f, "dataset.json", dataset);
    tiny_text(f, "metadata.json", metadata);
    tiny_text(f, "camera/a.json", camera);
    tiny_text(f, "camera/b.json", "{" EYE PLACE LENS "}");
}

#define GOOD "{" EYE PLACE LENS "}"

static const struct {
    const char *dataset, *metadata, *camera, *where, *what;
} hypernerf_cases[] = {
    { "{", WARPS, GOOD, "dataset.json:1", "not valid JSON" },
    { "{\"ids\": 3}", WARPS, GOOD, "dataset.json.ids", "expected a list" },
    { "{\"ids\": [3]}", WARPS, GOOD, "dataset.json.ids[0]", "expected a name" },
    { "{\"ids\": []}", WARPS, GOOD, "layout hypernerf", "no pictures" },
    { "{\"train_ids\": [\"a\"], \"val_ids\": [\"a\"]}", WARPS, GOOD, "dataset.json: \"a\"",
      "twice" },
    { "{\"train_ids\": [\"c\"], \"val_ids\": [\"a\"]}", WARPS, GOOD, "none is left to train on",
      "1 of 2 entries have no picture, the first: " },
    { "{\"train_ids\": [\"c\", \"d\"], \"val_ids\": []}", WARPS, GOOD, "no pictures", "" },
    { "{\"val_ids\": [\"a\"]}", WARPS, GOOD, "held out", "none is left" },
    { IDS, "{\"a\": {\"warp_id\": 0}}", GOOD, "metadata.json: \"b\"", "no such entry" },
    { IDS, "{\"a\": {\"warp_id\": 0}, \"b\": {}}", GOOD, "metadata.json: \"b\".warp_id",
      "missing" },
    { IDS, "{\"a\": {\"warp_id\": -1e308}}", GOOD, "metadata.json: \"a\".warp_id: -1e+308",
      "expected at most 1e+300 on either side of 0" },
    { IDS, "{\"a\": {\"warp_id\": \"0\"}}", GOOD, "metadata.json: \"a\".warp_id",
      "expected a number" },
    { IDS, WARPS, "[", "camera/a.json:1", "not valid JSON" },
    { IDS, WARPS, "{" PLACE LENS "}", "camera/a.json.orientation", "missing" },
    { IDS, WARPS, "{" EYE LENS "}", "camera/a.json.position", "missing" },
    { IDS, WARPS, "{" EYE "\"position\": [1, 2]," LENS "}", "camera/a.json.position",
      "expected 3 numbers" },
    { IDS, WARPS, "{" EYE "\"position\": [1, 2, 3, 4]," LENS "}", "camera/a.json.position",
      "expected 3 numbers" },
    { IDS, WARPS, "{\"orientation\": [[1,0,0],[0,1,0],[0,0,-1]]," PLACE LENS "}",
      "camera/a.json.orientation", "mirror" },
    { IDS, WARPS, "{" EYE PLACE "\"principal_point\": [8, 6], \"image_size\": [16, 12]}",
      "a.json.focal_length", "missing" },
    { IDS, WARPS, "{" EYE PLACE "\"focal_length\": 9, \"principal_point\": [8, 6]}",
      "a.json.image_size", "missing" },
    { IDS, WARPS,
      "{" EYE PLACE "\"focal_length\": 9, \"principal_point\": [8, 6], \"image_size\": [0, 12]}",
      "a.json.image_size", "0, 12" },
    { IDS, WARPS,
      "{" EYE PLACE "\"focal_length\": 9, \"principal_point\": [8, 6], \"image_size\": [16.5, 12]}",
      "a.json.image_size", "16.5, 12, expected whole numbers" },
    { IDS, WARPS,
      "{" EYE PLACE "\"focal_length\": 9, \"principal_point\": [8, 6], \"image_size\": [20, 12]}",
      "a.png", "camera says 20x12" },
    { IDS, WARPS, "{" EYE PLACE LENS ", \"radial_distortion\": [1, 2]}", "a.json.radial_distortion",
      "expected 3 numbers" },
    { IDS, WARPS, "{" EYE PLACE LENS ", \"pixel_aspect_ratio\": 0}", "a.png",
      "focal lengths 9, 0" },
};

static void test_hypernerf(void **state)
{
    tiny_folder f = tiny_new();

    (void)state;
    hypernerf(&f, IDS, WARPS, GOOD);
    refuse(&f, "/rgb", "none of the folders");
    tiny_picture(&f, "rgb/1x/a.png", TINY_W, TINY_H, 0);
    assert_int_equal(warned(&f, "1 of 2 entries has no picture", "dataset.json: \"b\""), 1);
    tiny_picture(&f, "rgb/1x/b.png", TINY_W, TINY_H, 0);
    accept(&f);
    for (size_t i = 0; i < sizeof hypernerf_cases / sizeof hypernerf_cases[0]; i++) {
        hypernerf(&f, hypernerf_cases[i].dataset, hypernerf_cases[i].metadata,
                  hypernerf_cases[i].camera);
        refuse(&f, hypernerf_cases[i].where, hypernerf_cases[i].what);
    }
    hypernerf(&f, IDS, WARPS, GOOD);
    must(remove(tiny_path(&f, "camera/b.json")) == 0, "b.json");
    refuse(&f, "camera/b.json", "No such file");
    must(remove(tiny_path(&f, "metadata.json")) == 0, "metadata.json");
    refuse(&f, "metadata.json", "No such file");
    tiny_free(&f);
}

/* neu3d */

/* Writes a NumPy header of version 1, then n rows, each one camera as float64. */
static void table(const tiny_folder *f, const char *header, int n, double focal)
{
    const double row[17] = { 0, 1, 0, 0, 12, 1, 0, 0, 0, 16, 0, 0, -1, 0, focal, 1, 9 };
    tiny_record r = { { 0 }, 0 };

    memcpy(r.bytes, "\x93NUMPY\x01\0", r.n = 8);
    tiny_put(&r, strlen(header), 2);
    memcpy(r.bytes + r.n, header, strlen(header));
    r.n += strlen(header);
    for (int i = 0; i < 17 * n; i++)
        tiny_put_real(&r, row[i % 17]);
    tiny_bytes(f, "poses_bounds.npy", r.bytes, r.n);
}

#define NPY(type, order, shape) \
    "{'descr': '" type "', 'fortran_order': " order ", 'shape': " shape ", }\n"
#define TWO NPY("<f8", "False", "(2, 17)")

static void test_neu3d(void **state)
{
    static const struct {
        const char *header;
        int rows;
        double focal;
        const char *what;
    } cases[] = {
        { NPY("<f8", "False", "(2, 15)"), 2, 9, "shape (2, 15), expected rows of 17" },
        { NPY("<f8", "False", "(34,)"), 2, 9, "shape (34,), expected two dimensions" },
        { NPY("<f8", "False", "(2, 17, 1)"), 2, 9, "expected two dimensions" },
        { NPY("<f8", "True", "(2, 17)"), 2, 9, "Fortran order" },
        { NPY(">f8", "False", "(2, 17)"), 2, 9, "numbers of type '>f8', expected '<f4' or '<f8'" },
        { NPY("<i4", "False", "(2, 17)"), 2, 9, "numbers of type '<i4'" },
        { "{'descr': [('x', '<f8')], }\n", 2, 9, "numbers of type [('x', expected '<f4'" },
        { "{}\n", 2, 9, "no type of numbers, expected '<f4'" },
        { NPY("<f4", "False", "(2, 17)"), 2, 9, "272 bytes of numbers" },
        { NPY("<f8", "False", "(0, 17)"), 0, 9, "shape (0, 17)" },
        { NPY("<f8", "False", "(999999999, 17)"), 2, 9, "bytes of numbers" },
        { TWO, 1, 9, "136 bytes of numbers, its shape (2, 17) needs 272" },
        { TWO, 2, NAN, "row 0, column 14 is not finite" },
        { NPY("<f8", "False", "(3, 17)"), 3, 9, "3 rows, but 2 cameras" },
    };
    tiny_folder f = tiny_new();

    (void)state;
    table(&f, TWO, 2, 9);
    refuse(&f, "poses_bounds.npy", "2 rows, but 0 pictures in images/, and no cameras");
    for (int i = 0; i < 4; i++) {
        char name[64];
        snprintf(name, sizeof name, "cam%02d/images/%04d.png", i / 2, i % 2);
        tiny_picture(&f, name, TINY_W, TINY_H, i);
    }
    accept(&f);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        table(&f, cases[i].header, cases[i].rows, cases[i].focal);
        refuse(&f, "poses_bounds.npy", cases[i].what);
    }
    table(&f, TWO, 2, -9);
    refuse(&f, "cam0", "focal lengths -9");
    table(&f, TWO, 2, 9);
    must(remove(tiny_path(&f, "cam01/images/0001.png")) == 0, "0001.png");
    assert_int_equal(warned(&f, "from 1 to 2 frames", "--max-frames 1"), 3);
    must(remove(tiny_path(&f, "cam01/images/0000.png")) == 0, "0000.png");
    refuse(&f, "cam01/images", "no pictures");
    tiny_text(&f, "poses_bounds.npy", "NUMPY");
    refuse(&f, "poses_bounds.npy", "not a NumPy array");
    tiny_bytes(&f, "poses_bounds.npy", "\x93NUMPY\x01\0\xff\xff{}", 12);
    refuse(&f, "poses_bounds.npy", "header cut short");
    tiny_free(&f);
}

/* calibration */

#define SIZE "\"w\": 16, \"h\": 12,"
#define K    "\"K\": [[9,0,8],[0,9,6],[0,0,1]],"
#define W2C  "\"w2c\": " TINY_POSE

static void calibration(const tiny_folder *f, const char *top, const char *camera)
{
    tiny_string s = { "", 0 };

    tiny_add(&s, "{%s \"cameras\": [{\"name\": \"one\"," SIZE K W2C "}, {%s}]}", top, camera);
    tiny_text(f, "cams.json", s.text);
}

static const char good[] = "\"name\": \"two\"," SIZE K W2C;

static const struct {
    const char *top, *camera, *where, *what;
} calibration_cases[] = {
    { "\"frames\": 3,", good, "cams.json: cameras[0]",
      "2 frames, expected 3 by the file's frames" },
    { "\"frames\": 2.5,", good, "cams.json.frames", "2.5" },
    { "\"frames\": 1e9,", good, "cams.json.frames", "1e+09" },
    { "\"fps\": -1,", good, "cams.json.fps", "-1" },
    { "\"fps\": 1e-9,", good, "cams.json.fps", "from 1/16777215" },
    { "\"fps\": 3e7,", good, "cams.json.fps", "to 16777215" },
    { "", SIZE K W2C, "cameras[1]", "no name" },
    { "", "\"name\": \"two\"," K W2C, "cameras[1]", "no w, h" },
    { "", "\"name\": \"one\"," SIZE K W2C, "cams.json: cameras[1].name: ", "one, as cameras[0]" },
    { "", "\"name\": \"two\"," SIZE W2C, "cameras[1]", "no K" },
    { "", "\"name\": \"two\"," SIZE "\"K\": [[9,0,8],[0,9,6]]," W2C, "cameras[1].K",
      "expected 9 numbers" },
    { "", "\"name\": \"two\"," SIZE "\"K\": [[9,0,8],[1,9,6],[0,0,1]]," W2C, "cameras[1].K",
      "expected fx s cx" },
    { "", "\"name\": \"two\"," SIZE K "\"dist\": [1, 2]," W2C, "cameras[1].dist",
      "expected 4 to 5 numbers" },
    { "", "\"name\": \"two\"," SIZE K "\"dist\": [1, 2, 3, 4, 5, 6]," W2C, "cameras[1].dist",
      "expected 4 to 5 numbers" },
    { "", "\"name\": \"two\"," SIZE K "\"w2c\": [[1,0,0,0],[0,1,0,0],[0,0,-1,0]]", "cameras[1].w2c",
      "mirror" },
    { "", "\"name\": \"two\", \"w\": 16, \"h\": 12," K "\"x\": 1", "cameras[1]", "no w2c" },
    { "", "\"name\": \"two\", \"start\": 1," SIZE K W2C, "cameras[1].start", "no fps" },
    { "\"fps\": 30,", "\"name\": \"two\", \"start\": 1, \"frame\": 3," SIZE K W2C, "cameras[1]",
      "both start and frame" },
    { "", "\"name\": \"two\", \"frame\": 1.5," SIZE K W2C, "cameras[1].frame", "1.5" },
    { "", "\"name\": \"two\", \"frame\": 1e9," SIZE K W2C, "cameras[1]", "1e+09 frames" },
    { "", "\"name\": \"two\", \"w\": 16.7, \"h\": 12," K W2C,
      "cams.json: cameras[1]: w, h are 16.7, 12", "expected whole numbers of pixels" },
    { "", "\"name\": \"two\", \"w\": 16, \"h\": 12.5," K W2C,
      "cams.json: cameras[1]: w, h are 16, 12.5", "expected whole numbers of pixels" },
    { "", "\"name\": \"two\", \"w\": 20, \"h\": 12," K W2C, "two/images/0.png",
      "its camera says 20x12" },
};

static void test_calibration(void **state)
{
    tiny_folder f = tiny_new();

    (void)state;
    for (int i = 0; i < 4; i++) {
        char name[64];
        snprintf(name, sizeof name, "%s/images/%d.png", i / 2 ? "two" : "one", i % 2);
        tiny_picture(&f, name, TINY_W, TINY_H, i);
    }
    calibration(&f, "", good);
    accept(&f);
    for (size_t i = 0; i < sizeof calibration_cases / sizeof calibration_cases[0]; i++) {
        calibration(&f, calibration_cases[i].top, calibration_cases[i].camera);
        refuse(&f, calibration_cases[i].where, calibration_cases[i].what);
    }
    calibration(&f, "", good);
    must(remove(tiny_path(&f, "two/images/1.png")) == 0, "1.png");
    assert_int_equal(warned(&f, "from 1 to 2 frames", "--max-frames 1"), 3);
    calibration(&f, "", "\"name\": \"six\"," SIZE K W2C);
    assert_int_equal(
        warned(&f, "1 of 2 entries has no picture: ", "cameras[1]: six: no such video"), 2);
    /* A video that is named is not replaced by other pictures of the camera. */
    calibration(&f, "", "\"name\": \"two\", \"video\": \"x.mkv\"," SIZE K W2C);
    refuse(&f, "cams.json: cameras[1].video: x.mkv: ", "no such video or folder of pictures");
    tiny_text(&f, "cams.json", "{}");
    refuse(&f, "cams.json", "cameras: expected a list");
    tiny_free(&f);
}

/* Videos */

static int files_in(const char *path)
{
    DIR *d = opendir(path);
    int n = -2; /* does not count . and .. */

    assert_non_null(d);
    while (readdir(d) != NULL)
        n++;
    closedir(d);
    return n;
}

/* A damaged video, a missing ffmpeg, and a file in place of the folder for the frames. */
static void test_videos(void **state)
{
    tiny_folder f = tiny_new(), cache = tiny_new();
    char *path = ted4_text_copy(getenv("PATH"));

    (void)state;
    must(path != NULL, "PATH");
    setenv("XDG_CACHE_HOME", cache.path, 1);
    tiny_bytes(&f, "it's \"one\" % $x.mp4",
               "\0\0\0\x18"
               "ftypmp42",
               12);
    tiny_text(
        &f, "cams.json",
        "{\"cameras\": [{\"name\": \"one\", \"video\": \"it's \\\"one\\\" % $x.mp4\"," SIZE K W2C
        "}]}");
    if (system("ffmpeg -version >/dev/null 2>&1") == 0) {
        refuse(&f, "it's \"one\" % $x.mp4: ffmpeg", "failed after 0 frames: ");
        assert_int_equal(files_in(tiny_path(&cache, "ted4")), 0);
    }
    tiny_bytes(&f, "it's \"one\" % $x.mp4", "\0#EXTM3U\nother.mp4\n", 19);
    refuse(&f, "it's \"one\" % $x.mp4: begins like no video that is known here", "MP4, MOV");
    tiny_bytes(&f, "it's \"one\" % $x.mp4",
               "\0\0\0\x18"
               "ftypmp42",
               12);
    setenv("PATH", cache.path, 1);
    refuse(&f, "it's \"one\" % $x.mp4", "ffmpeg is needed");
    assert_int_equal(files_in(tiny_path(&cache, "ted4")), 0);
    setenv("PATH", path, 1);
    rmdir(tiny_path(&cache, "ted4"));
    tiny_text(&cache, "ted4", "in the way");
    refuse(&f, "/ted4", "not a folder of this user");
    free(path);
    tiny_free(&f);
    tiny_free(&cache);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_hypernerf),
        cmocka_unit_test(test_neu3d),
        cmocka_unit_test(test_calibration),
        cmocka_unit_test(test_videos),
    };

    return cmocka_run_group_tests_name("layout errors", tests, NULL, NULL);
}
