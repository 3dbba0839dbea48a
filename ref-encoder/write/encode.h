/* encode.h - from a scene to the bytes of a file, and what they cost. The trainer fills the scene
 * (norm/scene.h):
 *     s = ted4_scene_new(&head, NULL);   networks by ted4_snap (write/snap.h), positions sorted by
 *                                        ted4_positions_sort
 *     ted4_scene_steps(s, ...);          step indices from the hyperprior
 *     ... masks and symbols ...
 *     ted4_encode(s, 0, ...);
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_ENCODE_H
#define TED4_ENCODE_H

#include "norm/scene.h"

/* Evaluates the hyperprior for every anchor and fills step_index. head, nete, shift and position
 * are there. e may be NULL; its offset means nothing. */
ted4_status ted4_scene_steps(ted4_scene *s, const ted4_parallel *p, ted4_error *e);

/* Writes a whole file. level 0: the lowest that fits (ted4_level_lowest). Blobs of mode
 * TED4_BLOB_AUTO are deflated when that is smaller, and zero probabilities are counted; what a file
 * has said before is written again as it was. A scene that no decoder would accept is refused with
 * the decoder's status; step indices that are not those of the prior, and masks that contradict the
 * header, with TED4_E_SYN_HASH.
 * *out is the caller's, to be freed with free(); NULL on failure. e may be NULL. */
ted4_status ted4_encode(const ted4_scene *s, int level, const ted4_parallel *p, uint8_t **out,
                        size_t *size, ted4_error *e);

/* The same with a chunk META before ENDS (spec 5.2): text, lines key=value for people, each ended
 * by LF; no key twice. NULL: without. */
ted4_status ted4_encode_with_text(const ted4_scene *s, int level, char *text,
                                  const ted4_parallel *p, uint8_t **out, size_t *size,
                                  ted4_error *e);

/* Ideal code lengths, -log2 of the coded frequencies, in bits. */
typedef struct {
    double mask;
    double slice[TED4_MAX_SLICES]; /* of the feature */
    double type[TED4_TYPES];       /* [TED4_FEATURE]: the sum of slice */
    double frame;                  /* tile headers, and 16 bits for each lane */
    double total;                  /* of the TILE payloads */
} ted4_bits;

/* Same walk, same refusals as ted4_encode. */
ted4_status ted4_count(const ted4_scene *s, const ted4_parallel *p, ted4_bits *bits, ted4_error *e);

#endif
