/* image_cache.h - decoded pictures under a bound of memory, least recently used leave first.
 * Depends on data/dataset.h for ted4_message.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_IMAGE_CACHE_H
#define TED4_IMAGE_CACHE_H

#include <stddef.h>
#include <stdint.h>
#include "data/dataset.h"

/* Makes the bytes of picture i: malloc'ed, *size of them. Called without any lock, for one i by
 * one thread at a time. NULL with *m filled. */
typedef uint8_t *ted4_image_decoder(void *user, size_t i, size_t *size, ted4_message *m);

typedef struct ted4_image_cache ted4_image_cache;

/* n pictures, at most bound bytes kept; user is borrowed. NULL: no memory. */
ted4_image_cache *ted4_image_cache_new(size_t n, size_t bound, ted4_image_decoder *decode,
                                       void *user);
void ted4_image_cache_free(ted4_image_cache *c); /* NULL is fine; no picture may be in use */

/* Safe from several threads. The bytes stay until as many unpins as pins; pinned pictures may
 * exceed the bound. Two threads that want the same picture wait for one decoding. NULL with *m
 * filled. */
const uint8_t *ted4_image_cache_pin(ted4_image_cache *c, size_t i, ted4_message *m);
void ted4_image_cache_unpin(ted4_image_cache *c, size_t i);

/* Says that picture i is wanted soon: up to n_threads threads of the cache, at most
 * TED4_DATASET_AHEAD, decode such pictures meanwhile. Only a hint: it may come to nothing, and a
 * picture that cannot be decoded is told of by pin. Nothing is done where the bound is too small
 * for pictures to wait in. */
void ted4_image_cache_ahead(ted4_image_cache *c, size_t i, int n_threads);

size_t ted4_image_cache_held(ted4_image_cache *c); /* bytes now in memory */

#endif
