/* view_subset.c - chooses training pictures spread over all frames: see view_subset.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "view_subset.h"

#include <stdlib.h>

#include "train/math/random.h"

/* Training pictures, sorted by frame. */
typedef struct {
    size_t frames;
    uint32_t *first; /* [frames + 1] index in item of a frame's first picture */
    uint32_t *item;  /* numbers of pictures in the data set */
    uint32_t *turn;  /* [frames] a random order of the frames */
} by_frame;

static void count_frames(const ted4_dataset *d, uint32_t *first, size_t frames)
{
    for (size_t f = 0; f <= frames; f++)
        first[f] = 0;
    for (size_t i = 0; i < d->n_pictures; i++)
        first[d->pictures[i].frame + 1] += !d->pictures[i].is_test;
    for (size_t f = 0; f < frames; f++)
        first[f + 1] += first[f];
}

static void sort_frames(const ted4_dataset *d, uint64_t key, by_frame *b)
{
    count_frames(d, b->first, b->frames);
    for (size_t i = 0; i < d->n_pictures; i++)
        if (!d->pictures[i].is_test)
            b->item[b->first[d->pictures[i].frame]++] = (uint32_t)i;
    count_frames(d, b->first, b->frames);
    for (size_t f = 0; f < b->frames; f++) {
        const uint32_t j = ted4_below(key, f, (uint32_t)f + 1);

        b->turn[f] = (uint32_t)f;
        b->turn[f] = b->turn[j];
        b->turn[j] = (uint32_t)f;
    }
}

size_t ted4_view_subset_frames(const ted4_trainer *t)
{
    return t->data->n_frames > 0 ? t->data->n_frames : 1;
}

int ted4_view_subset_choose(ted4_trainer *t, uint64_t key, size_t n, uint32_t *item)
{
    const size_t frames = ted4_view_subset_frames(t);
    by_frame b = { frames, malloc((frames + 1) * sizeof *b.first),
                   malloc((t->data->n_pictures + 1) * sizeof *b.item),
                   malloc(frames * sizeof *b.turn) };
    const int bad = b.first == NULL || b.item == NULL || b.turn == NULL;
    size_t chosen = 0;

    if (!bad)
        sort_frames(t->data, key, &b);
    for (uint32_t round = 0; !bad && chosen < n; round++)
        for (size_t k = 0; k < frames && chosen < n; k++) {
            const uint32_t f = b.turn[k], count = b.first[f + 1] - b.first[f];

            if (round < count)
                item[chosen++] = b.item[b.first[f] + (ted4_below(~key, f, count) + round) % count];
        }
    free(b.first);
    free(b.item);
    free(b.turn);
    return bad ? ted4_trainer_fail(t, "no memory to choose pictures") : 0;
}
