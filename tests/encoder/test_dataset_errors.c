/* test_dataset_errors.c - every error in a scene gives one message that says where and what, and
 * leaves an empty dataset.
 * SPDX-License-Identifier: BSD-2-Clause */
#define _DEFAULT_SOURCE /* setgroups */
#include <grp.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "test.h"
#include "data/point_cloud.h"
#include "refuse.h"
#include "tiny_scene.h"

/* Writes a transforms.json of two frames: top is inserted at the top level, frame is the content of
 * the second frame. */
static void transforms(const tiny_folder *f, const char *top, const char *frame)
{
    tiny_string s = { "", 0 };

    tiny_picture(f, "p.png", TINY_W, TINY_H, 0);
    tiny_add(
        &s,
        "{%s\n\"frames\": [{\"file_path\": \"p.png\", \"fl_x\": 9, \"transform_matrix\": " TINY_POSE
        "},\n{%s}]}",
        top, frame);
    tiny_text(f, "transforms.json", s.text);
}

#define FILE_PATH "\"file_path\": \"p.png\", \"fl_x\": 9"
#define GOOD      FILE_PATH ", \"transform_matrix\": " TINY_POSE

static const struct {
    const char *top, *frame, *where, *what;
} transforms_cases[] = {
    { "", "", "transforms.json: frames[1].file_path", "missing" },
    { "", "\"file_path\": 3", "frames[1].file_path", "expected a string" },
    { "", FILE_PATH, "frames[1].transform_matrix", "expected 4x4 numbers" },
    { "", FILE_PATH ", \"transform_matrix\": [[1,0,0,0],[0,1,0],[0,0,1,0],[0,0,0,1]]",
      "frames[1].transform_matrix", "expected 4x4 numbers" },
    { "", FILE_PATH ", \"transform_matrix\": [[1,0,0,0],[0,1,\"a\",0],[0,0,1,0],[0,0,0,1]]",
      "frames[1].transform_matrix", "expected 4x4 numbers" },
    { "", FILE_PATH ", \"transform_matrix\": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,1,1]]",
      "frames[1].transform_matrix", "expected 0 0 0 1" },
    { "", FILE_PATH ", \"transform_matrix\": [[1,0,0,0],[0,1,0,0],[0,1,0,0],[0,0,0,1]]",
      "frames[1].transform_matrix", "singular" },
    { "", FILE_PATH ", \"transform_matrix\": [[1,0,0,0],[0,1,0.1,0],[0,0,1,0],[0,0,0,1]]",
      "frames[1].transform_matrix", "not orthonormal" },
    { "", FILE_PATH ", \"transform_matrix\": [[1,0,0,0],[0,1,0,0],[0,0,-1,0],[0,0,0,1]]",
      "frames[1].transform_matrix", "mirror" },
    { "", FILE_PATH ", \"transform_matrix\": [[NaN,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]",
      "transforms.json:3", "not valid JSON" },
    { "", GOOD ", \"time\": 0.5", "frames[0].time", "missing" },
    { "", GOOD ", \"time\": \"x\"", "frames[0].time", "missing" },
    { "", GOOD ", \"fl_x\": 8", "transforms.json:3", "duplicate" },
    { "", "\"file_path\": \"p.png\", \"transform_matrix\": " TINY_POSE, "frames[1]", "no fl_x" },
    { "\"camera_angle_x\": 4,", "\"file_path\": \"p.png\"", "frames[1]", "camera_angle_x is 4" },
    { "", GOOD ", \"camera_angle_y\": 0", "frames[1]: camera_angle_y is 0", "between 0 and pi" },
    { "\"camera_model\": \"OPENCV_FISHEYE\",", GOOD, "camera_model", "OPENCV_FISHEYE" },
    { "", GOOD ", \"camera_model\": \"OPENCV_FISHEYE\"", "frames[1].camera_model",
      "OPENCV_FISHEYE" },
    { "\"is_fisheye\": true,", GOOD, "transforms.json.is_fisheye: true", "perspective" },
    { "", GOOD ", \"is_fisheye\": true", "frames[1].is_fisheye: true", "perspective" },
    { "", GOOD ", \"k4\": 0.1", "frames[1].k4", "only k1 k2 k3 p1 p2" },
    { "\"k4\": 0.1,", GOOD, ".k4", "only k1 k2 k3 p1 p2" },
    { "", "\"file_path\": \"p.png\", \"K\": [[9,0,8],[0,9,6]]", "frames[1].K", "expected fx s cx" },
    { "", "\"file_path\": \"p.png\", \"intrinsics\": [9]", "frames[1].intrinsics",
      "expected 4 to 9 numbers" },
    { "",
      "\"file_path\": \"p.png\", \"K\": [[-9,0,8],[0,9,6],[0,0,1]], "
      "\"transform_matrix\": " TINY_POSE,
      "p.png", "focal lengths -9, 9" },
    { "\"w\": 20, \"h\": 12,", GOOD, "p.png", "file is 16x12, its camera says 20x12" },
    { "\"w\": 8, \"h\": 6,", GOOD, "p.png", "file is 16x12, its camera says 8x6" },
    { "\"cx\": \"left\",", GOOD, "transforms.json.cx", "expected a number" },
    { "\"fl_y\": -1,", GOOD, "p.png", "focal lengths 9, -1" },
    { "\"ply_file_path\": \"no.ply\",", GOOD, "no.ply", "No such file" },
    { "\"applied_transform\": [[1,0,0,0],[1,0,0,0],[0,0,1,0]],", GOOD, "applied_transform",
      "singular" },
    { "\"fps\": -3,", GOOD, "fps", "-3" },
    { "\"fps\": 5.9e-8,", GOOD, "transforms.json.fps: 5.9e-08", "from 1/16777215" },
    { "\"fps\": 16777216,", GOOD, "transforms.json.fps", "to 16777215" },
    { "", GOOD ", \"camera\": [1]", "frames[1].camera", "string or an integer" },
    { "oops", GOOD, "transforms.json:1", "not valid JSON" },
};

