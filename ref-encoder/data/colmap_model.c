/* colmap_model.c - what COLMAP's binary and text models share: camera models, poses and growing
 * arrays. See colmap_file.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "data/colmap_file.h"
#include "data/data_util.h"
#include "data/image_file.h"

enum { SIMPLE_PINHOLE, PINHOLE, SIMPLE_RADIAL, RADIAL, OPENCV, N_SUPPORTED };

/* COLMAP's model numbers are the indices of this table. Models after OPENCV are known by name
 * only. */
static const struct {
    const char *name;
    size_t n_parameters;
} models[] = {
    { "SIMPLE_PINHOLE", 3 }, /* f cx cy */
    { "PINHOLE", 4 },        /* fx fy cx cy */
    { "SIMPLE_RADIAL", 4 },  /* f cx cy k1 */
    { "RADIAL", 5 },         /* f cx cy k1 k2 */
    { "OPENCV", 8 },         /* fx fy cx cy k1 k2 p1 p2 */
    { "OPENCV_FISHEYE", 0 },
    { "FULL_OPENCV", 0 },
    { "FOV", 0 },
    { "SIMPLE_RADIAL_FISHEYE", 0 },
    { "RADIAL_FISHEYE", 0 },
    { "THIN_PRISM_FISHEYE", 0 },
    { "RAD_TAN_THIN_PRISM_FISHEYE", 0 },
};
enum { N_MODELS = sizeof models / sizeof models[0] };

#define SUPPORTED                                                                            \
    "SIMPLE_PINHOLE, PINHOLE, SIMPLE_RADIAL, RADIAL or OPENCV (undistort the pictures with " \
    "COLMAP first)"

int ted4_colmap_model_by_id(int64_t id, const char *where, size_t *n_parameters, ted4_message *m)
{
    if (id < 0 || id >= N_MODELS)
        return ted4_say(m, "%s: camera model number %lld, expected " SUPPORTED, where,
                        (long long)id);
    if (id >= N_SUPPORTED)
        return ted4_say(m, "%s: camera model %s, expected " SUPPORTED, where, models[id].name);
    *n_parameters = models[id].n_parameters;
    return (int)id;
}

int ted4_colmap_model_by_name(const char *name, const char *where, size_t *n_parameters,
                              ted4_message *m)
{
    for (int i = 0; i < N_SUPPORTED; i++)
        if (strcmp(name, models[i].name) == 0) {
            *n_parameters = models[i].n_parameters;
            return i;
        }
    return ted4_say(m, "%s: camera model %s, expected " SUPPORTED, where, name);
}

int ted4_colmap_set_camera(ted4_colmap_camera *c, int model, uint64_t width, uint64_t height,
                           const double *p, const char *where, ted4_message *m)
{
    ted4_lens *l = &c->lens;
    const int two = model == PINHOLE || model == OPENCV; /* two focal lengths */

    if (width < 1 || height < 1 || width > TED4_IMAGE_MAX_SIDE || height > TED4_IMAGE_MAX_SIDE)
        return ted4_say(m, "%s: picture size %llux%llu, expected 1 to %d a side", where,
                        (unsigned long long)width, (unsigned long long)height, TED4_IMAGE_MAX_SIDE);
    memset(l, 0, sizeof *l);
    l->width = (int)width;
    l->height = (int)height;
    l->fx = p[0];
    l->fy = p[two];
    l->cx = p[1 + two];
    l->cy = p[2 + two];
    if (model >= SIMPLE_RADIAL)
        l->k1 = p[3 + two];
    if (model >= RADIAL)
        l->k2 = p[4 + two];
    if (model == OPENCV) {
        l->p1 = p[6];
        l->p2 = p[7];
    }
    return 0;
}

int ted4_colmap_set_pose(ted4_colmap_image *i, const double qt[7], const char *where,
                         ted4_message *m)
{
    const double norm2 = qt[0] * qt[0] + qt[1] * qt[1] + qt[2] * qt[2] + qt[3] * qt[3];
    const double n = 1 / sqrt(norm2);
    const double w = qt[0] * n, x = qt[1] * n, y = qt[2] * n, z = qt[3] * n;
    const double R[9] = {
        1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
        2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
        2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y),
    };

    for (int k = 0; k < 7; k++)
        if (!isfinite(qt[k]))
            return ted4_say(m, "%s: the pose holds a value that is not finite", where);
    if (fabs(norm2 - 1) > 2 * TED4_ROTATION_TOLERANCE)
        return ted4_say(m, "%s: rotation quaternion of length %g, expected 1", where, sqrt(norm2));
    memcpy(i->R, R, sizeof R);
    memcpy(i->t, qt + 4, sizeof i->t);
    return 0;
}

int ted4_colmap_reserve(void **array, size_t n, size_t record_size)
{
    if (n != 0 && (n & (n - 1)) != 0)
        return 0; /* the array is full only at powers of two */
    void *p = n > SIZE_MAX / 2 / record_size ? NULL
                                             : realloc(*array, (n == 0 ? 1 : 2 * n) * record_size);
    if (p == NULL)
        return -1;
    *array = p;
    return 0;
}
