/* spans_failed.c - see spans.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdio.h>
#include "spans.h"
#include "tool/cli.h"

int failed(const char *what, const char *why)
{
    fprintf(stderr, "spans: %s: %s\n", what, why);
    return TED4_EXIT_TOOL;
}