static void test_transforms(void **state)
{
    (void)state;
    tiny_folder f = tiny_new();

    for (size_t i = 0; i < sizeof transforms_cases / sizeof transforms_cases[0]; i++) {
        transforms(&f, transforms_cases[i].top, transforms_cases[i].frame);
        refuse(&f, transforms_cases[i].where, transforms_cases[i].what);
    }
    tiny_text(&f, "transforms.json", "{\"frames\": []}");
    refuse(&f, "transforms.json: frames", "at least one");
    tiny_text(&f, "transforms.json", "[]");
    refuse(&f, "transforms.json", "expected an object");
    tiny_text(&f, "transforms.json", "");
    refuse(&f, "transforms.json:1", "not valid JSON");
    tiny_text(&f, "transforms_train.json",
              "{\"fl_x\": 9, \"frames\": [{\"file_path\": \"p\", \"transform_matrix\": " TINY_POSE
              "}]}");
    tiny_text(&f, "transforms_test.json",
              "{\"fl_x\": 9, \"frames\": [{\"file_path\": \"p\", \"time\": 0, "
              "\"transform_matrix\": " TINY_POSE "}]}");
    refuse(&f, "transforms_test.json", "have a time");
    tiny_text(&f, "transforms_train.json",
              "{\"fl_x\": 9, \"frames\": [{\"file_path\": \"p\", \"time\": -1e308, "
              "\"transform_matrix\": " TINY_POSE "}, {\"file_path\": \"p\", \"time\": 1e308, "
              "\"transform_matrix\": " TINY_POSE "}]}");
    refuse(&f, "transforms_train.json: frames[0].time: -1e+308", "expected at most 1e+300");
    tiny_free(&f);
}

