/* source.c - see source.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "data/source.h"

#include <stdlib.h>
#include <string.h>
#include "data/data_util.h"
#include "data/image_file.h"

/* Composites RGBA over a grey level to RGB, in place and rounded. Premultiplied colours above their
 * alpha, which should not occur, are clipped to white. */
static void composite(ted4_image *image, ted4_source *s)
{
    const int background = s->background, premultiplied = s->premultiplied;
    const size_t n = (size_t)image->width * (size_t)image->height;
    uint8_t *out = image->bytes;

    s->n_partial = s->n_above = 0;
    for (size_t i = 0; i < n; i++) {
        const uint8_t *p = image->bytes + 4 * i;
        const int alpha = p[3], partial = alpha > 0 && alpha < 255;
        s->n_partial += (size_t)partial;
        s->n_above += (size_t)(partial && (p[0] > alpha || p[1] > alpha || p[2] > alpha));
        for (int c = 0; c < 3; c++) {
            const int sum =
                (p[c] * (premultiplied ? 255 : alpha) + background * (255 - alpha) + 127) / 255;
            *out++ = (uint8_t)(sum > 255 ? 255 : sum);
        }
    }
    image->channels = 3;
}

static int undistort(ted4_image *image, const ted4_lens *l, ted4_message *m)
{
    uint8_t *out = malloc((size_t)image->width * (size_t)image->height * 3);

    if (out == NULL)
        return ted4_say_no_memory(m);
    ted4_undistort(l, image->bytes, out);
    free(image->bytes);
    image->bytes = out;
    return 0;
}

/* Is this the file that was probed, and decoded before? If a picture changed during training, the
 * result would not be reproducible. */
static int check_same(ted4_source *s, const ted4_image *image, ted4_message *m)
{
    if (image->width != s->lens.width || image->height != s->lens.height)
        return ted4_say(m, "%s: now %dx%d, was %dx%d when the scene was loaded", s->path,
                        image->width, image->height, s->lens.width, s->lens.height);
    if (s->is_known && image->digest != s->digest)
        return ted4_say(m, "%s: the file has changed since it was read first", s->path);
    s->is_known = 1;
    s->digest = image->digest;
    return 0;
}

uint8_t *ted4_source_decode(void *sources, size_t i, size_t *size, ted4_message *m)
{
    ted4_source *s = (ted4_source *)sources + i;
    ted4_image image;

    if (ted4_image_read(s->path, &image, m) != 0)
        return NULL;
    if (check_same(s, &image, m) != 0) {
        free(image.bytes);
        return NULL;
    }
    if (image.channels == 4)
        composite(&image, s);
    if (!ted4_lens_is_pinhole(&s->lens) && undistort(&image, &s->lens, m) != 0) {
        free(image.bytes);
        return NULL;
    }
    if (s->downscale > 1)
        ted4_downscale(image.bytes, image.width, image.height, s->downscale, image.bytes);
    *size = (size_t)(image.width / s->downscale) * (size_t)(image.height / s->downscale) * 3;
    /* Frees what composite and downscale left unused at the end; if shrinking fails, the block is
     * kept. */
    uint8_t *exact = realloc(image.bytes, *size);
    return exact != NULL ? exact : image.bytes;
}
