/* picture_order.c - see picture_order.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "picture_order.h"

#include <stdlib.h>

#include "train/math/random.h"

static void shuffle(ted4_order *o)
{
    for (uint32_t i = o->n; i > 1; i--) {
        const uint32_t j = ted4_below(o->key, o->round << 32 | i, i);
        const uint32_t x = o->item[i - 1];

        o->item[i - 1] = o->item[j];
        o->item[j] = x;
    }
}

/* A picture, and its place in an order. */
typedef struct {
    uint64_t major, minor;
    uint32_t item;
} card;

static int compare_cards(const void *x, const void *y)
{
    const card *a = x, *b = y;

    if (a->major != b->major)
        return a->major < b->major ? -1 : 1;
    if (a->minor != b->minor)
        return a->minor < b->minor ? -1 : 1;
    return a->item < b->item ? -1 : a->item > b->item;
}

/* Returns the end of the pictures of one time in c[n], sorted by time, that begin with c[from]. */
static uint32_t time_end(const card *c, uint32_t n, uint32_t from)
{
    uint32_t to = from;

    while (to < n && c[to].major == c[from].major)
        to++;
    return to;
}

/* Returns how many of the pictures of a time wait for a later round, so that all batches are full:
 * those beyond a multiple of the size of a batch, unless all fit into one. */
static uint32_t waiting(const ted4_trainer *t, uint32_t count)
{
    const uint32_t most = (uint32_t)t->opt.batch;

    return count > most ? count % most : 0;
}

/* Returns the pictures of all times, sorted by time, those of a time in an order that stays.
 * Owned by the caller; NULL with t->message filled: no memory. */
static card *sort_by_time(ted4_trainer *t)
{
    const ted4_order *o = &t->order;
    card *c = malloc((o->n + 1) * sizeof *c);

    if (c == NULL) {
        ted4_trainer_fail(t, "no memory for the order of pictures");
        return NULL;
    }
    for (uint32_t i = 0; i < o->n; i++) {
        const uint32_t item = o->item[i];

        c[i] = (card) { t->data->pictures[item].frame, ted4_random(ted4_mix(o->key), item), item };
    }
    qsort(c, o->n, sizeof *c, compare_cards);
    return c;
}

/* Gives the pictures of each time, sorted by time, a random place among those of their time in this
 * round. Those that wait come last. They are the next ones in turn, so that in the long run all
 * pictures come equally often: at any end of a round, no picture of a time is more than one behind
 * another. */
static void shuffle_times(const ted4_trainer *t, card *c)
{
    const ted4_order *o = &t->order;

    for (uint32_t from = 0, to; from < o->n; from = to) {
        to = time_end(c, o->n, from);

        const uint32_t count = to - from, wait = waiting(t, count);
        const uint32_t begin = (uint32_t)(o->round % count * wait % count);

        for (uint32_t i = 0; i < count; i++)
            c[from + i].minor = (i + count - begin) % count < wait
                                    ? UINT64_MAX
                                    : ted4_random(o->key, o->round << 32 | c[from + i].item);
    }
    qsort(c, o->n, sizeof *c, compare_cards);
}

/* Divides the pictures of each time into batches, and gives each batch a random place. Returns how
 * many pictures are in batches; those that wait come behind them. */
static uint32_t make_batches(const ted4_trainer *t, card *c)
{
    const ted4_order *o = &t->order;
    const uint32_t most = (uint32_t)t->opt.batch;
    uint64_t batch = 0;
    uint32_t end = 0;

    for (uint32_t from = 0, to; from < o->n; from = to) {
        to = time_end(c, o->n, from);

        const uint32_t drawn = to - from - waiting(t, to - from);

        for (uint32_t i = from; i < to; i++) {
            batch += i < from + drawn && (i - from) % most == 0;
            c[i].minor = i < from + drawn ? ted4_random(~o->key, o->round << 32 | batch)
                                          : UINT64_MAX;
        }
        end += drawn;
    }
    for (uint32_t i = 0; i < o->n; i++) {
        c[i].major = c[i].minor;
        c[i].minor = i;
    }
    qsort(c, o->n, sizeof *c, compare_cards);
    return end;
}

/* Does the same as shuffle(), with the pictures of a batch next to one another, and those that wait
 * at the end. */
static int shuffle_batches(ted4_trainer *t)
{
    ted4_order *o = &t->order;
    card *c = sort_by_time(t);

    if (c == NULL)
        return -1;
    shuffle_times(t, c);
    o->end = make_batches(t, c);
    for (uint32_t i = 0; i < o->n; i++)
        o->item[i] = c[i].item;
    free(c);
    return 0;
}

/* Finds o->end, which is the same in all rounds. */
static int find_end(ted4_trainer *t)
{
    ted4_order *o = &t->order;
    card *c = t->opt.batch > 1 ? sort_by_time(t) : NULL;

    if (t->opt.batch > 1 && c == NULL)
        return -1;
    o->end = o->n;
    for (uint32_t from = 0, to; c != NULL && from < o->n; from = to) {
        to = time_end(c, o->n, from);
        o->end -= waiting(t, to - from);
    }
    free(c);
    return 0;
}

/* Returns the number of pictures of the batch that begins with picture at of the order. */
static size_t batch_at(const ted4_trainer *t, size_t at)
{
    const ted4_order *o = &t->order;
    const ted4_picture *pic = t->data->pictures;
    size_t n = 1;

    while (n < (size_t)t->opt.batch && at + n < o->end &&
           pic[o->item[at + n]].frame == pic[o->item[at]].frame)
        n++;
    return n;
}

/* Announces the next pictures that this process draws, so that they can be decoded in the meantime.
 * Those after the next shuffle are not known yet. */
static void announce(const ted4_trainer *t)
{
    const ted4_order *o = &t->order;
    int left = TED4_DATASET_AHEAD;

    for (size_t at = o->next; at < o->end && left > 0;) {
        const size_t n = batch_at(t, at);
        size_t first, end;

        ted4_exchange_views(t->exchange, n, &first, &end);
        for (size_t i = first; i < end && left > 0; i++, left--)
            ted4_dataset_ahead(t->data, o->item[at + i]);
        at += n;
    }
}

int ted4_next_pictures(ted4_trainer *t, const uint32_t **item, size_t *n)
{
    ted4_order *o = &t->order;

    if (o->end == 0 && find_end(t) != 0)
        return -1;
    if (o->next >= o->end) {
        if (t->opt.batch > 1 && shuffle_batches(t) != 0)
            return -1;
        if (t->opt.batch == 1)
            shuffle(o);
        o->round++;
        o->next = 0;
    }
    *item = o->item + o->next;
    *n = batch_at(t, o->next);
    o->next += (uint32_t)*n;
    announce(t);
    return 0;
}
