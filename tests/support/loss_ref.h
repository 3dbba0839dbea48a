/* loss_ref.h - the distortion of train/loss/loss.h computed by its definition, in double precision,
 * one pixel at a time: the reference of test_loss.c, test_extremes_loss.c and test_step_grad.c.
 * Shares no code with train/.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_LOSS_REF_H
#define TED4_LOSS_REF_H

#include <math.h>
#include <stddef.h>
#include <stdint.h>

enum { REF_RADIUS = 5 };

/* image: planar [3][height][width]; truth: interleaved bytes. */
typedef struct {
    int width, height;
    const double *image;
    const uint8_t *truth;
} ref_picture;

static inline size_t ref_pixel(const ref_picture *p, int c, int y, int x)
{
    return ((size_t)c * (size_t)p->height + (size_t)y) * (size_t)p->width + (size_t)x;
}

static inline double ref_truth(const ref_picture *p, int c, int y, int x)
{
    return p->truth[((size_t)y * (size_t)p->width + (size_t)x) * 3 + (size_t)c] / 255.0;
}

static inline double ref_absolute(const ref_picture *p, int c, int y, int x, double delta)
{
    return fabs(p->image[ref_pixel(p, c, y, x)] + delta - ref_truth(p, c, y, x));
}

/* The Gaussian window, not normalised. */
static inline const double *ref_window(void)
{
    static double window[2 * REF_RADIUS + 1];

    if (window[0] <= 0.0)
        for (int i = -REF_RADIUS; i <= REF_RADIUS; i++)
            window[i + REF_RADIUS] = exp(-(i * i) / (2.0 * 1.5 * 1.5));
    return window + REF_RADIUS;
}

/* SSIM at one pixel by the definition; delta is added to the image at (cy, cx). */
static inline double ref_ssim(const ref_picture *p, int c, int y, int x, int cy, int cx,
                              double delta)
{
    const double *window = ref_window();
    double weight = 0.0, mx = 0.0, my = 0.0, xx = 0.0, yy = 0.0, xy = 0.0;

    for (int i = -REF_RADIUS; i <= REF_RADIUS; i++) {
        for (int k = -REF_RADIUS; k <= REF_RADIUS; k++) {
            const double g = window[i] * window[k];
            const int r = y + i, s = x + k;

            weight += g;
            if (r < 0 || s < 0 || r >= p->height || s >= p->width)
                continue;
            const double a = p->image[ref_pixel(p, c, r, s)] + (r == cy && s == cx ? delta : 0.0);
            const double b = ref_truth(p, c, r, s);

            mx += g * a;
            my += g * b;
            xx += g * a * a;
            yy += g * b * b;
            xy += g * a * b;
        }
    }
    mx /= weight;
    my /= weight;
    const double vx = xx / weight - mx * mx, vy = yy / weight - my * my;
    const double cov = xy / weight - mx * my;

    return (2.0 * mx * my + 1e-4) * (2.0 * cov + 9e-4) /
           ((mx * mx + my * my + 1e-4) * (vx + vy + 9e-4));
}

/* The part of L that depends on the image at (c, y, x), multiplied by the number of values. */
static inline double ref_local_loss(const ref_picture *p, double w, int c, int y, int x,
                                    double delta)
{
    double loss = (1.0 - w) * ref_absolute(p, c, y, x, delta);

    for (int r = y - REF_RADIUS; r <= y + REF_RADIUS; r++)
        for (int s = x - REF_RADIUS; s <= x + REF_RADIUS; s++)
            if (r >= 0 && s >= 0 && r < p->height && s < p->width)
                loss -= w * ref_ssim(p, c, r, s, y, x, delta);
    return loss;
}

/* *l1 and *ssim: means over pixels and channels. Returns (1 - w) L1 + w (1 - SSIM). */
static inline double ref_distortion(const ref_picture *p, double w, double *l1, double *ssim)
{
    const double count = 3.0 * p->width * p->height;

    *l1 = *ssim = 0.0;
    for (int c = 0; c < 3; c++)
        for (int y = 0; y < p->height; y++)
            for (int x = 0; x < p->width; x++) {
                *l1 += ref_absolute(p, c, y, x, 0.0) / count;
                *ssim += ref_ssim(p, c, y, x, -1, -1, 0.0) / count;
            }
    return (1.0 - w) * *l1 + w * (1.0 - *ssim);
}

#endif
