/* fz_roundtrip.c - any bytes, given to the strict decoder; what it accepts is given to the writer.
 * Up to two bytes after the chunk ENDS are knobs of other harnesses and ignored. Claim:
 * write(parse(x)) is x. Ancillary chunks and the minor version are not parsed, so they are removed
 * from x first; without them a file may have too many symbols per byte for its level, which the
 * writer then reports. Writing a second time, with tiles in any order, gives the same bytes.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <string.h>
#include "harness.h"
#include "fix_hashes.h"
#include "order.h"
#include "write/encode.h"

enum { TAIL = 2 };

static void rewrite(const ted4_scene *s, const uint8_t *data, size_t size)
{
    const ted4_parallel backwards = order_parallel(2);
    uint8_t *const plain = malloc(size), *first, *second;
    const size_t n = plain != NULL ? ted4_plain_file(plain, data, size) : 0;
    size_t n_first, n_second;
    const ted4_status verdict = ted4_encode(s, s->level, NULL, &first, &n_first, NULL);

    fuzz_require(plain != NULL, "memory");
    fuzz_require(verdict == TED4_OK || (n < size && verdict == TED4_E_LVL_EXCEEDED),
                 "what is read can be written");
    fuzz_require(verdict != TED4_OK || (n_first == n && memcmp(first, plain, n) == 0),
                 "the same bytes");
    fuzz_require(ted4_encode(s, s->level, &backwards, &second, &n_second, NULL) == verdict,
                 "the same verdict twice");
    fuzz_require(n_second == n_first && (n_first == 0 || memcmp(first, second, n_first) == 0),
                 "the same bytes twice");
    free(second);
    free(first);
    free(plain);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const ted4_options o = { .max_bytes = FUZZ_MAX_BYTES };
    const size_t n = ted4_without_tail(data, size, TAIL);
    ted4_scene *s = NULL;

    if (ted4_decode(data, n, &o, &s, NULL) == TED4_OK)
        rewrite(s, data, n);
    ted4_scene_free(s);
    return 0;
}
