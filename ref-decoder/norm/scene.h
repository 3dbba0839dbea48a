/* scene.h - the memory of a scene, and its hash. The encoder fills scenes itself.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SCENE_H
#define TED4_SCENE_H

#include "norm/syntax.h"

/* Returns a scene without a header, or NULL if there is no memory. Free it with ted4_scene_free. */
ted4_scene *ted4_scene_empty(const ted4_options *o);
/* Allocates storage for a blob of n values. Returns 1, or 0 if there is no memory. */
int ted4_blob_alloc(ted4_scene *s, ted4_blob *b, uint64_t n);
/* Allocate everything that has one entry per anchor, and shift and prob. head and shape are filled
 * already. Return 1, or 0 if there is no memory. */
int ted4_scene_alloc_anchors(ted4_scene *s);
int ted4_scene_alloc_shifts(ted4_scene *s);

/* For encoders: returns a scene with that header and all arrays, zeroed, and with blobs of mode
 * TED4_BLOB_AUTO. The values of the header must be in range. o may be NULL. Returns NULL if there
 * is no memory. */
ted4_scene *ted4_scene_new(const ted4_header *h, const ted4_options *o);

/* Computes the hash of the decoded integers (spec 15.2). */
void ted4_scene_hash(const ted4_scene *s, uint8_t hash[16]);

#endif
