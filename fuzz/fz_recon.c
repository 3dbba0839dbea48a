/* fz_recon.c - the Gaussians of any file that the decoder accepts, at times and camera centres
 * given by up to 32 bytes after the chunk ENDS. Claims: a query gives finite numbers or
 * rec.non-finite; the numbers are those of class X in recon_ref.h, bit for bit; earlier queries,
 * the order of blocks and the kernel do not matter; there is one record per kept offset, and ids
 * increase.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <string.h>
#include "harness.h"
#include "fix_hashes.h"
#include "norm/syntax.h"
#include "order.h"
#include "recon_ref.h"

enum { TAIL = 32, QUERIES = 3 };

static const float *channel(const ted4_gaussians *g, int c)
{
    return c < 3     ? g->mean[c]
           : c < 6   ? g->scale[c - 3]
           : c < 10  ? g->rot[c - 6]
           : c == 10 ? g->opacity
                     : g->colour[c - 11];
}

/* Compares with the records of recon_ref.h. The verdict must be rec.non-finite if one of them has a
 * value that is not finite. */
static void check_reference(const ted4_scene *s, const ted4_query *q, size_t n,
                            const ted4_gaussians *g, ted4_status verdict)
{
    double *const record = malloc((n + 1) * REF_VALUES * sizeof *record);
    int finite = 1;

    fuzz_require(record != NULL && ref_query(s, q, 1, record) == n,
                 "every kept offset has a record");
    for (size_t i = 0; i < n * REF_VALUES; i++) {
        finite = finite && isfinite(record[i]);
        if (verdict != TED4_OK)
            continue;
        const float v = channel(g, (int)(i % REF_VALUES))[i / REF_VALUES];

        fuzz_require(isfinite(v), "finite or rec.non-finite");
        fuzz_require((double)v == record[i], "class X");
    }
    fuzz_require(finite == (verdict == TED4_OK),
                 "rec.non-finite exactly when a value is not finite");
    free(record);
}

static void check_ids(const ted4_scene *s, const ted4_gaussians *g)
{
    const uint32_t k = s->head.n_offsets;

    for (size_t i = 0; i < g->n; i++) {
        fuzz_require(i == 0 || g->id[i] > g->id[i - 1], "ids in order");
        fuzz_require(g->id[i] / k < s->head.n_anchors &&
                         s->offset_bits[g->id[i] / k] >> g->id[i] % k & 1,
                     "ids of kept offsets");
    }
}

/* Returns a query that differs from the previous one, but may share its numerator, denominator or
 * camera. */
static ted4_query query_of(fuzz_source *in, const ted4_query *before)
{
    const uint8_t keep = fuzz_u8(in);
    ted4_query q;

    q.den = keep & 1 ? before->den : 1 + fuzz_u32(in) % 0xffffff;
    q.num = keep & 2 && before->num <= q.den ? before->num : fuzz_u32(in) % (q.den + 1);
    for (int c = 0; c < 3; c++) {
        const uint32_t bits = fuzz_u32(in);

        q.camera[c] = keep & 4         ? before->camera[c]
                      : bits % 64 == 1 ? 0x1.fffffep+127f
                                       : (float)((int32_t)bits >> 16) / 1024.0f;
    }
    return q;
}

/* Repeats a query on a new object, which has no earlier query, with plain kernels and another order
 * of blocks. */
static void check_fresh(const ted4_scene *s, const ted4_query *q, const uint8_t hash[16],
                        ted4_status verdict)
{
    const ted4_parallel backwards = order_parallel(2);
    ted4_recon *r = NULL;
    ted4_gaussians g;
    uint8_t again[16];

    use_kernels("plain");
    fuzz_require(ted4_recon_new(&r, s, NULL) == TED4_OK, "recon");
    use_kernels(NULL);
    fuzz_require(ted4_recon_query(r, q, &backwards, &g) == verdict, "one verdict");
    ted4_gaussians_hash(&g, again);
    fuzz_require(verdict != TED4_OK || memcmp(hash, again, sizeof again) == 0,
                 "whatever was queried before");
    ted4_recon_free(r);
}

static void query_all(const ted4_scene *s, fuzz_source *in)
{
    ted4_query q = { 0, 1, { 0, 0, 0 } };
    ted4_recon *r = NULL;
    ted4_gaussians g;
    ted4_info info;
    uint8_t hash[16];

    ted4_scene_info(s, &info);
    fuzz_require(ted4_recon_new(&r, s, NULL) == TED4_OK, "recon");
    for (int i = 0; i < QUERIES; i++) {
        q = query_of(in, &q);

        const ted4_status verdict = ted4_recon_query(r, &q, NULL, &g);

        fuzz_require(verdict == TED4_OK || verdict == TED4_E_REC_NONFINITE, "query");
        fuzz_require(g.n == (verdict == TED4_OK ? info.n_gaussians : 0),
                     "every kept offset has a record");
        ted4_gaussians_hash(&g, hash);
        check_ids(s, &g);
        check_reference(s, &q, info.n_gaussians, &g, verdict);
        check_fresh(s, &q, hash, verdict);
    }
    ted4_recon_free(r);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const ted4_options o = { .max_bytes = FUZZ_MAX_BYTES };
    const size_t n = ted4_without_tail(data, size, TAIL);
    fuzz_source in = { data + n, data + size };
    ted4_scene *s = NULL;

    /* Only small scenes: the reference is slow, since it evaluates whole networks in doubles per
     * anchor. */
    if (ted4_decode(data, n, &o, &s, NULL) == TED4_OK && s->head.n_anchors <= 128 &&
        ted4_recon_class_x())
        query_all(s, &in);
    ted4_scene_free(s);
    return 0;
}
