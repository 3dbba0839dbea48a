/* tier_hash.c - see tier_hash.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "tier_hash.h"

#include <stdlib.h>
#include <string.h>
#include <xxhash.h>
#include "record.h"
#include "sha256.h"

enum { BUFFER = 1 << 14 };

struct ted4_tier_hash {
    FILE *keep;
    XXH3_state_t *xxh3; /* owned */
    ted4_sha256 sha256;
    uint64_t size;
    size_t n; /* bytes in the buffer */
    uint8_t bytes[BUFFER];
};

ted4_tier_hash *ted4_tier_hash_new(FILE *keep)
{
    ted4_tier_hash *h = calloc(1, sizeof *h);

    if (h == NULL)
        return NULL;
    h->keep = keep;
    h->xxh3 = XXH3_createState();
    if (h->xxh3 == NULL) {
        free(h);
        return NULL;
    }
    (void)XXH3_128bits_reset(h->xxh3);
    ted4_sha256_init(&h->sha256);
    return h;
}

static void flush(ted4_tier_hash *h)
{
    (void)XXH3_128bits_update(h->xxh3, h->bytes, h->n);
    ted4_sha256_add(&h->sha256, h->bytes, h->n);
    if (h->keep != NULL)
        fwrite(h->bytes, 1, h->n, h->keep); /* the owner of keep checks ferror */
    h->size += h->n;
    h->n = 0;
}

void ted4_tier_hash_add(void *hash, const void *bytes, size_t size)
{
    ted4_tier_hash *h = hash;
    const uint8_t *p = bytes;

    while (size > 0) {
        const size_t bytes_left = BUFFER - h->n, n = size < bytes_left ? size : bytes_left;

        memcpy(h->bytes + h->n, p, n);
        h->n += n;
        p += n;
        size -= n;
        if (h->n == BUFFER)
            flush(h);
    }
}

json_t *ted4_tier_hash_end(ted4_tier_hash *h)
{
    XXH128_canonical_t canonical;
    uint8_t sha[TED4_SHA256_SIZE];
    char xxh3_hex[33], sha_hex[65];
    json_t *o;

    if (h == NULL)
        return NULL;
    flush(h);
    XXH128_canonicalFromHash(&canonical, XXH3_128bits_digest(h->xxh3));
    ted4_sha256_end(&h->sha256, sha);
    ted4_hex(xxh3_hex, canonical.digest, sizeof canonical.digest);
    ted4_hex(sha_hex, sha, sizeof sha);
    o = json_pack("{s:I, s:s, s:s}", "bytes", (json_int_t)h->size, "xxh3", xxh3_hex, "sha256",
                  sha_hex);
    XXH3_freeState(h->xxh3);
    free(h);
    return o;
}

void ted4_tier_records(const ted4_gaussians *g, ted4_sink *sink, void *user)
{
    const float *const column[TED4_RECORD_FLOATS] = TED4_RECORD_COLUMNS(g);

    for (size_t i = 0; i < g->n; i++) {
        uint8_t record[4 * TED4_RECORD_FLOATS];

        ted4_record_store(record, column, i);
        sink(user, record, sizeof record);
    }
}
