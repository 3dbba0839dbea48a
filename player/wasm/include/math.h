/* math.h - what the decoder takes of ISO C 7.12; the root is an instruction of WebAssembly.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_WASM_MATH_H
#define TED4_WASM_MATH_H

#define HUGE_VALF __builtin_huge_valf()

static inline float sqrtf(float x)
{
    return __builtin_sqrtf(x);
}

#endif
