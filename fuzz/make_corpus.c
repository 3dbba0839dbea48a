/* make_corpus.c - writes fuzz/corpus: tiny valid files, each with other parts of the header in use. `make fuzz-corpus`.
 *     make_corpus FOLDER
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdio.h>
#include "mend.h"
#include "norm/coder.h"
#include "random_scene.h"

enum { MAX_FILE = 1 << 14 };

/* Nothing moves, no masks, one slice, no view: the least that a file holds. */
static ted4_header smallest(void)
{
    ted4_header h;

    memset(&h, 0, sizeof h);
    h.n_anchors = 6;
    h.tile_size = 64;
    h.n_offsets = 2;
    h.feature_dim = 3;
    h.prior = TED4_PRIOR_FACTORISED;
    h.n_slices = 1;
    h.slice[0] = 3;
    h.context_bits = 8;
    for (int t = 0; t < TED4_TYPES; t++)
        h.step[t] = 0.125f;
    h.frames = 4;
    h.rate_num = 30;
    h.rate_den = 1;
    return h;
}

static void inr_prior(ted4_header *h)
{
    h->prior = TED4_PRIOR_INR;
    h->pe_octaves = 1;
    h->hyper_layers = 1;
    h->hyper_width = 3;
}

static void slices(ted4_header *h)
{
    h->n_slices = 2;
    h->slice[0] = 1;
    h->slice[1] = 2;
    h->ar_width = 3;
}

static void moving(ted4_header *h, uint8_t motion)
{
    h->motion = motion;
    h->deform_layers = 1;
    h->deform_width = 3;
    if (motion == TED4_MOTION_INR) {
        h->deform_width = 1;
        return;
    }
    h->phi_dim = 2;
    h->bank_rows = 3;
    h->bank_dim = 2;
}

static const char *const name[] = { "smallest", "masks", "inr", "slices", "bank", "bank_mask", "concat", "motion_inr", "activation",
                                    "view_colour", "view_full", "linear", "two_tiles", "escapes", "deflated", "meta" };

enum { N_FILES = sizeof name / sizeof *name };

static ted4_header header_of(int i)
{
    ted4_header h = smallest();

    switch (i) {
    case 1: h.offset_mask = 1; break;
    case 2: inr_prior(&h); break;
    case 3: inr_prior(&h); slices(&h); break;
    case 4: moving(&h, TED4_MOTION_BANK); break;
    case 5: moving(&h, TED4_MOTION_BANK); h.temporal_mask = h.offset_mask = 1; break;
    case 6: moving(&h, TED4_MOTION_CONCAT); break;
    case 7: moving(&h, TED4_MOTION_INR); h.temporal_mask = 1; break;
    case 8: h.activation = 1; break;
    case 9: h.view = TED4_VIEW_COLOUR; h.head_layers = 1; h.head_width = 2; break;
    case 10: h.view = TED4_VIEW_FULL; slices(&h); break;
    case 11: h.scale_domain = TED4_SCALE_LINEAR; h.frames = 1; h.exponent = -7; break;
    case 12: h.n_anchors = 67; h.n_offsets = 1; h.feature_dim = h.slice[0] = 1; h.offset_mask = 1; break;
    case 13: inr_prior(&h); h.activation = 1; h.context_bits = 12; break;
    default: break;
    }
    return h;
}

/* An ancillary chunk META behind HEAD, and a minor version above ours. Gives the new size. */
static size_t add_meta(uint8_t *data, size_t size)
{
    static const char text[] = "title=fuzz\n";
    const size_t      n = sizeof text - 1, whole = TED4_FRAME_HEAD_SIZE + n + TED4_FRAME_HASH_SIZE;
    const size_t      head = TED4_FILE_HEADER_SIZE;
    const size_t      at = head + TED4_FRAME_HEAD_SIZE + ted4_load32(data + head + 8) + TED4_FRAME_HASH_SIZE;

    memmove(data + at + whole, data + at, size - at);
    memcpy(data + at, "META", 4);
    ted4_store32(data + at + 4, TED4_FLAG_COPY);
    ted4_store32(data + at + 8, (uint32_t)n);
    memcpy(data + at + TED4_FRAME_HEAD_SIZE, text, n);
    data[9] = 1;
    ted4_mend_chunks(data, size + whole);
    return size + whole;
}

static int write_file(const char *folder, int i)
{
    random_source     r = random_seed((uint64_t)i);
    const ted4_header h = header_of(i);
    ted4_scene       *s = random_scene_of(&r, &h, i == 13);
    uint8_t           data[MAX_FILE], *out = NULL;
    size_t            size = 0;
    char              path[4096];
    FILE             *f;

    for (size_t j = 0; i == 14 && s != NULL && j < s->netr.n; j++)
        s->netr.values[j] = 0.25f;
    if (s == NULL || ted4_encode(s, 0, NULL, &out, &size, NULL) != TED4_OK || size > MAX_FILE / 2)
        return 0;
    memcpy(data, out, size);
    free(out);
    ted4_scene_free(s);
    if (i == 15)
        size = add_meta(data, size);
    (void)snprintf(path, sizeof path, "%s/%s.ted4", folder, name[i]);
    f = fopen(path, "wb");
    if (f == NULL || fwrite(data, 1, size, f) != size)
        return 0;
    return fclose(f) == 0;
}

int main(int argc, char **argv)
{
    for (int i = 0; argc == 2 && i < N_FILES; i++)
        if (!write_file(argv[1], i)) {
            fprintf(stderr, "make_corpus: %s failed\n", name[i]);
            return 3;
        }
    return argc == 2 ? 0 : 3;
}
