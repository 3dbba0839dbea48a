/* test_scene_input.c - scenes as users supply them: JPEGs with an EXIF orientation, JPEGs with four
 * components, nerfstudio's own lists of the split, more frames than requested, pictures that change
 * or disappear while they are in use, damaged pictures, byte order marks.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdio.h>
#include <jpeglib.h>

#include "test.h"
#include "data/image_file.h"
#include "tiny_scene.h"
#include "tool/threads.h"

/* ---- EXIF ---- */

enum { EXIF_SIZE = 6 + 8 + 2 + 2 * 12 + 4 };

static void put(uint8_t *to, uint32_t v, int n, int little)
{
    for (int i = 0; i < n; i++)
        to[little ? i : n - 1 - i] = (uint8_t)(v >> 8 * i);
}

/* The payload of an APP1 segment: a directory of two entries, of which the second is the
 * orientation. */
static void make_exif(uint8_t exif[EXIF_SIZE], uint32_t orientation, int little)
{
    uint8_t *tiff = exif + 6, *entry = tiff + 10;

    memset(exif, 0, EXIF_SIZE);
    memcpy(exif, "Exif", 4);
    memcpy(tiff, little ? "II" : "MM", 2);
    put(tiff + 2, 42, 2, little);
    put(tiff + 4, 8, 4, little);
    put(tiff + 8, 2, 2, little);
    put(entry, 0x010f, 2, little), put(entry + 2, 2, 2, little), put(entry + 4, 1, 4, little);
    entry += 12;
    put(entry, 0x0112, 2, little), put(entry + 2, 3, 2, little), put(entry + 4, 1, 4, little);
    put(entry + 8, orientation, 2, little);
}

static void test_exif(void **state)
{
    uint8_t exif[EXIF_SIZE];

    (void)state;
    for (int little = 0; little < 2; little++) {
        for (uint32_t v = 0; v < 12; v++) {
            make_exif(exif, v, little);
            assert_int_equal(ted4_exif_orientation(exif, sizeof exif), v >= 1 && v <= 8 ? v : 1);
        }
        make_exif(exif, 6, little);
        for (size_t n = 0; n < sizeof exif; n++) { /* cut to n bytes, exactly, for sanitizers */
            uint8_t *cut = malloc(n + 1);
            assert_non_null(cut);
            memmove(cut, exif, n);
            const int v = ted4_exif_orientation(cut, n);
            assert_true(v == 1 || (v == 6 && n >= sizeof exif - 6));
            free(cut);
        }
        put(exif + 10, 0xfffffff0, 4, little); /* a directory beyond the end */
        assert_int_equal(ted4_exif_orientation(exif, sizeof exif), 1);
        make_exif(exif, 6, little);
        put(exif + 14, 0xffff, 2, little); /* more entries than bytes */
        assert_int_equal(ted4_exif_orientation(exif, sizeof exif), 6);
    }
}

/* Writes a JPEG: grey (1 component), RGB (3) or CMYK (4), with an EXIF orientation; 0: without
 * EXIF. */
static void write_jpeg(const tiny_folder *f, const char *name, int w, int h, int components,
                       uint32_t orientation)
{
    struct jpeg_compress_struct c;
    struct jpeg_error_mgr e;
    uint8_t row[4 * 64], exif[EXIF_SIZE];
    JSAMPROW rows[1] = { row };
    FILE *out = fopen(tiny_path(f, name), "wb");

    assert_non_null(out);
    c.err = jpeg_std_error(&e);
    jpeg_create_compress(&c);
    jpeg_stdio_dest(&c, out);
    c.image_width = (JDIMENSION)w;
    c.image_height = (JDIMENSION)h;
    c.input_components = components;
    c.in_color_space = components == 1 ? JCS_GRAYSCALE : components == 3 ? JCS_RGB : JCS_CMYK;
    jpeg_set_defaults(&c);
    jpeg_start_compress(&c, TRUE);
    make_exif(exif, orientation, 1);
    if (orientation > 0)
        jpeg_write_marker(&c, JPEG_APP0 + 1, exif, sizeof exif);
    memset(row, 200, sizeof row);
    for (int y = 0; y < h; y++)
        jpeg_write_scanlines(&c, rows, 1);
    jpeg_finish_compress(&c);
    jpeg_destroy_compress(&c);
    fclose(out);
}

