/* fz_masks.c - masks of a scene (spec 9.3): u8 offsets K, u8 which masks exist, u8 anchors, u8
 * probabilities given or counted (bit 1: of a file of profile Compact), then masks. Claims: masks
 * that a header allows are written and read back; masks that contradict it (an offset beyond K, a
 * mask that is not coded and differs from the implied one) are refused by the writer, never
 * written; a tile whose mask substream is replaced by any other bytes is refused, or is written
 * again as the same bytes. SPDX-License-Identifier: BSD-2-Clause */
#include "harness.h"
#include "fix_hashes.h"
#include "norm/coder.h"
#include "random_scene.h"

enum { MAX_N = 150, GIVEN = 1, COMPACT = 2 };

static ted4_header header_of(fuzz_source *in)
{
    ted4_header h;

    memset(&h, 0, sizeof h);
    h.n_offsets = (uint8_t)fuzz_in(in, 1, TED4_MAX_OFFSETS);
    h.temporal_mask = fuzz_u8(in) & 1;
    h.offset_mask = fuzz_u8(in) & 1;
    h.n_anchors = fuzz_in(in, 1, MAX_N);
    h.tile_size = 64;
    h.feature_dim = h.slice[0] = h.n_slices = 1;
    h.motion = h.temporal_mask ? TED4_MOTION_BANK : TED4_MOTION_NONE;
    h.phi_dim = h.deform_layers = h.temporal_mask;
    h.bank_rows = h.bank_dim = h.deform_width = h.temporal_mask;
    h.prior = TED4_PRIOR_FACTORISED;
    h.frames = h.rate_num = h.rate_den = 1;
    for (int t = 0; t < TED4_TYPES; t++)
        h.step[t] = 1;
    return h;
}

/* Copies the masks from the input unchecked. Returns 1 if the header allows them. */
static int take_masks(fuzz_source *in, ted4_scene *s)
{
    const int wild = (fuzz_u8(in) & 3) == 3, knob = fuzz_u8(in);
    const uint16_t all = (uint16_t)((1u << s->head.n_offsets) - 1);
    int legal = 1;

    for (size_t i = 0; i < s->head.n_anchors; i++) {
        const uint16_t bits = fuzz_u16(in);

        s->dynamic[i] = s->head.temporal_mask ? fuzz_u8(in) & 1 : s->dynamic[i];
        s->offset_bits[i] = s->head.offset_mask ? bits & all : all;
        if (wild && fuzz_u8(in) % 16 == 1) {
            s->offset_bits[i] = bits;
            s->dynamic[i] = fuzz_u8(in);
        }
        legal = legal && s->dynamic[i] <= s->head.temporal_mask && s->offset_bits[i] <= all &&
                (s->head.offset_mask || s->offset_bits[i] == all);
    }
    s->profile = knob & COMPACT ? TED4_PROFILE_COMPACT : TED4_PROFILE_MAIN;
    for (size_t i = 0; (knob & GIVEN) && i < s->shape.n_tiles * (size_t)TED4_PROBS; i++)
        s->prob[i] = (uint16_t)(1 + fuzz_u16(in) % 65535);
    return legal;
}

/* Changes bytes of the first TILE after its sizes, as the input says. */
static void damage(fuzz_source *in, uint8_t *data, size_t size)
{
    size_t at = TED4_FILE_HEADER_SIZE;

    while (memcmp(data + at, "TILE", 4) != 0)
        at += ted4_chunk_size(data, size, at);
    for (size_t i = 40; i < ted4_load32(data + at + 8) && in->at < in->end; i++)
        data[at + TED4_FRAME_HEAD_SIZE + i] ^= fuzz_u8(in);
    ted4_fix_hashes(data, size);
    ted4_fix_rans_ends(data, size);
}

static void check_file(fuzz_source *in, const ted4_scene *s, uint8_t *data, size_t size)
{
    ted4_scene *read = NULL;
    uint8_t *out;
    size_t n_out;

    fuzz_require(ted4_decode(data, size, NULL, &read, NULL) == TED4_OK, "read");
    fuzz_require(memcmp(read->dynamic, s->dynamic, s->head.n_anchors) == 0 &&
                     memcmp(read->offset_bits, s->offset_bits, 2 * (size_t)s->head.n_anchors) == 0,
                 "the same masks");
    ted4_scene_free(read);
    damage(in, data, size);
    if (ted4_decode(data, size, NULL, &read, NULL) != TED4_OK)
        return;
    fuzz_require(ted4_encode(read, read->level, NULL, &out, &n_out, NULL) == TED4_OK &&
                     n_out == size && memcmp(out, data, size) == 0,
                 "the same bytes");
    free(out);
    ted4_scene_free(read);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_source in = { data, data + size };
    random_source r = random_seed(1);
    const ted4_header h = header_of(&in);
    ted4_scene *const s = random_scene_of(&r, &h, 0);
    uint8_t *out;
    size_t n_out;
    int legal;

    fuzz_require(s != NULL, "a scene");
    legal = take_masks(&in, s);
    if (legal)
        random_tidy(s);

    const ted4_status verdict = ted4_encode(s, 0, NULL, &out, &n_out, NULL);

    fuzz_require(verdict == (legal ? TED4_OK : TED4_E_SYN_HASH), "written exactly when allowed");
    if (legal)
        check_file(&in, s, out, n_out);
    free(out);
    ted4_scene_free(s);
    return 0;
}
