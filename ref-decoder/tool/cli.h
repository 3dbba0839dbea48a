/* cli.h - what every program does: read a file, say why a stream was refused.
 * Exit codes: 0 fine, 1 stream refused, 2 fine with warnings, 3 usage, input, output or resources.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_CLI_H
#define TED4_CLI_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "base/status.h"

enum { TED4_EXIT_FINE = 0, TED4_EXIT_REFUSED = 1, TED4_EXIT_WARNED = 2, TED4_EXIT_TOOL = 3 };

/* read_file.c: a whole file, or standard input when path is "-". malloc'd, to be freed; NULL with
 * errno set. */
uint8_t *ted4_read_file(const char *path, size_t *size);
/* All that is left of a stream, in whatever pieces it comes. malloc'd; NULL: no memory, or an error
 * of the stream. */
uint8_t *ted4_read_stream(FILE *f, size_t *size);

/* Says on stderr why path was not decoded: "ted4dec: a.ted4: byte 1234: text [id] (specification
 * 5.1)"; with json also an object on stdout. Returns the
 * exit code of the verdict. */
int ted4_report(const char *program, const char *path, const ted4_error *e, int json);

#endif
