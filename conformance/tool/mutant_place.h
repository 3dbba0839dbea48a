/* mutant_place.h - where a mutant is judged: by which kernels, with how many threads, and with
 * which decoder of DEFLATE. A place is named by the words of a line "@" of mutants.list: (none)
 * plain kernels, one thread, zlib v3, v4           the kernels that TED4_KERNEL names so
 * (base/level.h) vnni, no-vnni    v4 on a machine with, or without, the VNNI extension of AVX-512
 *     neon             as v3 and v4
 *     threads          plain kernels and a team of threads
 *     printed          plain kernels, and the decoder of DEFLATE that annex L prints
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_MUTANT_PLACE_H
#define CONF_MUTANT_PLACE_H

/* The annex, whose printed code a mutant of the place "printed" changes, and what uses that code
 * instead of read/inflate.c. */
#define CONF_ANNEX_L         "spec/annex-l-deflate.md"
#define CONF_PRINTED_INFLATE "player/wasm/inflate.c"

typedef struct {
    const char *name;     /* "": the first place above */
    const char *variable; /* "TED4_KERNEL=" and a level */
    const char *needs;    /* what a machine may lack, in words; NULL: nothing */
    int threads;          /* of replay: 1, or the size of a team */
    int printed;          /* 1: DEFLATE by annex L */
} conf_place;

/* Returns place i = 0, 1 .. in the order above, or NULL if there are no more. */
const conf_place *conf_place_at(int i);
/* Returns the place with this name, or NULL if there is none. */
const conf_place *conf_place_named(const char *name);
/* Returns 1 if mutants can be judged there on this machine, else 0. */
int conf_place_is_here(const conf_place *place);

#endif
