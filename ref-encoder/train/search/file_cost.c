/* file_cost.c - measures the rate-distortion cost of a model by coding its file and rendering from
 * it: see file_cost.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "file_cost.h"

#include <stdlib.h>

#include "train/state/picture.h"
#include "train/monitor/checkpoint.h"
#include "train/state/view_subset.h"
#include "train/step/export_scene.h"
#include "write/encode.h"

/* LEAST_PICTURES and MOST_PICTURES bound the number of pictures that are rendered, which is one per
 * frame. The times of rendering one and of coding a file are in training steps, as measured on
 * kitchen at a quarter of its size. */
enum { LEAST_PICTURES = 16, MOST_PICTURES = 24 };
#define STEPS_A_PICTURE 0.4
#define STEPS_A_FILE    4.0
/* A decision at the end of stage 2 is skipped unless the budget of all trials is at least this many
 * times what the decision takes. */
#define SAFETY_FACTOR   3.0

static size_t subset_size(const ted4_trainer *t)
{
    const size_t frames = ted4_view_subset_frames(t);
    const size_t n = frames < LEAST_PICTURES  ? LEAST_PICTURES
                     : frames > MOST_PICTURES ? MOST_PICTURES
                                              : frames;

    return n < t->order.n ? n : t->order.n;
}

double ted4_file_cost_steps(const ted4_trainer *t)
{
    return STEPS_A_FILE + STEPS_A_PICTURE * (double)subset_size(t);
}

double ted4_search_budget(const ted4_trainer *t)
{
    return t->opt.capacity_share * (double)ted4_trainer_total(t);
}

double ted4_search_afford(const ted4_trainer *t, double steps)
{
    return SAFETY_FACTOR * steps <= ted4_search_budget(t) ? steps : 0;
}

int ted4_search_note(ted4_trainer *t, const struct ted4_trial *x)
{
    struct ted4_trial *more = realloc(t->search.trial, (t->search.n_trials + 1) * sizeof *more);

    if (more == NULL)
        return ted4_trainer_fail(t, "no memory to note a trial");
    t->search.trial = more;
    more[t->search.n_trials++] = *x;
    return 0;
}

/* Counts the bytes of the file. Leaves the trainer at the end of stage 2. */
static int count_bytes(ted4_trainer *t, double *bytes)
{
    ted4_scene *scene;
    uint8_t *file;
    size_t size;
    ted4_error e = { TED4_OK, 0 };

    if (ted4_export_scene(t, &scene) != 0)
        return -1;

    const int bad = ted4_encode(scene, 0, t->parallel, &file, &size, &e) != TED4_OK;

    ted4_scene_free(scene);
    if (bad)
        return ted4_trainer_fail(t, "a trial's file was refused: %s", ted4_status_id(e.code));
    free(file);
    *bytes = (double)size;
    return 0;
}

/* lambda weighs the mean bits per value, so it is divided by the number of all values. */
double ted4_lambda_per_bit(const ted4_trainer *t)
{
    return t->opt.lambda / (ted4_rate_norm(t) * (double)(t->anchors.n > 0 ? t->anchors.n : 1));
}

static int measure(ted4_trainer *t, ted4_cost *c)
{
    const size_t n = subset_size(t);
    uint32_t item[MOST_PICTURES];

    if (count_bytes(t, &c->bytes) != 0 ||
        ted4_view_subset_choose(t, t->opt.seed ^ 0x6a75646765u, n, item) != 0)
        return -1;
    c->distortion = 0;
    for (size_t i = 0; i < n; i++) {
        const double d = ted4_trainer_distortion(t, item[i]);

        if (d < 0)
            return -1;
        c->distortion += d / (double)n;
    }
    c->cost = c->distortion + 8.0 * ted4_lambda_per_bit(t) * c->bytes;
    return 0;
}

int ted4_file_cost(ted4_trainer *t, ted4_cost *c)
{
    ted4_snapshot before = { 0 };
    int bad = ted4_state_take(t, &before) != 0 || measure(t, c) != 0;

    bad = bad || ted4_state_restore(t, &before) != 0;
    ted4_snapshot_free(&before);
    return bad || ted4_trainer_report(t, ted4_file_cost_steps(t)) != 0 ? -1 : 0;
}
