/* attributes.c - the mean position and the number of visible Gaussians of every frame of a file.
 *     cc attributes.c $(pkg-config --cflags --libs ted4)
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdio.h>
#include "read_file.h"

/* Ends the program if a call has failed. */
static void check(ted4_status s)
{
    if (s == TED4_OK)
        return;
    fprintf(stderr, "%s: %s\n", ted4_status_id(s), ted4_status_text(s));
    exit(1);
}

int main(int argc, char **argv)
{
    size_t size;
    unsigned char *data = read_file(argc, argv, &size);
    ted4_scene *scene;
    ted4_recon *recon;
    ted4_info info;

    check(ted4_decode(data, size, NULL, &scene, NULL));
    check(ted4_recon_new(&recon, scene, NULL));
    ted4_scene_info(scene, &info);
    for (uint32_t frame = 0; frame < info.frames; frame++) {
        /* Up to 2^24 frames; more of them need R-HDR-005. */
        const ted4_query q = { frame, info.frames > 1 ? info.frames - 1 : 1, { 0, 0, 0 } };
        ted4_gaussians g;
        double sum[3] = { 0, 0, 0 };
        size_t visible = 0;

        check(ted4_recon_query(recon, &q, NULL, &g));
        for (size_t i = 0; i < g.n; i++) {
            visible += g.opacity[i] > 1.0f / 255;
            for (int c = 0; c < 3; c++)
                sum[c] += g.mean[c][i];
        }
        printf("frame %u: %zu of %zu visible", (unsigned)frame, visible, g.n);
        if (g.n > 0)
            printf(", mean %.3f %.3f %.3f", sum[0] / (double)g.n, sum[1] / (double)g.n,
                   sum[2] / (double)g.n);
        putchar('\n');
    }
    ted4_recon_free(recon);
    ted4_scene_free(scene);
    free(data);
    return 0;
}
