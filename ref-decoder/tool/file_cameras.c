/* file_cameras.c - see file_cameras.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "file_cameras.h"

#include <stdlib.h>
#include <string.h>

#include "chunks.h"
#include "turn.h"

void ted4_file_up(const uint8_t *file, size_t size, float up[3])
{
    ted4_chunk_view chunk;
    ted4_cams c;

    memset(up, 0, 3 * sizeof *up);
    for (size_t at = TED4_FILE_HEADER; ted4_chunks_next(file, size, &at, &chunk);)
        if (strcmp(chunk.type, "CAMS") == 0 && ted4_cams_read(chunk.payload, chunk.size, &c) == 0 &&
            ted4_has_direction(c.up))
            memcpy(up, c.up, sizeof c.up);
}

int ted4_file_cameras(const uint8_t *file, size_t size, ted4_cams_kind kind, ted4_camera_list *l)
{
    ted4_chunk_view chunk;
    ted4_cams c, found = { .n = 0 };

    *l = (ted4_camera_list) { 0 };
    for (size_t at = TED4_FILE_HEADER; ted4_chunks_next(file, size, &at, &chunk);)
        if (strcmp(chunk.type, "CAMS") == 0 && ted4_cams_read(chunk.payload, chunk.size, &c) == 0 &&
            c.kind == kind && c.n > 0)
            found = c;
    if (found.n == 0)
        return 0;
    l->camera = calloc(found.n, sizeof *l->camera);
    if (l->camera == NULL)
        return -1;
    for (; l->n < found.n; l->n++) {
        const ted4_cams_camera from = ted4_cams_get(&found, l->n);

        l->camera[l->n] = (ted4_listed_camera) { .view = from.view, .time = from.time };
    }
    return 0;
}
