/* file_cameras.c - see file_cameras.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "file_cameras.h"

#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

#include "base/bytes.h"
#include "chunks.h"
#include "turn.h"

/* Reads the next cameras from *at on, and moves *at behind them. Returns 1, or 0 at the end of the
 * file. A damaged chunk, as a file may have of which --lenient recovered a part, is left out. */
static int next_cameras(const uint8_t *file, size_t size, size_t *at, ted4_cams *c)
{
    ted4_chunk_view chunk;

    while (ted4_chunks_next(file, size, at, &chunk)) {
        const size_t hashed = TED4_CHUNK_HEAD + chunk.size;

        if (strcmp(chunk.type, "CAMS") == 0 &&
            XXH3_64bits(file + chunk.at, hashed) == ted4_load64(file + chunk.at + hashed) &&
            ted4_cams_read(chunk.payload, chunk.size, c) == 0)
            return 1;
    }
    return 0;
}

void ted4_file_up(const uint8_t *file, size_t size, float up[3])
{
    ted4_cams c;

    memset(up, 0, 3 * sizeof *up);
    for (size_t at = TED4_FILE_HEADER; next_cameras(file, size, &at, &c);)
        if (ted4_has_direction(c.up))
            memcpy(up, c.up, sizeof c.up);
}

/* The cameras of a kind that count: n is 0 if there are none. */
static ted4_cams find_cameras(const uint8_t *file, size_t size, ted4_cams_kind kind)
{
    ted4_cams c, found = { .n = 0 };

    for (size_t at = TED4_FILE_HEADER; next_cameras(file, size, &at, &c);)
        if (c.kind == kind && c.n > 0)
            found = c;
    return found;
}

static int by_value(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;

    return (x > y) - (x < y);
}

/* Gives each camera the width of its pixels in pixels of training, which follows from the median
 * focal length of the cameras that took the pictures (annex I.4). Returns 0, or -1 if out of
 * memory. */
static int set_pixels(ted4_camera_list *l, const ted4_cams *taken)
{
    float *const fx = malloc(taken->n * sizeof *fx);

    if (fx == NULL)
        return -1;
    for (size_t i = 0; i < taken->n; i++)
        fx[i] = ted4_cams_get(taken, i).view.fx;
    qsort(fx, taken->n, sizeof *fx, by_value);
    for (size_t i = 0; i < l->n; i++)
        l->camera[i].view.pixel = fx[taken->n / 2] / l->camera[i].view.fx;
    free(fx);
    return 0;
}

int ted4_file_cameras(const uint8_t *file, size_t size, ted4_cams_kind kind, ted4_camera_list *l)
{
    const ted4_cams found = find_cameras(file, size, kind);
    const ted4_cams taken = find_cameras(file, size, TED4_CAMS_TAKEN);

    *l = (ted4_camera_list) { 0 };
    if (found.n == 0)
        return 0;
    l->camera = calloc(found.n, sizeof *l->camera);
    if (l->camera == NULL)
        return -1;
    for (; l->n < found.n; l->n++) {
        const ted4_cams_camera from = ted4_cams_get(&found, l->n);

        l->camera[l->n] = (ted4_listed_camera) { .view = from.view, .time = from.time };
    }
    return kind == TED4_CAMS_PATH && taken.n > 0 ? set_pixels(l, &taken) : 0;
}
