/* ways.h - a file given to our decoder as other callers may give it: with threads, with a trace,
 * with nothing but the file. None of that may matter (R-DEC-004). What is decoded is copied into a
 * scene as encoders make it, too.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_WAYS_H
#define CONF_WAYS_H

#include "answer.h"

/* The way in which something else came out than without threads and trace; NULL: all agree. */
const char *conf_ways_differ(const conf_bytes *file, conf_knobs knobs);

#endif
