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

/* Divides c[n], sorted by time, into batches of at most `most` pictures, of sizes as equal as
 * possible, and gives each a random place. If most is even, so are all sizes of a time but one, for
 * two processes to share them equally. */
static void make_batches(const ted4_order *o, card *c, uint32_t n, uint32_t most)
{
    uint64_t batch = 0;

    for (uint32_t from = 0, to; from < n; from = to) {
        for (to = from; to < n && c[to].major == c[from].major;)
            to++;

        const uint32_t count = to - from, parts = (count + most - 1) / most;
        const uint32_t unit = 2 - most % 2, units = (count + unit - 1) / unit;

        for (uint32_t part = 0; part < parts; part++, batch++)
            for (uint32_t i = unit * (units * part / parts);
                 i < unit * (units * (part + 1) / parts) && i < count; i++)
                c[from + i].minor = ted4_random(~o->key, o->round << 32 | batch);
    }
    for (uint32_t i = 0; i < n; i++) {
        c[i].major = c[i].minor;
        c[i].minor = i;
    }
}

/* Does the same as shuffle(), with the pictures of a batch next to one another. */
static int shuffle_batches(ted4_trainer *t)
{
    ted4_order *o = &t->order;
    const uint32_t n = o->n;
    card *c = malloc((n + 1) * sizeof *c);

    if (c == NULL)
        return ted4_trainer_fail(t, "no memory for the order of pictures");
    for (uint32_t i = 0; i < n; i++) {
        const uint32_t item = o->item[i];

        c[i] = (card) { t->data->pictures[item].frame, ted4_random(o->key, o->round << 32 | item),
                        item };
    }
    qsort(c, n, sizeof *c, compare_cards);
    make_batches(o, c, n, (uint32_t)t->opt.batch);
    qsort(c, n, sizeof *c, compare_cards);
    for (uint32_t i = 0; i < n; i++)
        o->item[i] = c[i].item;
    free(c);
    return 0;
}

/* Returns the number of pictures of the batch that begins with picture at of the order. */
static size_t batch_at(const ted4_trainer *t, size_t at)
{
    const ted4_order *o = &t->order;
    const ted4_picture *pic = t->data->pictures;
    size_t n = 1;

    while (n < (size_t)t->opt.batch && at + n < o->n &&
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

    for (size_t at = o->next; at < o->n && left > 0;) {
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

    if (o->next >= o->n) {
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
