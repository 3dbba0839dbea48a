/* tables.h - annex A: the tables of Tier E. tests/gen/gen_tables.c generates tables.c, and
 * tests/decoder/test_tables.c checks it.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_TABLES_H
#define TED4_TABLES_H

#include <stdint.h>

enum {
    TED4_N_SIGMA = 240,
    TED4_N_PHI = 1025,
    TED4_N_SIN = 1025,
    TED4_N_STEP = 256,
    TED4_N_WHERE = 256
};

extern const uint16_t ted4_half[TED4_N_SIGMA]; /* HALF: half window per sigma index, spec 9.4 */
extern const int32_t ted4_inv[TED4_N_SIGMA];   /* INV: 2^17 / sigma */
extern const int32_t ted4_phi[TED4_N_PHI];     /* PHI: 2^24 Phi((i - 512) / 64) */
extern const int16_t ted4_sin[TED4_N_SIN];     /* SIN: 4096 sin(2 pi i / 1024), spec 10.1 */
extern const uint32_t ted4_step[TED4_N_STEP];  /* STEP: binary32 patterns of 2^((i - 128) / 32) */
extern const int32_t ted4_stepi[TED4_N_STEP];  /* STEPI: 4096 STEP */

/* Not in the specification: 2^14 Phi^-1((i + 1/2) / 256), from which the search for a symbol in
 * gaussian.c and kernel/ starts. */
extern const int32_t ted4_where[TED4_N_WHERE];

#endif
