/* decode.h - pass 2 of spec 5.3, one chunk at a time. The strict decoder, the lenient decoder and
 * the validator share it.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_DECODE_H
#define TED4_DECODE_H

#include "norm/prior.h"
#include "read/container.h"

struct ted4_tile_job;

typedef struct {
    const ted4_options *o; /* never NULL; borrowed */
    ted4_scene *s;         /* owned by the caller */
    ted4_reader file;      /* reads the whole file; its error is the verdict on the payloads */
    uint64_t file_bytes;   /* file size for which the bounds of the level are checked */
    ted4_prior prior;
    ted4_gauss_many many; /* for readers of tiles */
    struct ted4_tile_job *jobs;
    unsigned n_workspaces, n_queued; /* tiles decoded at the same time; tiles that are queued */
    unsigned n_tiles;                /* TILE chunks seen so far */
    unsigned n_good;                 /* tiles before the first error, decoded so far */
} ted4_decoder;

/* Prepares to decode from the first byte of the file. data and o are borrowed; o may be NULL.
 * Returns 1, or 0 with s == NULL if out of memory. */
int ted4_decoder_init(ted4_decoder *d, const void *data, size_t size, const ted4_options *o);
/* Parses the payload of one chunk. Chunks must be given in the order of the file, after the level
 * has been stored in s. A tile may be queued instead of decoded at once. After an error, only tiles
 * that were queued before it are valid. */
void ted4_decoder_chunk(ted4_decoder *d, const ted4_chunk_place *p);
/* Returns a reader of the payload of a chunk; it ends where the payload ends. */
ted4_reader ted4_decoder_reader(ted4_decoder *d, const ted4_chunk_place *p);
/* Decodes the tiles that are still queued, and frees the work memory of tiles. */
void ted4_decoder_finish(ted4_decoder *d);

#endif
