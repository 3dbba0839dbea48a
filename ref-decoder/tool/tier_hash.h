/* tier_hash.h - spec J.1: counts the bytes of a tier as they arrive, hashes them with XXH3 and
 * SHA-256, and optionally writes them to a file.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_TIER_HASH_H
#define TED4_TIER_HASH_H

#include <stdint.h>
#include <stdio.h>
#include <jansson.h>
#include "ted4.h"

enum { TED4_TIERS = 6 };

typedef struct ted4_tier_hash ted4_tier_hash;

/* keep: borrowed; the bytes are also written to it, unless it is NULL. Returns NULL if there is no
 * memory. */
ted4_tier_hash *ted4_tier_hash_new(FILE *keep);
/* A ted4_sink whose user argument is a ted4_tier_hash. */
void ted4_tier_hash_add(void *hash, const void *bytes, size_t size);
/* Returns a new object {"bytes", "xxh3", "sha256"} and frees the hash. Returns NULL if h is
 * NULL. */
json_t *ted4_tier_hash_end(ted4_tier_hash *h);

/* T5: passes the records of a query to the sink. */
void ted4_tier_records(const ted4_gaussians *g, ted4_sink *sink, void *user);

#endif
