/* camera_colour.c - applies, inverts and centres the colour maps of the cameras, and computes
 * their gradients (camera_colour.h).
 * SPDX-License-Identifier: BSD-2-Clause */
#include "camera_colour.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "camera_colour_job.h"
#include "middle.h"

enum { BAND = TED4_COLOUR_BAND };

enum { N = TED4_COLOUR_VALUES, ROW_V = TED4_COLOUR_ROW_V };

static size_t n_bands(size_t pixels)
{
    return (pixels + BAND - 1) / BAND;
}

static size_t least(size_t a, size_t b)
{
    return a < b ? a : b;
}

/* Marks the cameras that took at least two training pictures. Returns their number. */
static size_t choose(uint8_t *corrected, const ted4_dataset *d)
{
    size_t n = 0;

    for (size_t i = 0; i < d->n_pictures; i++) {
        uint8_t *seen = &corrected[d->pictures[i].camera_id];

        if (!d->pictures[i].is_test && *seen < 2)
            ++*seen;
    }
    for (size_t k = 0; k < d->n_cameras; k++) {
        corrected[k] = corrected[k] == 2;
        n += corrected[k];
    }
    return n;
}

static size_t largest_picture(const ted4_dataset *d)
{
    size_t largest = 0;

    for (size_t i = 0; i < d->n_pictures; i++) {
        const ted4_camera *c = &d->pictures[i].camera;
        const size_t n = (size_t)c->width * (size_t)c->height;

        largest = n > largest ? n : largest;
    }
    return largest;
}

static int reserve(ted4_colour *c, size_t pixels)
{
    const size_t n = c->n_cameras;

    c->steps = calloc(n, sizeof *c->steps);
    c->value = calloc(n, sizeof *c->value);
    c->m = calloc(n, sizeof *c->m);
    c->v = calloc(n, sizeof *c->v);
    c->image = malloc(3 * pixels * sizeof *c->image);
    c->seen = malloc(3 * pixels);
    c->sums = malloc(n_bands(pixels) * N * sizeof *c->sums);
    c->sorted = malloc(n * sizeof *c->sorted);
    return c->steps != NULL && c->value != NULL && c->m != NULL && c->v != NULL &&
                   c->image != NULL && c->seen != NULL && c->sums != NULL && c->sorted != NULL
               ? 0
               : -1;
}

int ted4_colour_init(ted4_colour *c, const ted4_dataset *d)
{
    memset(c, 0, sizeof *c);
    if (d->n_cameras < 2)
        return 0;
    c->corrected = calloc(d->n_cameras, 1);
    if (c->corrected == NULL)
        return -1;
    c->n_cameras = d->n_cameras;
    c->n_corrected = choose(c->corrected, d);
    if (c->n_corrected < 2) {
        ted4_colour_finish(c);
        return 0;
    }
    return reserve(c, largest_picture(d));
}

void ted4_colour_finish(ted4_colour *c)
{
    ted4_exposure_finish(&c->exposure);
    free(c->corrected);
    free(c->steps);
    free(c->value);
    free(c->m);
    free(c->v);
    free(c->image);
    free(c->seen);
    free(c->sums);
    free(c->sorted);
    memset(c, 0, sizeof *c);
}

int ted4_colour_has(const ted4_colour *c, uint32_t camera)
{
    return camera < c->n_cameras && c->corrected[camera];
}

int ted4_colour_finite(const ted4_colour *c)
{
    for (size_t i = 0; i < c->n_cameras; i++)
        for (int k = 0; k < N; k++)
            if (!isfinite(c->value[i][k]))
                return 0;
    return ted4_exposure_finite(&c->exposure);
}

void ted4_colour_at(const ted4_colour *c, uint32_t camera, uint32_t frame, ted4_colour_map map)
{
    float gain[3];

    memcpy(map, c->value[camera], sizeof c->value[camera]);
    if (c->exposure.n_knots == 0)
        return;
    ted4_exposure_at(&c->exposure, camera, frame, gain);
    for (int k = 0; k < N; k++)
        map[k] += gain[k % 3] * (map[k] + (k < ROW_V && k % 4 == 0 ? 1.0f : 0.0f));
}

void ted4_colour_split(const ted4_colour *c, uint32_t camera, uint32_t frame,
                       ted4_colour_map gradient, float d_gain[3])
{
    const float *x = c->value[camera];
    float gain[3] = { 0 };

    if (c->exposure.n_knots > 0)
        ted4_exposure_at(&c->exposure, camera, frame, gain);
    for (int k = 0; k < 3; k++)
        d_gain[k] = 0;
    for (int k = 0; k < N; k++) {
        /* in ted4_colour_at this was: map = x + gain (x + 1 on the diagonal) */
        d_gain[k % 3] += gradient[k] * (x[k] + (k < ROW_V && k % 4 == 0 ? 1.0f : 0.0f));
        gradient[k] *= 1.0f + gain[k % 3];
    }
}

