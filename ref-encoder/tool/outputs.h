/* outputs.h - the files that ted4enc is to write, before hours of training: can they be written, is
 * nothing lost by it, and has each a name of its own?
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_OUTPUTS_H
#define TED4_OUTPUTS_H

#include <stddef.h>

#include "request.h"

/* Returns 0, or -1 with why filled. */
int ted4_outputs_check(const ted4_request *r, char *why, size_t why_size);

#endif