static void test_folders(void **state)
{
    (void)state;
    tiny_folder f = tiny_new(), none = f;

    refuse(&f, f.path, "no scene recognised");
    none.path[strlen(none.path) - 1] = 0;
    refuse(&none, none.path, "no such folder");
    tiny_text(&f, "sparse/x", "");
    refuse(&f, "sparse", "neither cameras.bin nor cameras.txt");
    tiny_text(&f, "sparse/cameras.txt", "1 PINHOLE 16 12 9 9 8 6\n");
    refuse(&f, "sparse", "neither images.bin nor images.txt");
    tiny_text(&f, "sparse/images.txt", "1 1 0 0 0 0 0 0 1 p.png\n\n");
    refuse(&f, "/images", "no such folder");
    tiny_text(&f, "images/x", "");
    refuse(&f, "only entry has no picture: COLMAP image \"p.png\"", "images/p.png");
    tiny_text(&f, "sparse/images.txt", "# nothing\n");
    refuse(&f, "layout colmap", "no pictures");
    tiny_free(&f);
}

static void test_colmap_text(void **state)
{
    (void)state;
    static const char camera[] = "1 PINHOLE 16 12 9 9 8 6\n",
                      image[] = "1 1 0 0 0 0 0 0 1 p1.png\n\n";
    static const struct {
        const char *cameras, *images, *points, *where, *what;
    } cases[] = {
        { "# c\n7 OPENCV_FISHEYE 16 12 9 9 8 6 0 0 0 0\n", image, "", "cameras.txt:2: camera 7",
          "model OPENCV_FISHEYE" },
        { "7 FOV9 16 12 9\n", image, "", "cameras.txt:1: camera 7", "model FOV9" },
        { "7 PINHOLE 16 12 9 9 8\n", image, "", "cameras.txt:1: camera 7",
          "4 parameters of PINHOLE" },
        { "7 PINHOLE 16 12 9 9 8 6 1\n", image, "", "cameras.txt:1: camera 7",
          "4 parameters of PINHOLE" },
        { "1 PINHOLE 0 12 9 9 8 6\n", image, "", "camera 1", "size 0x12" },
        { "1 PINHOLE 16 12 nan 9 8 6\n", image, "", "p1.png", "focal lengths" },
        { "x\n", image, "", "cameras.txt:1", "expected CAMERA_ID" },
        { camera, "1 1 0 0 0 0 0 0 1\n", "", "images.txt:1", "expected IMAGE_ID" },
        { camera, "1 2 0 0 0 0 0 0 1 p1.png\n", "", "images.txt:1", "length 2, expected 1" },
        { camera, "1 0 0 0 0 0 0 0 1 p1.png\n", "", "images.txt:1", "length 0, expected 1" },
        { camera, "\n1 nan 0 0 0 0 0 0 1 p1.png\n", "", "images.txt:2", "not finite" },
        { camera, "1 1 0 0 0 0 inf 0 1 p1.png\n", "", "images.txt:1", "not finite" },
        { camera, "1 1 0 0 0 0 0 0 5 p1.png\n", "", "p1.png", "camera 5 is not in" },
        { camera, "1 1 0 0 0 0 0 0 1 p1.png\n\n1 1 0 0 0 0 0 0 1 p.png\n\n", "",
          "/images/p.png has no number in its name, ",
          "/images/p1.png has one: their order in time is unknown" },
        { camera, "1 1 0 0 0 0 0 0 1 p1.png\n2 1 0 0 0 0 0 0 1 p1.png\n", "", "images.txt:2: ",
          "expected the observations of the image on the line before: X Y POINT3D_ID for each, or "
          "an empty line" },
        { camera, "# c\r\n\r\n1 1 0 0 0 0 0 0 1 p1.png\r\n1 2 3 4\r\n", "",
          "images.txt:4: ", "expected the observations" },
        { camera, "1 1 0 0 0 0 0 0 1 p1.png\n1 2 x\n", "", "images.txt:2: ", "observations" },
        { camera, "1 1 0 0 0 0 0 0 1 p1.png\n1 2 3 4 5 6-\n", "", "images.txt:2: ", "observ" },
        { camera, image, "1 0 0 nan 1 1 1\n", "points3D.txt:1", "not finite" },
        { camera, image, "1 0 0 0 1 1\n", "points3D.txt:1", "expected POINT_ID" },
        { "1 PINHOLE 20 12 9 9 8 6\n", image, "", "p1.png", "its camera says 20x12" },
    };
    tiny_folder f = tiny_new();

    tiny_picture(&f, "images/p1.png", TINY_W, TINY_H, 0);
    tiny_picture(&f, "images/p.png", TINY_W, TINY_H, 0);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        tiny_text(&f, "sparse/0/cameras.txt", cases[i].cameras);
        tiny_text(&f, "sparse/0/images.txt", cases[i].images);
        tiny_text(&f, "sparse/0/points3D.txt", cases[i].points);
        refuse(&f, cases[i].where, cases[i].what);
    }
    tiny_free(&f);
}

