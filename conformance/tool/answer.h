/* answer.h - the answer of this project's decoder to a byte string, as the driver contract
 * (conformance/README.md) defines it, computed without a separate process.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_ANSWER_H
#define CONF_ANSWER_H

#include <jansson.h>
#include "ted4.h"
#include "text.h"

/* The limits that the knobs of a vector set; 0: the decoder's own limit. */
typedef struct {
    uint64_t memory, work; /* max_alloc_total, max_work */
} conf_knobs;

/* Returns the limits in the "knobs" of a descriptor. */
conf_knobs conf_knobs_of(const json_t *descriptor);

/* Returns, as a new reference, the document that ted4dec prints when asked for all tiers. queries:
 * an array, or NULL. */
json_t *conf_answer(const conf_bytes *file, const json_t *queries, conf_knobs knobs);
/* Like conf_answer, but in lenient mode (spec 3.3). */
json_t *conf_answer_lenient(const conf_bytes *file, const json_t *queries, conf_knobs knobs);

/* Returns the "salvage" object of an answer or of a descriptor: a reduced scene, its tiles, and the
 * error that stopped decoding. */
json_t *conf_salvaged(const ted4_scene *s, const ted4_salvage *what, const json_t *queries);
/* Returns the tiers of a decoded scene. T0 needs file; if file is NULL, the tiers start at T1. */
json_t *conf_tiers(const conf_bytes *file, const ted4_scene *s, const json_t *queries);

#endif
