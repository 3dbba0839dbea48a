/* annex_b_compact.h - the part of annex B about profile Compact: a file byte by byte, and every bit
 * of its tree and of the integers of its bank.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_ANNEX_B_COMPACT_H
#define TED4_ANNEX_B_COMPACT_H

#include "annex_b.h"
#include "write/coded.h"

/* B.3: the scene of B.2, but for one coordinate, which lies on the coarsest grid. */
static inline ted4_scene *annex_b_compact(void)
{
    ted4_scene *s = annex_b_dynamic();
    ted4_blob *const blob[] = { &s->nete, &s->netr, &s->bank };

    s->profile = TED4_PROFILE_COMPACT;
    s->grid = 6;
    s->position[5] = ted4_float_to_half(0.75f);
    for (int i = 0; i < 3; i++)
        (void)ted4_blob_code(s, blob[i], &s->arena, SIZE_MAX);
    return s;
}

/* The scene of B.1 in as few bytes as a file of profile Compact can have: a tree that goes down the
 * last children has the fewest bits. */
static inline ted4_scene *annex_b_smallest_compact(void)
{
    ted4_scene *s = annex_b_smallest();

    s->profile = TED4_PROFILE_COMPACT;
    s->grid = 6;
    for (int j = 0; j < 3; j++)
        s->position[j] = ted4_grid_half(63, 6);
    s->nete.mode = TED4_BLOB_CODED;
    return s;
}

/* One adaptive bit, and its row. */
static inline unsigned annex_b_adaptive(FILE *out, struct coder *c, struct adaptive *m,
                                        const char *what, unsigned first, unsigned second)
{
    const struct coder before = *c;
    const struct adaptive was = *m;
    const unsigned bit = take_adaptive(c, m);
    char text[2 * ANNEX_B_NOTE];

    snprintf(text, sizeof text,
             "%s: %u, context (%u, %u), slots of 1 below %" PRId32 ", seen %" PRId32, what, bit,
             first, second, was.p, was.seen);
    annex_b_step(out, &before, c, 0, text);
    return bit;
}

static inline void annex_b_node(FILE *out, struct tree *t, uint64_t prefix, int level,
                                unsigned siblings)
{
    unsigned children = 0, n = 0;
    char what[ANNEX_B_NOTE];

    for (unsigned i = 0; i < 8; i++) {
        const unsigned context = 1u << i | children;
        unsigned bit = 1;

        snprintf(what, sizeof what, "level %d, node %" PRIu64 ", child %u", level, prefix, i);
        if (i < 7 || children != 0)
            bit = annex_b_adaptive(out, t->c, &t->context[siblings][context], what, siblings,
                                   context);
        children |= bit << i;
        n += bit;
    }
    for (unsigned i = 0; i < 8; i++) {
        if ((children >> i & 1) == 0)
            continue;
        if (level + 1 < t->depth)
            annex_b_node(out, t, 8 * prefix + i, level + 1, n > 3 ? 2 : n - 1);
        else
            t->key[t->found++] = 8 * prefix + i;
    }
}

/* bytes: the payload of POSN. */
static inline void annex_b_tree(FILE *out, const uint8_t *bytes, size_t size, size_t n)
{
    uint64_t key[2], again[2];
    struct coder c, d;
    struct tree t = { .c = &c, .key = key, .n = n, .depth = bytes[0] };

    if (n > 2)
        abort();
    annex_b_steps_head(out, "tree_substream", bytes + 1, size - 1);
    open_rest(&c, bytes + 1, size - 1, n);
    d = c;
    reset(t.context[0], 3 * 256);
    annex_b_node(out, &t, 0, 0, 0);
    if (!take_tree(&d, t.depth, n, again) || memcmp(key, again, n * sizeof *key) != 0 ||
        memcmp(&c, &d, sizeof c) != 0)
        abort();
    fprintf(out, "\n| anchor | key | places | position |\n|---|---|---|---|\n");
    for (size_t i = 0; i < n; i++) {
        fprintf(out, "| %zu | %" PRIu64 " |", i, key[i]);
        for (int j = 0; j < 3; j++)
            fprintf(out, " %" PRIu32, place_of(key[i], t.depth, j));
        fprintf(out, " |");
        for (int j = 0; j < 3; j++)
            fprintf(out, " %g",
                    (double)q24(coordinate(place_of(key[i], t.depth, j), t.depth)) / 16777216.0);
        fprintf(out, " |\n");
    }
}

