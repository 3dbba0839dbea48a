/* photo_votes.c - counts photo votes, and derives from them when a point is present
 * (photo_votes.h).
 * SPDX-License-Identifier: BSD-2-Clause */
#include "photo_votes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "math/elementary.h"
#include "train/state/picture.h"
#include "view_geometry.h"

/* MUST_AGREE: the share of the cameras that must agree. NEAR_BEST: a frame counts if its agreement
 * is at least this share of the best frame's. */
#define MUST_AGREE    0.5f
#define NEAR_BEST     0.7f
/* A point comes and goes if it is present in no more than LONGEST_SHARE of the frames that are
 * known, or if in at least GONE_SHARE of them it is clearly gone: agreement is then below
 * CLEARLY_GONE of the best. The second test is needed where different cameras see each frame,
 * because the share of cameras from which the point is hidden then varies, too. */
#define LONGEST_SHARE 0.5f
#define CLEARLY_GONE  0.25f
#define GONE_SHARE    0.25f

uint32_t ted4_most_cameras(const ted4_dataset *d)
{
    uint32_t *cameras = calloc(d->n_frames, sizeof *cameras), most = 0;

    for (size_t i = 0; cameras != NULL && i < d->n_pictures; i++) {
        const ted4_picture *p = &d->pictures[i];

        if (!p->is_test && ++cameras[p->frame] > most)
            most = cameras[p->frame];
    }
    free(cameras);
    return most;
}

typedef struct {
    ted4_photo_votes *s;
    const uint8_t *pixels;
    ted4_view view;
    uint32_t frame;
} match_job;

/* Number of points per job. */
enum { RUN = 4096 };

static void match_run(void *arg, size_t run)
{
    const match_job *j = arg;
    ted4_photo_votes *s = j->s;
    const size_t end = (run + 1) * RUN < s->n ? (run + 1) * RUN : s->n;

    for (size_t i = run * RUN; i < end; i++) {
        const size_t at = j->frame * s->n + i;
        size_t pixel;
        float depth;

        if (!ted4_view_pixel(&j->view, s->point + 3 * i, &pixel, &depth))
            continue;
        s->seen[at]++;
        if (ted4_colour_agrees(j->pixels + 3 * pixel, s->colour + 3 * i))
            s->hits[at]++;
    }
}

static int match_pictures(ted4_photo_votes *s, ted4_trainer *t)
{
    match_job j = { .s = s };

    for (size_t i = 0; i < t->data->n_pictures; i++) {
        const ted4_picture *pic = &t->data->pictures[i];
        float centre[3];

        if (pic->is_test)
            continue;
        for (size_t k = i + 1; k < t->data->n_pictures && k <= i + TED4_DATASET_AHEAD; k++)
            if (!t->data->pictures[k].is_test)
                ted4_dataset_ahead(t->data, k);
        j.pixels = ted4_trainer_seen(t, i);
        if (j.pixels == NULL)
            return -1;
        ted4_trainer_view(t, pic, &j.view, centre);
        j.frame = pic->frame;
        ted4_parallel_for(t->parallel, (s->n + RUN - 1) / RUN, match_run, &j);
        ted4_dataset_release(t->data, i);
    }
    return 0;
}

int ted4_photo_votes_count(ted4_photo_votes *s, ted4_trainer *t, const float *point,
                           const uint8_t *colour, size_t n)
{
    memset(s, 0, sizeof *s);
    s->point = point;
    s->colour = colour;
    s->n = n;
    s->n_frames = t->data->n_frames;
    s->hits = calloc(s->n_frames * n + 1, sizeof *s->hits);
    s->seen = calloc(s->n_frames * n + 1, sizeof *s->seen);
    if (s->hits == NULL || s->seen == NULL)
        return ted4_trainer_fail(t, "no memory to look for what comes and goes");
    return match_pictures(s, t);
}

void ted4_photo_votes_free(ted4_photo_votes *s)
{
    free(s->hits);
    free(s->seen);
    memset(s, 0, sizeof *s);
}

/* Returns whether enough cameras see point i in this frame to tell if it is present. They do not
 * where pictures are held out. */
static int is_known(const ted4_photo_votes *s, uint32_t frame, size_t i)
{
    return s->seen[frame * s->n + i] >= TED4_CAMERAS_NEEDED;
}

static float agreement(const ted4_photo_votes *s, uint32_t frame, size_t i)
{
    const size_t at = frame * s->n + i;

    return is_known(s, frame, i) ? (float)s->hits[at] / (float)s->seen[at] : 0.0f;
}

/* Returns the last frame of the run in which point i is present, from a frame on in steps of +1 or
 * -1. *gone: the distance from there to the next known frame. An unknown frame belongs to the run
 * if the known frames on both sides do, or if there is none on the far side. */
static uint32_t run_end(const ted4_photo_votes *s, size_t i, uint32_t frame, int step, float enough,
                        uint32_t *gone)
{
    const uint32_t last = step > 0 ? s->n_frames - 1 : 0;

    for (uint32_t f = frame; f != last;) {
        f += (uint32_t)step;
        if (!is_known(s, f, i))
            continue;
        if (agreement(s, f, i) < enough) {
            *gone = step > 0 ? f - frame : frame - f;
            return frame;
        }
        frame = f;
    }
    *gone = 1;
    return last;
}

uint32_t ted4_photo_votes_best(const ted4_photo_votes *s, size_t i)
{
    uint32_t best = 0;

    for (uint32_t f = 1; f < s->n_frames; f++)
        if (agreement(s, f, i) > agreement(s, best, i))
            best = f;
    return best;
}

static int comes_and_goes(const ted4_photo_votes *s, size_t i, float best)
{
    uint32_t known = 0, there = 0, gone = 0;

    for (uint32_t f = 0; f < s->n_frames; f++) {
        if (!is_known(s, f, i))
            continue;
        known++;
        there += agreement(s, f, i) >= NEAR_BEST * best;
        gone += agreement(s, f, i) < CLEARLY_GONE * best;
    }
    return (float)there <= LONGEST_SHARE * (float)known || (float)gone >= GONE_SHARE * (float)known;
}

int ted4_photo_votes_span(const ted4_photo_votes *s, size_t i, uint32_t frame, ted4_span *span)
{
    const float best = agreement(s, ted4_photo_votes_best(s, i), i), enough = NEAR_BEST * best;

    if (agreement(s, frame, i) < fmaxf(MUST_AGREE, enough) || !comes_and_goes(s, i, best))
        return 0;
    span->from = run_end(s, i, frame, -1, enough, &span->before);
    span->to = run_end(s, i, frame, 1, enough, &span->after);
    return 1;
}

/* In units of the distance to the next known frame: a span extends beyond its first and last frame
 * by SPAN_BEYOND, so that small coding errors do no harm, and then fades over SPAN_FADES, so that
 * exp(-4.6) is left at the known frame. */
#define SPAN_BEYOND 0.25f
#define SPAN_FADES  0.35f

void ted4_span_set(ted4_trainer *t, size_t i, const ted4_span *span)
{
    const int first = t->layout.first[TED4_TAU];
    const float frame = 1.0f / (float)(t->data->n_frames - 1);
    const float before = (float)span->before, after = (float)span->after;

    *ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i, first) =
        ((float)span->from - SPAN_BEYOND * before) * frame;
    *ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i, first + 1) =
        ted4_math_log2f(SPAN_FADES * before * frame);
    *ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i, first + 2) =
        ((float)span->to + SPAN_BEYOND * after) * frame;
    *ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i, first + 3) =
        ted4_math_log2f(SPAN_FADES * after * frame);
}
