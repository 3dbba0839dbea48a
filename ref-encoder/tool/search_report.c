/* search_report.c - see search_report.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "search_report.h"

#include <stdio.h>
#include <stdlib.h>

#include "data/flicker.h"
#include "tool/plural.h"
#include "train/search/candidates.h"
#include "train/state/anchor_masks.h"
#include "train/state/dropout.h"

static void put_time(FILE *f, const ted4_trainer *t)
{
    const double *loss = t->search.probe_loss;
    const int timed = t->layout.head.motion != TED4_MOTION_NONE || t->layout.head.activation;

    if (loss[0] > 0)
        fprintf(f, "capacity.time=%s: loss %.6f with it, %.6f without\n",
                timed ? "needed" : "not needed", loss[0], loss[1]);
}

static void put_dropout(FILE *f, const ted4_trainer *t)
{
    const double most = ted4_dropout_most(t);

    if (most > 0)
        fprintf(f, "capacity.dropout=%.3g of the anchors at most; %.3g cameras per time\n", most,
                t->order.cameras);
}

static void put_light(FILE *f, const ted4_trainer *t)
{
    const double flicker = ted4_dataset_flicker(t->data);

    if (flicker >= TED4_FLICKER_SEEN)
        fprintf(
            f,
            "capacity.light=flickers by %.1f levels; trained with a bank of %d rows for %u times\n",
            flicker, t->opt.bank_rows, t->data->n_frames);
}

/* No trial decides which anchors move: training does, and the closing of still anchors. */
static void put_moving(FILE *f, const ted4_trainer *t)
{
    const ted4_closing *c = &t->closing;

    if (!t->opt.capacity || t->layout.head.motion == TED4_MOTION_NONE ||
        !t->layout.head.temporal_mask)
        return;
    fprintf(
        f,
        "capacity.moving=%zu of %zu anchor%s: masks learn in every step whether motion is worth "
        "its bits",
        ted4_count_dynamic(t), t->anchors.n, ted4_s(t->anchors.n));
    if (c->moving > 0)
        fprintf(f, ", and in stage 1 the motion of %llu of %llu explained nothing",
                (unsigned long long)c->closed, (unsigned long long)c->moving);
    fprintf(f, "\n");
}

static void put_trial(FILE *f, size_t number, const struct ted4_trial *x)
{
    fprintf(f,
            "capacity.%03zu=%s, %lld to %lld: %s; cost %.6f to %.6f, distortion %.6f to %.6f, %.0f "
            "to %.0f bytes; ",
            number, ted4_candidate_name((ted4_candidate)x->candidate), (long long)x->from,
            (long long)x->to, x->taken ? "taken" : "left", x->before.cost, x->after.cost,
            x->before.distortion, x->after.distortion, x->before.bytes, x->after.bytes);
    if (x->steps > 0)
        fprintf(f, "after %lld step%s each\n", (long long)x->steps, ted4_s((uint64_t)x->steps));
    else
        fprintf(f, "at sight\n");
}

char *ted4_search_report(const ted4_trainer *t)
{
    char *text = NULL;
    size_t size;
    FILE *f = open_memstream(&text, &size);

    if (f == NULL)
        return NULL;
    fprintf(f, "capacity=%s; lambda %.7g\n", t->opt.capacity ? "auto" : "fixed", t->opt.lambda);
    put_time(f, t);
    put_dropout(f, t);
    put_light(f, t);
    put_moving(f, t);
    for (size_t i = 0; i < t->search.n_trials; i++)
        put_trial(f, i + 1, &t->search.trial[i]);
    if (fclose(f) == 0)
        return text;
    free(text);
    return NULL;
}
