/* test_ways.c - ted4scene imitates what other writers do: kinds of picture files, backgrounds and
 * alpha, masks, alternating cameras, missing pictures, coordinates, points. Links
 * tools/scene/ray_*.o.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "test.h"
#include "tools/scene/ray_palette.h"
#include "tools/scene/ray_picture.h"
#include "tools/scene/ray_shot.h"
#include "temporary.h"

enum { W = 48, H = 32, AREA = W * H };

static ted4_ray_options toys(void)
{
    ted4_ray_options o = ted4_ray_defaults(RAY_TOYS);

    o.width = W;
    o.height = H;
    o.n_train = 3;
    o.n_test = 1;
    o.n_frames = 4;
    return o;
}

/* ---- picture files ---- */

/* Writes picture (1, 2) of o. head: receives the first bytes of the file. */
static void written(const ted4_ray_options *o, const char *path, uint8_t *rgba, uint8_t head[32])
{
    ted4_ray_message m;

    ted4_ray_shot(o, 1, 2, rgba);
    assert_int_equal(ted4_ray_write_picture(o, path, W, H, rgba, &m), 0);
    FILE *const f = fopen(path, "rb");
    assert_non_null(f);
    assert_int_equal(fread(head, 1, 32, f), 32);
    fclose(f);
}

/* Reads the values as they are in the file, the upper byte of 16 bits, converted to four
 * channels. */
static void read_png(const char *path, uint8_t *rgba)
{
    FILE *const f = fopen(path, "rb");
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    png_bytep rows[H];

    assert_non_null(f);
    png_init_io(png, f);
    png_read_info(png, info);
    png_set_expand(png);
    png_set_strip_16(png);
    png_set_gray_to_rgb(png);
    png_set_add_alpha(png, 255, PNG_FILLER_AFTER);
    png_set_interlace_handling(png);
    png_read_update_info(png, info);
    assert_int_equal(png_get_rowbytes(png, info), 4 * W);
    for (int y = 0; y < H; y++)
        rows[y] = rgba + 4 * W * y;
    png_read_image(png, rows);
    png_destroy_read_struct(&png, &info, NULL);
    fclose(f);
}

static double mean_error(const uint8_t *a, const uint8_t *b)
{
    double sum = 0;

    for (int i = 0; i < 4 * AREA; i++)
        sum += abs(a[i] - b[i]);
    return sum / (4 * AREA);
}

/* Bit depth, colour type and interlacing of each kind, with and without alpha; the same pixels are
 * read back, except from a palette of few colours and from grey. */
static void test_kinds(void **state)
{
    static const struct {
        int kind, background;
        uint8_t depth, type, interlace;
        double error;
    } cases[] = {
        { RAY_PNG, RAY_CLEAR, 8, 6, 0, 0 },        { RAY_PNG, RAY_BLACK, 8, 2, 0, 0 },
        { RAY_PNG16, RAY_CLEAR, 16, 6, 0, 0 },     { RAY_PNG16, RAY_WHITE, 16, 2, 0, 0 },
        { RAY_PALETTE, RAY_CLEAR, 8, 3, 0, 1 },    { RAY_PALETTE, RAY_ROOM, 8, 3, 0, 4 },
        { RAY_INTERLACED, RAY_CLEAR, 8, 6, 1, 0 }, { RAY_INTERLACED, RAY_BLACK, 8, 2, 1, 0 },
        { RAY_GREY, RAY_CLEAR, 8, 4, 0, 9 },       { RAY_GREY, RAY_WHITE, 8, 0, 0, 9 },
    };
    static uint8_t rgba[4 * AREA], back[4 * AREA];
    char path[TEMPORARY_SIZE];
    uint8_t head[32];

    (void)state;
    close(temporary_file(path, "ways"));
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        ted4_ray_options o = toys();

        o.ways.background = cases[i].background;
        o.ways.file = cases[i].kind;
        written(&o, path, rgba, head);
        assert_int_equal(head[24], cases[i].depth);
        assert_int_equal(head[25], cases[i].type);
        assert_int_equal(head[28], cases[i].interlace);
        read_png(path, back);
        if (cases[i].error == 0)
            assert_memory_equal(rgba, back, sizeof rgba);
        assert_true(mean_error(rgba, back) <= cases[i].error);
    }
    remove(path);
}

/* Reads the type of a JPEG's frame header: baseline or progressive. */
static int jpeg_frame(const char *path)
{
    FILE *const f = fopen(path, "rb");
    int before = 0, c, found = 0;

    assert_non_null(f);
    while ((c = getc(f)) != EOF && !found) {
        if (before == 0xff && (c == 0xc0 || c == 0xc2))
            found = c;
        before = c;
    }
    fclose(f);
    return found;
}

