/* answer.h - what our decoder answers to a byte string under the driver contract (conformance/README.md), without a process of its own.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_ANSWER_H
#define CONF_ANSWER_H

#include <jansson.h>
#include "text.h"

/* The document that ted4dec would print for all tiers. queries: an array, or NULL. max_bytes: of memory; 0: the decoder's own bound.
 * A new reference. */
json_t *conf_answer(const conf_bytes *file, const json_t *queries, uint64_t max_bytes);

#endif
