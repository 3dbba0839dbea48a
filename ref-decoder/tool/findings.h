/* findings.h - ted4info --validate: prints findings as text or as one JSON object
 * (conformance/schema/validate.schema.json). Depends on ted4.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_TOOL_FINDINGS_H
#define TED4_TOOL_FINDINGS_H

#include <stddef.h>
#include <stdint.h>

#include "ted4.h"

/* Validates a file with the options o and prints every finding on standard output; with quiet, only
 * errors. Returns an exit code of cli.h: success, refused, success with warnings, or TED4_EXIT_TOOL
 * if a limit was reached. A hint does not count as a warning. */
int ted4_findings_print(const char *path, const uint8_t *data, size_t size, const ted4_options *o,
                        int json, int quiet);

#endif
