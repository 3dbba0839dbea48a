/* scene.h - a scene's memory and its hash. The encoder fills scenes itself.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SCENE_H
#define TED4_SCENE_H

#include "norm/syntax.h"

/* A scene without a header. NULL: no memory. Free it with ted4_scene_free. */
ted4_scene *ted4_scene_empty(const ted4_options *o);
/* Storage for one blob of n values: 1, or 0: no memory. */
int ted4_blob_alloc(ted4_scene *s, ted4_blob *b, uint64_t n);
/* Everything that has one entry an anchor, and shift and prob. head and shape are filled. 1, or 0:
 * no memory. */
int ted4_scene_alloc_anchors(ted4_scene *s);
int ted4_scene_alloc_shifts(ted4_scene *s);

/* For encoders: a scene of that header with all arrays, zeroed, and blobs in mode TED4_BLOB_AUTO.
 * The header's values must be in range.
 * NULL: no memory. o may be NULL. */
ted4_scene *ted4_scene_new(const ted4_header *h, const ted4_options *o);

/* spec 15.2 */
void ted4_scene_hash(const ted4_scene *s, uint8_t hash[16]);

#endif