/* Loads a scene of one picture a.jpg whose camera states a size. */
static const char *load_jpeg(const tiny_folder *f, ted4_dataset *d, int w, int h)
{
    tiny_string s = { "", 0 };

    tiny_add(&s,
             "{\"fl_x\": 9, \"w\": %d, \"h\": %d, \"frames\": [{\"file_path\": \"a.jpg\", "
             "\"transform_matrix\": " TINY_POSE "}]}",
             w, h);
    tiny_text(f, "transforms.json", s.text);
    return tiny_load(d, f, &tiny_options);
}

static void test_turned(void **state)
{
    tiny_folder f = tiny_new();
    ted4_dataset d;
    ted4_message m;

    (void)state;
    write_jpeg(&f, "a.jpg", TINY_W, TINY_H, 3, 6);
    assert_string_equal(load_jpeg(&f, &d, TINY_W, TINY_H), ""); /* as stored, like COLMAP */
    assert_int_equal(d.pictures[0].camera.width, TINY_W);
    assert_non_null(ted4_dataset_pixels(&d, 0, &m));
    ted4_dataset_release(&d, 0);
    ted4_dataset_free(&d);
    assert_non_null(strstr(load_jpeg(&f, &d, TINY_H, TINY_W),
                           "a.jpg: the file is 16x12 (EXIF turns it by a quarter"));
    assert_non_null(strstr(load_jpeg(&f, &d, 2 * TINY_H, 2 * TINY_W), "EXIF turns it"));
    assert_null(strstr(load_jpeg(&f, &d, 99, 7), "EXIF"));
    write_jpeg(&f, "a.jpg", TINY_W, TINY_H, 3, 3);
    assert_null(strstr(load_jpeg(&f, &d, TINY_H, TINY_W), "EXIF"));
    write_jpeg(&f, "a.jpg", TINY_W, TINY_H, 1, 0);
    assert_non_null(
        strstr(load_jpeg(&f, &d, TINY_H, TINY_W), "the file is 16x12, its camera says 12x16"));
    tiny_free(&f);
}

static void test_four_colours(void **state)
{
    tiny_folder f = tiny_new();
    ted4_dataset d;
    ted4_image image;
    ted4_message m;

    (void)state;
    write_jpeg(&f, "a.jpg", TINY_W, TINY_H, 4, 0);
    assert_non_null(strstr(load_jpeg(&f, &d, TINY_W, TINY_H),
                           "a.jpg: JPEG of 4 colours (CMYK?), expected grey or RGB"));
    assert_int_equal(ted4_image_read(tiny_path(&f, "a.jpg"), &image, &m), -1);
    assert_null(image.bytes);
    tiny_free(&f);
}

/* ---- split and times ---- */

/* Writes transforms.json of pictures 0.png to 7.png, with additional members. Picture i has the
 * time i / 2. */
enum { N = 8 };

static void write_scene(const tiny_folder *f, const char *more)
{
    tiny_string s = { "", 0 };

    tiny_add(&s, "{\"fl_x\": 9, %s \"frames\": [", more);
    for (int i = 0; i < N; i++) {
        char name[16];
        snprintf(name, sizeof name, "%d.png", i);
        tiny_picture(f, name, TINY_W, TINY_H, 10 * i);
        tiny_add(&s,
                 "%s{\"file_path\": \"./%s\", \"time\": %d, \"transform_matrix\": " TINY_POSE "}",
                 i > 0 ? "," : "", name, i / 2);
    }
    tiny_add(&s, "]}");
    tiny_text(f, "transforms.json", s.text);
}

/* The names of the training pictures, a bar, the names of the test pictures, and the times: "02|1
 * f3". */
static const char *summary(const tiny_folder *f, const ted4_dataset_options *o)
{
    static char text[1200];
    ted4_dataset d;
    size_t n = 0;
    const char *failure = tiny_load(&d, f, o);

    if (*failure != 0)
        return failure;
    for (size_t i = 0; i < d.n_pictures; i++) {
        if (d.pictures[i].is_test && (i == 0 || !d.pictures[i - 1].is_test))
            text[n++] = '|';
        text[n++] = strrchr(d.pictures[i].path, '/')[1];
    }
    snprintf(text + n, sizeof text - n, " f%u", (unsigned)d.n_frames);
    ted4_dataset_free(&d);
    return text;
}

