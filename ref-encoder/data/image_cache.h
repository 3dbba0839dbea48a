/* image_cache.h - cache of decoded pictures with a memory limit; the least recently used are
 * evicted first. Depends on data/dataset.h for ted4_message.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_IMAGE_CACHE_H
#define TED4_IMAGE_CACHE_H

#include <stddef.h>
#include <stdint.h>
#include "data/dataset.h"

/* Decodes picture i into *size bytes that are allocated with malloc. Called without any lock held,
 * and never by two threads at a time for the same i. Returns NULL with *m filled on failure. */
typedef uint8_t *ted4_image_decoder(void *user, size_t i, size_t *size, ted4_message *m);

typedef struct ted4_image_cache ted4_image_cache;

/* Creates a cache of n pictures that keeps at most bound bytes. user is borrowed. Returns NULL if
 * memory runs out. */
ted4_image_cache *ted4_image_cache_new(size_t n, size_t bound, ted4_image_decoder *decode,
                                       void *user);
void ted4_image_cache_free(ted4_image_cache *c); /* c may be NULL; no picture may be in use */

/* Returns the bytes of picture i, decoding it if necessary. They stay valid until the picture has
 * been unpinned as often as pinned; pinned pictures may exceed the limit. Both functions may be
 * called from several threads; threads that request the same picture wait for a single decoding.
 * Returns NULL with *m filled on failure. */
const uint8_t *ted4_image_cache_pin(ted4_image_cache *c, size_t i, ted4_message *m);
void ted4_image_cache_unpin(ted4_image_cache *c, size_t i);

/* Announces that picture i will be requested soon: up to n_threads threads of the cache, at most
 * TED4_DATASET_AHEAD, decode announced pictures in the background. This is only a hint, and may be
 * ignored; pin reports pictures that cannot be decoded. Nothing happens if the limit is too small
 * to hold pictures in advance. */
void ted4_image_cache_ahead(ted4_image_cache *c, size_t i, int n_threads);

size_t ted4_image_cache_held(ted4_image_cache *c); /* number of bytes held at present */

#endif
