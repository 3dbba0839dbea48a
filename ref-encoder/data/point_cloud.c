/* point_cloud.c - see point_cloud.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "data/point_cloud.h"

#include <stdlib.h>
#include <string.h>
#include "data/data_util.h"

int ted4_point_cloud_alloc(ted4_point_cloud *c, size_t n)
{
    c->xyz = calloc(n + 1, 3 * sizeof *c->xyz);
    c->rgb = calloc(n + 1, 3);
    c->n = n;
    if (c->xyz != NULL && c->rgb != NULL)
        return 0;
    ted4_point_cloud_free(c);
    return -1;
}

void ted4_point_cloud_free(ted4_point_cloud *c)
{
    free(c->xyz);
    free(c->rgb);
    memset(c, 0, sizeof *c);
}

int ted4_ply_find(ted4_point_cloud *c, const char *folder, ted4_message *m)
{
    static const char *const names[] = {
        "points3D_downsample.ply",
        "points3D_downsample2.ply",
        "points3d.ply",
        "points3D.ply",
        "fused.ply",
        "sparse.ply",
        "colmap/dense/workspace/fused.ply",
    };

    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        char *path = ted4_path_join(folder, names[i]);
        if (path == NULL)
            return ted4_say_no_memory(m);
        const int found = ted4_is_file(path);
        const int result = found ? ted4_ply_read(c, path, m) : 0;
        free(path);
        if (found)
            return result;
    }
    return 0;
}

int ted4_point_cloud_random(ted4_point_cloud *c, const double centre[3], double half, uint32_t seed)
{
    uint64_t state = seed;

    if (ted4_point_cloud_alloc(c, TED4_RANDOM_POINTS) != 0)
        return -1;
    for (size_t i = 0; i < 3 * c->n; i++)
        c->xyz[i] = (float)(centre[i % 3] + half * (2 * ted4_split_uniform(&state) - 1));
    memset(c->rgb, TED4_POINT_GREY, 3 * c->n);
    return 0;
}
