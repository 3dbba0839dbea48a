/* fz_decode.c - any bytes to the strict decoder. Refused: with a reason and an offset inside the file. Valid: written again by the encoder
 * they are the same bytes (decisions 3.9; ancillary chunks and the minor version are not parsed, so they are left out), and a query works.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <string.h>
#include "harness.h"
#include "mend.h"
#include "write/encode.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void rewrite(const ted4_scene *s, const uint8_t *data, size_t size)
{
    uint8_t     *const plain = malloc(size), *out;
    const size_t n = plain != NULL ? ted4_plain_file(plain, data, size) : 0;
    size_t       n_out;
    const ted4_status verdict = ted4_encode(s, s->level, NULL, &out, &n_out, NULL);

    fuzz_require(plain != NULL, "memory");
    /* Without its ancillary chunks a file may have too many symbols a byte. */
    fuzz_require(verdict == TED4_OK || (n < size && verdict == TED4_E_LVL_EXCEEDED), "what is read can be written");
    fuzz_require(verdict != TED4_OK || (n_out == n && memcmp(out, plain, n) == 0), "the same bytes");
    free(out);
    free(plain);
}

static void query(const ted4_scene *s, const ted4_options *o)
{
    const ted4_query q = { 1, 3, { 0.5f, -1, 2 } };
    ted4_recon      *r = NULL;
    ted4_gaussians   g;
    ted4_info        info;
    ted4_status      verdict = ted4_recon_new(&r, s, o);

    ted4_scene_info(s, &info);
    fuzz_require(verdict == TED4_OK || verdict == TED4_E_LIMIT_MEMORY, "recon");
    if (verdict == TED4_OK) {
        verdict = ted4_recon_query(r, &q, NULL, &g);
        fuzz_require(verdict == TED4_OK || verdict == TED4_E_REC_NONFINITE, "query");
        fuzz_require(verdict != TED4_OK || g.n == info.n_gaussians, "every kept offset has a record");
    }
    ted4_recon_free(r);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const ted4_options o = { .max_bytes = FUZZ_MAX_BYTES };
    ted4_scene        *s = NULL;
    ted4_error         e = { TED4_OK, 0 };
    const ted4_status  verdict = ted4_decode(data, size, &o, &s, &e);

    fuzz_require(verdict == e.code && (s != NULL) == (verdict == TED4_OK), "one verdict");
    fuzz_require(e.offset <= size, "an offset in the file");
    if (verdict == TED4_OK) {
        rewrite(s, data, size);
        query(s, &o);
    }
    ted4_scene_free(s);
    return 0;
}
