/* cli.h - functions that all programs share: beginning and end, reading a file, and reporting
 * why a stream was refused.
 * Exit codes: 0 success; 1 the stream was refused; 2 success with warnings; 3 wrong usage, failed
 * input or output, a query without a result, or too few resources.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_CLI_H
#define TED4_CLI_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "base/status.h"

enum { TED4_EXIT_FINE = 0, TED4_EXIT_REFUSED = 1, TED4_EXIT_WARNED = 2, TED4_EXIT_TOOL = 3 };

/* Called by a program before it opens or writes anything: ted4_arguments_next does so. From then on
 * no file gets the number of a standard stream that is closed; and a file that reaches the limit of
 * file sizes (ulimit -f) is an error of output, as on a full disk, for this process and its
 * children; by itself, the system would end the process. */
void ted4_cli_begin(void);
/* Called where standard output takes no more, with the errno of that, which is gone by the end:
 * ted4_cli_end says so. */
void ted4_cli_lost(int why);
/* Returns 0 if this machine can run the kernels that TED4_KERNEL names, or if it is not set;
 * otherwise prints a message and returns -1. */
int ted4_cli_kernels(const char *program);
/* Called when everything has been printed. Returns code; or TED4_EXIT_TOOL, after a message, if
 * standard output could not take it all. */
int ted4_cli_end(const char *program, int code);

/* read_file.c: reads a whole file, or standard input if path is "-". Returns a buffer from malloc
 * that the caller frees, or NULL with errno set. */
uint8_t *ted4_read_file(const char *path, size_t *size);
/* The same for a file that should be a TED4 file: of another one, or of one that is longer than its
 * level allows, whatever its size, only as much is read as it is refused with. */
uint8_t *ted4_read_ted4(const char *path, size_t *size);
/* Reads the rest of a stream, which may be a pipe. Returns a buffer from malloc that the caller
 * frees, or NULL if there is no memory or the stream fails. */
uint8_t *ted4_read_stream(FILE *f, size_t *size);

/* Reports on stderr why path was not decoded: "ted4dec: a.ted4: byte 1234: text [id]
 * (specification 5.1)". With json, also prints an object on stdout. Returns the exit code of the
 * verdict. An error of a query says nothing against the file: it is reported without an offset, and
 * the exit code is TED4_EXIT_TOOL. */
int ted4_report(const char *program, const char *path, const ted4_error *e, int json);

/* Reports that path cannot be read, for the reason in errno, in the same way. Returns the exit
 * code. */
int ted4_report_unread(const char *program, const char *path, int json);

#endif
