/* open_decoded.h - decodes a file and prepares it for queries.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_OPEN_DECODED_H
#define TED4_OPEN_DECODED_H

#include "ted4.h"

typedef struct {
    ted4_scene *scene; /* owned, as recon */
    ted4_recon *recon;
    ted4_info info;
    size_t bytes; /* size of the file */
} decoded;

/* Returns an exit code, and has printed a line of the program if it is not TED4_EXIT_FINE. */
int open_decoded(const char *program, const char *path, decoded *d);

#endif