/* Every file of a valid binary model is refused if cut at any length, or if its count is raised. */
static void cut_everywhere(const tiny_folder *f, const char *name, const tiny_record *r)
{
    tiny_record more = *r;

    for (size_t n = 0; n < r->n; n++) {
        tiny_bytes(f, name, r->bytes, n);
        refuse(f, name, "file");
    }
    tiny_bytes(f, name, r->bytes, r->n + 3);
    refuse(f, name, "3 bytes after the last record");
    memset(more.bytes, 0xff, 7);
    tiny_bytes(f, name, more.bytes, more.n);
    refuse(f, name, "announced");
    tiny_bytes(f, name, r->bytes, r->n);
}

static void test_colmap_binary(void **state)
{
    (void)state;
    tiny_record c = { { 0 }, 0 }, s = { { 0 }, 0 }, p = { { 0 }, 0 };
    tiny_folder f = tiny_new();
    ted4_dataset d;

    tiny_put(&c, 1, 8), tiny_put(&c, 1, 4), tiny_put(&c, 2, 4), tiny_put(&c, TINY_W, 8),
        tiny_put(&c, TINY_H, 8);
    for (int i = 0; i < 4; i++)
        tiny_put_real(&c, i < 3 ? 9 : 0.1);
    tiny_put(&s, 1, 8), tiny_put(&s, 1, 4);
    for (int i = 0; i < 7; i++)
        tiny_put_real(&s, i == 0);
    tiny_put(&s, 1, 4), tiny_put(&s, 0x676e702e70, 6), tiny_put(&s, 1, 8);
    tiny_put_real(&s, 0), tiny_put_real(&s, 0), tiny_put(&s, 0, 8);
    tiny_put(&p, 1, 8), tiny_put(&p, 1, 8);
    for (int i = 0; i < 3; i++)
        tiny_put_real(&p, 1);
    tiny_put(&p, 0, 3), tiny_put_real(&p, 0), tiny_put(&p, 1, 8), tiny_put(&p, 0, 8);
    tiny_bytes(&f, "sparse/0/cameras.bin", c.bytes, c.n);
    tiny_bytes(&f, "sparse/0/images.bin", s.bytes, s.n);
    tiny_bytes(&f, "sparse/0/points3D.bin", p.bytes, p.n);
    tiny_picture(&f, "images/p.png", TINY_W, TINY_H, 0);
    assert_string_equal(tiny_load(&d, &f, &tiny_options), "");
    ted4_dataset_free(&d);
    cut_everywhere(&f, "sparse/0/cameras.bin", &c);
    cut_everywhere(&f, "sparse/0/images.bin", &s);
    cut_everywhere(&f, "sparse/0/points3D.bin", &p);
    c.bytes[12] = 5;
    tiny_bytes(&f, "sparse/0/cameras.bin", c.bytes, c.n);
    refuse(&f, "cameras.bin: camera 1", "model OPENCV_FISHEYE");
    c.bytes[12] = 77;
    tiny_bytes(&f, "sparse/0/cameras.bin", c.bytes, c.n);
    refuse(&f, "cameras.bin: camera 1", "model number 77");
    tiny_free(&f);
}

