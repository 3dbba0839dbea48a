/* json_file.h - reads JSON from files that people write.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_JSON_FILE_H
#define TED4_JSON_FILE_H

#include <jansson.h>
#include <stddef.h>

/* Returns the JSON text in a file, which the caller owns; or NULL with why filled: the system's
 * reason, or a line and what is wrong there. A byte order mark is skipped. */
json_t *ted4_json_load(const char *path, char *why, size_t why_size);

#endif
