/* test_pictures.c - pictures of every kind that PNG and JPEG allow are decoded to the correct
 * bytes, or are refused; alpha is straight, as PNG specifies, or premultiplied, as some programs
 * write it.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdio.h>

#include "test.h"
#include "jpeg_writer.h"
#include "data/image_file.h"
#include "refuse.h"
#include "tiny_scene.h"

enum { W = 11, H = 9 };

/* Sample c of pixel (x, y) with 8 bits. */
static int level(int x, int y, int c)
{
    return c == 3 ? (x * 23 + y) % 256 : (x * 20 + y * 7 + c * 40) % 256;
}

/* kind: PNG_COLOR_TYPE_*. Samples of 16 bits are 257 times those of 8 bits, less 100 where that
 * rounds to the same value. */
static void write_png(const char *path, int kind, int depth, int interlace,
                      const png_color_16 *clear)
{
    const int n = kind == PNG_COLOR_TYPE_GRAY         ? 1
                  : kind == PNG_COLOR_TYPE_GRAY_ALPHA ? 2
                  : kind == PNG_COLOR_TYPE_RGB        ? 3
                                                      : 4;
    static uint8_t px[H][W * 8];
    png_bytep rows[H];
    FILE *f = fopen(path, "wb");
    png_structp p = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(p);

    assert_non_null(f);
    for (int i = 0; i < W * H * n; i++) {
        const int x = i / n % W, y = i / n / W, c = n < 3 && i % n == 1 ? 3 : i % n,
                  v = level(x, y, c);
        const int wide = v > 0 ? 257 * v - 100 : 0;
        uint8_t *at = px[y] + (x * n + i % n) * depth / 8;
        at[0] = (uint8_t)(depth == 16 ? wide >> 8 : v);
        if (depth == 16)
            at[1] = (uint8_t)wide;
    }
    for (int y = 0; y < H; y++)
        rows[y] = px[y];
    png_init_io(p, f);
    png_set_IHDR(p, info, W, H, depth, kind, interlace ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (clear != NULL)
        png_set_tRNS(p, info, NULL, 0, clear);
    png_write_info(p, info);
    png_write_image(p, rows);
    png_write_end(p, info);
    png_destroy_write_struct(&p, &info);
    fclose(f);
}

static ted4_image decode(const char *path)
{
    ted4_image image;
    ted4_image_header header;
    ted4_message m;

    if (ted4_image_probe(path, &header, &m) != 0 || ted4_image_read(path, &image, &m) != 0)
        fail_msg("%s", m.text);
    assert_int_equal(image.width, header.width);
    assert_int_equal(image.height, header.height);
    assert_int_equal(image.channels == 4, header.has_alpha);
    return image;
}

static void test_png(void **state)
{
    static const int kinds[] = { PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB,
                                 PNG_COLOR_TYPE_RGB_ALPHA };
    tiny_folder f = tiny_new();
    const char *path = tiny_path(&f, "a.png");

    (void)state;
    for (int k = 0; k < 16; k++) {
        const int kind = kinds[k % 4], depth = k & 4 ? 16 : 8;
        write_png(path, kind, depth, k & 8, NULL);
        ted4_image image = decode(path);
        assert_int_equal(image.width, W);
        assert_int_equal(image.height, H);
        assert_int_equal(image.channels, kind & PNG_COLOR_MASK_ALPHA ? 4 : 3);
        for (int i = 0; i < W * H * image.channels; i++) {
            const int c = i % image.channels, at = i / image.channels;
            const int want = level(at % W, at / W,
                                   c == 3                        ? 3
                                   : kind & PNG_COLOR_MASK_COLOR ? c
                                                                 : 0);
            if (image.bytes[i] != want)
                fail_msg("kind %d, %d bits, interlaced %d: byte %d is %d, expected %d", kind, depth,
                         k & 8, i, image.bytes[i], want);
        }
        free(image.bytes);
    }
    /* The last picture, interlaced and with 16 bits, is an error if cut at any length; reading only
     * its header is not. */
    const size_t n = tiny_size(&f, "a.png");
    for (size_t k = n - 1; k > 8; k -= 5) {
        ted4_image image;
        ted4_message m;
        must(truncate(path, (off_t)k) == 0, path);
        assert_int_equal(ted4_image_read(path, &image, &m), -1);
        assert_null(image.bytes);
        assert_non_null(strstr(m.text, "a.png: PNG: "));
    }
    tiny_free(&f);
}

/* A colour of a PNG without alpha that is declared transparent. */
static void test_clear_colour(void **state)
{
    tiny_folder f = tiny_new();
    const char *path = tiny_path(&f, "a.png");
    const png_color_16 grey = { .gray = 20 }, rgb = { .red = 20, .green = 60, .blue = 100 };

    (void)state;
    for (int k = 0; k < 2; k++) {
        write_png(path, k == 0 ? PNG_COLOR_TYPE_GRAY : PNG_COLOR_TYPE_RGB, 8, 0,
                  k == 0 ? &grey : &rgb);
        ted4_image image = decode(path);
        assert_int_equal(image.channels, 4);
        for (int i = 0; i < W * H; i++)
            assert_int_equal(image.bytes[4 * i + 3], level(i % W, i / W, 0) == 20 ? 0 : 255);
        free(image.bytes);
    }
    tiny_free(&f);
}

static void write_jpeg(const char *path, J_COLOR_SPACE space, int n, int progressive, int exact)
{
    const jpeg_slopes s = { .w = 48,
                            .h = 32,
                            .n = n,
                            .space = space,
                            .progressive = progressive,
                            .exact = exact,
                            .column = 2,
                            .row = 2,
                            .component = 20 };

    jpeg_write(path, &s);
}

static void test_jpeg(void **state)
{
    tiny_folder f = tiny_new();
    const char *path = tiny_path(&f, "a.jpg");
    ted4_image image;
    ted4_image_header header;
    ted4_message m;

    (void)state;
    for (int k = 0; k < 6; k++) {
        const int n = k % 3 == 0 ? 1 : 3;
        write_jpeg(path, n == 1 ? JCS_GRAYSCALE : JCS_RGB, n, k >= 3, k % 3 == 2);
        image = decode(path);
        assert_int_equal(image.width, 48);
        assert_int_equal(image.height, 32);
        assert_int_equal(image.channels, 3);
        for (int i = 0; i < 48 * 32 * 3; i++)
            assert_true(abs(image.bytes[i] - (2 * (i / 3 % 48) + 2 * (i / 3 / 48) +
                                              (n == 3 ? 20 * (i % 3) : 0))) <= 8);
        free(image.bytes);
    }
    write_jpeg(path, JCS_CMYK, 4, 0, 0);
    assert_int_equal(ted4_image_probe(path, &header, &m), -1);
    assert_non_null(strstr(m.text, "a.jpg: JPEG of 4 colours (CMYK?), expected grey or RGB"));
    /* Reading the pixels alone fails, too. */
    assert_int_equal(ted4_image_read(path, &image, &m), -1);
    assert_null(image.bytes);
    tiny_free(&f);
}

/* Half-transparent orange: 200 100 0 straight, 100 50 0 premultiplied; then colours brighter than
 * white, which no premultiplied picture contains. */
static void test_alpha(void **state)
{
    const uint8_t straight[16] = {
        200, 100, 0, 128, 9, 8, 7, 255, 90, 90, 90, 0, 255, 255, 255, 128
    };
    const uint8_t premultiplied[16] = { 100, 50, 0, 128, 9,   8,   7,   255,
                                        0,   0,  0, 0,   255, 255, 255, 128 };
    const uint8_t white[12] = { 227, 177, 127, 9, 8, 7, 255, 255, 255, 255, 255, 255 };
    const uint8_t black[2][12] = { { 100, 50, 0, 9, 8, 7, 0, 0, 0, 128, 128, 128 },
                                   { 100, 50, 0, 9, 8, 7, 0, 0, 0, 255, 255, 255 } };
    tiny_folder f = tiny_new();
    uint64_t digest[2];

    (void)state;
    tiny_text(&f, "transforms.json",
              "{\"fl_x\": 9, \"frames\": [{\"file_path\": \"p.png\", "
              "\"transform_matrix\": " TINY_POSE "}]}");
    for (int k = 0; k < 4; k++) {
        ted4_dataset_options o = tiny_options;
        ted4_dataset d;
        ted4_message m;
        const int pre = k % 2;
        o.premultiplied = pre;
        o.white = k < 2;
        tiny_png(&f, "p.png", 2, 2, PNG_FORMAT_RGBA, pre ? premultiplied : straight);
        assert_string_equal(tiny_load(&d, &f, &o), "");
        const uint8_t *px = ted4_dataset_pixels(&d, 0, &m);
        assert_non_null(px);
        assert_memory_equal(px, o.white ? white : black[pre], 12);
        digest[pre] = ted4_dataset_digest(&d);
        ted4_dataset_release(&d, 0);
        ted4_dataset_free(&d);
    }
    assert_int_not_equal(digest[0], digest[1]);
    tiny_free(&f);
}

/* Half-transparent pictures of 48 x 48, with colours of 100 and an alpha of 90 or 110, declared as
 * straight or premultiplied. */
static void test_alpha_doubt(void **state)
{
    static uint8_t px[48 * 48 * 4];
    tiny_folder f = tiny_new();

    (void)state;
    tiny_text(
        &f, "transforms.json",
        "{\"fl_x\": 9, \"frames\": [{\"file_path\": \"p.png\", \"transform_matrix\": " TINY_POSE
        "}]}");
    for (int k = 0; k < 4; k++) {
        ted4_dataset_options o = tiny_options;
        ted4_dataset d;
        ted4_message m;
        const int alpha = k % 2 ? 110 : 90;
        for (int i = 0; i < 48 * 48 * 4; i++)
            px[i] = (uint8_t)(i % 4 == 3 ? alpha : 100);
        tiny_png(&f, "p.png", 48, 48, PNG_FORMAT_RGBA, px);
        o.premultiplied = k >= 2;
        assert_string_equal(tiny_load(&d, &f, &o), "");
        assert_int_equal(ted4_dataset_verify(&d, NULL, &m), 0);
        /* Premultiplied colours above their alpha become white, which is told of, too. */
        assert_int_equal(d.n_warnings, k == 1 ? 1 : k == 2 ? 2 : 0);
        if (k == 1)
            assert_non_null(strstr(d.warnings[0], "(--alpha premultiplied)"));
        if (k == 2)
            assert_non_null(strstr(d.warnings[0], "2304 of 2304 pixels"));
        ted4_dataset_free(&d);
    }
    tiny_free(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_png),         cmocka_unit_test(test_clear_colour),
        cmocka_unit_test(test_jpeg),        cmocka_unit_test(test_alpha),
        cmocka_unit_test(test_alpha_doubt),
    };

    return cmocka_run_group_tests_name("pictures", tests, NULL, NULL);
}