static void test_ply(void **state)
{
    (void)state;
#define XYZ "property float x\nproperty float y\nproperty float z\n"
    static const struct {
        const char *text, *what;
    } cases[] = {
        { "plx\n", "not a PLY" },
        { "ply\nformat ascii 1.0\nelement vertex 1\n" XYZ, "without end_header" },
        { "ply\nformat binary_big_endian 1.0\nend_header\n", ":2: format" },
        { "ply\nformat ascii 1.0\nelement face 1\nend_header\n", "first element" },
        { "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n",
          "without vertex properties" },
        { "ply\nformat ascii 1.0\nelement vertex 1\nproperty list uchar int x\nend_header\n1\n",
          ":4: vertex property" },
        { "ply\nformat ascii 1.0\nelement vertex 2\n" XYZ "end_header\n1 2 3\n1 2 \n",
          "vertex 1 of 2" },
        { "ply\nformat ascii 1.0\nelement vertex 1\n" XYZ "end_header\n1 2 nan\n",
          "vertex 0: a coordinate" },
        { "ply\nformat ascii 1.0\nelement vertex 4000000000000\n" XYZ "end_header\n1 2 3\n",
          "announced" },
        { "ply\nformat binary_little_endian 1.0\nelement vertex 2\n" XYZ "end_header\n123456789012",
          "announced" },
        { "ply\nformat ascii 1.0\nelement vertex 1\n" XYZ "end_header", "announced" },
    };
    tiny_folder f = tiny_new();
    ted4_point_cloud c = { NULL, NULL, 0 };
    ted4_message m;

    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        tiny_text(&f, "a.ply", cases[i].text);
        assert_int_equal(ted4_ply_read(&c, tiny_path(&f, "a.ply"), &m), -1);
        assert_null(c.xyz);
        if (strstr(m.text, "a.ply") == NULL || strstr(m.text, cases[i].what) == NULL)
            fail_msg("got \"%s\", expected \"%s\"", m.text, cases[i].what);
    }
    tiny_free(&f);
}

/* A truncated picture loads, since its header is complete; decoding detects the error. */
static void test_damaged_pictures(void **state)
{
    (void)state;
    tiny_folder f = tiny_new();
    ted4_dataset d;
    ted4_message m;
    uint8_t bytes[4096];

    transforms(&f, "", GOOD);
    const size_t n = tiny_size(&f, "p.png");
    FILE *in = fopen(tiny_path(&f, "p.png"), "rb");
    assert_non_null(in);
    assert_true(n < sizeof bytes);
    assert_int_equal(fread(bytes, 1, n, in), n);
    fclose(in);
    assert_string_equal(tiny_load(&d, &f, &tiny_options), "");
    assert_int_equal(ted4_dataset_verify(&d, NULL, &m), 0);
    ted4_dataset_free(&d);
    tiny_bytes(&f, "p.png", bytes, n - 30);
    assert_string_equal(tiny_load(&d, &f, &tiny_options), "");
    assert_int_equal(ted4_dataset_verify(&d, NULL, &m), -1);
    assert_non_null(strstr(m.text, "p.png: PNG"));
    assert_null(ted4_dataset_pixels(&d, 0, &m));
    assert_null(ted4_dataset_pixels(&d, 2, &m));
    tiny_picture(&f, "p.png", TINY_W, TINY_H + 1, 0);
    assert_null(ted4_dataset_pixels(&d, 0, &m));
    assert_non_null(strstr(m.text, "now 16x13, was 16x12"));
    ted4_dataset_free(&d);
    tiny_bytes(&f, "p.png", bytes, 20);
    refuse(&f, "frames[0]", "IHDR");
    tiny_text(&f, "p.png", "GIF89a.......");
    refuse(&f, "frames[0]", "neither PNG nor JPEG");
    tiny_free(&f);
}

