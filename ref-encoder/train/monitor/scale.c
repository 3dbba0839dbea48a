/* scale.c - tracks the usual size of a number (scale.h).
 * SPDX-License-Identifier: BSD-2-Clause */
#include "scale.h"

#include <math.h>

#include "math/elementary.h"

/* A scale moves by at most this factor (log2) per step. At first it moves faster, and nothing is
 * judged by it. */
#define SCALE_STEP  0.05
#define SCALE_FIRST 0.5
enum { SCALE_NEW = 100 };

double ted4_scale_usual(const ted4_scale *s)
{
    return s->n > 0 ? ted4_math_exp2(s->level) : 0.0;
}

double ted4_scale_take(ted4_scale *s, double x)
{
    if (!(x > 0))
        return 0;

    const double away = ted4_math_log2(x) - s->level,
                 most = s->n < SCALE_NEW ? SCALE_FIRST : SCALE_STEP;
    const double times = s->n < SCALE_NEW ? 0.0 : ted4_math_exp2(away);

    s->level += s->n == 0 ? away : fmin(fmax(away, -most), most);
    s->n++;
    s->peak = fmax(s->peak, times);
    return times;
}
