/* verify.c - see verify.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "verify.h"

#include <stdio.h>
#include <string.h>

#include "base/bytes.h"
#include "write/encode.h"

static int differs(const ted4_scene *a, const ted4_scene *b)
{
    const size_t n = a->head.n_anchors;
    int          bad = b->head.n_anchors != n ||
                       memcmp(a->position, b->position, n * 3 * sizeof *a->position) != 0 ||
                       memcmp(a->dynamic, b->dynamic, n) != 0 ||
                       memcmp(a->offset_bits, b->offset_bits, n * sizeof *a->offset_bits) != 0;

    for (int y = 0; y < TED4_TYPES && !bad; y++)
        bad = a->shape.dim[y] != b->shape.dim[y] ||
              (a->shape.dim[y] > 0 &&
               (memcmp(a->step_index[y], b->step_index[y], n) != 0 ||
                memcmp(a->symbol[y], b->symbol[y],
                       n * a->shape.dim[y] * sizeof *a->symbol[y]) != 0));
    return bad || memcmp(a->netr.values, b->netr.values, a->netr.n * sizeof(float)) != 0 ||
           (a->bank.n > 0 &&
            memcmp(a->bank.values, b->bank.values, a->bank.n * sizeof(float)) != 0);
}

int ted4_verify(const ted4_scene *scene, const uint8_t *bytes, size_t size,
                const ted4_parallel *p, ted4_verified *v, char *why, size_t why_size)
{
    const ted4_options o = { .parallel = p };
    ted4_scene        *decoded;
    ted4_error         e = { TED4_OK, 0 };
    ted4_info          info;
    ted4_bits          bits;

    if (ted4_decode(bytes, size, &o, &decoded, &e) != TED4_OK) {
        snprintf(why, why_size, "verification: byte %zu: %s", e.offset, ted4_status_id(e.code));
        return -1;
    }
    const int bad = differs(scene, decoded) || ted4_count(decoded, p, &bits, &e) != TED4_OK;

    ted4_scene_info(decoded, &info);
    ted4_scene_free(decoded);
    if (bad) {
        snprintf(why, why_size, "verification: the decoded scene differs from the encoded one");
        return -1;
    }
    v->anchors = info.n_anchors;
    v->dynamic = info.n_dynamic;
    v->gaussians = info.n_gaussians;
    v->coded_bits = bits.total - bits.mask - bits.frame;
    ted4_hex(v->hash, info.hash, sizeof info.hash);
    return 0;
}
