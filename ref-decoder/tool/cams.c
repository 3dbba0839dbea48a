/* cams.c - see cams.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "cams.h"

#include <math.h>
#include <string.h>

#include "base/bytes.h"
#include "rotation.h"

/* R-EXT-008: how far the length of up may be from 1. */
#define UP_TOLERANCE 1e-3

enum { KIND_AT = 12, COUNT_AT = 16, DEN_END = 1 << 24 /* R-REC-002 */ };

static void put_floats(uint8_t *to, const float *x, size_t n)
{
    for (size_t i = 0; i < n; i++)
        ted4_store32(to + 4 * i, ted4_float_bits(x[i]));
}

static void get_floats(const uint8_t *from, float *x, size_t n)
{
    for (size_t i = 0; i < n; i++)
        x[i] = ted4_bits_float(ted4_load32(from + 4 * i));
}

static int all_finite(const float *x, size_t n)
{
    for (size_t i = 0; i < n; i++)
        if (!isfinite(x[i]))
            return 0;
    return 1;
}

static int side_is_valid(int side)
{
    return side >= 1 && side <= TED4_CAMS_SIDE;
}

static int camera_is_valid(const ted4_cams_camera *c)
{
    const ted4_view *v = &c->view;
    const float pinhole[4] = { v->fx, v->fy, v->cx, v->cy };

    return side_is_valid(v->width) && side_is_valid(v->height) && all_finite(pinhole, 4) &&
           v->fx > 0.0f && v->fy > 0.0f && ted4_is_rotation(v->R) && all_finite(v->t, 3) &&
           c->time.num <= c->time.den && c->time.den < DEN_END;
}

static int up_is_valid(const float up[3])
{
    const double x = (double)up[0], y = (double)up[1], z = (double)up[2];
    const double length = sqrt(x * x + y * y + z * z);

    return length == 0.0 || fabs(length - 1.0) <= UP_TOLERANCE;
}

int ted4_cams_read(const uint8_t *payload, size_t size, ted4_cams *c)
{
    memset(c, 0, sizeof *c);
    if (size < TED4_CAMS_HEAD)
        return -1;

    const uint32_t kind = ted4_load32(payload + KIND_AT), n = ted4_load32(payload + COUNT_AT);

    get_floats(payload, c->up, 3);
    if (!up_is_valid(c->up) || kind >= TED4_CAMS_KINDS || n > TED4_CAMS_MOST ||
        size - TED4_CAMS_HEAD != (size_t)n * TED4_CAMS_CAMERA)
        return -1;
    c->kind = (ted4_cams_kind)kind;
    c->n = n;
    c->camera = payload + TED4_CAMS_HEAD;
    for (size_t i = 0; i < n; i++) {
        const ted4_cams_camera camera = ted4_cams_get(c, i);

        if (!camera_is_valid(&camera))
            return -1;
    }
    return 0;
}

ted4_cams_camera ted4_cams_get(const ted4_cams *c, size_t i)
{
    const uint8_t *from = c->camera + i * TED4_CAMS_CAMERA;
    const uint32_t width = ted4_load32(from), height = ted4_load32(from + 4);
    ted4_cams_camera camera = { .time = { ted4_load32(from + 72), ted4_load32(from + 76) } };
    ted4_view *v = &camera.view;

    v->width = width <= TED4_CAMS_SIDE ? (int)width : 0;
    v->height = height <= TED4_CAMS_SIDE ? (int)height : 0;
    get_floats(from + 8, &v->fx, 1);
    get_floats(from + 12, &v->fy, 1);
    get_floats(from + 16, &v->cx, 1);
    get_floats(from + 20, &v->cy, 1);
    get_floats(from + 24, v->R, 9);
    get_floats(from + 60, v->t, 3);
    return camera;
}

void ted4_cams_put_head(uint8_t *to, const float up[3], ted4_cams_kind kind, size_t n)
{
    put_floats(to, up, 3);
    ted4_store32(to + KIND_AT, (uint32_t)kind);
    ted4_store32(to + COUNT_AT, (uint32_t)n);
}

void ted4_cams_put(uint8_t to[TED4_CAMS_CAMERA], const ted4_cams_camera *camera)
{
    const ted4_view *v = &camera->view;
    const float pinhole[4] = { v->fx, v->fy, v->cx, v->cy };

    ted4_store32(to, (uint32_t)v->width);
    ted4_store32(to + 4, (uint32_t)v->height);
    put_floats(to + 8, pinhole, 4);
    put_floats(to + 24, v->R, 9);
    put_floats(to + 60, v->t, 3);
    ted4_store32(to + 72, camera->time.num);
    ted4_store32(to + 76, camera->time.den);
}
