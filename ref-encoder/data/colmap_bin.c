/* colmap_bin.c - reads COLMAP's binary model files, which are little-endian and packed. See
 * colmap_file.h. Each file is a u64 count followed by its records:
 *   camera   u32 id, i32 model, u64 width, u64 height, f64 parameters
 *   image    u32 id, f64 q[4] t[3], u32 camera, name ending in 0, u64 n, n x (f64 x, f64 y, u64
 *            point)
 *   point    u64 id, f64 xyz[3], u8 rgb[3], f64 error, u64 n, n x (u32 image, u32 index)
 * SPDX-License-Identifier: BSD-2-Clause */
#include "data/colmap_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "data/data_util.h"

/* Smallest sizes of the records, against which counts are checked. */
enum {
    CAMERA_MIN = 24 + 3 * 8,
    IMAGE_MIN = 64 + 1 + 8,
    OBSERVATION = 24,
    POINT_MIN = 43 + 8,
    TRACK = 8
};

/* Position in a file. From the first read past the end on, every read gives 0 and overrun stays
 * set. */
typedef struct {
    const char *path;
    uint8_t *bytes; /* owned */
    size_t size, at;
    int overrun;
} reader;

static const uint8_t *take(reader *r, size_t n)
{
    static const uint8_t zeros[8];

    if (r->overrun || r->size - r->at < n) {
        r->overrun = 1;
        return zeros;
    }
    r->at += n;
    return r->bytes + r->at - n;
}

static void skip(reader *r, uint64_t n, size_t record_size)
{
    if (r->overrun || n > (r->size - r->at) / record_size)
        r->overrun = 1;
    else
        r->at += (size_t)n * record_size;
}

static uint64_t integer(reader *r, size_t size)
{
    const uint8_t *p = take(r, size);
    uint64_t v = 0;

    for (size_t i = 0; i < size; i++)
        v |= (uint64_t)p[i] << (8 * i);
    return v;
}

static double real(reader *r)
{
    const uint64_t v = integer(r, 8);
    double d;

    memcpy(&d, &v, sizeof d);
    return d;
}

/* Opens the file and reads the count, which is refused if the file is too short for it. */
static int start(reader *r, const char *path, const char *what, size_t record_min, size_t *count,
                 ted4_message *m)
{
    memset(r, 0, sizeof *r);
    r->path = path;
    if (ted4_read_whole(path, &r->bytes, &r->size, m) != 0)
        return -1;
    const uint64_t n = integer(r, 8);
    if (!r->overrun && n <= (r->size - r->at) / record_min) {
        *count = (size_t)n;
        return 0;
    }
    ted4_say(m, "%s: %llu %s announced, but the file has only %zu bytes", path,
             (unsigned long long)n, what, r->size);
    free(r->bytes);
    return -1;
}

/* Completes a file whose records gave result: refuses bytes after the last record. */
static int finish(reader *r, int result, ted4_message *m)
{
    if (result == 0 && r->at != r->size)
        result = ted4_say(m, "%s: %zu bytes after the last record", r->path, r->size - r->at);
    free(r->bytes);
    return result;
}

static int cut_short(const reader *r, const char *where, ted4_message *m)
{
    return ted4_say(m, "%s: the file ends here (%zu bytes)", where, r->size);
}

static int read_camera(reader *r, ted4_colmap_camera *c, size_t index, ted4_message *m)
{
    char where[600];
    double p[TED4_COLMAP_MAX_PARAMETERS];
    size_t n = 0;

    c->id = (uint32_t)integer(r, 4);
    snprintf(where, sizeof where, "%s: camera %u (record %zu)", r->path, (unsigned)c->id, index);
    const int64_t id = (int32_t)(uint32_t)integer(r, 4);
    const uint64_t width = integer(r, 8), height = integer(r, 8);
    if (r->overrun)
        return cut_short(r, where, m);
    const int model = ted4_colmap_model_by_id(id, where, &n, m);
    if (model < 0)
        return -1;
    for (size_t i = 0; i < n; i++)
        p[i] = real(r);
    return r->overrun ? cut_short(r, where, m)
                      : ted4_colmap_set_camera(c, model, width, height, p, where, m);
}