static inline int32_t annex_b_integer(FILE *out, struct coder *c, struct integers *m,
                                      unsigned expected, size_t number)
{
    unsigned length = 1, negative, size = 1;
    char what[ANNEX_B_NOTE];

    for (int i = 4; i >= 0; i--) {
        snprintf(what, sizeof what, "value %zu, bit %d of its length", number, i);
        length = 2 * length +
                 annex_b_adaptive(out, c, &m->length[expected][length], what, expected, length);
    }
    length -= 32;
    if (length == 0)
        return 0;
    snprintf(what, sizeof what, "value %zu, sign", number);
    negative = annex_b_adaptive(out, c, &m->sign, what, 0, 0);
    for (unsigned i = 1; i < length; i++)
        if (i > 1)
            abort(); /* not in these examples */
        else {
            snprintf(what, sizeof what, "value %zu, bit below the leading one", number);
            size = 2 * size + annex_b_adaptive(out, c, &m->top[length], what, length, 0);
        }
    return negative ? -(int32_t)size : (int32_t)size;
}

/* bytes: the payload of BANK, of mode 2, with two values. */
static inline void annex_b_bank(FILE *out, const uint8_t *bytes, size_t size)
{
    static struct integers m, again;
    unsigned length[2] = { 0, 0 };
    struct coder c, d;

    annex_b_steps_head(out, "weights_substream", bytes + 2, size - 2);
    open_rest(&c, bytes + 2, size - 2, 2);
    d = c;
    reset_integers(&m);
    reset_integers(&again);
    for (size_t i = 0; i < 2; i++) {
        const unsigned expected = (length[0] + length[1] + 1) / 2;
        const int32_t k = annex_b_integer(out, &c, &m, expected, i);

        if (k != take_integer(&d, &again, expected))
            abort();
        length[0] = length[1];
        length[1] = length_of(k);
    }
    if (memcmp(&c, &d, sizeof c) != 0)
        abort();
}

/* Offset of the payload of the first chunk of a type; *size bytes. */
static inline const uint8_t *annex_b_payload(const uint8_t *data, const char *type, size_t *size)
{
    size_t at = 12;

    while (memcmp(data + at, type, 4) != 0)
        at += 20 + load32(data + at + 8);
    *size = load32(data + at + 8);
    return data + at + 12;
}

static inline void annex_b_compact_file(FILE *out, const uint8_t *data, size_t size)
{
    spec_tiers t = { .model = { .tile_done = spec_tile_done } };
    size_t n;
    const uint8_t *payload;

    t.model.user = &t;
    fprintf(out, "\n### B.3.1 Bytes\n\n");
    annex_b_bytes(out, data, size);
    fprintf(out, "\n### B.3.2 Substreams of adaptive bits\n\n"
                 "As in B.2.2. A node is named by the bits of its key, an integer, and its\n"
                 "children are coded in order. No row stands for a child that is certain. The\n"
                 "contexts of a tree are (s, 2^i + m) of 8.2, those of lengths are (expected\n"
                 "length, node) of 9.6; that of signs, which has no numbers, is printed as\n"
                 "(0, 0). The rows of NETE and NETR are left out.\n");
    payload = annex_b_payload(data, "POSN", &n);
    annex_b_tree(out, payload, n, 2);
    payload = annex_b_payload(data, "BANK", &n);
    annex_b_bank(out, payload, n);
    spec_model_decode(&t.model, data, size);
    if (t.model.p.v.id != NULL)
        abort();
    spec_t0(&t.tier[0], &t.model, data, size);
    spec_t1(&t.tier[1], &t.model.p.s);
    fprintf(out, "\n### B.3.3 Values\n");
    annex_b_values(out, &t.model.p.s);
    annex_b_results(out, 3, &t, 5);
    spec_tiers_free(&t);
}

/* B.3 */
static inline void annex_b_of_compact(FILE *out)
{
    size_t size, n_smallest, n_dynamic;
    uint8_t *data = annex_b_encode(annex_b_smallest_compact(), &n_smallest);

    free(data);
    data = annex_b_encode(annex_b_dynamic(), &n_dynamic);
    free(data);
    data = annex_b_encode(annex_b_compact(), &size);
    fprintf(
        out,
        "\n"
        "## B.3 Profile Compact\n\n"
        "This is the scene of B.2, except that z of anchor 1 is 0.75, so that the\n"
        "positions lie on a grid of 6 bits. All blobs are of mode 2. The file has %zu\n"
        "bytes where that of B.2 has %zu. The file of B.1 has %zu bytes in profile Compact if its\n"
        "anchor lies in place (63, 63, 63) and NETE is of mode 2, and no valid file has\n"
        "fewer: the substreams of POSN and NETE need a state each, and a blob of mode 2\n"
        "in NETR has 14 exponents.\n",
        size, n_dynamic, n_smallest);
    annex_b_compact_file(out, data, size);
    free(data);
}

/* The whole annex. */
static inline void annex_b_all(FILE *out)
{
    annex_b(out);
    annex_b_of_compact(out);
}

#endif
