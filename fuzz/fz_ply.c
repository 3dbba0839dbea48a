/* fz_ply.c - a PLY point cloud. Claims: the result is at most as many points as the bytes can hold,
 * all finite; or a message and no point.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include "data/point_cloud.h"
#include "harness.h"
#include "scene_folder.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    ted4_point_cloud c = { NULL, NULL, 0 };
    ted4_message m;

    (void)fuzz_scene("ply");
    if (ted4_ply_read(&c, fuzz_file("points.ply", data, size), &m) == 0) {
        fuzz_require(c.n <= size, "points that the bytes hold");
        for (size_t i = 0; i < 3 * c.n; i++)
            fuzz_require(isfinite(c.xyz[i]), "finite");
        ted4_point_cloud_free(&c);
    } else {
        fuzz_check_message(&m);
        fuzz_require(c.xyz == NULL && c.rgb == NULL && c.n == 0, "no point");
    }
    return 0;
}
