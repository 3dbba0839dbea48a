/* viewpoints.c - see viewpoints.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "viewpoints.h"

#include <math.h>
#include <string.h>

#include "photo_votes.h"
#include "train/model/normalise.h"

/* Viewpoints are distinct if they are at least APART radians apart, as seen from the middle of the
 * scene. One that is nearer to the middle than NEAREST is treated as if it were at that distance.
 */
#define APART   0.05f
#define NEAREST 0.25f

static int are_apart(const float a[3], const float b[3])
{
    float square = 0, other = 0;
    const float far = NEAREST * NEAREST;

    for (int k = 0; k < 3; k++) {
        square += (a[k] - b[k]) * (a[k] - b[k]);
        other += a[k] * a[k];
    }
    return square >= APART * APART * fmaxf(far, other);
}

int ted4_has_viewpoints(const ted4_trainer *t)
{
    const ted4_dataset *d = t->data;
    float found[TED4_CAMERAS_NEEDED][3], centre[3];
    int n = 0;

    for (size_t i = 0; i < d->n_pictures && n < TED4_CAMERAS_NEEDED; i++) {
        ted4_view v;
        int is_new = !d->pictures[i].is_test;

        ted4_normalise_view(&t->layout.head, &d->pictures[i].camera, &v, centre);
        for (int k = 0; k < n; k++)
            is_new &= are_apart(found[k], centre);
        if (is_new)
            memcpy(found[n++], centre, sizeof centre);
    }
    return n == TED4_CAMERAS_NEEDED;
}
