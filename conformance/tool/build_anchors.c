/* build_anchors.c - builds the positions and masks of a scene.
 *     positions random                     the default: any binary16 of magnitude up to 1
 *     positions line START BITS            anchor i is at x = (START + i) / 2^BITS, y = z = 0
 *     positions tiny                       subnormal binary16
 *     positions bit B                      two anchors whose x differ only in bit B of the pattern;
 *                                          14: in the sign
 *     positions block BITS SIDE            three of four cells, at random, of a cube of SIDE^3 of
 *                                          them; coordinates are 0 .. SIDE - 1 over 2^BITS
 *     positions at X:Y:Z ...               patterns in hexadecimal; they are sorted, duplicates are
 *                                          dropped, and n_anchors of them must remain
 *     dynamic random | all | none | alternate | first N
 *     offsets random | all | none | alternate | bits B0 B1 ...   (masks of anchors in turn)
 *     prob I P                             probability I (0 dynamic, 1 .. 6 offset) of all tiles;
 *                                          without such a line it follows from the counts
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdlib.h>
#include <string.h>
#include "build.h"
#include "norm/half.h"
#include "write/snap.h"

static uint16_t random_half(conf_chance *c, int tiny)
{
    const uint32_t u = conf_u32(c);
    uint16_t h = (uint16_t)(u & 0x3ff);

    if (!tiny)
        h |= (uint16_t)((u >> 10 & 7) == 0 ? u >> 13 & 0x3c00 : 0x3000 + ((u >> 13) % 3 << 10));
    if (h > 0x3c00)
        h = 0x3c00;
    return h != 0 && u >> 31 ? h | 0x8000 : h;
}

/* Sorts the positions and keeps n_anchors of them, evenly spaced in that order. tries: the number
 * of positions. */
static void keep(conf_build *b, const uint16_t *p, size_t tries)
{
    const size_t n = b->head.n_anchors;
    uint32_t *order = conf_alloc(tries, sizeof *order);
    const size_t kept = ted4_positions_sort(p, tries, order);

    if (kept == SIZE_MAX || kept < n)
        conf_die("%s: only %zu different positions", b->recipe->id, kept);
    for (size_t i = 0; i < n; i++)
        memcpy(b->scene->position + 3 * i, p + 3 * (size_t)order[i * kept / n], 6);
    free(order);
}

static void positions_at(conf_build *b, const conf_line *l)
{
    uint16_t *p = conf_alloc((size_t)l->n, 6);

    for (int i = 2; i < l->n; i++) {
        char *at = l->word[i];

        for (int j = 0; j < 3; j++, at += *at == ':')
            p[3 * (i - 2) + j] = (uint16_t)strtoul(at, &at, 16);
    }
    keep(b, p, (size_t)l->n - 2);
    free(p);
}

static void positions_bit(conf_build *b, const conf_line *l)
{
    const uint16_t p[6] = { 0,      0x2e00,
                            0xb123, (uint16_t)(1u << (conf_line_number(l, 2, 0, 14) % 14)),
                            0x2e00, 0xb123 };
    const uint16_t sign[6] = { 0x3555, 1, 1, 0xb555, 1, 1 };

    keep(b, conf_line_number(l, 2, 0, 14) == 14 ? sign : p, 2);
}

static void positions_block(conf_build *b, const conf_line *l)
{
    const long long bits = conf_line_number(l, 2, 0, 11), side = conf_line_number(l, 3, 1, 64);
    uint16_t *p = conf_alloc((size_t)(side * side * side), 6);
    size_t n = 0;

    for (long long i = 0; i < side * side * side; i++) {
        const long long place[3] = { i / side / side, i / side % side, i % side };

        for (size_t j = 0; j < 3; j++)
            p[3 * n + j] = ted4_float_to_half((float)place[j] / (float)(1 << bits));
        n += conf_in(&b->chance, 0, 3) > 0;
    }
    keep(b, p, n);
    free(p);
}

void conf_build_positions(conf_build *b)
{
    const conf_line *const l = conf_line_find(b->recipe, "positions");
    const int line = l != NULL && conf_word_is(l, 1, "line"),
              tiny = l != NULL && conf_word_is(l, 1, "tiny");
    const size_t n = b->head.n_anchors, tries = line ? n : n + n / 8 + 16;
    uint16_t *p;

    if (l != NULL && conf_word_is(l, 1, "at")) {
        positions_at(b, l);
        return;
    }
    if (l != NULL && conf_word_is(l, 1, "bit")) {
        positions_bit(b, l);
        return;
    }
    if (l != NULL && conf_word_is(l, 1, "block")) {
        positions_block(b, l);
        return;
    }
    p = conf_alloc(tries, 6);
    for (size_t i = 0; i < tries; i++)
        for (size_t j = 0; j < 3; j++)
            if (!line)
                p[3 * i + j] = random_half(&b->chance, tiny);
            else if (j == 0)
                p[3 * i] = ted4_float_to_half(
                    (float)(conf_line_number(l, 2, -65536, 65536) + (long long)i) /
                    (float)(1 << conf_line_number(l, 3, 0, 20)));
    keep(b, p, tries);
    free(p);
}

static void dynamic(conf_build *b, const conf_line *l)
{
    const size_t first = l != NULL && conf_word_is(l, 1, "first")
                             ? (size_t)conf_line_number(l, 2, 0, UINT32_MAX)
                             : 0;

    for (size_t i = 0; i < b->head.n_anchors; i++) {
        uint8_t v = b->head.motion != TED4_MOTION_NONE;

        if (b->head.temporal_mask)
            v = l == NULL || conf_word_is(l, 1, "random") ? conf_in(&b->chance, 0, 2) == 0
                : conf_word_is(l, 1, "all")               ? 1
                : conf_word_is(l, 1, "none")              ? 0
                : conf_word_is(l, 1, "first")             ? i < first
                                                          : (uint8_t)(i % 2);
        b->scene->dynamic[i] = v;
    }
}

static void offsets(conf_build *b, const conf_line *l)
{
    const unsigned all = (1u << b->head.n_offsets) - 1;

    for (size_t i = 0; i < b->head.n_anchors; i++) {
        unsigned v = all;

        if (b->head.offset_mask)
            v = l == NULL || conf_word_is(l, 1, "random")
                    ? conf_u32(&b->chance) | conf_u32(&b->chance)
                : conf_word_is(l, 1, "all")  ? all
                : conf_word_is(l, 1, "none") ? 0
                : conf_word_is(l, 1, "bits")
                    ? (unsigned)conf_line_number(l, 2 + (int)(i % (size_t)(l->n - 2)), 0, 65535)
                : i % 2 ? 0xaaaa
                        : 0x5555;
        b->scene->offset_bits[i] = (uint16_t)(v & all);
    }
}

void conf_build_masks(conf_build *b)
{
    dynamic(b, conf_line_find(b->recipe, "dynamic"));
    offsets(b, conf_line_find(b->recipe, "offsets"));
    for (size_t i = 0; i < b->recipe->n; i++) {
        const conf_line *const l = &b->recipe->line[i];

        for (size_t t = 0; conf_word_is(l, 0, "prob") && t < b->scene->shape.n_tiles; t++)
            b->scene->prob[t * TED4_PROBS + (size_t)conf_line_number(l, 1, 0, 6)] =
                (uint16_t)conf_line_number(l, 2, 1, 65535);
    }
}
