/* cli_shared.c - the decoder programs' helpers for command lines, for the encoder programs too:
 * each side links its own tool folder, so these sources
 * are compiled once more here.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "tool/arguments.c"
#include "tool/cli.c"
