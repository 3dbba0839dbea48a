/* break_coded.c - see break_coded.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "break_coded.h"

#include <stdlib.h>
#include <string.h>
#include "norm/octree.h"
#include "write/coder_write.h"

/* Replaces the payload behind its first head bytes by what w holds, and ends w. */
static void replace(conf_bytes *payload, size_t head, ted4_writer *w, const conf_line *l)
{
    if (w->base.error.code != TED4_OK)
        conf_line_bad(l, "cannot be coded");
    conf_remove(payload, head, payload->size - head);
    conf_add(payload, w->out.data, w->out.size);
    ted4_writer_finish(w);
}

void conf_coded_tree(conf_bytes *payload, const conf_line *l)
{
    const size_t n = (size_t)l->n - 3;
    const unsigned grid = (unsigned)conf_line_number(l, 2, 1, 16);
    uint16_t *p = conf_alloc(n, 6);
    ted4_writer w;

    for (size_t i = 0; i < n; i++) {
        char *at = l->word[3 + i];

        for (size_t j = 0; j < 3; j++, at += *at == ':')
            p[3 * i + j] = (uint16_t)strtoul(at, &at, 16);
    }
    ted4_writer_init(&w);
    w.base.ops->number(&w.base, 1, grid);
    w.base.ops->rest(&w.base, 0);
    w.base.ops->open(&w.base, 1);
    if (!ted4_octree_walk(&w.base, grid, n, p))
        conf_line_bad(l, "positions off the grid or out of order");
    w.base.ops->close(&w.base);
    replace(payload, 0, &w, l);
    free(p);
}

/* A coder that writes, and that sets one bit of the substream. */
typedef struct {
    ted4_writer w;
    int (*bit)(ted4_coder *c, uint32_t prob, int value);
    size_t n, set; /* bits so far; which of them is set, from 1 on; 0: none */
} setter;

static int set_bit(ted4_coder *c, uint32_t prob, int value)
{
    setter *const s = (setter *)c;

    return s->bit(c, prob, ++s->n == s->set ? 1 : value);
}

/* Codes mode and what follows it. */
static void code_blob(setter *t, size_t set, const ted4_scene *s, ted4_blob *blob)
{
    static ted4_coder_ops ops;

    memset(t, 0, sizeof *t);
    t->set = set;
    ted4_writer_init(&t->w);
    ops = *t->w.base.ops;
    t->bit = ops.bit;
    ops.bit = set_bit;
    t->w.base.ops = &ops;
    t->w.base.ops->number(&t->w.base, 1, TED4_BLOB_CODED);
    (void)ted4_walk_coded(&t->w.base, s, blob);
}

void conf_coded_blob(conf_bytes *payload, size_t head, const ted4_scene *s, ted4_blob *blob,
                     const conf_line *l)
{
    setter t;

    if (blob->mode != TED4_BLOB_CODED)
        conf_line_bad(l, "the blob was not of mode 2");
    code_blob(&t, 0, s, blob);
    if (l->n > 4) {
        const size_t n = t.n;

        ted4_writer_finish(&t.w);
        code_blob(&t, n + 1 - (size_t)conf_line_number(l, 4, 1, (long long)n), s, blob);
    }
    replace(payload, head, &t.w, l);
}
