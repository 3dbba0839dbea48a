/* coder_write.h - the coder that writes (norm/coder.h).
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_CODER_WRITE_H
#define TED4_CODER_WRITE_H

#include "norm/coder.h"
#include "write/rans_enc.h"

typedef struct {
    ted4_coder base;          /* must be first; base.pos is out.size */
    ted4_buffer out;          /* owned */
    ted4_rans_enc rans;       /* owned */
    size_t sizes;             /* offset in out of the next entry of the tile's size[] to fill in;
                                 SIZE_MAX: there is none */
    uint64_t least;           /* bytes that the current substream must have */
    size_t opened, n_symbols; /* of the current substream: offset in out, number of symbols */
} ted4_writer;

void ted4_writer_init(ted4_writer *w);
void ted4_writer_finish(ted4_writer *w);

#endif
