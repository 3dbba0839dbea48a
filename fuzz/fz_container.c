/* fz_container.c - any bytes, given to pass 1 (spec 5.3), which parses no payload and allocates no
 * memory. Claims: a refusal has an offset inside the file; an accepted file consists of chunks
 * without a gap from the file header to the last byte, with HEAD first and ENDS last.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "harness.h"
#include "read/container.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    ted4_reader r;
    size_t at = TED4_FILE_HEADER_SIZE;
    int type = TED4_CHUNKS;

    ted4_reader_init(&r, data, 0, size, 1);
    ted4_container_check(&r);
    fuzz_require(r.base.error.offset <= size, "an offset in the file");
    if (r.base.error.code != TED4_OK)
        return 0;
    fuzz_require(r.base.pos == size, "all bytes looked at");
    r.base.pos = at;
    while (at < size) {
        const ted4_chunk_place p = ted4_container_next(&r);

        fuzz_require(p.at == at && p.payload == at + TED4_FRAME_HEAD_SIZE && p.end >= p.payload &&
                         r.base.pos == p.end + TED4_FRAME_HASH_SIZE && r.base.pos <= size,
                     "chunks without a gap");
        fuzz_require(at > TED4_FILE_HEADER_SIZE || p.type == TED4_HEAD, "HEAD first");
        at = r.base.pos;
        type = p.type;
    }
    fuzz_require(at == size && type == TED4_ENDS, "ENDS last");
    return 0;
}
