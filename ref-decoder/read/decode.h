/* decode.h - pass 2 of spec 5.3, a chunk at a time: what the strict, the lenient decoder and the
 * validator share.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_DECODE_H
#define TED4_DECODE_H

#include "norm/prior.h"
#include "read/container.h"

struct ted4_tile_job;

typedef struct {
    const ted4_options *o; /* never NULL; borrowed */
    ted4_scene *s;         /* the caller's to free */
    ted4_reader file;      /* of the whole file; its error is the verdict on payloads */
    uint64_t file_bytes;   /* what the bounds of the level are judged by */
    ted4_prior prior;
    ted4_gauss_many many; /* for readers of tiles */
    struct ted4_tile_job *jobs;
    unsigned n_workspaces, n_queued; /* tiles that run at once; tiles that wait to run */
    unsigned n_tiles;                /* seen so far */
    unsigned n_good;                 /* decoded without an error here or before */
} ted4_decoder;

/* data and o are borrowed; o may be NULL. file stands at the first byte. 1, or 0: no memory, s is
 * NULL. */
int ted4_decoder_init(ted4_decoder *d, const void *data, size_t size, const ted4_options *o);
/* Parses the payload of a chunk of a file in order, the level being in s. Tiles may be queued.
 * After an error only tiles that were queued before are of use. */
void ted4_decoder_chunk(ted4_decoder *d, const ted4_chunk_place *p);
/* What reads the payload of a chunk; ends where that ends. */
ted4_reader ted4_decoder_reader(ted4_decoder *d, const ted4_chunk_place *p);
/* Runs what is queued and gives the memory of tiles back. */
void ted4_decoder_finish(ted4_decoder *d);

#endif
