/* stage_judge.c - see stage_judge.h. Deterministic: sums in the order of pictures.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "stage_judge.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "events.h"
#include "train/math/random.h"
#include "train/state/picture.h"

enum { GROUPS = TED4_JUDGE_GROUPS };
/* With fewer pictures, none can be spared. */
enum { FEWEST = 2 * GROUPS };
/* A window is this share of its stage, whole rounds, and at least SHORTEST steps. */
#define WINDOW (1.0 / 48.0)
enum { SHORTEST = 140 };
/* Pictures of a group that are measured; one takes a third of the time of a step. */
enum { MEASURED = 8 };
/* Share of a stage before the first window. By the time of the first decision, two turns of all
 * groups later, the static test and the search for a smaller model are over. */
#define FIRST 0.1
/* Pictures stand still if, from one turn of all groups to the next, their loss falls by less than
 * this share. */
#define STILL 0.01

/* Distinguishes the random numbers of this file from others of the same seed: "judg". */
#define JUDGE_STREAM 0x6a756467u

typedef struct {
    uint64_t key;
    uint32_t id;
} card;

static int compare_cards(const void *x, const void *y)
{
    const card *a = x, *b = y;

    if (a->key != b->key)
        return a->key < b->key ? -1 : 1;
    return a->id < b->id ? -1 : a->id > b->id;
}

/* Fills group[n] with numbers from 1 to GROUPS, in random order and groups of almost equal size.
 * Returns 0, or -1 if memory ran out. */
static int deal(const ted4_trainer *t, uint32_t n, uint8_t *group)
{
    const uint64_t key = ted4_mix(t->opt.seed ^ JUDGE_STREAM);
    card *c = malloc((n + (size_t)1) * sizeof *c);

    if (c == NULL)
        return -1;
    for (uint32_t i = 0; i < n; i++)
        c[i] = (card) { ted4_random(key, i), i };
    qsort(c, n, sizeof *c, compare_cards);
    for (uint32_t i = 0; i < n; i++)
        group[c[i].id] = (uint8_t)(1 + i % GROUPS);
    free(c);
    return 0;
}

/* Gives training cameras consecutive numbers, in number[n_cameras], and returns how many there
 * are. */
static uint32_t number_cameras(const ted4_trainer *t, uint32_t *number)
{
    uint32_t n = 0;

    for (uint32_t i = 0; i < t->data->n_cameras; i++)
        number[i] = UINT32_MAX;
    for (uint32_t i = 0; i < t->order.n; i++) {
        const uint32_t c = t->data->pictures[t->order.item[i]].camera_id;

        if (number[c] == UINT32_MAX)
            number[c] = n++;
    }
    return n;
}

/* Groups are whole cameras where there are enough; otherwise pictures at random. */
static int make_groups(ted4_trainer *t)
{
    uint32_t *number = malloc(((size_t)t->data->n_cameras + 1) * sizeof *number);
    uint8_t *of_camera = malloc((size_t)t->data->n_cameras + 1);
    int bad = number == NULL || of_camera == NULL;

    if (!bad) {
        const uint32_t cameras = number_cameras(t, number);
        const int by_camera = cameras >= GROUPS;

        bad = by_camera ? deal(t, cameras, of_camera) != 0
                        : deal(t, t->order.n, t->judge.group) != 0;
        for (uint32_t i = 0; !bad && by_camera && i < t->order.n; i++)
            t->judge.group[i] = of_camera[number[t->data->pictures[i].camera_id]];
    }
    free(number);
    free(of_camera);
    return bad ? -1 : 0;
}

int ted4_judge_init(ted4_trainer *t)
{
    if (!t->opt.judge || t->order.n < FEWEST)
        return 0;
    t->judge.group = malloc(t->order.n);
    return t->judge.group == NULL || make_groups(t) != 0
               ? ted4_trainer_fail(t, "no memory for the judge")
               : 0;
}

/* Returns the number of pictures that rest. */
static size_t group_size(const ted4_trainer *t)
{
    size_t n = 0;

    for (uint32_t i = 0; i < t->order.n; i++)
        n += t->judge.group[i] == t->judge.state.resting;
    return n;
}

/* Returns the loss of a value's bits. */
static double rate_loss(const ted4_trainer *t)
{
    double bits = 0;

    for (int y = 0; y < TED4_TYPES; y++)
        bits += t->progress.bits[y];
    return t->phase.stage2 ? t->opt.lambda * bits / ted4_rate_norm(t) : 0.0;
}

/* Computes the mean loss of up to MEASURED pictures of the group that rests, evenly spread, plus
 * that of the rate. Returns 0, or -1 with t->message. */
static int measure(ted4_trainer *t, double *level)
{
    const size_t size = group_size(t), most = size < MEASURED ? size : MEASURED;
    size_t seen = 0, done = 0;

    *level = rate_loss(t);
    for (uint32_t i = 0; i < t->order.n && done < most; i++) {
        if (t->judge.group[i] != t->judge.state.resting || seen++ != done * size / most)
            continue;

        const double loss = ted4_trainer_distortion(t, i);

        if (loss < 0)
            return -1;
        *level += loss / (double)most;
        done++;
    }
    return 0;
}

/* Returns whether pictures stand still: each group has been measured twice, and the mean of their
 * gains is small. */
static int stands_still(const ted4_judge_state *s)
{
    double sum = 0;

    for (int g = 0; g < GROUPS; g++)
        sum += s->gain[g];
    return s->n >= GROUPS && sum < STILL * GROUPS;
}

static int end_window(ted4_trainer *t)
{
    ted4_judge_state *s = &t->judge.state;
    double level, *before = &s->level[s->resting - 1], *gain = &s->gain[s->resting - 1];

    if (measure(t, &level) != 0)
        return -1;
    s->windows++;
    s->last = s->resting;
    s->n += *before > 0;
    *gain = *before > 0 ? 1.0 - level / *before : 0.0;
    *before = level;
    s->left_out = 0;
    if (t->phase.clock_stopped || !stands_still(s))
        return 0;
    s->left_out = ted4_schedule_next(t) - ted4_stage_position(t);
    s->n = 0;
    t->phase.left_out[t->phase.stage2] += s->left_out;
    return 0;
}

int ted4_judge_round(ted4_trainer *t)
{
    ted4_judge_state *s = &t->judge.state;
    const double stage = t->phase.stage2 ? t->opt.stage2 : t->opt.stage1;

    if (t->judge.group == NULL || t->onlooker.busy == TED4_BUSY_TRIALS ||
        t->order.next < t->order.n - t->order.rest)
        return 0;
    if (s->resting > 0) {
        if ((double)(t->iteration - s->begin) < fmax(WINDOW * stage, SHORTEST))
            return 0;
        if (end_window(t) != 0)
            return -1;
        s->resting = 0;
    }
    if (!t->phase.integer && (double)ted4_stage_position(t) >= FIRST * stage) {
        s->resting = 1 + s->turn++ % GROUPS;
        s->begin = t->iteration;
    }
    return 0;
}
