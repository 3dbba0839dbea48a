/* parse.h - Tier E of a file as far as it can be read, whatever the hash in ENDS says.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_FUZZ_PARSE_H
#define TED4_FUZZ_PARSE_H

#include <stddef.h>
#include <stdint.h>
#include "norm/scene.h"

/* The scene of a file that a decoder accepts but for the hash in ENDS; its hash member is what ENDS
 * has to say. forgiving: the payloads of TILE may hold anything at all, and symbols come out of it:
 * a substream that ends too early gives what is likely, one that ends too late is left there. NULL:
 * something else is wrong, or there is no memory. *ends: offset of the payload of ENDS. Free it
 * with ted4_scene_free. */
ted4_scene *fuzz_parse(const uint8_t *data, size_t size, int forgiving, size_t *ends);

#endif