int ted4_colmap_bin_cameras(ted4_colmap *c, const char *path, ted4_message *m)
{
    reader r;
    size_t n;
    int result = 0;

    if (start(&r, path, "cameras", CAMERA_MIN, &n, m) != 0)
        return -1;
    c->cameras = calloc(n + 1, sizeof *c->cameras);
    if (c->cameras == NULL)
        result = ted4_say_no_memory(m);
    for (size_t i = 0; i < n && result == 0; i++, c->n_cameras++)
        result = read_camera(&r, &c->cameras[i], i, m);
    return finish(&r, result, m);
}

/* Returns a name with its terminating zero, or NULL if the file ends before it. */
static const char *read_name(reader *r)
{
    const uint8_t *begin = r->bytes + r->at;
    const uint8_t *end = r->overrun ? NULL : memchr(begin, 0, r->size - r->at);

    if (end == NULL) {
        r->overrun = 1;
        return NULL;
    }
    r->at += (size_t)(end - begin) + 1;
    return (const char *)begin;
}

static int read_image(reader *r, ted4_colmap_image *image, size_t index, ted4_message *m)
{
    char where[600];
    double qt[7];

    integer(r, 4);
    for (int i = 0; i < 7; i++)
        qt[i] = real(r);
    image->camera = (uint32_t)integer(r, 4);
    const char *name = read_name(r);
    snprintf(where, sizeof where, "%s: image \"%.200s\" (record %zu)", r->path,
             name == NULL ? "" : name, index);
    skip(r, integer(r, 8), OBSERVATION);
    if (r->overrun)
        return cut_short(r, where, m);
    image->name = ted4_text_copy(name);
    return image->name == NULL ? ted4_say_no_memory(m) : ted4_colmap_set_pose(image, qt, where, m);
}

int ted4_colmap_bin_images(ted4_colmap *c, const char *path, ted4_message *m)
{
    reader r;
    size_t n;
    int result = 0;

    if (start(&r, path, "images", IMAGE_MIN, &n, m) != 0)
        return -1;
    c->images = calloc(n + 1, sizeof *c->images);
    if (c->images == NULL)
        result = ted4_say_no_memory(m);
    for (size_t i = 0; i < n && result == 0; i++, c->n_images++)
        result = read_image(&r, &c->images[i], i, m);
    return finish(&r, result, m);
}

static int read_point(reader *r, float *xyz, uint8_t *rgb, size_t index, ted4_message *m)
{
    integer(r, 8);
    for (int k = 0; k < 3; k++)
        xyz[k] = (float)real(r);
    for (int k = 0; k < 3; k++)
        rgb[k] = (uint8_t)integer(r, 1);
    real(r);
    skip(r, integer(r, 8), TRACK);
    if (r->overrun)
        return ted4_say(m, "%s: point %zu: the file ends here (%zu bytes)", r->path, index,
                        r->size);
    if (!isfinite(xyz[0]) || !isfinite(xyz[1]) || !isfinite(xyz[2]))
        return ted4_say(m, "%s: point %zu: a coordinate is not finite", r->path, index);
    return 0;
}

int ted4_colmap_bin_points(ted4_colmap *c, const char *path, ted4_message *m)
{
    reader r;
    size_t n;
    int result = 0;

    if (start(&r, path, "points", POINT_MIN, &n, m) != 0)
        return -1;
    if (ted4_point_cloud_alloc(&c->cloud, n) != 0)
        result = ted4_say_no_memory(m);
    for (size_t i = 0; i < n && result == 0; i++)
        result = read_point(&r, c->cloud.xyz + 3 * i, c->cloud.rgb + 3 * i, i, m);
    return finish(&r, result, m);
}
