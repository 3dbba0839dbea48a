/* parse.h - parses Tier E of a file as far as it can be read, whatever the hash in ENDS.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_FUZZ_PARSE_H
#define TED4_FUZZ_PARSE_H

#include <stddef.h>
#include <stdint.h>
#include "norm/scene.h"

/* Returns the scene of a file that a decoder accepts apart from the hash in ENDS; its hash member
 * is the value that ENDS should contain. If forgiving is set, substreams may be any bytes,
 * and symbols are decoded from them: a substream that ends too early continues with likely symbols,
 * and the remaining bytes of one that ends too late are ignored. Where positions or weights that
 * are read in this way from a file of profile Compact are not legal, others replace them. Returns
 * NULL if something else is wrong, or memory ran out. *ends: offset of the payload of ENDS. Free
 * the scene with ted4_scene_free. */
ted4_scene *fuzz_parse(const uint8_t *data, size_t size, int forgiving, size_t *ends);

#endif