static void test_jpeg(void **state)
{
    static uint8_t rgba[4 * AREA];
    ted4_ray_options o = toys();
    char path[TEMPORARY_SIZE];
    uint8_t head[32];

    (void)state;
    close(temporary_file(path, "ways"));
    o.ways.background = RAY_BLACK;
    o.ways.file = RAY_JPEG;
    assert_string_equal(ted4_ray_ending(&o), ".jpg");
    written(&o, path, rgba, head);
    assert_int_equal(jpeg_frame(path), 0xc0);
    o.ways.file = RAY_PROGRESSIVE;
    written(&o, path, rgba, head);
    assert_int_equal(jpeg_frame(path), 0xc2);
    remove(path);
}

/* ---- pixels ---- */

/* The opaque, white and black pictures equal the transparent picture over these backgrounds;
 * premultiplied colours equal those over black. */
static void test_backgrounds(void **state)
{
    static uint8_t straight[4 * AREA], multiplied[4 * AREA], black[4 * AREA], white[4 * AREA];
    ted4_ray_options o = toys();
    int edges = 0;

    (void)state;
    ted4_ray_shot(&o, 0, 1, straight);
    o.ways.premultiplied = 1;
    ted4_ray_shot(&o, 0, 1, multiplied);
    o.ways.premultiplied = 0;
    o.ways.background = RAY_BLACK;
    ted4_ray_shot(&o, 0, 1, black);
    o.ways.background = RAY_WHITE;
    ted4_ray_shot(&o, 0, 1, white);
    for (int i = 0; i < 4 * AREA; i++) {
        const int alpha = straight[i | 3];

        edges += alpha > 0 && alpha < 255 && multiplied[i] != straight[i];
        if (i % 4 == 3) {
            assert_int_equal(multiplied[i], alpha);
            assert_int_equal(black[i] & white[i], 255);
            continue;
        }
        assert_int_equal(multiplied[i], black[i]);
        assert_true(abs(255 * multiplied[i] - straight[i] * alpha) <= 128);
        assert_int_equal(white[i], black[i] + 255 - alpha);
    }
    assert_true(edges > 20);
    assert_int_equal(straight[3], 0);
}

/* The mask is set where a picture differs from that of a scene that does not move; a still scene
 * has no mask. */
static void test_masks(void **state)
{
    static uint8_t a[AREA], b[AREA];
    ted4_ray_options o = toys();
    int n = 0, both = 0, m = 0;

    (void)state;
    assert_int_equal(ted4_ray_mask(&o, 0, 0, a), 0);
    assert_int_equal(ted4_ray_mask(&o, 0, 2, b), 0);
    for (int i = 0; i < AREA; i++) {
        assert_true(a[i] == 0 || a[i] == 255);
        n += a[i] > 0;
        m += b[i] > 0;
        both += a[i] & b[i] & 1;
    }
    assert_true(n > 10);
    assert_true(m > 10);
    assert_true(n < AREA / 8);
    assert_true(m < AREA / 8);
    assert_true(both < n / 2);
    o.scene = RAY_THINGS0;
    assert_int_equal(ted4_ray_mask(&o, 0, 2, b), 0);
    for (int i = 0; i < AREA; i++)
        assert_int_equal(b[i], 0);
}

/* There are no more colours than the palette can hold, and each pixel gets the nearest one of its
 * box: the result is exact if the picture has few colours. */
static void test_palette(void **state)
{
    static uint8_t rgba[4 * AREA], palette[TED4_RAY_PALETTE][4], index[AREA];

    (void)state;
    for (int i = 0; i < 4 * AREA; i++)
        rgba[i] = (uint8_t)(i % 4 == 3 ? 255 : 40 * (i / 4 % (i % 4 + 3)));
    assert_int_equal(ted4_ray_palette(rgba, AREA, palette, index), 3 * 4 * 5);
    for (int i = 0; i < AREA; i++)
        assert_memory_equal(palette[index[i]], rgba + 4 * i, 4);
    for (int i = 0; i < 4 * AREA; i++)
        rgba[i] = (uint8_t)(i * 2654435761u >> 24);
    assert_int_equal(ted4_ray_palette(rgba, AREA, palette, index), TED4_RAY_PALETTE);
}

/* ---- what there is ---- */

/* Of alternating cameras, each has one time and each time has one camera; the order of the times is
 * not that of the cameras. */
static void test_turns(void **state)
{
    ted4_ray_options o = toys();
    int used[30] = { 0 }, jumps = 0, last = -9;

    (void)state;
    o.n_train = 24;
    o.n_test = 6;
    o.n_frames = 30;
    o.ways.turns = 1;
    for (int frame = 0; frame < 30; frame++) {
        int n = 0, who = 0;

        for (int number = 0; number < 30; number++)
            if (ted4_ray_is_taken(&o, number, frame)) {
                who = number;
                n++;
            }
        assert_int_equal(n, 1);
        used[who]++;
        jumps += abs(who - last) > 1;
        last = who;
    }
    for (int i = 0; i < 30; i++)
        assert_int_equal(used[i], 1);
    assert_true(jumps > 22);
}

