/* make_corpus.c - writes fuzz/corpus: tiny valid files, each with different parts of the header in
 * use; the same files with knobs after them; files that are refused; and the seeds of
 * corpus_units.c and corpus_scenes.c. `make fuzz-corpus`.
 *     make_corpus FOLDER
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdio.h>
#include <sys/stat.h>
#include "corpus.h"
#include "fix_hashes.h"
#include "mutate.h"
#include "norm/coder.h"
#include "random_scene.h"

enum { MAX_FILE = 1 << 14, KNOBS = 2, QUERIES = 32 };

/* Nothing moves, no masks, one slice, no view: the least that a file can contain. */
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

static const char *const name[] = { "smallest",   "masks",       "inr",       "slices",
                                    "bank",       "bank_mask",   "concat",    "motion_inr",
                                    "activation", "view_colour", "view_full", "linear",
                                    "two_tiles",  "escapes",     "deflated",  "meta",
                                    "grid",       "tree",        "coded",     "coded_moving",
                                    "both_modes", "exponents",   "leaves",    "coded_tiles" };

/* The first of them that is of profile Compact, and its successors in the list. */
enum {
    N_FILES = sizeof name / sizeof *name,
    GRID = 16,
    TREE,
    CODED,
    CODED_MOVING,
    BOTH_MODES,
    EXPONENTS,
    LEAVES,
    CODED_TILES
};

/* Sets what a file of profile Compact uses of the header. */
static void compact(ted4_header *h, int i)
{
    switch (i) {
    case TREE: h->offset_mask = 1; break;
    case CODED:
        inr_prior(h);
        slices(h);
        h->view = TED4_VIEW_COLOUR;
        h->head_layers = 1;
        h->head_width = 2;
        break;
    case CODED_MOVING:
        moving(h, TED4_MOTION_BANK);
        h->temporal_mask = h->activation = 1;
        break;
    case BOTH_MODES:
        moving(h, TED4_MOTION_CONCAT);
        slices(h);
        break;
    case LEAVES:
        h->n_anchors = 64;
        h->feature_dim = h->slice[0] = h->n_offsets = 1;
        break;
    case CODED_TILES:
        h->n_anchors = 67;
        h->n_offsets = 1;
        h->feature_dim = h->slice[0] = 1;
        moving(h, TED4_MOTION_INR);
        h->temporal_mask = 1;
        break;
    default: break;
    }
}

static ted4_header header_of(int i)
{
    ted4_header h = smallest();

    switch (i) {
    case 1: h.offset_mask = 1; break;
    case 2: inr_prior(&h); break;
    case 3:
        inr_prior(&h);
        slices(&h);
        break;
    case 4: moving(&h, TED4_MOTION_BANK); break;
    case 5:
        moving(&h, TED4_MOTION_BANK);
        h.temporal_mask = h.offset_mask = 1;
        break;
    case 6: moving(&h, TED4_MOTION_CONCAT); break;
    case 7:
        moving(&h, TED4_MOTION_INR);
        h.temporal_mask = 1;
        break;
    case 8: h.activation = 1; break;
    case 9:
        h.view = TED4_VIEW_COLOUR;
        h.head_layers = 1;
        h.head_width = 2;
        break;
    case 10:
        h.view = TED4_VIEW_FULL;
        slices(&h);
        break;
    case 11:
        h.scale_domain = TED4_SCALE_LINEAR;
        h.frames = 1;
        h.exponent = -7;
        break;
    case 12:
        h.n_anchors = 67;
        h.n_offsets = 1;
        h.feature_dim = h.slice[0] = 1;
        h.offset_mask = 1;
        break;
    case 13:
        inr_prior(&h);
        h.activation = 1;
        h.context_bits = 12;
        break;
    default: compact(&h, i); break;
    }
    return h;
}

/* Inserts an ancillary chunk META after HEAD, and sets a minor version above ours. Returns the new
 * size. */
static size_t add_meta(uint8_t *data, size_t size)
{
    static const char text[] = "title=fuzz\n";
    const size_t n = sizeof text - 1, whole = TED4_FRAME_HEAD_SIZE + n + TED4_FRAME_HASH_SIZE;
    const size_t head = TED4_FILE_HEADER_SIZE;
    const size_t at = head + TED4_FRAME_HEAD_SIZE + ted4_load32(data + head + 8) +
                      TED4_FRAME_HASH_SIZE;

    memmove(data + at + whole, data + at, size - at);
    memcpy(data + at, "META", 4);
    ted4_store32(data + at + 4, TED4_FLAG_COPY);
    ted4_store32(data + at + 8, (uint32_t)n);
    memcpy(data + at + TED4_FRAME_HEAD_SIZE, text, n);
    data[9] = 1;
    ted4_fix_hashes(data, size + whole);
    return size + whole;
}

/* Makes the weights multiples of the least and the largest power of two that a unit can have, and
 * lets them have as many significant bits as an integer can. */
static void extreme_units(ted4_scene *s)
{
    for (size_t i = 0; i < s->netr.n; i++)
        s->netr.values[i] = i % 2 ? 0x1p-126f : 0x1.fffffep-104f;
    s->netr.values[0] = -0x1p127f;
}

/* Makes the positions a solid block: every node of the two lowest levels has all children. */
static void solid(ted4_scene *s)
{
    for (size_t i = 0; i < 3 * (size_t)s->head.n_anchors; i++) {
        const uint32_t x = ted4_gather3(i / 3 >> (2 - i % 3));

        s->position[i] = ted4_grid_half(x + 32, s->grid);
    }
    (void)ted4_scene_steps(s, NULL, NULL);
}

