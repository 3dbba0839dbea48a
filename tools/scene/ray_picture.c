/* ray_picture.c - see ray_picture.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "ray_picture.h"

#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <jpeglib.h>
#include <png.h>

#include "ray_palette.h"
#include "ray_rig.h"
#include "ray_save.h"

enum { QUALITY = 98 };

static int complain(ted4_ray_message *m, const char *path, const char *why)
{
    snprintf(m->text, sizeof m->text, "%s: %s", path, why);
    return -1;
}

const char *ted4_ray_ending(const ted4_ray_options *o)
{
    return o->ways.file >= RAY_JPEG ? ".jpg" : ".png";
}

/* ---- PNG: rows of bytes as in the file ---- */

typedef struct {
    int width, height, depth, type, interlaced, channels;
    uint8_t *rows; /* owned */
    uint8_t palette[TED4_RAY_PALETTE][4];
    int n_palette;
} raw;

static void fill_row(const ted4_ray_options *o, raw *r, const uint8_t *rgba, size_t i)
{
    const uint8_t *const p = rgba + 4 * i;
    const int wide = r->depth == 16 ? 2 : 1;
    uint8_t *to = r->rows + i * (size_t)(r->channels * wide);
    uint8_t grey[2] = { (uint8_t)((299 * p[0] + 587 * p[1] + 114 * p[2] + 500) / 1000), p[3] };
    const uint8_t *const from = o->ways.file == RAY_GREY ? grey : p;

    for (int k = 0; k < r->channels; k++)
        for (int b = 0; b < wide; b++)
            *to++ = from[k];
}

/* Returns 0, or -1 without memory. */
static int fill(const ted4_ray_options *o, raw *r, const uint8_t *rgba)
{
    const size_t n = (size_t)r->width * (size_t)r->height;

    r->rows = malloc(n * 8);
    if (r->rows == NULL)
        return -1;
    if (o->ways.file == RAY_PALETTE) {
        r->n_palette = ted4_ray_palette(rgba, n, r->palette, r->rows);
        return r->n_palette < 0 ? -1 : 0;
    }
    for (size_t i = 0; i < n; i++)
        fill_row(o, r, rgba, i);
    return 0;
}

static void put_palette(png_structp png, png_infop info, const raw *r, int clear)
{
    png_color colours[TED4_RAY_PALETTE];
    png_byte alpha[TED4_RAY_PALETTE];

    for (int i = 0; i < r->n_palette; i++) {
        colours[i] = (png_color) { r->palette[i][0], r->palette[i][1], r->palette[i][2] };
        alpha[i] = r->palette[i][3];
    }
    png_set_PLTE(png, info, colours, r->n_palette);
    if (clear)
        png_set_tRNS(png, info, alpha, r->n_palette, NULL);
}

