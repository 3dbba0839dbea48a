/* transcode.h - writes the scene of a file again, in another profile (spec 13).
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_TRANSCODE_H
#define TED4_TRANSCODE_H

#include <stddef.h>
#include <stdint.h>

#include "base/parallel.h"
#include "base/status.h"

/* Writes the file [size] in a profile of spec 5.1. All decoded integers and all values of networks
 * stay what they are. So does the order of anchors, and with it the hash of spec 15.2, unless the
 * positions lie on a grid whose order is not that of profile Main: then, on the way to Main,
 * anchors are sorted and *sorted is 1. META, CAMS, THMB and chunks that are safe to copy are kept;
 * others are dropped, and *dropped is their number. Returns 0 with *out, which the caller frees
 * with free(); or -1 with *why, a text, or NULL if the file was refused, as *e says. p may be
 * NULL. */
int ted4_transcode(const uint8_t *file, size_t size, int profile, const ted4_parallel *p,
                   uint8_t **out, size_t *out_size, int *sorted, size_t *dropped, ted4_error *e,
                   const char **why);

#endif
