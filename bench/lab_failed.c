/* lab_failed.c - see lab_facts.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdio.h>
#include "lab_facts.h"
#include "tool/cli.h"

int lab_failed(const char *what, const char *why)
{
    fprintf(stderr, "lab_facts: %s: %s\n", what, why);
    return TED4_EXIT_TOOL;
}
