/* build_pack.c - `pack nete|netr|bank raw | fixed | dynamic | mixed | small | coded`: sets the
 * modes of the blobs. A blob without such a line is raw.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdlib.h>
#include <string.h>
#include "build.h"
#include "pack.h"
#include "write/coded.h"

static void pack(conf_build *b, const conf_line *l, ted4_blob *blob)
{
    const int way = l->n > 2 ? conf_pack_way_of(l->word[2]) : -1;
    const size_t n = (size_t)blob->n;
    uint8_t *bytes;
    conf_bytes out = { NULL, 0, 0 };

    if (l->n > 2 && conf_word_is(l, 2, "coded") &&
        !ted4_blob_code(b->scene, blob, &b->scene->arena, SIZE_MAX))
        conf_line_bad(l, "values that mode 2 does not have");
    if (way < 0)
        return;
    bytes = conf_alloc(n, 4);
    conf_shuffle(bytes, blob->values, n);
    conf_pack(&out, bytes, 4 * n, (conf_pack_way)way, CONF_PACK_GOOD);
    if (out.size >= 4 * n)
        conf_line_bad(l, "not shorter than the values themselves");
    blob->mode = TED4_BLOB_DEFLATED;
    blob->deflated = ted4_arena_alloc(&b->scene->arena, out.size, 1);
    if (blob->deflated == NULL)
        conf_die("no memory");
    memcpy(blob->deflated, out.data, out.size);
    blob->deflated_size = out.size;
    conf_free(&out);
    free(bytes);
}

void conf_build_pack(conf_build *b)
{
    ted4_scene *s = b->scene;

    s->nete.mode = s->netr.mode = s->bank.mode = TED4_BLOB_RAW;
    for (size_t i = 0; i < b->recipe->n; i++) {
        const conf_line *const l = &b->recipe->line[i];

        if (!conf_word_is(l, 0, "pack"))
            continue;
        pack(b, l,
             conf_word_is(l, 1, "nete")   ? &s->nete
             : conf_word_is(l, 1, "netr") ? &s->netr
                                          : &s->bank);
    }
}
