/* inject.h - makes tiles that no encoder writes: one symbol of a substream is replaced by a symbol
 * that the coder can code but the rules forbid.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_INJECT_H
#define CONF_INJECT_H

#include "norm/scene.h"
#include "text.h"

typedef enum {
    CONF_INJECT_NOTHING,
    CONF_INJECT_VALUE /* the value k, which may exceed 16 bits */,
    CONF_INJECT_ESCAPE /* r = -hw - 1 - value; on the high side, hw + 2 + value */,
    CONF_INJECT_ONES /* an escape that begins with value ones, a zero, and value zeros */
} conf_inject_way;

typedef struct {
    conf_inject_way way;
    unsigned substream; /* index in the tile, with the masks counted */
    size_t symbol;      /* index in the substream */
    int64_t value;
    int high; /* 1: an escape on the high side */
} conf_injection;

/* Appends the payload of a tile of the scene with the injected symbol. The rules for values are not
 * checked. */
void conf_inject(conf_bytes *payload, const ted4_scene *s, unsigned tile,
                 const conf_injection *what);

#endif