static void test_lists(void **state)
{
    static const struct {
        const char *more, *want;
    } cases[] = {
        { "", "0123567|4 f4" },
        { "\"train_filenames\": [\"./0.png\", \"3.png\", \"2.png\"], \"val_filenames\": "
          "[\"1.png\"], \"test_filenames\": [\"7.png\"],",
          "023|7 f4" },
        { "\"train_filenames\": [\"./0.png\", \"3.png\"], \"val_filenames\": [\"1.png\"],",
          "03|1 f2" },
        { "\"train_filenames\": [\"./0.png\", \"3.png\"], \"test_filenames\": [], "
          "\"val_filenames\": [\"1.png\"],",
          "03|1 f2" },
        { "\"train_filenames\": [\"5.png\"],", "5 f1" },
        { "\"test_filenames\": [\"5.png\"],", "train_filenames: missing" },
        { "\"train_filenames\": \"5.png\",", "train_filenames: not a list" },
        { "\"train_filenames\": [\"5.png\", 3],", "train_filenames[1]: expected a file_path" },
        { "\"train_filenames\": [\"5.png\", \"9.png\"],",
          "train_filenames[1]: no frame has the file_path 9.png" },
        { "\"train_filenames\": [\"5.png\"], \"test_filenames\": [\"5.png\"],",
          "test_filenames[0]: 5.png is listed twice" },
        { "\"train_filenames\": [], \"test_filenames\": [\"5.png\"],",
          "all 1 pictures are held out" },
        { "\"train_filenames\": [],", "no pictures" },
    };
    tiny_folder f = tiny_new();

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        write_scene(&f, cases[i].more);
        const char *got = summary(&f, &tiny_options);
        if (strstr(got, cases[i].want) == NULL)
            fail_msg("got \"%s\", expected \"%s\"", got, cases[i].want);
    }
    tiny_free(&f);
}

static void test_max_frames(void **state)
{
    static const char *const want[] = { "0123567|4 f4", "01 f1",        "0123 f2",
                                        "01235|4 f3",   "0123567|4 f4", "0123567|4 f4" };
    ted4_dataset_options o = tiny_options;
    tiny_folder f = tiny_new();

    (void)state;
    write_scene(&f, "");
    for (o.max_frames = 0; o.max_frames < 6; o.max_frames++)
        assert_string_equal(summary(&f, &o), want[o.max_frames]);
    o.max_frames = 2;
    write_scene(&f, "\"train_filenames\": [\"6.png\", \"7.png\"],");
    assert_string_equal(summary(&f, &o), "67 f1");
    write_scene(
        &f,
        "\"train_filenames\": [\"6.png\", \"3.png\", \"0.png\"], \"test_filenames\": [\"2.png\"],");
    assert_string_equal(summary(&f, &o), "03|2 f2");
    o.max_frames = 1;
    write_scene(&f, "\"train_filenames\": [\"7.png\"], \"test_filenames\": [\"0.png\"],");
    assert_non_null(strstr(summary(&f, &o), "none is left to train on"));
    tiny_free(&f);
}

/* ---- byte order marks ---- */

#define MARK "\xef\xbb\xbf"

/* Puts a mark before a text file. */
static void mark(const tiny_folder *f, const char *name, const char *text)
{
    tiny_string s = { "", 0 };

    tiny_add(&s, MARK "%s", text);
    tiny_text(f, name, s.text);
}

static void test_marked_json(void **state)
{
    static const char transforms[] = "{\"fl_x\": 9, \"frames\": [{\"file_path\": \"0.png\", "
                                     "\"transform_matrix\": " TINY_POSE "}]}";
    static const char *const broken[] = { MARK, "\xef\xbb", "\xef", "{\n" MARK "}" };
    tiny_folder f = tiny_new();

    (void)state;
    tiny_picture(&f, "0.png", TINY_W, TINY_H, 0);
    mark(&f, "transforms.json", transforms);
    assert_string_equal(summary(&f, &tiny_options), "0 f1");
    for (size_t i = 0; i < sizeof broken / sizeof broken[0]; i++) {
        tiny_text(&f, "transforms.json", broken[i]);
        assert_non_null(strstr(summary(&f, &tiny_options), "not valid JSON"));
    }
    must(remove(tiny_path(&f, "transforms.json")) == 0, "transforms.json");
    tiny_picture(&f, "a/images/0.png", TINY_W, TINY_H, 0);
    mark(&f, "cams.json",
         "{\"cameras\": [{\"name\": \"a\", \"w\": 16, \"h\": 12, "
         "\"K\": [[9,0,8],[0,9,6],[0,0,1]], \"w2c\": " TINY_POSE "}]}");
    assert_string_equal(summary(&f, &tiny_options), "0 f1");
    tiny_free(&f);
}

