/* widen.c - see widen.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "widen.h"

#include <math.h>
#include <stdlib.h>

/* Lowers seen[i] to the width of a pixel of v at Gaussian i if v sees it, that is, as far beside
 * the picture as I.2, step 4, goes; and away[i] to the width at the same distance in any direction.
 */
static void look(const ted4_view *v, float near_z, size_t n, const float *const mean[3],
                 float *restrict seen, float *restrict away)
{
    const float *const R = v->R, *const t = v->t;
    const float reach_x = TED4_RASTER_GUARD * 0.5f * (float)v->width / v->fx,
                reach_y = TED4_RASTER_GUARD * 0.5f * (float)v->height / v->fy;
    const float middle_x = (0.5f * (float)v->width - v->cx) / v->fx,
                middle_y = (0.5f * (float)v->height - v->cy) / v->fy;

    for (size_t i = 0; i < n; i++) {
        const float x = R[0] * mean[0][i] + R[1] * mean[1][i] + R[2] * mean[2][i] + t[0],
                    y = R[3] * mean[0][i] + R[4] * mean[1][i] + R[5] * mean[2][i] + t[1],
                    z = R[6] * mean[0][i] + R[7] * mean[1][i] + R[8] * mean[2][i] + t[2];
        const int is_seen = z > near_z && fabsf(x - middle_x * z) <= reach_x * z &&
                            fabsf(y - middle_y * z) <= reach_y * z;
        const float width = is_seen ? z / v->fx : INFINITY;

        seen[i] = fminf(seen[i], width);
        away[i] = fminf(away[i], sqrtf(x * x + y * y + z * z) / v->fx);
    }
}

int ted4_widen(const ted4_camera_list *taken, float near_z, size_t n, const float *const mean[3],
               float *const scale[3])
{
    float *const seen = malloc(2 * (n + 1) * sizeof *seen), *const away = seen + n + 1;

    if (seen == NULL)
        return -1;
    for (size_t i = 0; i < n; i++)
        seen[i] = away[i] = INFINITY;
    for (size_t c = 0; c < taken->n; c++)
        look(&taken->camera[c].view, near_z, n, mean, seen, away);
    for (size_t i = 0; i < n; i++) {
        const float width = sqrtf(TED4_RASTER_BLUR) * (seen[i] < INFINITY ? seen[i] : away[i]);

        for (int k = 0; k < 3; k++) {
            const float wide = hypotf(scale[k][i], width);

            if (wide < INFINITY)
                scale[k][i] = wide;
        }
    }
    free(seen);
    return 0;
}
