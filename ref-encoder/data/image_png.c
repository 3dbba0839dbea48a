/* image_png.c - decodes interlaced 16-bit PNG to RGB or RGBA bytes, because libpng's simplified
 * interface (image_file.c) mixes up the rows of such files (pnggroup/libpng issue 853). It uses
 * setjmp for the same reason as image_jpeg.c: everything that must survive the jump belongs to the
 * caller of the function that calls setjmp.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <png.h>

#include "data/data_util.h"
#include "data/image_file.h"

typedef struct {
    png_structp png;
    png_infop info;
    const uint8_t *bytes; /* borrowed; the unread part of the file */
    size_t size;
    png_bytep *rows; /* owned; pointers into the image */
    jmp_buf out;
    char text[200];
} png_job;

static void leave(png_structp p, const char *text)
{
    png_job *job = png_get_error_ptr(p);

    snprintf(job->text, sizeof job->text, "%s", text);
    longjmp(job->out, 1);
}

static void ignore(png_structp p, const char *text)
{
    (void)p, (void)text;
}

static void read_bytes(png_structp p, png_bytep to, size_t n)
{
    png_job *job = png_get_io_ptr(p);

    if (n > job->size)
        png_error(p, "read beyond end of data");
    memcpy(to, job->bytes, n);
    job->bytes += n;
    job->size -= n;
}

/* Applies the transformations by which the simplified interface produces sRGB bytes, and reads the
 * image. */
static void read_all(png_job *job, ted4_image *image)
{
    png_structp p = job->png;

    png_set_read_fn(p, job, read_bytes);
    png_read_info(p, job->info);
    const size_t width = png_get_image_width(p, job->info),
                 height = png_get_image_height(p, job->info);
    const int has_alpha = (png_get_color_type(p, job->info) & PNG_COLOR_MASK_ALPHA) != 0 ||
                          png_get_valid(p, job->info, PNG_INFO_tRNS) != 0;
    if (width > TED4_IMAGE_MAX_SIDE || height > TED4_IMAGE_MAX_SIDE)
        png_error(p, "too large");
    png_set_alpha_mode_fixed(p, PNG_ALPHA_PNG, PNG_DEFAULT_sRGB);
    png_set_expand(p);
    png_set_scale_16(p);
    png_set_gray_to_rgb(p);
    png_set_interlace_handling(p);
    png_read_update_info(p, job->info);
    image->width = (int)width;
    image->height = (int)height;
    image->channels = has_alpha ? 4 : 3;
    const size_t stride = width * (size_t)image->channels;
    if (png_get_rowbytes(p, job->info) != stride)
        png_error(p, "rows of another size than expected");
    image->bytes = height > SIZE_MAX / stride ? NULL : malloc(height * stride);
    job->rows = malloc(height * sizeof *job->rows);
    if (image->bytes == NULL || job->rows == NULL)
        png_error(p, "out of memory");
    for (size_t y = 0; y < height; y++)
        job->rows[y] = image->bytes + y * stride;
    png_read_image(p, job->rows);
    png_read_end(p, NULL);
}

/* Returns 0, or -1 after any error in libpng. */
static int guarded_read(png_job *job, ted4_image *image)
{
    if (setjmp(job->out) != 0)
        return -1;
    job->png = png_create_read_struct(PNG_LIBPNG_VER_STRING, job, leave, ignore);
    job->info = job->png == NULL ? NULL : png_create_info_struct(job->png);
    if (job->info == NULL) {
        snprintf(job->text, sizeof job->text, "out of memory");
        return -1;
    }
    read_all(job, image);
    return 0;
}

int ted4_png_decode_interlaced(const char *path, const uint8_t *bytes, size_t size,
                               ted4_image *image, ted4_message *m)
{
    png_job job;

    memset(&job, 0, sizeof job);
    job.bytes = bytes;
    job.size = size;
    const int failed = guarded_read(&job, image);
    png_destroy_read_struct(&job.png, &job.info, NULL);
    free(job.rows);
    if (!failed)
        return 0;
    free(image->bytes);
    image->bytes = NULL;
    return ted4_say(m, "%s: PNG: %s (cut short or damaged)", path, job.text);
}
