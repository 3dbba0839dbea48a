/* encode.h - writes a scene as a file, and counts its bits. The trainer fills the scene
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
 * are filled already. e may be NULL; its offset has no meaning. */
ted4_status ted4_scene_steps(ted4_scene *s, const ted4_parallel *p, ted4_error *e);

/* Writes a whole file. level 0 stands for the lowest level that fits (ted4_level_lowest). Blobs of
 * mode TED4_BLOB_AUTO get the smallest mode that s->profile has, and probabilities of 0 are
 * computed from the masks. The modes and probabilities of a scene that was read from a file are
 * written unchanged. A scene that no decoder would accept is refused with the status that the
 * decoder would return. Step indices that are not those of the prior, and masks that contradict the
 * header, are refused with TED4_E_SYN_HASH. On success *out is owned by the caller, who frees it
 * with free(); on failure it is NULL. e may be NULL. */
ted4_status ted4_encode(const ted4_scene *s, int level, const ted4_parallel *p, uint8_t **out,
                        size_t *size, ted4_error *e);

/* Like ted4_encode, with a chunk META before ENDS (spec 5.2) that holds text: lines key=value for
 * human readers, each ended by LF, without repeated keys. If text is NULL, there is no META. */
ted4_status ted4_encode_with_text(const ted4_scene *s, int level, char *text,
                                  const ted4_parallel *p, uint8_t **out, size_t *size,
                                  ted4_error *e);

/* Ideal code lengths in bits: the sums of -log2 of the coded frequencies. */
typedef struct {
    double mask;
    double slice[TED4_MAX_SLICES]; /* each slice of the feature */
    double type[TED4_TYPES];       /* each type; that of TED4_FEATURE is the sum of slice */
    double frame;                  /* tile headers, and 16 bits per rANS lane */
    double total;                  /* all TILE payloads */
} ted4_bits;

/* Counts the bits of all tiles. Walks the scene as ted4_encode does, and refuses the same scenes.
 */
ted4_status ted4_count(const ted4_scene *s, const ted4_parallel *p, ted4_bits *bits, ted4_error *e);

#endif