const float *ted4_colour_apply(ted4_colour *c, const float *map, const float *image, size_t pixels,
                               const ted4_parallel *p)
{
    ted4_colour_job j = { .image = image, .map = map, .to = c->image, .pixels = pixels };

    ted4_parallel_for(p, n_bands(pixels), TED4_IN_USE(ted4_colour_apply_band), &j);
    return c->image;
}

/* Smallest magnitude of det(I + A) for which the map is inverted. */
#define LEAST_DETERMINANT 0.1

/* The inverse is computed from cofactors. */
int ted4_colour_invert(const float *a, double inverse[9])
{
    double m[9], det = 0;

    for (int k = 0; k < 9; k++)
        m[k] = (double)a[k] + (k % 4 == 0);
    for (int r = 0; r < 3; r++)
        for (int k = 0; k < 3; k++) {
            const int r1 = (r + 1) % 3, r2 = (r + 2) % 3, k1 = (k + 1) % 3, k2 = (k + 2) % 3;

            inverse[3 * k + r] = m[3 * r1 + k1] * m[3 * r2 + k2] - m[3 * r1 + k2] * m[3 * r2 + k1];
        }
    for (int k = 0; k < 3; k++)
        det += m[k] * inverse[3 * k];
    for (int k = 0; k < 9; k++)
        inverse[k] /= det;
    return fabs(det) >= LEAST_DETERMINANT ? 0 : -1;
}

typedef struct {
    const uint8_t *picture;
    uint8_t *to;
    size_t pixels;
    double inverse[9], v[3];
} undo_job;

static void undo_band(void *arg, size_t band)
{
    const undo_job *j = arg;
    const double *m = j->inverse;

    for (size_t i = band * BAND; i < least((band + 1) * BAND, j->pixels); i++) {
        double c[3];

        for (int k = 0; k < 3; k++)
            c[k] = (double)j->picture[3 * i + (size_t)k] - 255.0 * j->v[k];
        for (int k = 0; k < 3; k++)
            j->to[3 * i + (size_t)k] = (uint8_t)fmin(
                fmax(c[0] * m[k] + c[1] * m[3 + k] + c[2] * m[6 + k] + 0.5, 0.0), 255.0);
    }
}

const uint8_t *ted4_colour_undo(ted4_colour *c, const float *map, const uint8_t *picture,
                                size_t pixels, const ted4_parallel *p)
{
    undo_job j = { .picture = picture,
                   .to = c->seen,
                   .pixels = pixels,
                   .v = { (double)map[ROW_V], (double)map[ROW_V + 1], (double)map[ROW_V + 2] } };

    if (ted4_colour_invert(map, j.inverse) != 0)
        return picture;
    ted4_parallel_for(p, n_bands(pixels), undo_band, &j);
    return c->seen;
}

void ted4_colour_backward(ted4_colour *c, const float *map, const float *image, size_t pixels,
                          const ted4_parallel *p, float *d_image, ted4_colour_map gradient)
{
    ted4_colour_job j = { image, map, d_image, c->sums, pixels };

    ted4_parallel_for(p, n_bands(pixels), TED4_IN_USE(ted4_colour_backward_band), &j);
    for (int k = 0; k < N; k++) {
        double sum = 0;

        for (size_t band = 0; band < n_bands(pixels); band++)
            sum += c->sums[band * N + (size_t)k];
        gradient[k] = (float)sum;
    }
}

/* Returns the middle of value k over the corrected cameras. */
static double middle_of(ted4_colour *c, int k)
{
    size_t n = 0;

    for (size_t i = 0; i < c->n_cameras; i++)
        if (c->corrected[i])
            c->sorted[n++] = c->value[i][k];
    return ted4_middle(c->sorted, n);
}

void ted4_colour_centre(ted4_colour *c)
{
    for (int k = 0; k < N; k++) {
        const float off = (float)middle_of(c, k) - c->middle[k];

        for (size_t i = 0; i < c->n_cameras; i++)
            if (c->corrected[i])
                c->value[i][k] -= off;
    }
}

/* (I + A') = diag(1 / gain) (I + A). */
void ted4_colour_regauge(ted4_colour *c, const double *gain)
{
    for (size_t i = 0; i < c->n_cameras; i++)
        for (int k = 0; k < ROW_V && c->corrected[i]; k++) {
            const double one = k % 4 == 0;

            c->value[i][k] = (float)((one + (double)c->value[i][k]) / gain[k / 3] - one);
        }
    for (int k = 0; k < N; k++)
        c->middle[k] = (float)middle_of(c, k);
}
