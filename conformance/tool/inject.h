/* inject.h - tiles that no encoder writes: one symbol of a substream replaced by what the coder can
 * say but the rules forbid.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_INJECT_H
#define CONF_INJECT_H

#include "norm/scene.h"
#include "text.h"

typedef enum {
    CONF_INJECT_NOTHING,
    CONF_INJECT_VALUE /* k, also beyond 16 bits */,
    CONF_INJECT_ESCAPE /* r = -hw - 1 - value, or on the high side */,
    CONF_INJECT_ONES /* a low escape whose length is value ones, then a zero and that many zeros */
} conf_inject_way;

typedef struct {
    conf_inject_way way;
    unsigned substream; /* from 0 in the tile, masks included */
    size_t symbol;      /* from 0 in the substream */
    int64_t value;
    int high; /* side of an escape */
} conf_injection;

/* Payload of a tile of the scene, whatever the rules of its values say. */
void conf_inject(conf_bytes *payload, const ted4_scene *s, unsigned tile,
                 const conf_injection *what);

#endif
