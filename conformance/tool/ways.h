/* ways.h - decodes a file with other combinations of options that callers may use: threads, a
 * trace, or no options at all. None of them may change the result (R-DEC-004), or take more memory
 * than spec 13.3 allows. The decoded scene is also copied into a scene of the form that encoders
 * make.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_WAYS_H
#define CONF_WAYS_H

#include "answer.h"

/* Returns the name of the first way of decoding whose result differs from that without threads and
 * trace, or that takes too much memory, or NULL if there is none. */
const char *conf_ways_differ(const conf_bytes *file, conf_knobs knobs);

#endif
