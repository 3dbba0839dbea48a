/* fz_cams.c - cameras for players (spec 16.4): the input is read as a payload of CAMS, and as a
 * file of chunks. Claims: a payload that is read has cameras that can be rendered, and writing them
 * gives its bytes again; every chunk lies in the file, one after the other.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <string.h>
#include "harness.h"
#include "tool/cams.h"
#include "tool/chunks.h"

/* Row 0 times the cross product of rows 1 and 2. */
static double determinant(const float R[9])
{
    const double x = (double)R[4] * R[8] - (double)R[5] * R[7];
    const double y = (double)R[5] * R[6] - (double)R[3] * R[8];
    const double z = (double)R[3] * R[7] - (double)R[4] * R[6];

    return R[0] * x + R[1] * y + R[2] * z;
}

static void check_camera(const ted4_cams *c, size_t i)
{
    const ted4_cams_camera camera = ted4_cams_get(c, i);
    const ted4_view *v = &camera.view;
    uint8_t again[TED4_CAMS_CAMERA];

    fuzz_require(v->width >= 1 && v->width <= TED4_CAMS_SIDE, "a width");
    fuzz_require(v->height >= 1 && v->height <= TED4_CAMS_SIDE, "a height");
    fuzz_require(v->fx > 0 && v->fy > 0 && isfinite(v->fx) && isfinite(v->fy), "focal lengths");
    fuzz_require(isfinite(v->cx) && isfinite(v->cy), "a principal point");
    for (int k = 0; k < 9; k++)
        fuzz_require(fabsf(v->R[k]) <= 1.001f && isfinite(v->t[k % 3]), "a pose");
    fuzz_require(determinant(v->R) > 0.99, "no mirror image");
    fuzz_require(camera.time.num <= camera.time.den, "a time");
    ted4_cams_put(again, &camera);
    fuzz_require(memcmp(again, c->camera + i * TED4_CAMS_CAMERA, sizeof again) == 0, "same bytes");
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    uint8_t head[TED4_CAMS_HEAD];
    ted4_chunk_view chunk;
    ted4_cams c;
    size_t before = TED4_FILE_HEADER;

    if (ted4_cams_read(data, size, &c) == 0) {
        fuzz_require(size == TED4_CAMS_HEAD + c.n * TED4_CAMS_CAMERA, "a size");
        for (size_t i = 0; i < c.n; i++)
            check_camera(&c, i);
        ted4_cams_put_head(head, c.up, c.kind, c.n);
        fuzz_require(memcmp(head, data, sizeof head) == 0, "the same head");
    }
    for (size_t at = TED4_FILE_HEADER; ted4_chunks_next(data, size, &at, &chunk); before = at) {
        fuzz_require(chunk.at == before && chunk.end == at && at <= size, "a chunk in the file");
        fuzz_require(chunk.payload + chunk.size + TED4_CHUNK_HASH == data + at, "its payload");
    }
    return 0;
}
