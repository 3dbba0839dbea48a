/* reader.h - the coder that reads a file in memory (norm/coder.h).
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_READER_H
#define TED4_READER_H

#include "kernel/gauss_kernel.h"
#include "norm/coder.h"
#include "read/rans_dec.h"

enum { TED4_READER_SUBSTREAMS = 24 };

typedef struct {
    ted4_coder base;      /* must be first; base.pos counts from the file's first byte */
    const uint8_t *data;  /* borrowed: the file */
    size_t end;           /* offset of the first byte that must not be read */
    int whole_file;       /* reading beyond end means: 1: a truncated file; 0: a short payload */
    ted4_arena *arena;    /* for deflated blobs */
    ted4_gauss_many many; /* reads several symbols at a time; NULL: not available */
    uint32_t size[TED4_READER_SUBSTREAMS];
    unsigned n_opened;
    size_t n_symbols; /* of the open substream */
    size_t opened;    /* offset of its first byte */
    ted4_rans_dec rans;
} ted4_reader;

/* Prepares to read bytes [pos, end) of a file. data is borrowed. */
void ted4_reader_init(ted4_reader *r, const uint8_t *data, size_t pos, size_t end, int whole_file);

#endif
