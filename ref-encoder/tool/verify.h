/* verify.h - the encoder decodes what it wrote and compares all of it; nothing is written
 * otherwise.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_VERIFY_H
#define TED4_VERIFY_H

#include "norm/syntax.h"

typedef struct {
    uint32_t anchors, dynamic;
    size_t gaussians;
    double estimated_bits,
        coded_bits; /* sum of -log2 p of the attributes; bits of their substreams */
    char hash[33];  /* of the decoded integers, hexadecimal */
} ted4_verified;

/* 0, or -1 with why filled: refused, or something differs from scene. */
int ted4_verify(const ted4_scene *scene, const uint8_t *bytes, size_t size, const ted4_parallel *p,
                ted4_verified *v, char *why, size_t why_size);

#endif
