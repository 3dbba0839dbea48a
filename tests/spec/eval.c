/* eval.c - the records of a query by one variant of the code that the specification prints.
 * Compiled once for each evaluation of annex E, with
 * VARIANT: the header, REAL: its floating-point type, RECORDS: the name of the function. See
 * spec_tolerance.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include "names.h"

#pragma GCC diagnostic ignored "-Wunused-function"
#include VARIANT

size_t RECORDS(const void *scene, uint32_t num, uint32_t den, const float *camera,
               float (*out)[14]);

size_t RECORDS(const void *scene, uint32_t num, uint32_t den, const float *camera, float (*out)[14])
{
    const struct scene *s = scene;
    const REAL c[3] = { camera[0], camera[1], camera[2] };
    REAL record[16][14];
    struct net net[NETS_R];
    size_t n = 0;

    (void)nets_r(&s->h, net);
    for (size_t a = 0; a < (size_t)s->h.n_anchors; a++) {
        const int k = anchor_records(s, net, a, num, den, c, record);

        for (int i = 0; i < k; i++, n++)
            for (int j = 0; j < 14; j++)
                out[n][j] = (float)record[i][j];
    }
    return n;
}
