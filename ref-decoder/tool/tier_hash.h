/* tier_hash.h - spec J.1: a tier's byte string as it comes, hashed twice, counted and kept in a
 * file if wanted.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_TIER_HASH_H
#define TED4_TIER_HASH_H

#include <stdint.h>
#include <stdio.h>
#include <jansson.h>
#include "ted4.h"

enum { TED4_TIERS = 6 };

typedef struct ted4_tier_hash ted4_tier_hash;

/* keep: gets the bytes too; NULL: nobody does. Borrowed. NULL: no memory. */
ted4_tier_hash *ted4_tier_hash_new(FILE *keep);
/* A ted4_sink whose user is a ted4_tier_hash. */
void ted4_tier_hash_add(void *hash, const void *bytes, size_t size);
/* {"bytes", "xxh3", "sha256"}, a new reference; frees the hash. NULL stays NULL. */
json_t *ted4_tier_hash_end(ted4_tier_hash *h);

/* T5: the records of a query. */
void ted4_tier_records(const ted4_gaussians *g, ted4_sink *sink, void *user);

#endif
