/* verify.c - see verify.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "verify.h"

#include <stdio.h>
#include <string.h>

#include "base/bytes.h"
#include "train/model/header_from_options.h"
#include "write/encode.h"

static int blob_differs(const ted4_blob *a, const ted4_blob *b)
{
    return a->n != b->n ||
           (a->n > 0 && memcmp(a->values, b->values, (size_t)a->n * sizeof *a->values) != 0);
}

static int type_differs(const ted4_scene *a, const ted4_scene *b, int type)
{
    const size_t n = a->head.n_anchors, dim = a->shape.dim[type];

    return dim > 0 &&
           (memcmp(a->step_index[type], b->step_index[type], n) != 0 ||
            memcmp(a->symbol[type], b->symbol[type], n * dim * sizeof *a->symbol[type]) != 0);
}

/* The headers are compared first: if they are equal, so are the shapes and the sizes of all arrays.
 */
static int differs(const ted4_scene *a, const ted4_scene *b)
{
    const size_t n = a->head.n_anchors;
    int bad = b->head.n_anchors != n || !ted4_header_same(&a->head, &b->head) ||
              memcmp(a->position, b->position, n * 3 * sizeof *a->position) != 0 ||
              memcmp(a->dynamic, b->dynamic, n) != 0 ||
              memcmp(a->offset_bits, b->offset_bits, n * sizeof *a->offset_bits) != 0 ||
              memcmp(a->shift, b->shift, a->shape.n_units) != 0;

    for (int y = 0; y < TED4_TYPES && !bad; y++)
        bad = type_differs(a, b, y);
    return bad || blob_differs(&a->nete, &b->nete) || blob_differs(&a->netr, &b->netr) ||
           blob_differs(&a->bank, &b->bank);
}

int ted4_verify(const ted4_scene *scene, const uint8_t *bytes, size_t size, const ted4_parallel *p,
                ted4_verified *v, char *why, size_t why_size)
{
    const ted4_options o = { .parallel = p };
    ted4_scene *decoded;
    ted4_error e = { TED4_OK, 0 };
    ted4_info info;
    ted4_bits bits;

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
