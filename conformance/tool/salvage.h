/* salvage.h - what a lenient decoder has to return for a file that is not valid (spec 3.3),
 * computed from the valid file before it was broken.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_SALVAGE_H
#define CONF_SALVAGE_H

#include <jansson.h>
#include "stream.h"

/* Returns the "salvage" of a descriptor for the recipe's line `salvage TILES [ID at PLACE]`: an
 * object, or null for 0 tiles. valid: the file before it was broken; stop: the error that the
 * recipe expects, used if the line has no ID at PLACE. */
json_t *conf_salvage(const conf_line *l, const conf_bytes *valid, const conf_stream *s,
                     const json_t *stop, const json_t *queries);

#endif
