/* train_record.c - see train_record.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "train_record.h"

#include "measure.h"
#include "math/compare.h"
#include "train/step/trainer_init.h"

void record_init(train_record *r, int steps, size_t members)
{
    memset(r, 0, sizeof *r);
    r->steps = steps;
    r->members = members;
    for (int stage = 0; stage < STAGES; stage++)
        r->sample[stage] = must(malloc((size_t)steps * members * sizeof *r->sample[stage]));
}

void record_free(train_record *r)
{
    for (int stage = 0; stage < STAGES; stage++)
        free(r->sample[stage]);
}

static void one_step(train_record *r, ted4_trainer *t, record_step step, double *sample)
{
    int stage = 0;

    step(t, sample);
    stage = parts_stage(t);
    if (r->n[stage] < (size_t)r->steps)
        memcpy(r->sample[stage] + r->n[stage]++ * r->members, sample, r->members * sizeof *sample);
    r->anchors[stage] = t->anchors.n;
    r->splats[stage] = t->progress.splats;
}

void record_training(train_record *r, ted4_dataset *d, const ted4_parallel *team, record_step step)
{
    double *sample = must(malloc(r->members * sizeof *sample));
    ted4_train_options o;
    ted4_trainer t;

    memset(r->n, 0, sizeof r->n);
    parts_options(&o, r->steps);
    if (ted4_trainer_init(&t, &o, d, team) != 0)
        parts_fail(&t.message);
    while (t.iteration < ted4_trainer_total(&t))
        one_step(r, &t, step, sample);
    ted4_trainer_finish(&t);
    free(sample);
}

void record_medians(const train_record *r, int stage, double *median)
{
    const size_t first = r->n[stage] > 2 * RECORD_WARM_UP ? RECORD_WARM_UP : 0;
    const size_t n = r->n[stage] - first;
    const double *sample = r->sample[stage] + first * r->members;
    double *value = must(malloc((n + 1) * sizeof *value));

    for (size_t i = 0; i < r->members; i++) {
        for (size_t k = 0; k < n; k++)
            value[k] = sample[k * r->members + i];
        qsort(value, n, sizeof *value, ted4_compare_doubles);
        median[i] = n > 0 ? value[n / 2] : 0;
    }
    free(value);
}

void record_print_title(const train_record *r, const ted4_dataset *d, char *const *argv)
{
    const ted4_camera *c = &d->pictures[0].camera;
    const char *name = strrchr(argv[1], '/') != NULL ? strrchr(argv[1], '/') + 1 : argv[1];

    printf("%s, 1/%s size: %dx%d, %zu pictures; preset fast, full number of anchors from the first "
           "step; medians of %d steps",
           name, argv[2], c->width, c->height, d->n_pictures, r->steps - RECORD_WARM_UP);
}

void record_print_stage(const train_record *r, int stage)
{
    printf("%s: %zu anchors, %.0f Gaussians on screen\n", stage_name[stage], r->anchors[stage],
           r->splats[stage]);
}
