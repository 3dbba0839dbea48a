/* encode_main.h - ted4enc: trains a scene and writes it as a .ted4 file, alone or together with
 * other processes.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_ENCODE_MAIN_H
#define TED4_ENCODE_MAIN_H

#include "train/state/exchange.h"

/* Does what the command line says. x: the other processes of this run, which call this function
 * with the same command line; NULL: alone. Only rank 0 writes files and messages, except that a
 * process which fails alone says so. Returns the exit status. */
int ted4_encoder_main(int argc, char **argv, ted4_exchange *x);

#endif
