/* answer.h - what our decoder answers to a byte string under the driver contract
 * (conformance/README.md), without a process of its own.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_ANSWER_H
#define CONF_ANSWER_H

#include <jansson.h>
#include "ted4.h"
#include "text.h"

/* What the knobs of a vector allow; 0: what the decoder allows by itself. */
typedef struct {
    uint64_t memory, work; /* max_alloc_total, max_work */
} conf_knobs;

/* From a descriptor's "knobs". */
conf_knobs conf_knobs_of(const json_t *descriptor);

/* The document that ted4dec would print for all tiers. queries: an array, or NULL. A new reference.
 */
json_t *conf_answer(const conf_bytes *file, const json_t *queries, conf_knobs knobs);
/* The same in lenient mode (spec 3.3). */
json_t *conf_answer_lenient(const conf_bytes *file, const json_t *queries, conf_knobs knobs);

/* "salvage" of an answer, or of a descriptor: a reduced scene, the tiles it has and what stopped
 * decoding there. */
json_t *conf_salvaged(const ted4_scene *s, const ted4_salvage *what, const json_t *queries);
/* Tiers of a decoded scene, from T1 on when file is NULL, which T0 needs. */
json_t *conf_tiers(const conf_bytes *file, const ted4_scene *s, const json_t *queries);

#endif
