/* image_cache.c - see image_cache.h.
 * An entry is empty, loading (one thread decodes it, others wait) or full. Full entries without
 * pins form a list, oldest first; only these can be evicted. The threads that decode in advance are
 * started at the first announcement and end with the cache.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "data/image_cache.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include "data/data_util.h"
#include "tool/thread_start.h"

typedef struct {
    uint8_t *bytes; /* owned; NULL unless full */
    size_t size;
    size_t pins;
    int loading;
    int early; /* decoded in advance and not requested since */
    size_t before,
        /* before, after: neighbours in the list of unpinned pictures, if full and not pinned */
        after;
} entry;

/* Half of the limit may be used for pictures decoded in advance, counted at the size of the
 * largest; otherwise these and the pictures in use would evict one another. If fewer than
 * FEWEST_AHEAD fit, none is decoded in advance. */
enum { FEWEST_AHEAD = 4 };

/* Queue of announced pictures, in the order of announcement, and the threads that decode them. */
typedef struct {
    pthread_t threads[TED4_DATASET_AHEAD];
    size_t queue[TED4_DATASET_AHEAD];
    int n_threads, n_waiting, n_queued, n_loading, stop;
    size_t n_early; /* pictures decoded in advance and not requested since */
} ahead;

struct ted4_image_cache {
    pthread_mutex_t lock;
    pthread_cond_t loaded, wanted;
    ahead ahead;
    /* entries: owned, [n + 1]; the last is the head of the list of unpinned pictures: after is the
     * oldest, before is the newest */
    entry *entries;
    size_t n, bound, held;
    size_t largest; /* largest size of a picture so far */
    ted4_image_decoder *decode;
    void *user; /* borrowed */
};

ted4_image_cache *ted4_image_cache_new(size_t n, size_t bound, ted4_image_decoder *decode,
                                       void *user)
{
    ted4_image_cache *c = calloc(1, sizeof *c);
    entry *entries = calloc(n + 1, sizeof *entries);

    if (c == NULL || entries == NULL) {
        free(c);
        free(entries);
        return NULL;
    }
    pthread_mutex_init(&c->lock, NULL);
    pthread_cond_init(&c->loaded, NULL);
    pthread_cond_init(&c->wanted, NULL);
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
    pthread_mutex_lock(&c->lock);
    c->ahead.stop = 1;
    pthread_cond_broadcast(&c->wanted);
    pthread_mutex_unlock(&c->lock);
    for (int i = 0; i < c->ahead.n_threads; i++)
        pthread_join(c->ahead.threads[i], NULL);
    for (size_t i = 0; i < c->n; i++)
        free(c->entries[i].bytes);
    free(c->entries);
    pthread_cond_destroy(&c->wanted);
    pthread_cond_destroy(&c->loaded);
    pthread_mutex_destroy(&c->lock);
    free(c);
}

static void unlink_unpinned(ted4_image_cache *c, size_t i)
{
    entry *e = c->entries;

    e[e[i].before].after = e[i].after;
    e[e[i].after].before = e[i].before;
}

static void link_unpinned(ted4_image_cache *c, size_t i)
{
    entry *e = c->entries;

    e[i].before = e[c->n].before;
    e[i].after = c->n;
    e[e[i].before].after = i;
    e[c->n].before = i;
}

static void not_early(ted4_image_cache *c, size_t i)
{
    c->ahead.n_early -= c->entries[i].early ? 1 : 0;
    c->entries[i].early = 0;
}

/* Evicts unpinned pictures, oldest first, until extra more bytes fit or none is left. The caller
 * holds the lock. */
static void evict(ted4_image_cache *c, size_t extra)
{
    for (;;) {
        const size_t i = c->entries[c->n].after;
        if (i == c->n || (extra <= c->bound && c->held <= c->bound - extra))
            return;
        unlink_unpinned(c, i);
        not_early(c, i);
        c->held -= c->entries[i].size;
        free(c->entries[i].bytes);
        c->entries[i].bytes = NULL;
    }
}

/* Decodes picture i. The caller holds the lock, which is released while decoding. */
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
        evict(c, size);
        e->bytes = bytes;
        e->size = size;
        c->held += size;
        c->largest = size > c->largest ? size : c->largest;
        link_unpinned(c, i);
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
    not_early(c, i);
    if (bytes != NULL && e->pins++ == 0)
        unlink_unpinned(c, i);
    pthread_mutex_unlock(&c->lock);
    return bytes;
}

void ted4_image_cache_unpin(ted4_image_cache *c, size_t i)
{
    pthread_mutex_lock(&c->lock);
    if (--c->entries[i].pins == 0) {
        link_unpinned(c, i);
        evict(c, 0);
    }
    pthread_mutex_unlock(&c->lock);
}

static void *decode_ahead(void *cache)
{
    ted4_image_cache *c = cache;
    ahead *a = &c->ahead;
    ted4_message ignored;

    pthread_mutex_lock(&c->lock);
    while (!a->stop) {
        if (a->n_queued == 0) {
            a->n_waiting++;
            pthread_cond_wait(&c->wanted, &c->lock);
            a->n_waiting--;
            continue;
        }
        const size_t i = a->queue[0];
        a->n_queued--;
        memmove(a->queue, a->queue + 1, (size_t)a->n_queued * sizeof *a->queue);
        if (c->entries[i].loading || c->entries[i].bytes != NULL)
            continue;
        a->n_loading++;
        load(c, i, &ignored);
        a->n_loading--;
        if (c->entries[i].bytes != NULL && c->entries[i].pins == 0 && !c->entries[i].early) {
            c->entries[i].early = 1;
            a->n_early++;
        }
    }
    pthread_mutex_unlock(&c->lock);
    return NULL;
}

static int is_queued(const ahead *a, size_t i)
{
    for (int k = 0; k < a->n_queued; k++)
        if (a->queue[k] == i)
            return 1;
    return 0;
}

/* Returns how many pictures may be decoded in advance, counting those queued and being decoded. */
static size_t prefetch_limit(const ted4_image_cache *c)
{
    const size_t fit = c->largest > 0 ? c->bound / c->largest / 2 : TED4_DATASET_AHEAD;

    return fit < FEWEST_AHEAD ? 0 : fit < TED4_DATASET_AHEAD ? fit : TED4_DATASET_AHEAD;
}

void ted4_image_cache_ahead(ted4_image_cache *c, size_t i, int n_threads)
{
    ahead *a = &c->ahead;
    const int most = n_threads < TED4_DATASET_AHEAD ? n_threads : TED4_DATASET_AHEAD;

    pthread_mutex_lock(&c->lock);
    const size_t waiting = a->n_early + (size_t)(a->n_queued + a->n_loading);
    if (most > 0 && i < c->n && c->entries[i].bytes == NULL && !c->entries[i].loading &&
        !is_queued(a, i) && waiting < prefetch_limit(c)) {
        a->queue[a->n_queued++] = i;
        if (a->n_queued > a->n_waiting && a->n_threads < most &&
            ted4_thread_start(&a->threads[a->n_threads], decode_ahead, c) == 0)
            a->n_threads++;
        pthread_cond_signal(&c->wanted);
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
