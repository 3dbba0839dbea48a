/* image_jpeg.c - decodes JPEG to RGB bytes through libjpeg-turbo.
 * It uses setjmp, because libjpeg's error_exit must not return and the library offers no other way
 * out. Everything that must survive the jump belongs to the caller of the function that calls
 * setjmp.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <jpeglib.h>
#include <jerror.h>

#include "data/data_util.h"
#include "data/image_file.h"

typedef struct {
    struct jpeg_error_mgr errors; /* must be first: cinfo->err points at it */
    struct jpeg_decompress_struct cinfo;
    jmp_buf out;
    char text[JMSG_LENGTH_MAX];
} jpeg_job;

static void leave(j_common_ptr c)
{
    jpeg_job *job = (jpeg_job *)c->err;

    c->err->format_message(c, job->text);
    longjmp(job->out, 1);
}

/* Missing data would be filled with grey, so it is refused instead. Other warnings (stray bytes) do
 * not change pixels. */
static void warn(j_common_ptr c, int level)
{
    const int code = c->err->msg_code;

    if (level < 0 &&
        (code == JWRN_JPEG_EOF || code == JWRN_HIT_MARKER || code == JWRN_HUFF_BAD_CODE))
        leave(c);
}

static void read_all(jpeg_job *job, const uint8_t *bytes, size_t size, ted4_image *image)
{
    struct jpeg_decompress_struct *c = &job->cinfo;

    jpeg_mem_src(c, bytes, (unsigned long)size);
    jpeg_read_header(c, TRUE);
    c->out_color_space = JCS_RGB;
    c->dct_method = JDCT_ISLOW;
    if (c->image_width > TED4_IMAGE_MAX_SIDE || c->image_height > TED4_IMAGE_MAX_SIDE)
        ERREXIT1(c, JERR_IMAGE_TOO_BIG, TED4_IMAGE_MAX_SIDE);
    jpeg_start_decompress(c);
    image->width = (int)c->output_width;
    image->height = (int)c->output_height;
    image->channels = 3;
    image->bytes = malloc((size_t)c->output_width * c->output_height * 3);
    if (image->bytes == NULL)
        ERREXIT1(c, JERR_OUT_OF_MEMORY, 0);
    while (c->output_scanline < c->output_height) {
        JSAMPROW row = image->bytes + (size_t)c->output_scanline * c->output_width * 3;
        jpeg_read_scanlines(c, &row, 1);
    }
    jpeg_finish_decompress(c);
}

/* Returns 0, or -1 after any error in libjpeg. */
static int guarded_read(jpeg_job *job, const uint8_t *bytes, size_t size, ted4_image *image)
{
    if (setjmp(job->out) != 0)
        return -1;
    jpeg_create_decompress(&job->cinfo);
    read_all(job, bytes, size, image);
    return 0;
}

int ted4_jpeg_decode(const char *path, const uint8_t *bytes, size_t size, ted4_image *image,
                     ted4_message *m)
{
    jpeg_job job;

    memset(&job, 0, sizeof job);
    job.cinfo.err = jpeg_std_error(&job.errors);
    job.errors.error_exit = leave;
    job.errors.emit_message = warn;
    const int failed = guarded_read(&job, bytes, size, image);
    jpeg_destroy_decompress(&job.cinfo);
    if (!failed)
        return 0;
    free(image->bytes);
    image->bytes = NULL;
    return ted4_say(m, "%s: JPEG: %s", path, job.text);
}