static ted4_scene *scene_of(int i, random_source *r)
{
    static const uint8_t grid[] = { 6, 16, 12, 9, 16, 7, 6, 8 };
    const ted4_header h = header_of(i);
    ted4_scene *const s = i < GRID ? random_scene_of(r, &h, i == 13)
                                   : random_compact_of(r, &h, i == TREE, grid[i - GRID]);

    if (s == NULL)
        return NULL;
    for (size_t j = 0; i == 14 && j < s->netr.n; j++)
        s->netr.values[j] = 0.25f;
    if (i == BOTH_MODES) {
        s->netr.mode = TED4_BLOB_RAW;
        for (size_t j = 0; j < s->bank.n; j++)
            s->bank.values[j] = 0.1f; /* deflates better */
    }
    if (i == EXPONENTS)
        extreme_units(s);
    if (i == LEAVES)
        solid(s);
    return s;
}

static int write_file(int i)
{
    random_source r = random_seed((uint64_t)i);
    ted4_scene *s = scene_of(i, &r);
    uint8_t data[MAX_FILE], *out = NULL;
    size_t size = 0;
    char file[64];

    if (s == NULL || ted4_encode(s, 0, NULL, &out, &size, NULL) != TED4_OK || size > MAX_FILE / 2)
        return 0;
    memcpy(data, out, size);
    free(out);
    ted4_scene_free(s);
    if (i == 15)
        size = add_meta(data, size);
    (void)snprintf(file, sizeof file, "%s.ted4", name[i]);
    corpus_write("ted4", file, data, size);
    for (int j = 0; j < QUERIES; j++)
        data[size + (size_t)j] = (uint8_t)random_u32(&r);
    corpus_write("recon", file, data, size + QUERIES);
    data[size] = (uint8_t)(i % 8 | i / 2 << 4); /* tile order and trace, then a memory limit */
    corpus_write("knobs", file, data, size + KNOBS);
    return 1;
}

static size_t flip_bits(uint8_t *data, size_t size, size_t max_size)
{
    static random_source r = { 77 };

    (void)max_size;
    for (int i = 0; i < 2 && size > 0; i++)
        data[random_u32(&r) % size] ^= (uint8_t)(1u << random_in(&r, 0, 7));
    return size;
}

/* Writes changed files: for each verdict by which the decoder refuses a file, the first one found
 * that gets it, of the files from first to end. */
static void write_refused(int first, int end, const char *prefix)
{
    enum { TRIES = 30000 };
    int met[TED4_N_STATUS] = { 1 };
    static uint8_t data[2 * MAX_FILE];
    char path[4096], file[64];
    ted4_scene *s;

    for (uint32_t seed = 0; seed < TRIES; seed++) {
        FILE *f;
        size_t size;

        (void)snprintf(path, sizeof path, "%s/ted4/%s.ted4", corpus_folder,
                       name[first + (int)seed % (end - first)]);
        f = fopen(path, "rb");
        size = f != NULL ? fread(data, 1, MAX_FILE, f) : 0;
        if (f != NULL)
            fclose(f);
        size = ted4_without_tail(data, fuzz_mutate_file(data, size, MAX_FILE, seed, flip_bits),
                                 QUERIES);

        const ted4_status verdict = ted4_decode(data, size, NULL, &s, NULL);

        ted4_scene_free(s);
        if (met[verdict] || size > 2000)
            continue;
        met[verdict] = 1;
        (void)snprintf(file, sizeof file, "%s.%s.ted4", prefix, ted4_status_id(verdict));
        corpus_write("knobs", file, data, size);
    }
}

/* Writes two files of two tiles: one is truncated, so that a lenient decoder can save the first
 * tile; in the other both tiles are damaged, and whichever runs first, the fault of the first tile
 * in the file is reported. */
static void write_two_tiles(void)
{
    enum { TWO_TILES = 12, BACKWARDS = 2, CUT = 60 };
    random_source r = random_seed(TWO_TILES);
    const ted4_header h = header_of(TWO_TILES);
    ted4_scene *s = random_scene_of(&r, &h, 0);
    uint8_t *out = NULL, data[MAX_FILE];
    size_t size = 0;

    if (s == NULL || ted4_encode(s, 0, NULL, &out, &size, NULL) != TED4_OK || size > MAX_FILE / 2)
        exit(3);
    memcpy(data, out, size);
    data[size] = CUT;
    data[size + 1] = 0;
    corpus_write("knobs", "cut_tiles.ted4", data, size + KNOBS);
    for (size_t at = TED4_FILE_HEADER_SIZE; at < size; at += ted4_chunk_size(data, size, at))
        if (memcmp(data + at, "TILE", 4) == 0)
            data[at + ted4_chunk_size(data, size, at) - TED4_FRAME_HASH_SIZE - 1] ^= 1;
    ted4_fix_hashes(data, size);
    data[size] = BACKWARDS;
    data[size + 1] = 0;
    corpus_write("knobs", "both_tiles.ted4", data, size + KNOBS);
    free(out);
    ted4_scene_free(s);
}

int main(int argc, char **argv)
{
    if (argc != 2) {
        fprintf(stderr, "make_corpus: usage: make_corpus FOLDER\n");
        return 3;
    }
    corpus_folder = argv[1];
    for (int i = 0; i < N_FILES; i++)
        if (!write_file(i)) {
            fprintf(stderr, "make_corpus: %s failed\n", name[i]);
            return 3;
        }
    write_refused(0, GRID, "refused");
    write_refused(GRID, N_FILES, "refused_compact");
    write_two_tiles();
    corpus_units();
    corpus_scenes();
    return 0;
}
