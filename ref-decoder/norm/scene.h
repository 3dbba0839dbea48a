/* scene.h - allocates scenes and computes their hash. The encoder fills the arrays of its scenes
 * directly.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SCENE_H
#define TED4_SCENE_H

#include "norm/syntax.h"

/* Returns a scene whose header is all zeros, or NULL if memory ran out. The caller frees it with
 * ted4_scene_free. o may be NULL. */
ted4_scene *ted4_scene_empty(const ted4_options *o);
/* Allocates b->values[n], zeroed and owned by the scene. Returns 1, or 0 if memory ran out. */
int ted4_blob_alloc(ted4_scene *s, ted4_blob *b, uint64_t n);
/* Allocate the arrays per anchor and prob; and shift. head and shape must be filled already. Return
 * 1, or 0 if memory ran out. */
int ted4_scene_alloc_anchors(ted4_scene *s);
int ted4_scene_alloc_shifts(ted4_scene *s);

/* For encoders: returns a scene with the header *h, with all arrays allocated and zeroed, and with
 * blobs of mode TED4_BLOB_AUTO, or NULL if memory ran out. The values of the header must be in
 * range. The caller frees the scene with ted4_scene_free. o may be NULL. */
ted4_scene *ted4_scene_new(const ted4_header *h, const ted4_options *o);

/* Computes the hash of the decoded integers (spec 15.2). */
void ted4_scene_hash(const ted4_scene *s, uint8_t hash[16]);

#endif
