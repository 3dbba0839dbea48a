/* callers.h - decodes a file and asks for its records on several threads at once, in the ways that
 * callers may: with threads that are lent to the library, beside others that decode the same bytes,
 * and beside others that ask the same scene. Nothing may change (R-DEC-004), and a build for the
 * thread sanitizer sees whether any two threads share what they write.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_CALLERS_H
#define CONF_CALLERS_H

#include "answer.h"
#include "ted4.h"

/* Returns which way differs from decoding and asking on one thread, or NULL if all agree. team: at
 * least two threads, borrowed (tool/threads.h). */
const char *conf_callers_differ(const conf_bytes *file, conf_knobs knobs,
                                const ted4_parallel *team);

#endif