static void test_missing(void **state)
{
    ted4_ray_options o = toys();
    int n = 0, of_camera[3] = { 0 };

    (void)state;
    o.n_frames = 16;
    o.hold = 8;
    o.ways.missing = 11;
    for (int number = 0; number < 4; number++)
        for (int frame = 0; frame < 16; frame++)
            if (ted4_ray_is_missing(&o, number, frame)) {
                assert_true(number < 3);
                assert_true(ted4_ray_is_taken(&o, number, frame));
                of_camera[number]++;
                n++;
            }
    assert_int_equal(n, 11);
    assert_true(of_camera[0] > 0);
    assert_true(of_camera[1] > 0);
    assert_true(of_camera[2] > 0);
}

/* Test times are not among the training times; without a test file there are no test pictures. */
static void test_splits(void **state)
{
    ted4_ray_options o = toys();

    (void)state;
    o.n_frames = 16;
    o.hold = 4;
    o.ways.split = RAY_OTHER_TIMES;
    for (int frame = 0; frame < 16; frame++)
        assert_int_equal(ted4_ray_is_taken(&o, 0, frame), !ted4_ray_is_taken(&o, 3, frame));
    assert_true(ted4_ray_is_taken(&o, 3, 2));
    o.ways.split = RAY_TRAIN_ONLY;
    assert_false(ted4_ray_is_taken(&o, 3, 2));
    assert_non_null(
        ted4_ray_fault(&(ted4_ray_options) { .scene = RAY_STILL, .ways = { .premultiplied = 1 } }));
    assert_non_null(ted4_ray_fault(&(ted4_ray_options) {
        .scene = RAY_STILL, .layout = RAY_NEU3D, .ways = { .off = { 0.1, 0 } } }));
    assert_null(ted4_ray_fault(&o));
}

/* ---- coordinates ---- */

/* A point of the files projects to the same pixel of the same camera in all coordinate systems,
 * sizes and principal points. */
static void test_coordinates(void **state)
{
    const ted4_ray_options usual = toys();
    ted4_ray_options o = toys();

    (void)state;
    o.ways.unit = 100;
    o.ways.up_y = 1;
    o.ways.sizes = 1;
    o.ways.off[0] = 0.1;
    for (int i = 0; i < 60; i++) {
        const ted4_ray_point p = ted4_ray_point_at(&usual, i);
        const double at[3] = { (double)p.point.x, (double)p.point.y, (double)p.point.z };
        double there[3], pixel[2], other[2];
        ted4_ray_camera a, b;

        ted4_ray_camera_stated(&usual, i % 3, &a);
        ted4_ray_camera_stated(&o, i % 3, &b);
        ted4_ray_mapped(&o, at, there);
        assert_true(fabs(there[1] - 100 * at[2]) < 1e-9);
        assert_true(fabs(there[2] + 100 * at[1]) < 1e-9);
        const double depth = ted4_ray_project(&a, at, pixel),
                     far = ted4_ray_project(&b, there, other);
        assert_true(fabs(far / depth - 100) < 1e-6);
        assert_int_equal(b.width, W * (i % 3 == 1 ? 3 : i % 3 == 2 ? 5 : 4) / 4);
        assert_true(fabs((pixel[0] / W - 0.5) - (other[0] / b.width - 0.6)) < 1e-9);
        assert_true(fabs((pixel[1] / H - 0.5) - (other[1] / b.height - 0.5)) < 1e-9);
    }
}

/* Nearly all of the points in the large box lie outside the small one. */
static void test_points(void **state)
{
    ted4_ray_options o = toys();
    int inside = 0;

    (void)state;
    o.ways.points = RAY_BOX10;
    assert_int_equal(ted4_ray_n_points(&o), 100000);
    for (int i = 0; i < 100000; i++) {
        const vec3 p = v3_sub(ted4_ray_point_at(&o, i).point, v3(0, .15f, .6f));
        const float far = ray_max(fabsf(p.x), ray_max(fabsf(p.y), fabsf(p.z)));

        assert_true(far < 9.001f);
        inside += far < .9f;
    }
    assert_true(inside > 60);
    assert_true(inside < 140);
    o.ways.points = RAY_ANYWHERE;
    for (int i = 0; i < ted4_ray_n_points(&o); i++)
        assert_true(fabsf(ted4_ray_point_at(&o, i).point.x) < .901f);
    o.ways.points = RAY_NO_POINTS;
    assert_int_equal(ted4_ray_n_points(&o), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_kinds),       cmocka_unit_test(test_jpeg),
        cmocka_unit_test(test_backgrounds), cmocka_unit_test(test_masks),
        cmocka_unit_test(test_palette),     cmocka_unit_test(test_turns),
        cmocka_unit_test(test_missing),     cmocka_unit_test(test_splits),
        cmocka_unit_test(test_coordinates), cmocka_unit_test(test_points),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
