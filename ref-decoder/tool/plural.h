/* plural.h - the ending of a counted word in a message.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_PLURAL_H
#define TED4_PLURAL_H

#include <stdint.h>

/* As in printf("%zu anchor%s", n, ted4_s(n)). */
static inline const char *ted4_s(uint64_t n)
{
    return n == 1 ? "" : "s";
}

#endif