static void test_marked_colmap(void **state)
{
    tiny_folder f = tiny_new();
    ted4_dataset d;

    (void)state;
    tiny_picture(&f, "images/0.png", TINY_W, TINY_H, 0);
    mark(&f, "sparse/0/cameras.txt", "# Cameras\n1 PINHOLE 16 12 9 9 8 6\n");
    mark(&f, "sparse/0/images.txt", "1 1 0 0 0 0 0 0 1 0.png\n\n");
    mark(&f, "sparse/0/points3D.txt", "1 2 3 4 5 6 7\n");
    assert_string_equal(tiny_load(&d, &f, &tiny_options), "");
    assert_int_equal(d.n_pictures, 1);
    assert_int_equal(d.n_points, 1);
    assert_true(d.points[0] == 2 && d.points[2] == 4);
    ted4_dataset_free(&d);
    mark(&f, "sparse/0/cameras.txt", "x\n");
    assert_non_null(strstr(summary(&f, &tiny_options), "cameras.txt:1: expected CAMERA_ID"));
    tiny_free(&f);
}

/* ---- pictures that change ---- */

/* Loads without a cache, so that every access to a picture reads its file. */
static void load_uncached(ted4_dataset *d, const tiny_folder *f)
{
    ted4_dataset_options o = tiny_options;

    o.cache_bytes = 1;
    assert_string_equal(tiny_load(d, f, &o), "");
}

static void expect_pixels(ted4_dataset *d, size_t i, const char *why)
{
    ted4_message m = { "" };
    const uint8_t *p = ted4_dataset_pixels(d, i, &m);

    if (p != NULL)
        ted4_dataset_release(d, i);
    if ((p == NULL) != (*why != 0) || strstr(m.text, why) == NULL)
        fail_msg("picture %zu: \"%s\", expected \"%s\"", i, m.text, why);
}

static void test_changed(void **state)
{
    tiny_folder f = tiny_new();
    ted4_dataset d;
    ted4_message m;

    (void)state;
    write_scene(&f, "");
    load_uncached(&d, &f);
    tiny_picture(&f, "1.png", TINY_W, TINY_H, 99);
    expect_pixels(&d, 1, ""); /* not read before, so the change is not detected */
    assert_int_equal(ted4_dataset_verify(&d, NULL, &m), 0);
    tiny_picture(&f, "2.png", TINY_W, TINY_H, 21);
    expect_pixels(&d, 2, "2.png: the file has changed since it was read first");
    tiny_picture(&f, "2.png", TINY_H, TINY_W, 20);
    expect_pixels(&d, 2, "now 12x16, was 16x12");
    must(remove(tiny_path(&f, "2.png")) == 0, "2.png");
    expect_pixels(&d, 2, "2.png: No such file");
    tiny_picture(&f, "2.png", TINY_W, TINY_H, 20);
    expect_pixels(&d, 2, ""); /* restored */
    ted4_dataset_free(&d);
    tiny_free(&f);
}

/* If several pictures are damaged, the first is named, for any number of threads. */
static void test_verify(void **state)
{
    static const char *const names[] = { "3.png", "5.png", "7.png" };
    tiny_folder f = tiny_new();
    ted4_dataset d;
    ted4_message m;

    (void)state;
    write_scene(
        &f, "\"train_filenames\": "
            "[\"0.png\",\"1.png\",\"2.png\",\"3.png\",\"4.png\",\"5.png\",\"6.png\",\"7.png\"],");
    for (int i = 0; i < 3; i++)
        must(truncate(tiny_path(&f, names[i]), (off_t)tiny_size(&f, names[i]) - 30) == 0, names[i]);
    for (int threads = 1; threads <= 4; threads++) {
        ted4_parallel p;
        ted4_threads_init(&p, threads);
        for (int k = 0; k < 10; k++) {
            load_uncached(&d, &f);
            assert_int_equal(ted4_dataset_verify(&d, &p, &m), -1);
            assert_non_null(strstr(m.text, "3.png: PNG"));
            assert_int_equal(d.content, 0);
            ted4_dataset_free(&d);
        }
        ted4_threads_finish(&p);
    }
    tiny_free(&f);
}

/* Pictures that show nothing at all are told of before they are trained on. */
static void test_nothing_shown(void **state)
{
    static const struct {
        uint8_t train, test; /* all bytes of a training and of a held-out picture */
        const char *warning;
    } cases[] = { { 0, 9, "all training pictures are black" },
                  { 255, 9, "all training pictures are white" },
                  { 9, 0, NULL } };
    uint8_t px[TINY_W * TINY_H * 3];
    tiny_folder f = tiny_new();

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        ted4_dataset d;
        ted4_message m;

        write_scene(&f, "\"train_filenames\": [\"0.png\",\"1.png\"], \"test_filenames\": "
                        "[\"7.png\"],");
        for (int k = 0; k < N; k++) {
            char name[16];

            snprintf(name, sizeof name, "%d.png", k);
            memset(px, k < 2 ? cases[i].train : cases[i].test, sizeof px);
            tiny_png(&f, name, TINY_W, TINY_H, PNG_FORMAT_RGB, px);
        }
        assert_string_equal(tiny_load(&d, &f, &tiny_options), "");
        assert_int_equal(ted4_dataset_verify(&d, NULL, &m), 0);
        assert_int_equal(d.n_warnings, cases[i].warning != NULL);
        if (cases[i].warning != NULL)
            assert_non_null(strstr(d.warnings[0], cases[i].warning));
        ted4_dataset_free(&d);
    }
    tiny_free(&f);
}

