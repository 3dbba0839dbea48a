/* test_image_file.c - decoding of picture files, the writer of render/png_file.c, lens undistortion
 * against an analytic pattern, and the image cache.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <errno.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <time.h>

#include "test.h"
#include "jpeg_writer.h"
#include "data/image_cache.h"
#include "data/image_file.h"
#include "data/undistort.h"
#include "random_source.h"
#include "render/png_file.h"
#include "tiny_scene.h"

static png_fixed_point stated_gamma; /* of write_png; 0: none */

/* Writes a PNG of any colour type (plus 8: the first palette entry is transparent) and depth; rows
 * are packed as in the file. */
static void write_png(const char *path, int w, int h, int depth, int type, const uint8_t *rows,
                      size_t stride)
{
    const png_color palette[3] = { { 1, 2, 3 }, { 40, 50, 60 }, { 255, 0, 9 } };
    const png_byte transparent[1] = { 0 };
    FILE *f = fopen(path, "wb");
    png_structp p = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(p);

    assert_non_null(f);
    png_init_io(p, f);
    png_set_IHDR(p, info, (png_uint_32)w, (png_uint_32)h, depth, type & 7, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (stated_gamma > 0)
        png_set_gAMA_fixed(p, info, stated_gamma);
    if ((type & 7) == PNG_COLOR_TYPE_PALETTE)
        png_set_PLTE(p, info, palette, 3);
    if ((type & 8) != 0)
        png_set_tRNS(p, info, transparent, 1, NULL);
    png_write_info(p, info);
    for (int y = 0; y < h; y++)
        png_write_row(p, rows + (size_t)y * stride);
    png_write_end(p, info);
    png_destroy_write_struct(&p, &info);
    fclose(f);
}

static void expect_image(const char *path, int w, int h, int channels, const uint8_t *bytes)
{
    ted4_image image;
    ted4_image_header header;
    ted4_message m;

    if (ted4_image_read(path, &image, &m) != 0 || ted4_image_probe(path, &header, &m) != 0)
        fail_msg("%s", m.text);
    assert_int_equal(image.width, w);
    assert_int_equal(image.height, h);
    assert_int_equal(image.channels, channels);
    assert_int_equal(header.width, w);
    assert_int_equal(header.height, h);
    assert_int_equal(header.has_alpha, channels == 4);
    assert_memory_equal(image.bytes, bytes, (size_t)w * (size_t)h * (size_t)channels);
    free(image.bytes);
}

static void test_png(void **state)
{
    (void)state;
    tiny_folder f = tiny_new();
    const char *path = tiny_path(&f, "a.png");
    const uint8_t grey[3] = { 0, 77, 255 }, grey_rgb[9] = { 0, 0, 0, 77, 77, 77, 255, 255, 255 };
    const uint8_t grey16[6] = { 0, 100, 77, 77, 255, 255 }; /* 100 / 257 rounds to 0 */
    const uint8_t rgb16[6] = { 9, 138, 200, 200, 128, 255 },
                  rgb16_8[3] = { 10, 200, 128 }; /* 9.502, 200, 128.49 */
    const uint8_t rgba[8] = { 1, 2, 3, 0, 250, 128, 7, 99 };
    const uint8_t grey_alpha[2] = { 9, 200 }, grey_alpha_rgba[4] = { 9, 9, 9, 200 };
    const uint8_t index[1] = { 0x18 }, indexed[9] = { 1, 2, 3, 40, 50, 60, 255, 0, 9 };
    const uint8_t masked[12] = { 1, 2, 3, 0, 40, 50, 60, 255, 255, 0, 9, 255 };

    write_png(path, 3, 1, 8, PNG_COLOR_TYPE_GRAY, grey, 3);
    expect_image(path, 3, 1, 3, grey_rgb);
    write_png(path, 3, 1, 16, PNG_COLOR_TYPE_GRAY, grey16, 6);
    expect_image(path, 3, 1, 3, grey_rgb);
    write_png(path, 1, 1, 16, PNG_COLOR_TYPE_RGB, rgb16, 6);
    expect_image(path, 1, 1, 3, rgb16_8);
    write_png(path, 1, 2, 8, PNG_COLOR_TYPE_RGB_ALPHA, rgba, 4);
    expect_image(path, 1, 2, 4, rgba);
    write_png(path, 1, 1, 8, PNG_COLOR_TYPE_GRAY_ALPHA, grey_alpha, 2);
    expect_image(path, 1, 1, 4, grey_alpha_rgba);
    write_png(path, 3, 1, 2, PNG_COLOR_TYPE_PALETTE, index, 1);
    expect_image(path, 3, 1, 3, indexed);
    write_png(path, 3, 1, 2, PNG_COLOR_TYPE_PALETTE | 8, index, 1);
    expect_image(path, 3, 1, 4, masked);
    tiny_free(&f);
}

static void test_png_write(void **state)
{
    (void)state;
    tiny_folder f = tiny_new();
    char why[200] = "";
    uint8_t px[5 * 4 * 3];

    for (size_t i = 0; i < sizeof px; i++)
        px[i] = (uint8_t)(i * 37);
    assert_int_equal(ted4_png_write(tiny_path(&f, "out.png"), 5, 4, px, why, sizeof why), 0);
    expect_image(tiny_path(&f, "out.png"), 5, 4, 3, px);
    assert_int_equal(ted4_png_write("/nonexistent/out.png", 5, 4, px, why, sizeof why), -1);
    assert_string_equal(why, strerror(ENOENT));
    /* The target is a folder, so the rename fails, and no temporary file may remain. */
    tiny_text(&f, "folder/x", "");
    assert_int_equal(ted4_png_write(tiny_path(&f, "folder"), 5, 4, px, why, sizeof why), -1);
    remove(tiny_path(&f, "folder/x"));
    remove(tiny_path(&f, "folder"));
    remove(tiny_path(&f, "out.png"));
    assert_int_equal(rmdir(f.path), 0);
}

/* Pixels are those that are stored, whatever gamma the file states: linear light, or what ffmpeg
 * writes for video tagged as BT.709 and as BT.470 BG. */
static void test_png_gamma(void **state)
{
    static const png_fixed_point gamma[] = { 100000, 50994, 35714, 45455, 0 };
    const uint8_t rgb[6] = { 123, 62, 28, 128, 64, 0 };
    const uint8_t rgb16[12] = { 123, 123, 62, 62, 28, 28, 128, 128, 64, 64, 0, 0 };
    tiny_folder f = tiny_new();
    const char *path = tiny_path(&f, "a.png");

    (void)state;
    for (size_t i = 0; i < sizeof gamma / sizeof *gamma; i++) {
        stated_gamma = gamma[i];
        write_png(path, 2, 1, 8, PNG_COLOR_TYPE_RGB, rgb, sizeof rgb);
        expect_image(path, 2, 1, 3, rgb);
        write_png(path, 2, 1, 16, PNG_COLOR_TYPE_RGB, rgb16, sizeof rgb16);
        expect_image(path, 2, 1, 3, rgb);
    }
    tiny_free(&f);
}

/* A chunk before the data that is longer than PNG permits. */
static void test_png_chunk_length(void **state)
{
    static const uint8_t px[3];
    static const uint8_t long_chunk[8] = { 0xff, 0xff, 0xff, 0xf4, 't', 'E', 'X', 't' };
    enum { AFTER_IHDR = 8 + 8 + 13 + 4 };
    tiny_folder f = tiny_new();
    const char *path = tiny_path(&f, "a.png");
    uint8_t bytes[AFTER_IHDR + sizeof long_chunk];
    ted4_image_header header;
    ted4_message m;

    (void)state;
    write_png(path, 1, 1, 8, PNG_COLOR_TYPE_RGB, px, sizeof px);
    FILE *in = fopen(path, "rb");
    assert_non_null(in);
    assert_int_equal(fread(bytes, 1, AFTER_IHDR, in), AFTER_IHDR);
    fclose(in);
    memcpy(bytes + AFTER_IHDR, long_chunk, sizeof long_chunk);
    tiny_bytes(&f, "a.png", bytes, sizeof bytes);
    assert_int_equal(ted4_image_probe(path, &header, &m), -1);
    assert_non_null(strstr(m.text, "2^31 - 1"));
    remove(path);
    assert_int_equal(rmdir(f.path), 0);
}

static void write_jpeg(const char *path, int w, int h, int components)
{
    const jpeg_slopes s = { .w = w,
                            .h = h,
                            .n = components,
                            .column = 4,
                            .component = 60,
                            .space = components == 1 ? JCS_GRAYSCALE : JCS_RGB };

    jpeg_write(path, &s);
}

static void test_jpeg(void **state)
{
    (void)state;
    tiny_folder f = tiny_new();
    const char *path = tiny_path(&f, "a.jpg");
    ted4_image image;
    ted4_message m;
    uint8_t bytes[8192];
    ted4_image_header header;

    for (int components = 1; components <= 3; components += 2) {
        write_jpeg(path, 33, 17, components);
        assert_int_equal(ted4_image_probe(path, &header, &m), 0);
        assert_int_equal(header.width, 33);
        assert_int_equal(header.height, 17);
        assert_int_equal(ted4_image_read(path, &image, &m), 0);
        assert_int_equal(image.channels, 3);
        for (int i = 0; i < 33 * 17 * 3; i++)
            assert_true(abs(image.bytes[i] -
                            (4 * (i / 3 % 33) + (components == 3 ? 60 * (i % 3) : 0))) <= 8);
        free(image.bytes);
    }
    const size_t n = tiny_size(&f, "a.jpg");
    FILE *in = fopen(path, "rb");
    assert_non_null(in);
    assert_true(n < sizeof bytes);
    assert_int_equal(fread(bytes, 1, n, in), n);
    fclose(in);
    for (size_t k = 0; k < n - 2; k += 7) {
        tiny_bytes(&f, "a.jpg", bytes, k);
        assert_int_equal(ted4_image_read(path, &image, &m), -1);
        assert_null(image.bytes);
        assert_non_null(strstr(m.text, "a.jpg: "));
    }
    tiny_free(&f);
}

/* Lens */

/* A smooth pattern over the picture plane of a pinhole camera, in normalised coordinates. */
static double pattern(double u, double v, int c)
{
    return 128 + 60 * sin(9 * u + c) * cos(7 * v - c) + 50 * sin(5 * v + 2 * u * c);
}

/* Finds the pinhole position (u, v) whose distorted position is (a, b), by fixed-point iteration of
 * the lens equations. */
static void invert(const ted4_lens *l, double a, double b, double *u, double *v)
{
    a -= l->skew * b / l->fx;
    *u = a;
    *v = b;
    for (int k = 0; k < 60; k++) {
        const double s = *u * *u + *v * *v,
                     radial = 1 + l->k1 * s + l->k2 * s * s + l->k3 * s * s * s;
        const double tu = 2 * l->p1 * *u * *v + l->p2 * (s + 2 * *u * *u);
        const double tv = l->p1 * (s + 2 * *v * *v) + 2 * l->p2 * *u * *v;
        *u = (a - tu) / radial;
        *v = (b - tv) / radial;
    }
}

/* The lens equations themselves: the position (a, b) in the distorted picture of the pinhole
 * position (u, v). */
static void distort(const ted4_lens *l, double u, double v, double *a, double *b)
{
    const double s = u * u + v * v, radial = 1 + l->k1 * s + l->k2 * s * s + l->k3 * s * s * s;

    *b = v * radial + 2 * l->p2 * u * v + l->p1 * (s + 2 * v * v);
    *a = l->fx * (u * radial + 2 * l->p1 * u * v + l->p2 * (s + 2 * u * u)) + l->skew * *b + l->cx;
    *b = l->fy * *b + l->cy;
}

static void test_undistort(void **state)
{
    (void)state;
    static const ted4_lens lenses[] = {
        { 320, 240, 260, 250, 155, 124, -0.08, 0, 0, 0, 0, 0 },
        { 320, 240, 260, 250, 155, 124, 0.06, -0.02, 0, 0, 0, 0 },
        { 320, 240, 260, 250, 155, 124, -0.09, 0.02, 0.004, -0.006, 0, 0 },
        { 320, 240, 260, 250, 155, 124, -0.09, 0.05, 0.002, -0.001, -0.03, 4 },
    };
    uint8_t *in = malloc(320 * 240 * 3), *out = malloc(320 * 240 * 3);

    assert_non_null(in);
    assert_non_null(out);
    for (size_t k = 0; k < sizeof lenses / sizeof lenses[0]; k++) {
        const ted4_lens *l = &lenses[k];
        for (int i = 0; i < 320 * 240; i++) {
            double u, v;
            invert(l, (i % 320 + 0.5 - l->cx) / l->fx, (i / 320 + 0.5 - l->cy) / l->fy, &u, &v);
            for (int c = 0; c < 3; c++)
                in[3 * i + c] = (uint8_t)(pattern(u, v, c) + 0.5);
        }
        ted4_undistort(l, in, out);
        int seen = 0;
        for (int i = 0; i < 320 * 240; i++) {
            double dx, dy;
            distort(l, (i % 320 + 0.5 - l->cx) / l->fx, (i / 320 + 0.5 - l->cy) / l->fy, &dx, &dy);
            if (dx < 1 || dy < 1 || dx > 319 || dy > 239)
                continue;
            seen++;
            for (int c = 0; c < 3; c++) {
                const double want =
                    pattern((i % 320 + 0.5 - l->cx) / l->fx, (i / 320 + 0.5 - l->cy) / l->fy, c);
                if (!(fabs(out[3 * i + c] - want) <= 1.5))
                    fail_msg("lens %zu pixel %d: %d, expected %.1f", k, i, out[3 * i + c], want);
            }
        }
        assert_true(seen > 320 * 240 * 8 / 10);
    }
    free(in);
    free(out);
}

/* Outside the source the border is repeated. */
static void test_undistort_border(void **state)
{
    (void)state;
    const ted4_lens wide = { 8, 8, 4, 4, 4, 4, 0.9, 0, 0, 0, 0, 0 };
    uint8_t in[8 * 8 * 3], out[8 * 8 * 3];

    for (int i = 0; i < 8 * 8 * 3; i++)
        in[i] = (uint8_t)(i / 3 == 0 ? 200 : i / 3 == 63 ? 90 : 10);
    ted4_undistort(&wide, in, out);
    assert_int_equal(out[0], 200);
    assert_int_equal(out[8 * 8 * 3 - 1], 90);
}

enum { SIDE = 100, MIDDLE = 50 };

/* Undistorts a picture that is black up to column edge and white from the next column on; row: the
 * middle row of the result. */
static void undistort_edge(const ted4_lens *l, int edge, uint8_t row[SIDE])
{
    static uint8_t in[SIDE * SIDE * 3], out[SIDE * SIDE * 3];

    for (int i = 0; i < SIDE * SIDE * 3; i++)
        in[i] = i / 3 % SIDE > edge ? 255 : 0;
    ted4_undistort(l, in, out);
    for (int i = 0; i < SIDE; i++)
        row[i] = out[(MIDDLE * SIDE + i) * 3];
}

/* Where the polynomial would fold back, the position stays at the fold. r (1 - 0.2 r^2) is largest
 * at r = sqrt(5 / 3): 0.86066, 17.213 pixels from the middle; r (1 - 0.1 r^6) at r^6 = 1 / 0.7:
 * 0.90964, 18.193 pixels; r (1 + r^2 - r^4 + r^6) never folds. */
static void test_undistort_fold(void **state)
{
    (void)state;
    static const ted4_lens fold = { SIDE, SIDE, 20, 20, MIDDLE, MIDDLE + 0.5, -0.2, 0, 0, 0, 0, 0 };
    static const ted4_lens sixth = {
        SIDE, SIDE, 20, 20, MIDDLE, MIDDLE + 0.5, 0, 0, 0, 0, -0.1, 0
    };
    static const ted4_lens grows = { SIDE, SIDE, 20, 20, MIDDLE, MIDDLE + 0.5, 1, -1, 0, 0, 1, 0 };
    uint8_t row[SIDE];

    undistort_edge(&fold, 66, row);
    for (int i = 1; i < SIDE; i++)
        assert_true(row[i] >= row[i - 1]);
    assert_int_equal(row[80], (int)(255 * (MIDDLE + 17.2132 - 0.5 - 66) + 0.5));
    assert_int_equal(row[SIDE - 1], row[80]);
    undistort_edge(&sixth, 67, row);
    assert_int_equal(row[SIDE - 1], (int)(255 * (MIDDLE + 18.1928 - 0.5 - 67) + 0.5));
    undistort_edge(&grows, SIDE - 2, row);
    assert_int_equal(row[90], 255);
}

/* Cache */

enum { ITEMS = 12, ITEM_BYTES = 100 };

static uint8_t *make_item(void *user, size_t i, size_t *size, ted4_message *m)
{
    uint8_t *p = malloc(ITEM_BYTES);

    if (i == 11 || p == NULL) {
        snprintf(m->text, sizeof m->text, "item 11 is broken");
        free(p);
        return NULL;
    }
    memset(p, (int)i, ITEM_BYTES);
    ((size_t *)user)[i]++; /* one thread at a time per entry, as promised */
    *size = ITEM_BYTES;
    return p;
}

static void test_cache(void **state)
{
    (void)state;
    size_t made[ITEMS] = { 0 };
    ted4_message m;
    ted4_image_cache *c = ted4_image_cache_new(ITEMS, 3 * ITEM_BYTES, make_item, made);

    assert_non_null(c);
    for (size_t i = 0; i < 3; i++) {
        assert_int_equal(ted4_image_cache_pin(c, i, &m)[7], i);
        ted4_image_cache_unpin(c, i);
    }
    ted4_image_cache_pin(c, 0, &m); /* now 1 is the least recently used unpinned entry */
    ted4_image_cache_unpin(c, 0);
    ted4_image_cache_pin(c, 3, &m);
    ted4_image_cache_unpin(c, 3);
    assert_int_equal(ted4_image_cache_held(c), 3 * ITEM_BYTES);
    for (size_t i = 0; i < 4; i++) {
        if (i == 1)
            continue;
        ted4_image_cache_pin(c, i, &m);
        ted4_image_cache_unpin(c, i);
        assert_int_equal(made[i], 1);
    }
    /* Pinned entries may exceed the bound, and are not evicted. */
    const uint8_t *held[5];
    for (size_t i = 4; i < 9; i++)
        held[i - 4] = ted4_image_cache_pin(c, i, &m);
    assert_int_equal(ted4_image_cache_held(c), 5 * ITEM_BYTES);
    for (size_t i = 4; i < 9; i++)
        assert_int_equal(held[i - 4][ITEM_BYTES - 1], i);
    ted4_image_cache_pin(c, 4, &m);
    for (size_t i = 4; i < 9; i++)
        ted4_image_cache_unpin(c, i);
    assert_int_equal(ted4_image_cache_held(c), 3 * ITEM_BYTES);
    assert_int_equal(held[0][0], 4); /* pinned twice, unpinned once */
    ted4_image_cache_unpin(c, 4);
    assert_null(ted4_image_cache_pin(c, 11, &m));
    assert_string_equal(m.text, "item 11 is broken");
    assert_null(ted4_image_cache_pin(c, ITEMS, &m));
    ted4_image_cache_free(c);
}

/* Waits, at most five seconds, until the cache holds that many bytes. */
static int comes_to_hold(ted4_image_cache *c, size_t bytes)
{
    const struct timespec pause = { 0, 1000000 };

    for (int k = 0; k < 5000 && ted4_image_cache_held(c) != bytes; k++)
        nanosleep(&pause, NULL);
    return ted4_image_cache_held(c) == bytes;
}

/* Announced pictures are decoded before they are requested, and only once. */
static void test_cache_ahead(void **state)
{
    (void)state;
    size_t made[ITEMS] = { 0 };
    ted4_message m;
    ted4_image_cache *c = ted4_image_cache_new(ITEMS, ITEMS * ITEM_BYTES, make_item, made);

    assert_non_null(c);
    for (int round = 0; round < 2; round++)
        for (size_t i = 0; i < 3; i++)
            ted4_image_cache_ahead(c, i, 2);
    assert_true(comes_to_hold(c, 3 * ITEM_BYTES));
    for (size_t i = 0; i < 3; i++) {
        assert_int_equal(ted4_image_cache_pin(c, i, &m)[7], i);
        ted4_image_cache_unpin(c, i);
        assert_int_equal(made[i], 1);
    }
    ted4_image_cache_ahead(c, ITEMS, 2);
    ted4_image_cache_ahead(c, 11, 2);
    assert_null(ted4_image_cache_pin(c, 11, &m));
    assert_string_equal(m.text, "item 11 is broken");
    for (size_t i = 3; i < 10; i++) /* exceeds the queue; freed before all are done */
        ted4_image_cache_ahead(c, i, 1);
    ted4_image_cache_free(c);
}

/* Without threads, or without room, an announced picture is decoded only on request. */
static void test_cache_not_ahead(void **state)
{
    (void)state;
    const struct timespec pause = { 0, 20000000 };
    ted4_message m;

    for (int room = 0; room < 2; room++) {
        size_t made[ITEMS] = { 0 };
        ted4_image_cache *c = ted4_image_cache_new(
            ITEMS, room ? ITEMS * ITEM_BYTES : 3 * ITEM_BYTES, make_item, made);
        assert_non_null(c);
        assert_non_null(ted4_image_cache_pin(c, 0, &m));
        ted4_image_cache_unpin(c, 0);
        ted4_image_cache_ahead(c, 1, room ? 0 : 2);
        nanosleep(&pause, NULL);
        assert_int_equal(ted4_image_cache_held(c), ITEM_BYTES);
        ted4_image_cache_free(c);
        assert_int_equal(made[1], 0);
    }
}

/* At most half the room is used for announced pictures that wait; a picture that was requested or
 * evicted no longer counts. */
static void test_cache_half_ahead(void **state)
{
    (void)state;
    const struct timespec pause = { 0, 20000000 };
    size_t made[ITEMS] = { 0 };
    ted4_message m;
    ted4_image_cache *c = ted4_image_cache_new(ITEMS, 10 * ITEM_BYTES, make_item, made);

    assert_non_null(c);
    assert_non_null(ted4_image_cache_pin(c, 0, &m));
    for (int round = 0; round < 3; round++) {
        for (size_t i = 1; i < 9; i++)
            ted4_image_cache_ahead(c, i, 3);
        assert_true(round > 0 || comes_to_hold(c, 6 * ITEM_BYTES));
        nanosleep(&pause, NULL);
    }
    assert_int_equal(ted4_image_cache_held(c), 6 * ITEM_BYTES);
    assert_non_null(ted4_image_cache_pin(c, 1, &m));
    ted4_image_cache_ahead(c, 8, 3);
    assert_true(comes_to_hold(c, 7 * ITEM_BYTES));
    assert_int_equal(made[1], 1);
    ted4_image_cache_free(c);
}

static void *hammer(void *arg)
{
    ted4_image_cache *c = arg;
    ted4_message m;
    uintptr_t wrong = 0;
    random_source r = random_seed((uintptr_t)&m);

    for (int k = 0; k < 20000; k++) {
        const size_t i = random_in(&r, 0, ITEMS - 1);
        ted4_image_cache_ahead(c, (i + 5) % ITEMS, 3);
        const uint8_t *p = ted4_image_cache_pin(c, i, &m);
        wrong += (p == NULL) != (i == 11);
        if (p != NULL) {
            wrong += p[0] != i || p[ITEM_BYTES - 1] != i;
            ted4_image_cache_unpin(c, i);
        }
    }
    return (void *)wrong;
}

/* Requests from several threads: with room for four pictures nothing is decoded ahead, with room
 * for ten of twelve it is. */
static void hammer_cache(size_t bound)
{
    size_t made[ITEMS] = { 0 };
    pthread_t threads[4];
    ted4_image_cache *c = ted4_image_cache_new(ITEMS, bound, make_item, made);

    assert_non_null(c);
    for (int i = 0; i < 4; i++)
        assert_int_equal(pthread_create(&threads[i], NULL, hammer, c), 0);
    for (int i = 0; i < 4; i++) {
        void *wrong;
        assert_int_equal(pthread_join(threads[i], &wrong), 0);
        assert_null(wrong);
    }
    assert_true(ted4_image_cache_held(c) <= bound);
    ted4_image_cache_free(c);
}

static void test_cache_threads(void **state)
{
    (void)state;
    hammer_cache(4 * ITEM_BYTES);
    hammer_cache(10 * ITEM_BYTES);
}

/* Means of blocks, rounded to the nearest: of 2 x 2 pixels of these values in red, green, blue.
 * What is left at the right and at the bottom is cut off. */
static void test_downscale(void **state)
{
    static const uint8_t want[2][3] = { { 1, 0, 255 }, { 2, 128, 7 } };
    uint8_t in[3][5][3] = { { { 0 } } }, out[2][3];

    (void)state;
    in[0][0][0] = in[1][1][0] = 1; /* 0.5 */
    in[0][1][1] = 1;               /* 0.25 */
    for (int i = 0; i < 4; i++)
        in[i / 2][i % 2][2] = 255;
    in[0][2][0] = in[0][3][0] = in[1][2][0] = 2; /* 1.5 */
    in[0][2][1] = in[1][3][1] = 255;             /* 127.5 */
    for (int i = 0; i < 4; i++)
        in[i / 2][2 + i % 2][2] = (uint8_t)(i == 0 ? 8 : 7); /* 7.25 */
    in[2][0][0] = in[0][4][0] = 200;
    ted4_downscale(in[0][0], 5, 3, 2, out[0]);
    assert_memory_equal(out, want, sizeof want);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_png),
        cmocka_unit_test(test_png_write),
        cmocka_unit_test(test_png_gamma),
        cmocka_unit_test(test_png_chunk_length),
        cmocka_unit_test(test_jpeg),
        cmocka_unit_test(test_undistort),
        cmocka_unit_test(test_undistort_border),
        cmocka_unit_test(test_undistort_fold),
        cmocka_unit_test(test_downscale),
        cmocka_unit_test(test_cache),
        cmocka_unit_test(test_cache_ahead),
        cmocka_unit_test(test_cache_not_ahead),
        cmocka_unit_test(test_cache_threads),
        cmocka_unit_test(test_cache_half_ahead),
    };

    return cmocka_run_group_tests_name("image file", tests, NULL, NULL);
}
