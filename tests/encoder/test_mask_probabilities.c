/* test_mask_probabilities.c - write/tiles.c: the probabilities of masks that the writer chooses are
 * the frequencies of ones in each context of spec 9.3, tile by tile. A file with other
 * probabilities would be valid, only larger.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "random_scene.h"
#include "test.h"
#include "write/tiles.h"

enum { ANCHORS = 150, TILE = 64, TILES = 3 };

/* Masks in which all contexts occur, with different frequencies in each tile. In the last tile,
 * everything is static, and all masks are open. */
static void fill_masks(ted4_scene *s)
{
    const unsigned K = s->head.n_offsets, all = (1u << K) - 1;

    for (size_t a = 0; a < ANCHORS; a++) {
        const unsigned mixed = (unsigned)(a * a + 3 * a) & all;

        s->dynamic[a] = a < 2 * TILE && a % (3 + a / TILE) == 0;
        s->offset_bits[a] = (uint16_t)(a >= 2 * TILE || a % 4 == 0    ? all
                                       : a % 5 == 0 && !s->dynamic[a] ? 1u
                                       : mixed != 0                   ? mixed
                                                                      : all);
    }
}

/* R-ENT-014: the context of offset bit k, from the number of ones before it. */
static unsigned context_of(unsigned dynamic, unsigned k, unsigned ones)
{
    return 3 * dynamic + (ones == k ? 1 : ones == 0 ? 0 : 2);
}

/* Fills want[7] for a tile: the dynamic bit, then six contexts. */
static void count(const ted4_scene *s, size_t first, size_t end, uint16_t want[TED4_PROBS])
{
    double ones[TED4_PROBS] = { 0 }, n[TED4_PROBS] = { 0 };

    for (size_t a = first; a < end; a++) {
        unsigned before = 0;

        ones[0] += s->dynamic[a];
        n[0]++;
        for (unsigned k = 0; k < s->head.n_offsets; k++) {
            const unsigned bit = s->offset_bits[a] >> k & 1u,
                           context = 1 + context_of(s->dynamic[a], k, before);

            ones[context] += bit;
            n[context]++;
            before += bit;
        }
    }
    for (int i = 0; i < TED4_PROBS; i++) {
        const double p = n[i] > 0 ? floor(65536 * ones[i] / n[i] + 0.5) : 32768;

        want[i] = (uint16_t)(p < 1 ? 1 : p > 65535 ? 65535 : p);
    }
}

static void test_frequencies(void **state)
{
    ted4_header h = random_small_header(ANCHORS);
    ted4_scene *s = ted4_scene_new(&h, NULL);
    ted4_draft d;

    (void)state;
    assert_non_null(s);
    assert_int_equal(h.tile_size, TILE);
    assert_int_equal(s->shape.n_tiles, TILES);
    fill_masks(s);
    s->prob[TED4_PROBS + 2] = 777; /* what the caller gives stays */
    assert_int_equal(ted4_draft_init(&d, s), TED4_OK);
    for (size_t t = 0; t < TILES; t++) {
        uint16_t want[TED4_PROBS];

        count(s, t * TILE, t + 1 < TILES ? (t + 1) * TILE : ANCHORS, want);
        if (t == 1)
            want[2] = 777;
        for (int i = 0; i < TED4_PROBS; i++)
            assert_int_equal(d.s.prob[t * TED4_PROBS + (size_t)i], want[i]);
    }
    ted4_draft_finish(&d);
    ted4_scene_free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_frequencies),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
