/* jpeg_writer.h - writes a JPEG file of linear ramps, so that a test knows which pixels to expect.
 * For test_image_file.c and test_pictures.c.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_JPEG_WRITER_H
#define TED4_JPEG_WRITER_H

#include <stdint.h>
#include <stdio.h>
#include <jpeglib.h>

#include "test.h"

typedef struct {
    int w, h, n;         /* pixels, at most 64 wide; components, at most 4 */
    J_COLOR_SPACE space; /* of the components */
    int progressive;
    int exact;                  /* RGB is stored as it is, not as YCbCr */
    int column, row, component; /* level differences between neighbours */
} jpeg_slopes;

static inline void jpeg_write(const char *path, const jpeg_slopes *s)
{
    struct jpeg_compress_struct c;
    struct jpeg_error_mgr e;
    uint8_t row[4 * 64];
    JSAMPROW rows[1] = { row };
    FILE *f = fopen(path, "wb");

    assert_non_null(f);
    c.err = jpeg_std_error(&e);
    jpeg_create_compress(&c);
    jpeg_stdio_dest(&c, f);
    c.image_width = (JDIMENSION)s->w;
    c.image_height = (JDIMENSION)s->h;
    c.input_components = s->n;
    c.in_color_space = s->space;
    jpeg_set_defaults(&c);
    jpeg_set_quality(&c, 98, TRUE);
    if (s->exact)
        jpeg_set_colorspace(&c, JCS_RGB);
    if (s->progressive)
        jpeg_simple_progression(&c);
    jpeg_start_compress(&c, TRUE);
    for (int y = 0; y < s->h; y++) {
        for (int i = 0; i < s->w * s->n; i++)
            row[i] = (uint8_t)(s->column * (i / s->n) + s->row * y + s->component * (i % s->n));
        jpeg_write_scanlines(&c, rows, 1);
    }
    jpeg_finish_compress(&c);
    jpeg_destroy_compress(&c);
    fclose(f);
}

#endif
