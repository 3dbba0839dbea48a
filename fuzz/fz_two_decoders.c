/* fz_two_decoders.c - any bytes, given to the strict decoder and to the code that the specification
 * prints (spec 4.5, spec_model.h), which shares only the tables of annex A with it. Up to two bytes
 * after the chunk ENDS are knobs of other harnesses and ignored. Claims: both give the same
 * verdict, identifier and offset; for a valid file both give the same tiers T0 to T4, byte by byte.
 * (two_decoders.py compares with the decoder in Python.)
 * SPDX-License-Identifier: BSD-2-Clause */
#include "spec_tiers.h" /* first, because its names are common ones */
#include "harness.h"
#include "fix_hashes.h"
#include "norm/limits.h"
#include "read/container.h"

enum { TAIL = 2, SEARCH = 512 };

/* The number of steps that the printed code, which is plain and slow, may take. */
static const uint64_t patience = (uint64_t)1 << 24;

/* The expected tier, and how much of it has been received. */
typedef struct {
    const spec_bytes *want;
    size_t n;
} expected;

static void compare(void *user, const void *bytes, size_t size)
{
    expected *e = user;

    fuzz_require(size <= e->want->size - e->n && memcmp(bytes, e->want->data + e->n, size) == 0,
                 "one tier");
    e->n += size;
}

/* Returns whether the printed code ends soon. Without a valid HEAD it does. */
static int soon(const uint8_t *data, size_t size)
{
    ted4_reader r;
    ted4_chunk_place p;
    ted4_header h;
    ted4_shape shape;
    uint64_t n;
    int before = -1;
    uint8_t profile = 0;

    memset(&h, 0, sizeof h);
    ted4_reader_init(&r, data, 0, size, 1);
    (void)ted4_container_header(&r, &profile);
    p = ted4_container_judge(&r, &before);
    if (r.base.error.code != TED4_OK)
        return 1;
    ted4_reader_init(&r, data, p.payload, p.end, 0);
    ted4_walk_header(&r.base, &h, &shape, TED4_LEVEL_UNBOUNDED, UINT64_MAX);
    if (r.base.error.code != TED4_OK)
        return 1;
    /* Otherwise there are no positions (R-CON-011, R-ENT-016). */
    n = h.n_anchors <= (profile == TED4_PROFILE_MAIN ? size / 6 : 8 * size) ? h.n_anchors : 0;
    return n * ted4_count_products(&h, &shape) +
               SEARCH * n * (ted4_count_symbols(&h, &shape) / h.n_anchors) <=
           patience;
}

static void same_tiers(const spec_tiers *t, const ted4_scene *s, const uint8_t *data, size_t size)
{
    for (int i = 0; i < N_TIERS; i++) {
        expected e = { &t->tier[i], 0 };
        const ted4_status verdict = i == 0 ? ted4_dump_syntax(data, size, NULL, compare, &e, NULL)
                                           : ted4_dump_tier(s, i, NULL, compare, &e);

        fuzz_require(verdict == TED4_OK && e.n == t->tier[i].size, "whole tiers");
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const ted4_options o = { .max_bytes = FUZZ_MAX_BYTES };
    const size_t n = ted4_without_tail(data, size, TAIL);
    spec_tiers t;
    ted4_scene *s = NULL;
    ted4_error e = { TED4_OK, 0 };

    memset(&t, 0, sizeof t);
    if (!soon(data, n) || ted4_decode(data, n, &o, &s, &e) == TED4_E_LIMIT_MEMORY)
        return 0;
    spec_tiers_make(&t, data, n);
    if (t.model.p.v.id == NULL) {
        fuzz_require(e.code == TED4_OK, "both find it valid");
        same_tiers(&t, s, data, n);
    } else {
        fuzz_require(strcmp(t.model.p.v.id, ted4_status_id(e.code)) == 0, "one identifier");
        fuzz_require(t.model.p.v.offset == e.offset, "one offset");
    }
    spec_tiers_free(&t);
    ted4_scene_free(s);
    return 0;
}
