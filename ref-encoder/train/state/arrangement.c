/* arrangement.c - see arrangement.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "arrangement.h"

#include <math.h>
#include <stdlib.h>

#include "train/model/formulas.h"

/* At this many widths beyond its start or end, an anchor is no longer drawn: exp(-u u) = 1 / 255
 * (spec 11.4). */
#define REACH 2.354f

/* Lives are sorted into classes by their length: from LONG of the sequence on, then half as long
 * each, but the last class has all that are shorter. Within class c, the middles of lives are
 * sorted into 2^(c + 1) equal parts of the sequence, so that a block covers little more time than
 * each of its anchors. */
#define LONG 0.75f
enum { SHORTEST = 6, CLASS_AT = 8 }; /* bits of a group: part, class from CLASS_AT, then SHUT */
#define SHUT 0x8000u

/* Returns the group of a life from time from to time to, within [0, 1]. Numbers that are not finite
 * give a long life. */
static uint16_t group_of(float from, float to)
{
    const float start = from > 0 ? from : 0, end = to < 1 ? to : 1;
    const float length = end - start, middle = 0.5f * (start + end);
    float least = LONG;
    int kind = 0;

    while (kind < SHORTEST && length < least) {
        least *= 0.5f;
        kind++;
    }
    if (kind == 0)
        return 0;

    const int parts = 2 << kind, part = (int)(middle * (float)parts);

    return (uint16_t)(kind << CLASS_AT | (part < 0 ? 0 : part < parts ? part : parts - 1));
}

static int is_shut(const ted4_trainer *t, size_t i)
{
    const ted4_header *h = &t->layout.head;

    return h->motion != TED4_MOTION_NONE && h->temporal_mask &&
           ted4_mask_shut(
               *ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i, t->layout.temporal_logit));
}

static uint16_t group_of_life(const ted4_trainer *t, size_t i)
{
    const int first = t->layout.first[TED4_TAU];

    if (first < 0)
        return 0;
    const float *tau = ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i, first);
    const ted4_edge start = ted4_find_edge(-INFINITY, tau, ted4_pow2),
                    end = ted4_find_edge(INFINITY, tau, ted4_pow2);

    return group_of(tau[0] - REACH * start.width, tau[2 * TED4_LANES] + REACH * end.width);
}

int ted4_arrange_anchors(ted4_trainer *t)
{
    uint16_t *group = malloc((t->anchors.n + 1) * sizeof *group);
    int bad = group == NULL;

    for (size_t i = 0; !bad && i < t->anchors.n; i++)
        group[i] = (uint16_t)(group_of_life(t, i) | (is_shut(t, i) ? SHUT : 0));
    bad = bad || ted4_anchors_sort(&t->anchors, group) != 0;
    free(group);
    return bad ? ted4_trainer_fail(t, "no memory to sort anchors") : 0;
}
