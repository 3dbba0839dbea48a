/* threads.c - lends OpenMP's threads to the library, which starts none itself. The results do not
 * depend on their number.
 *     cc -fopenmp threads.c $(pkg-config --cflags --libs ted4)
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdio.h>
#include "read_file.h"

static void run(void *user, size_t n, void (*body)(void *arg, size_t i), void *arg)
{
    (void)user;
#pragma omp parallel for schedule(dynamic)
    for (size_t i = 0; i < n; i++)
        body(arg, i);
}

int main(int argc, char **argv)
{
    size_t size;
    unsigned char *data = read_file(argc, argv, &size);
    const ted4_parallel threads = { run, NULL };
    const ted4_query q = { 0, 1, { 0, 0, 0 } };
    ted4_options options = { 0 };
    ted4_error e;
    ted4_scene *scene;
    ted4_recon *recon;
    ted4_gaussians g;
    uint8_t hash[16];

    options.parallel = &threads;
    if (ted4_decode(data, size, &options, &scene, &e) != TED4_OK ||
        ted4_recon_new(&recon, scene, &options) != TED4_OK ||
        ted4_recon_query(recon, &q, &threads, &g) != TED4_OK)
        return 1;
    ted4_gaussians_hash(&g, hash);
    for (int i = 0; i < 16; i++)
        printf("%02x", hash[i]);
    printf("\n");
    ted4_recon_free(recon);
    ted4_scene_free(scene);
    free(data);
    return 0;
}