static void test_options(void **state)
{
    (void)state;
    tiny_folder f = tiny_new();
    ted4_dataset d;
    ted4_dataset_options o = tiny_options;

    transforms(&f, "", GOOD);
    o.downscale = 13;
    assert_non_null(strstr(tiny_load(&d, &f, &o), "cannot be reduced by 13"));
    o.downscale = 0;
    assert_non_null(strstr(tiny_load(&d, &f, &o), "cannot be reduced by 0"));
    tiny_free(&f);
}

/* Makes the superuser another user, of no group that files here may belong to. */
static int become_other(void)
{
    return geteuid() != 0 || (setgroups(0, NULL) == 0 && setgid(65534) == 0 && setuid(65534) == 0);
}

/* Can a process that is no superuser read below f, which lies in folders of somebody's? */
static int others_can_read(const tiny_folder *f)
{
    char path[400];
    int status;
    const pid_t child = fork();

    assert_true(child >= 0);
    if (child == 0) {
        snprintf(path, sizeof path, "%s/images/p.png", f->path);
        _exit(!become_other() || access(path, R_OK) != 0);
    }
    assert_int_equal(waitpid(child, &status, 0), child);
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

/* Asserts in a child process, which is no superuser, that loading fails as a path below f may not
 * be read. Returns 0 if there can be no such process. */
static int refused_to_others(const tiny_folder *f, const char *where)
{
    char path[400];
    int status;
    const pid_t child = fork();

    assert_true(child >= 0);
    if (child == 0) {
        ted4_dataset d;
        if (!become_other())
            _exit(2);
        const char *text = tiny_load(&d, f, &tiny_options);
        snprintf(path, sizeof path, "%s%s", f->path, where);
        const int right = strstr(text, path) != NULL && strstr(text, ": Permission denied") != NULL;
        if (!right)
            fprintf(stderr, "got \"%s\", expected \"%s: Permission denied\"\n", text, path);
        _exit(right ? 0 : 1);
    }
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status) && WEXITSTATUS(status) != 1);
    return WEXITSTATUS(status) == 0;
}

static void test_permissions(void **state)
{
    static const char *const places[] = { "sparse", "images", "", "cam00/images" };
    const mode_t usual = umask(022);
    tiny_folder f = tiny_new();
    int possible;

    (void)state;
    tiny_text(&f, "sparse/0/cameras.txt", "1 PINHOLE 16 12 9 9 8 6\n");
    tiny_text(&f, "sparse/0/images.txt", "1 1 0 0 0 0 0 0 1 p.png\n\n");
    tiny_picture(&f, "images/p.png", TINY_W, TINY_H, 0);
    tiny_picture(&f, "cam00/images/0.png", TINY_W, TINY_H, 0);
    must(chmod(f.path, 0755) == 0, f.path);
    possible = others_can_read(&f);
    for (size_t i = 0; i < sizeof places / sizeof places[0] && possible; i++) {
        const char *place = i == 2 ? f.path : tiny_path(&f, places[i]);
        char where[64] = "";
        if (i == 3)
            tiny_text(&f, "cams.json",
                      "{\"cameras\": [{\"name\": \"cam00\", \"w\": 16, \"h\": 12, \"K\": "
                      "[[9,0,8],[0,9,6],[0,0,1]], \"w2c\": " TINY_POSE "}]}");
        if (*places[i] != 0)
            snprintf(where, sizeof where, "/%s", places[i]);
        must(chmod(place, 0) == 0, place);
        possible = refused_to_others(&f, where);
        must(chmod(place, 0755) == 0, place);
    }
    tiny_free(&f);
    umask(usual);
    if (!possible) {
        puts("skipped: there is no other user here, or none that may look into TMPDIR");
        skip();
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_transforms),  cmocka_unit_test(test_folders),
        cmocka_unit_test(test_colmap_text), cmocka_unit_test(test_colmap_binary),
        cmocka_unit_test(test_ply),         cmocka_unit_test(test_damaged_pictures),
        cmocka_unit_test(test_options),     cmocka_unit_test(test_permissions),
    };

    return cmocka_run_group_tests_name("dataset errors", tests, NULL, NULL);
}
