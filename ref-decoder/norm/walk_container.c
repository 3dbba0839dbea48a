/* walk_container.c - spec 5.1, 5.2, 5.4: codes the file header, chunk frames, and ENDS.
 * read/container.c checks the order and the hashes of chunks.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "norm/coder.h"

#include <string.h>
#include "base/bytes.h"
#include "norm/limits.h"

const char ted4_chunk_type[TED4_CHUNKS][5] = { "HEAD", "NETE", "NETR", "BANK",
                                               "POSN", "TILE", "ENDS" };

/* spec 5.1 */
void ted4_walk_file_header(ted4_coder *c, unsigned minor, uint8_t *profile, uint8_t *level)
{
    static const uint8_t magic[8] = { 0x89, 'T', 'E', 'D', '4', 13, 10, 26 };
    uint8_t bytes[8];
    size_t at = c->pos;

    memcpy(bytes, magic, sizeof magic);
    c->ops->array(c, 1, bytes, sizeof bytes);
    ted4_require(c, memcmp(bytes, magic, sizeof magic) == 0, TED4_E_CON_MAGIC, at);
    for (int i = 0; i < 8; i++)
        ted4_trace(c, at + (size_t)i, "magic", i, bytes[i]);
    at = c->pos;
    ted4_require(c, ted4_code(c, "major", 0, 1, 1) == 1, TED4_E_CON_VERSION, at);
    ted4_code(c, "minor", 0, 1, minor);
    at = c->pos;
    *profile = (uint8_t)ted4_code(c, "profile", 0, 1, *profile);
    ted4_require(c, *profile <= TED4_PROFILE_COMPACT, TED4_E_UNSUPPORTED_PROFILE, at);
    at = c->pos;
    *level = (uint8_t)ted4_code(c, "level", 0, 1, *level);
    ted4_require(c, ted4_limits_of(*level) != NULL, TED4_E_CON_LEVEL, at);
}

/* spec 5.2 */
void ted4_walk_frame(ted4_coder *c, ted4_frame *f)
{
    const size_t at = c->pos;

    c->ops->array(c, 1, f->type, sizeof f->type);
    ted4_trace(c, at, "chunk_type", 0, ted4_load32(f->type));
    f->flags = ted4_code(c, "chunk_flags", 0, 4, f->flags);
    f->size = ted4_code(c, "chunk_size", 0, 4, f->size);
}

/* spec 5.4 */
void ted4_walk_ends(ted4_coder *c, const uint8_t *hash)
{
    const size_t at = c->pos;
    uint8_t coded[16];

    memcpy(coded, hash, sizeof coded);
    c->ops->array(c, 1, coded, sizeof coded);
    for (int i = 0; i < 16; i++)
        ted4_trace(c, at + (size_t)i, "ends_hash", i, coded[i]);
    ted4_require(c, memcmp(coded, hash, sizeof coded) == 0, TED4_E_SYN_HASH, at);
}
