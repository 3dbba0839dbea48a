/* trainer.c - messages, progress and numbers of a trainer: see trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "trainer.h"

#include <stdarg.h>

#include "train/model/normalise.h"

int ted4_trainer_fail(ted4_trainer *t, const char *format, ...)
{
    va_list arguments;

    va_start(arguments, format);
    vsnprintf(t->message.text, sizeof t->message.text, format, arguments);
    va_end(arguments);
    return -1;
}

void ted4_trainer_busy(ted4_trainer *t, ted4_busy busy, double budget)
{
    t->onlooker.busy = busy;
    t->onlooker.spent = 0;
    t->onlooker.budget = budget;
}

int ted4_trainer_report(ted4_trainer *t, double spent)
{
    ted4_onlooker *o = &t->onlooker;

    o->spent += spent;
    if (o->look == NULL || o->look(o->user) == 0 || o->busy == TED4_BUSY_TRAINING)
        return 0;
    o->stopped = 1;
    return ted4_trainer_fail(t, "stopped");
}

void ted4_trainer_view(const ted4_trainer *t, const ted4_picture *pic, ted4_view *v,
                       float centre[3])
{
    ted4_camera camera = pic->camera;

    if (t->poses.n > 0)
        ted4_pose_move(&t->poses, (size_t)(pic - t->data->pictures), &camera);
    ted4_normalise_view(&t->layout.head, &camera, v, centre);
}

double ted4_rate_norm(const ted4_trainer *t)
{
    ted4_shape s;
    double sum = 0;

    ted4_shape_make(&s, &t->phase.rate_norm_header);
    for (int y = 0; y < TED4_TYPES; y++)
        sum += s.dim[y];
    return sum;
}

uint64_t ted4_trainer_total(const ted4_trainer *t)
{
    return (uint64_t)t->opt.stage1 + (uint64_t)t->opt.stage2;
}

uint64_t ted4_stage_position(const ted4_trainer *t)
{
    return t->phase.stage2 ? t->iteration - t->phase.stage2_start : t->iteration;
}

int ted4_at_stage1_end(const ted4_trainer *t)
{
    return !t->phase.stage2 && ted4_stage_position(t) == (uint64_t)t->opt.stage1;
}

/* The sum of all values times 0 is 0 unless one of them is infinite or not a number. */
static int all_finite(const float *x, size_t n)
{
    float sum = 0;

#pragma omp simd reduction(+ : sum)
    for (size_t i = 0; i < n; i++)
        sum += x[i] * 0.0f;
    return sum == 0.0f;
}

int ted4_trainer_check(ted4_trainer *t, int anchors)
{
    const unsigned long long now = t->iteration;

    if (!all_finite(t->net.value, t->layout.n_net))
        return ted4_trainer_fail(t, "a network weight is not finite at step %llu", now);
    if (anchors && !all_finite(t->anchors.data[TED4_ROW_VALUE],
                               t->anchors.n_blocks * (size_t)t->layout.n_channels * TED4_LANES))
        return ted4_trainer_fail(t, "an anchor's value is not finite at step %llu", now);
    if (anchors && !all_finite(t->anchors.data[TED4_ROW_POSITION],
                               t->anchors.n_blocks * (size_t)3 * TED4_LANES))
        return ted4_trainer_fail(t, "an anchor's position is not finite at step %llu", now);
    if (!ted4_poses_finite(&t->poses))
        return ted4_trainer_fail(t, "a pose is not finite at step %llu", now);
    return ted4_colour_finite(&t->colour)
               ? 0
               : ted4_trainer_fail(t, "a colour map is not finite at step %llu", now);
}
