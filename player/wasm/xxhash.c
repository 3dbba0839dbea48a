/* xxhash.c - XXH3 for the whole module, once and for size: its own header, for speed, unrolls and
 * copies it until it is a third of the module.
 * SPDX-License-Identifier: BSD-2-Clause */
#define XXH_STATIC_LINKING_ONLY
#define XXH_IMPLEMENTATION
#include <xxhash.h>
