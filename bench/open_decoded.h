/* open_decoded.h - a file, decoded and laid out for queries.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_OPEN_DECODED_H
#define TED4_OPEN_DECODED_H

#include "ted4.h"

typedef struct {
    ted4_scene *scene; /* owned, as recon */
    ted4_recon *recon;
    ted4_info info;
    size_t bytes; /* of the file */
} decoded;

/* An exit code, after a line of the program where it is not TED4_EXIT_FINE. */
int open_decoded(const char *program, const char *path, decoded *d);

#endif