static uint64_t digest(const tiny_folder *f, int downscale, int verify)
{
    ted4_dataset_options o = tiny_options;
    ted4_dataset d;
    ted4_message m;

    o.downscale = downscale;
    assert_string_equal(tiny_load(&d, f, &o), "");
    if (verify)
        assert_int_equal(ted4_dataset_verify(&d, NULL, &m), 0);
    const uint64_t x = ted4_dataset_digest(&d);
    ted4_dataset_free(&d);
    return x;
}

static void test_digest(void **state)
{
    tiny_folder a = tiny_new(), b = tiny_new();

    (void)state;
    write_scene(&a, "");
    write_scene(&b, "");
    const uint64_t plain = digest(&a, 1, 0), whole = digest(&a, 1, 1);
    assert_int_not_equal(plain, whole);
    assert_int_equal(digest(&b, 1, 0), plain); /* another folder */
    assert_int_equal(digest(&b, 1, 1), whole);
    assert_int_not_equal(digest(&b, 2, 1), whole);
    tiny_picture(&b, "3.png", TINY_W, TINY_H, 31);
    assert_int_equal(digest(&b, 1, 0), plain); /* pixels are not compared */
    assert_int_not_equal(digest(&b, 1, 1), whole);
    write_scene(&b, "\"fl_y\": 10,");
    assert_int_not_equal(digest(&b, 1, 0), plain);
    write_scene(&b, "\"train_filenames\": "
                    "[\"0.png\",\"1.png\",\"2.png\",\"3.png\",\"4.png\",\"5.png\",\"6.png\"], "
                    "\"test_filenames\": [\"7.png\"],");
    assert_int_not_equal(digest(&b, 1, 0), plain);
    tiny_free(&a);
    tiny_free(&b);
}

/* Pixels depend on all coefficients of the lens, which undistortion removes from the camera. */
static void test_digest_of_lens(void **state)
{
    static const char *const lenses[] = {
        "\"fl_x\": 9,",
        "\"fl_x\": 9, \"k1\": 0.01,",
        "\"fl_x\": 9, \"k2\": 0.01,",
        "\"fl_x\": 9, \"k3\": 0.01,",
        "\"fl_x\": 9, \"p1\": 0.01,",
        "\"fl_x\": 9, \"p2\": 0.01,",
        "\"fl_x\": 9, \"p2\": 0.02,",
        "\"K\": [[9, 1, 8], [0, 9, 6], [0, 0, 1]],",
        "\"K\": [[9, 2, 8], [0, 9, 6], [0, 0, 1]],",
    };
    enum { LENSES = sizeof lenses / sizeof lenses[0] };
    tiny_folder f = tiny_new();
    uint64_t seen[LENSES];

    (void)state;
    tiny_picture(&f, "p.png", TINY_W, TINY_H, 0);
    for (int i = 0; i < LENSES; i++) {
        tiny_string s = { "", 0 };

        tiny_add(&s,
                 "{%s \"frames\": [{\"file_path\": \"p.png\", \"transform_matrix\": " TINY_POSE
                 "}]}",
                 lenses[i]);
        tiny_text(&f, "transforms.json", s.text);
        seen[i] = digest(&f, 1, 1);
        for (int k = 0; k < i; k++)
            if (seen[k] == seen[i])
                fail_msg("lenses \"%s\" and \"%s\"", lenses[k], lenses[i]);
    }
    tiny_free(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_exif),           cmocka_unit_test(test_turned),
        cmocka_unit_test(test_four_colours),   cmocka_unit_test(test_lists),
        cmocka_unit_test(test_max_frames),     cmocka_unit_test(test_changed),
        cmocka_unit_test(test_verify),         cmocka_unit_test(test_digest),
        cmocka_unit_test(test_digest_of_lens), cmocka_unit_test(test_nothing_shown),
        cmocka_unit_test(test_marked_json),    cmocka_unit_test(test_marked_colmap),
    };

    return cmocka_run_group_tests_name("scene input", tests, NULL, NULL);
}
