/* verify.h - the encoder decodes its own output and compares it with the scene; a file that differs
 * is not written.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_VERIFY_H
#define TED4_VERIFY_H

#include "norm/syntax.h"

typedef struct {
    uint32_t anchors, dynamic;
    size_t gaussians;
    /* Of the attributes: sum of -log2 p, set by the caller, and size of their substreams. */
    double estimated_bits, coded_bits;
    char hash[33]; /* hash of the decoded integers, hexadecimal */
} ted4_verified;

/* Decodes the file and compares it with scene. Returns 0, or -1 with why filled: the decoder
 * refuses the file, or the result differs. */
int ted4_verify(const ted4_scene *scene, const uint8_t *bytes, size_t size, const ted4_parallel *p,
                ted4_verified *v, char *why, size_t why_size);

#endif
