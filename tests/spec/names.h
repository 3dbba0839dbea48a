/* names.h - the tables of annex A under the names that the printed code gives them. For
 * tests/support/spec_model.h and eval.c.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SPEC_NAMES_H
#define TED4_SPEC_NAMES_H

#include "norm/tables.h"

#define HALF  ted4_half
#define INV   ted4_inv
#define PHI   ted4_phi
#define SIN   ted4_sin
#define STEP  ted4_step
#define STEPI ted4_stepi

#endif
