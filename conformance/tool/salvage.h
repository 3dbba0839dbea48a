/* salvage.h - what a lenient decoder has to give of a file that is not valid (spec 3.3), worked out
 * from the valid file that it was made of.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_SALVAGE_H
#define CONF_SALVAGE_H

#include <jansson.h>
#include "stream.h"

/* "salvage" of a descriptor, by the recipe's line `salvage TILES [ID at PLACE]`: an object, or null
 * for 0 tiles. valid: the file before it was broken; stop: the error that the recipe expects, which
 * stands for ID at PLACE where the line has none. */
json_t *conf_salvage(const conf_line *l, const conf_bytes *valid, const conf_stream *s,
                     const json_t *stop, const json_t *queries);

#endif
