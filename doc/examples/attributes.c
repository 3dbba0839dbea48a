/* attributes.c - the mean position and the number of visible Gaussians of every frame of a file.
 *     cc attributes.c $(pkg-config --cflags --libs ted4)
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdio.h>
#include "read_file.h"

int main(int argc, char **argv)
{
    size_t size;
    unsigned char *data = read_file(argc, argv, &size);
    ted4_error e;
    ted4_scene *scene;
    ted4_recon *recon;
    ted4_info info;

    if (ted4_decode(data, size, NULL, &scene, &e) != TED4_OK ||
        ted4_recon_new(&recon, scene, NULL) != TED4_OK)
        return 1;
    ted4_scene_info(scene, &info);
    for (uint32_t frame = 0; frame < info.frames; frame++) {
        const ted4_query q = { frame, info.frames > 1 ? info.frames - 1 : 1, { 0, 0, 0 } };
        ted4_gaussians g;
        double sum[3] = { 0, 0, 0 };
        size_t visible = 0;

        if (ted4_recon_query(recon, &q, NULL, &g) != TED4_OK)
            return 1;
        for (size_t i = 0; i < g.n; i++) {
            visible += g.opacity[i] > 1.0f / 255;
            for (int c = 0; c < 3; c++)
                sum[c] += g.mean[c][i];
        }
        printf("frame %u: %zu visible, mean %.3f %.3f %.3f\n", (unsigned)frame, visible,
               sum[0] / (double)g.n, sum[1] / (double)g.n, sum[2] / (double)g.n);
    }
    ted4_recon_free(recon);
    ted4_scene_free(scene);
    free(data);
    return 0;
}
