/* fz_encode.c - a scene made from the input: the first 8 bytes seed a random scene, of profile
 * Compact if bit 1 is set, and every 4 further bytes replace one symbol. Claims: the decoder
 * accepts what the encoder accepts, with the same integers, and the encoder writes the result again
 * as the same bytes; the level declared is the lowest whose bounds hold (spec 13), and with a lower
 * level the encoder refuses to write and the decoder to read; the number of ideal bits is at most
 * that of the bits written. SPDX-License-Identifier: BSD-2-Clause */
#include "harness.h"
#include "fix_hashes.h"
#include "norm/coder.h"
#include "random_scene.h"

enum { LEVEL_BYTE = 11, COMPACT = 2 };

/* Places are restored in profile Compact, as are weights, in whichever mode they were written. */
static void check_rest(const ted4_scene *s, const ted4_scene *read)
{
    const ted4_blob *const was[] = { &s->nete, &s->netr, &s->bank };
    const ted4_blob *const is[] = { &read->nete, &read->netr, &read->bank };

    fuzz_require(read->profile == s->profile &&
                     (s->profile == TED4_PROFILE_MAIN || read->grid == s->grid),
                 "the same profile and grid");
    fuzz_require(memcmp(read->position, s->position, 6 * (size_t)s->head.n_anchors) == 0,
                 "the same positions");
    for (int i = 0; i < 3; i++)
        fuzz_require(was[i]->n == is[i]->n &&
                         (was[i]->n == 0 || memcmp(was[i]->values, is[i]->values,
                                                   (size_t)was[i]->n * sizeof(float)) == 0),
                     "the same weights");
}

/* Replaces symbols. Place and value take 16 bits each; places cycle through the types and the
 * symbols of each type. */
static void place_symbols(ted4_scene *s, const uint8_t *data, size_t size)
{
    for (size_t i = 0; i + 4 <= size; i += 4) {
        const int t = (int)(i / 4 % TED4_TYPES);
        const size_t n = (size_t)s->shape.dim[t] * s->head.n_anchors;

        if (n > 0)
            s->symbol[t][ted4_load16(data + i) % n] = (int16_t)ted4_load16(data + i + 2);
    }
    random_tidy(s);
}

static void check_level(const ted4_scene *s, uint8_t *file, size_t size)
{
    uint8_t *out;
    size_t n_out;

    for (uint8_t level = 1; level < 5 && level < file[LEVEL_BYTE]; level++) {
        const uint8_t declared = file[LEVEL_BYTE];
        ted4_scene *read = NULL;

        fuzz_require(ted4_encode(s, level, NULL, &out, &n_out, NULL) == TED4_E_LVL_EXCEEDED &&
                         out == NULL,
                     "no lower level written");
        file[LEVEL_BYTE] = level;
        fuzz_require(ted4_decode(file, size, NULL, &read, NULL) == TED4_E_LVL_EXCEEDED,
                     "no lower level read");
        file[LEVEL_BYTE] = declared;
    }
}

static void check_count(const ted4_scene *s, const uint8_t *file, size_t size)
{
    ted4_bits bits;
    size_t tiles = 0;

    for (size_t at = TED4_FILE_HEADER_SIZE; at < size; at += ted4_chunk_size(file, size, at))
        if (memcmp(file + at, "TILE", 4) == 0)
            tiles += ted4_load32(file + at + 8);
    fuzz_require(ted4_count(s, NULL, &bits, NULL) == TED4_OK, "what can be written can be counted");
    fuzz_require(bits.total <= 8.0 * (double)tiles + 0.5, "not above the bits written");
}

static void there_and_back(const ted4_scene *s)
{
    uint8_t *first, *second;
    size_t n_first, n_second;
    ted4_scene *read = NULL;
    ted4_error e = { TED4_OK, 0 };
    const ted4_status verdict = ted4_encode(s, 0, NULL, &first, &n_first, NULL);

    /* A symbol of -32768 is the only possible fault of such a scene. */
    fuzz_require(verdict == TED4_OK || verdict == TED4_E_ENT_SYMBOL_RANGE,
                 "a scene that can be written");
    if (verdict != TED4_OK)
        return;
    fuzz_require(ted4_decode(first, n_first, NULL, &read, &e) == TED4_OK,
                 "what is written can be read");
    for (int t = 0; t < TED4_TYPES; t++)
        fuzz_require(s->shape.dim[t] == 0 ||
                         memcmp(read->symbol[t], s->symbol[t],
                                (size_t)2 * s->shape.dim[t] * s->head.n_anchors) == 0,
                     "the same symbols");
    check_rest(s, read);
    fuzz_require(ted4_encode(read, read->level, NULL, &second, &n_second, NULL) == TED4_OK &&
                     n_second == n_first && memcmp(first, second, n_first) == 0,
                 "the same bytes");
    check_level(s, first, n_first);
    check_count(s, first, n_first);
    ted4_scene_free(read);
    free(first);
    free(second);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    random_source r =
        random_seed(size < 8 ? 0 : ted4_load64(data) / 2); /* the highest seed has no state */
    ted4_header h = random_header(&r);
    ted4_scene *s;

    if (size < 8)
        return 0;
    h.n_anchors = 1 + h.n_anchors % 80; /* for speed; this is enough for two tiles */
    if (data[7] & 1)
        h.frames = 1u << (data[7] >> 1 & 31); /* can exceed the first level */
    if (data[0] & COMPACT)
        s = random_compact_of(&r, &h, data[0] & 1, data[1] % 8 < 7 ? 6 + data[1] % 8 : 16);
    else
        s = random_scene_of(&r, &h, data[0] & 1);
    if (s == NULL)
        return 0;
    place_symbols(s, data + 8, size - 8);
    there_and_back(s);
    ted4_scene_free(s);
    return 0;
}
