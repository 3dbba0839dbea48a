/* ways.h - decodes a file with other combinations of options that callers may use: threads, a
 * trace, or no options at all. None of them may change the result (R-DEC-004). The decoded scene is
 * also copied into a scene of the form that encoders make.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_WAYS_H
#define CONF_WAYS_H

#include "answer.h"

/* Returns the name of the first way of decoding whose result differs from that without threads and
 * trace, or NULL if all agree. */
const char *conf_ways_differ(const conf_bytes *file, conf_knobs knobs);

#endif