/* libpng returns by a jump, so that everything that must survive it is in *r. */
static int put_png(FILE *f, const raw *r, int clear)
{
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png == NULL ? NULL : png_create_info_struct(png);
    const size_t row = (size_t)r->width * (size_t)(r->channels * r->depth / 8);

    if (info == NULL || setjmp(png_jmpbuf(png)) != 0) {
        png_destroy_write_struct(&png, &info);
        return -1;
    }
    png_init_io(png, f);
    png_set_IHDR(png, info, (png_uint_32)r->width, (png_uint_32)r->height, r->depth, r->type,
                 r->interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (r->type == PNG_COLOR_TYPE_PALETTE)
        put_palette(png, info, r, clear);
    png_write_info(png, info);
    for (int pass = png_set_interlace_handling(png); pass > 0; pass--)
        for (int y = 0; y < r->height; y++)
            png_write_row(png, r->rows + (size_t)y * row);
    png_write_end(png, NULL);
    png_destroy_write_struct(&png, &info);
    return 0;
}

static int write_other_png(const ted4_ray_options *o, const char *path, int clear, raw *r,
                           const uint8_t *rgba, ted4_ray_message *m)
{
    ted4_ray_collected c;

    ted4_ray_collect(&c);
    const int bad = c.file == NULL || fill(o, r, rgba) != 0 || put_png(c.file, r, clear) != 0;
    free(r->rows);
    return ted4_ray_collect_end(&c, bad, path, m);
}

/* Writes 8 bits per channel, with libpng's simplified interface. */
static int write_png(const char *path, png_uint_32 format, int width, int height,
                     const uint8_t *pixels, ted4_ray_message *m)
{
    png_image png = { .version = PNG_IMAGE_VERSION,
                      .format = format,
                      .width = (png_uint_32)width,
                      .height = (png_uint_32)height };
    ted4_ray_collected c;

    ted4_ray_collect(&c);
    const int bad = c.file == NULL ||
                    png_image_write_to_stdio(&png, c.file, 0, pixels, 0, NULL) == 0;
    return ted4_ray_collect_end(&c, bad, path, m);
}

int ted4_ray_write_grey(const char *path, int width, int height, const uint8_t *grey,
                        ted4_ray_message *m)
{
    return write_png(path, PNG_FORMAT_GRAY, width, height, grey, m);
}

/* ---- JPEG ---- */

static int write_jpeg(const char *path, int width, int height, int progressive, uint8_t *rgb,
                      ted4_ray_message *m)
{
    struct jpeg_compress_struct jpeg;
    struct jpeg_error_mgr errors;
    unsigned char *bytes = NULL;
    unsigned long n = 0;

    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_compress(&jpeg);
    jpeg_mem_dest(&jpeg, &bytes, &n);
    jpeg.image_width = (JDIMENSION)width;
    jpeg.image_height = (JDIMENSION)height;
    jpeg.input_components = 3;
    jpeg.in_color_space = JCS_RGB;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, QUALITY, TRUE);
    if (progressive)
        jpeg_simple_progression(&jpeg);
    jpeg_start_compress(&jpeg, TRUE);
    for (int y = 0; y < height; y++) {
        JSAMPROW row = rgb + 3 * (size_t)y * (size_t)width;
        jpeg_write_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_compress(&jpeg);
    jpeg_destroy_compress(&jpeg);
    const int status = ted4_ray_save(path, bytes, n, m);
    free(bytes);
    return status;
}

/* ---- all kinds ---- */

static int write_opaque(const ted4_ray_options *o, const char *path, int width, int height,
                        const uint8_t *rgba, ted4_ray_message *m)
{
    const size_t n = (size_t)width * (size_t)height;
    uint8_t *const rgb = malloc(3 * n);
    int status;

    if (rgb == NULL)
        return complain(m, path, "out of memory");
    for (size_t i = 0; i < n; i++)
        memcpy(rgb + 3 * i, rgba + 4 * i, 3);
    if (o->ways.file >= RAY_JPEG)
        status = write_jpeg(path, width, height, o->ways.file == RAY_PROGRESSIVE, rgb, m);
    else
        status = write_png(path, PNG_FORMAT_RGB, width, height, rgb, m);
    free(rgb);
    return status;
}

int ted4_ray_write_picture(const ted4_ray_options *o, const char *path, int width, int height,
                           const uint8_t *rgba, ted4_ray_message *m)
{
    const int clear = ted4_ray_around(o) == RAY_CLEAR, kind = o->ways.file;
    raw r = { .width = width,
              .height = height,
              .depth = kind == RAY_PNG16 ? 16 : 8,
              .channels = 3 + clear,
              .type = clear ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB,
              .interlaced = kind == RAY_INTERLACED };

    if (kind >= RAY_JPEG || (kind == RAY_PNG && !clear))
        return write_opaque(o, path, width, height, rgba, m);
    if (kind == RAY_PNG)
        return write_png(path, PNG_FORMAT_RGBA, width, height, rgba, m);
    if (kind == RAY_GREY) {
        r.channels = 1 + clear;
        r.type = clear ? PNG_COLOR_TYPE_GRAY_ALPHA : PNG_COLOR_TYPE_GRAY;
    }
    if (kind == RAY_PALETTE) {
        r.channels = 1;
        r.type = PNG_COLOR_TYPE_PALETTE;
    }
    return write_other_png(o, path, clear, &r, rgba, m);
}
