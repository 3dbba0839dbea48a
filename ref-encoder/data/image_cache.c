/* image_cache.c - see image_cache.h.
 * An entry is empty, loading (a thread decodes it, others wait) or full. Full entries without
 * pins form a list, oldest first; only they can be evicted.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "data/image_cache.h"

#include <pthread.h>
#include <stdlib.h>
#include "data/data_util.h"

typedef struct {
    uint8_t *bytes;             /* owned; NULL unless full */
    size_t   size;
    size_t   pins;
    int      loading;
    size_t   before, after;     /* neighbours in the idle list, when full and not pinned */
} entry;

struct ted4_image_cache {
    pthread_mutex_t lock;
    pthread_cond_t  loaded;
    entry          *entries;    /* owned, [n + 1]; the last is the head of the idle list: after = oldest, before = newest */
    size_t          n, bound, held;
    ted4_image_decoder    *decode;
    const void     *user;       /* borrowed */
};

ted4_image_cache *ted4_image_cache_new(size_t n, size_t bound, ted4_image_decoder *decode, const void *user)
{
    ted4_image_cache *c = calloc(1, sizeof *c);
    entry *entries = calloc(n + 1, sizeof *entries);

    if (c == NULL || entries == NULL || pthread_mutex_init(&c->lock, NULL) != 0) {
        free(c);
        free(entries);
        return NULL;
    }
    if (pthread_cond_init(&c->loaded, NULL) != 0) {
        pthread_mutex_destroy(&c->lock);
        free(c);
        free(entries);
        return NULL;
    }
    entries[n].before = entries[n].after = n;
    c->entries = entries;
    c->n = n;
    c->bound = bound;
    c->decode = decode;
    c->user = user;
    return c;
}

void ted4_image_cache_free(ted4_image_cache *c)
{
    if (c == NULL)
        return;
    for (size_t i = 0; i < c->n; i++)
        free(c->entries[i].bytes);
    free(c->entries);
    pthread_cond_destroy(&c->loaded);
    pthread_mutex_destroy(&c->lock);
    free(c);
}

static void leave_idle(ted4_image_cache *c, size_t i)
{
    entry *e = c->entries;

    e[e[i].before].after = e[i].after;
    e[e[i].after].before = e[i].before;
}

static void join_idle(ted4_image_cache *c, size_t i)
{
    entry *e = c->entries;

    e[i].before = e[c->n].before;
    e[i].after = c->n;
    e[e[i].before].after = i;
    e[c->n].before = i;
}

/* With the lock held: drops idle pictures, oldest first, until extra more bytes fit or none is
 * left. */
static void make_room(ted4_image_cache *c, size_t extra)
{
    for (;;) {
        const size_t i = c->entries[c->n].after;
        if (i == c->n || (extra <= c->bound && c->held <= c->bound - extra))
            return;
        leave_idle(c, i);
        c->held -= c->entries[i].size;
        free(c->entries[i].bytes);
        c->entries[i].bytes = NULL;
    }
}

/* With the lock held, which is let go while decoding. */
static void load(ted4_image_cache *c, size_t i, ted4_message *m)
{
    size_t size = 0;
    entry *e = &c->entries[i];

    e->loading = 1;
    pthread_mutex_unlock(&c->lock);
    uint8_t *bytes = c->decode(c->user, i, &size, m);
    pthread_mutex_lock(&c->lock);
    e->loading = 0;
    if (bytes != NULL) {
        make_room(c, size);
        e->bytes = bytes;
        e->size = size;
        c->held += size;
        join_idle(c, i);
    }
    pthread_cond_broadcast(&c->loaded);
}

const uint8_t *ted4_image_cache_pin(ted4_image_cache *c, size_t i, ted4_message *m)
{
    if (i >= c->n) {
        ted4_say(m, "picture %zu asked of a scene of %zu", i, c->n);
        return NULL;
    }
    entry *e = &c->entries[i];
    pthread_mutex_lock(&c->lock);
    while (e->loading)
        pthread_cond_wait(&c->loaded, &c->lock);
    if (e->bytes == NULL)
        load(c, i, m);
    const uint8_t *bytes = e->bytes;
    if (bytes != NULL && e->pins++ == 0)
        leave_idle(c, i);
    pthread_mutex_unlock(&c->lock);
    return bytes;
}

void ted4_image_cache_unpin(ted4_image_cache *c, size_t i)
{
    pthread_mutex_lock(&c->lock);
    if (--c->entries[i].pins == 0) {
        join_idle(c, i);
        make_room(c, 0);
    }
    pthread_mutex_unlock(&c->lock);
}

size_t ted4_image_cache_held(ted4_image_cache *c)
{
    pthread_mutex_lock(&c->lock);
    const size_t held = c->held;
    pthread_mutex_unlock(&c->lock);
    return held;
}
