/* annex_b.h - the text of annex B: two files byte by byte, with the coder's steps, the values and
 * the records, all worked out by the code that the specification prints (spec_tiers.h).
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_ANNEX_B_H
#define TED4_ANNEX_B_H

#include <inttypes.h>
#include <stdio.h>
#include "spec_tiers.h"
#include "annex_b_files.h"
#include "tool/sha256.h"

enum { ANNEX_B_WIDTH = 16, ANNEX_B_NOTE = 96 };

/* An element under way, and the run of equal ones that it ends. */
typedef struct {
    FILE *out;
    const uint8_t *data;
    size_t at; /* of the element that has not been printed yet */
    char name[32];
    int64_t index, value;
    size_t run; /* equal entries of one array, the current one included */
    char previous[32];
    int n_repeated;
} annex_b_dissection;

static inline void annex_b_hex(FILE *out, const uint8_t *p, size_t n)
{
    for (size_t i = 0; i < n; i++)
        fprintf(out, "%s%02x", i > 0 ? " " : "", p[i]);
}

/* What the value of a substream counts: entries of what it codes. */
static inline const char *annex_b_unit(const char *name)
{
    return strcmp(name, "tree_substream") == 0      ? "anchor"
           : strcmp(name, "weights_substream") == 0 ? "value"
                                                    : "symbol";
}

/* What a value means, for people. */
static inline void annex_b_note(const annex_b_dissection *d, char note[ANNEX_B_NOTE])
{
    static const char *const real[] = { "step", "origin", "nete", "netr", "bank" };

    note[0] = 0;
    for (size_t i = 0; i < sizeof real / sizeof *real; i++)
        if (strcmp(d->name, real[i]) == 0 && d->index >= 0)
            snprintf(note, ANNEX_B_NOTE, "%g", (double)from_bits((uint32_t)d->value));
    if (strcmp(d->name, "position") == 0)
        snprintf(note, ANNEX_B_NOTE, "%g, X = %" PRId32,
                 (double)q24((uint16_t)d->value) / 16777216.0, q24((uint16_t)d->value));
    if (strcmp(d->name, "chunk_type") == 0)
        snprintf(note, ANNEX_B_NOTE, "%.4s", (const char *)d->data + d->at);
    if (strstr(d->name, "_substream") != NULL)
        snprintf(note, ANNEX_B_NOTE, "%d %s%s", (int)d->value, annex_b_unit(d->name),
                 d->value == 1 ? "" : "s");
    if (strcmp(d->name, "magic") == 0 || strcmp(d->name, "ends_hash") == 0)
        snprintf(note, ANNEX_B_NOTE, "all of them");
    if (d->index < 0)
        snprintf(note, ANNEX_B_NOTE, "zlib stream");
}

/* Prints the element that ends at offset end. */
static inline void annex_b_row(annex_b_dissection *d, size_t end)
{
    const size_t n = end - d->at;
    char note[ANNEX_B_NOTE];
    const int whole = strcmp(d->name, "chunk_hash") == 0 || strcmp(d->name, "magic") == 0 ||
                      strcmp(d->name, "ends_hash") == 0 || strstr(d->name, "_substream") != NULL ||
                      d->index < 0;

    annex_b_note(d, note);
    fprintf(d->out, "| %zu | `", d->at);
    if (d->run > 1)
        fprintf(d->out, "%zu x ", d->run);
    annex_b_hex(d->out, d->data + d->at, d->run > 1 ? n / d->run : n);
    fprintf(d->out, "` | %s", d->name);
    if (d->index > 0 && strstr(d->name, "_substream") == NULL)
        fprintf(d->out, "[%" PRId64 "]", d->index);
    if (d->run > 1)
        fprintf(d->out, " and the next %zu", d->run - 1);
    if (whole)
        fprintf(d->out, " | | %s |\n", note);
    else
        fprintf(d->out, " | %" PRId64 " | %s |\n", d->value, note);
}

static inline int annex_b_symbol(const char *name)
{
    static const char *const symbol[] = { "dynamic", "offset_bit", "feature", "scaling",
                                          "offset",  "phi",        "tau" };

    for (size_t i = 0; i < sizeof symbol / sizeof *symbol; i++)
        if (strcmp(symbol[i], name) == 0)
            return 1;
    return 0;
}

/* For ted4_options.trace. */
static inline void annex_b_element(void *user, size_t at, const char *name, int64_t index,
                                   int64_t value)
{
    annex_b_dissection *d = user;
    const int same = strcmp(d->name, name) == 0;

    if (annex_b_symbol(name) ||
        (same && index > 0 && (strcmp(name, "magic") == 0 || strcmp(name, "ends_hash") == 0)))
        return;
    if (same && index > 0 && value == d->value && strcmp(name, "position") != 0 &&
        strstr(name, "_substream") == NULL) {
        d->run++;
        return;
    }
    if (d->name[0] != 0)
        annex_b_row(d, at);
    snprintf(d->name, sizeof d->name, "%s", name);
    d->at = at;
    d->index = index;
    d->value = value;
    d->run = 1;
}

static inline void annex_b_bytes(FILE *out, const uint8_t *data, size_t size)
{
    annex_b_dissection d = { .out = out, .data = data };
    const ted4_options o = { .trace = annex_b_element, .trace_user = &d };
    ted4_scene *s;

    fprintf(out,
            "Offsets are decimal and bytes hexadecimal; \"n x\" stands for n equal entries.\n\n"
            "| offset | bytes | element | value | note |\n|---|---|---|---|---|\n");
    if (ted4_decode(data, size, &o, &s, NULL) != TED4_OK)
        abort();
    annex_b_row(&d, size);
    ted4_scene_free(s);
}

/* One step of the coder. */
static inline void annex_b_step(FILE *out, const struct coder *before, const struct coder *after,
                                unsigned lane, const char *what)
{
    fprintf(out, "| %s | %08" PRIx32 " | %" PRIu32 " | %08" PRIx32 " |", what, before->state[lane],
            before->state[lane] % 65536, after->state[lane]);
    for (const uint8_t *word = before->word; word < after->word; word += 2)
        fprintf(out, " %04" PRIx32, load16(word));
    fprintf(out, " |\n");
}

static inline void annex_b_steps_head(FILE *out, const char *name, const uint8_t *bytes,
                                      size_t size)
{
    fprintf(out, "\n`%s`, bytes `", name);
    annex_b_hex(out, bytes, size);
    fprintf(out, "`:\n\n| symbol | state | slot | state after | word |\n|---|---|---|---|---|\n");
}

typedef struct {
    spec_tiers t; /* first: spec_tile_done takes the same pointer */
    FILE *out;
    const uint8_t *payload; /* of the TILE */
} annex_b_tile;

static inline const uint8_t *annex_b_masks(const annex_b_tile *b, const uint8_t *p, size_t size,
                                           const uint32_t prob[7])
{
    const struct scene *s = &b->t.model.p.s;
    struct coder c;

    annex_b_steps_head(b->out, "mask_substream", p, size);
    open_substream(&c, p, size, (uint64_t)(s->h.n_anchors * (s->h.temporal_mask + s->h.n_offsets)));
    for (size_t a = 0; a < (size_t)s->h.n_anchors; a++)
        for (int k = -1, seen = 1, bits = 0; k < s->h.n_offsets; k++) {
            const uint32_t pr = k < 0 ? prob[0] : prob[1 + 3 * s->dynamic[a] + seen];
            struct coder before = c;
            char what[ANNEX_B_NOTE];
            const int bit = take_bit(&c, 0, pr);

            if (k < 0)
                snprintf(what, sizeof what, "anchor %zu dynamic: %d, slots of 1 below %" PRIu32, a,
                         bit, pr);
            else
                snprintf(what, sizeof what,
                         "anchor %zu offset %d: %d, context %d, slots of 1 below %" PRIu32, a, k,
                         bit, 3 * s->dynamic[a] + seen, pr);
            annex_b_step(b->out, &before, &c, 0, what);
            if (k >= 0) {
                bits |= bit << k;
                seen = bits == (2 << k) - 1 ? 1 : bits == 0 ? 0 : 2;
            }
        }
    return p + size;
}

/* e of spec 9.4 of a symbol, or -1 when it is none. */
static inline int32_t annex_b_escape(int32_t mu, int g, int32_t k)
{
    const int32_t r = k - floor_shift(mu, 8);

    return r < -HALF[g] ? -HALF[g] - 1 - r : r > HALF[g] + 1 ? r - HALF[g] - 2 : -1;
}

/* Components comp .. comp + n - 1 of a type, which one substream holds. */
static inline const uint8_t *annex_b_attributes(const annex_b_tile *b, const char *name, int type,
                                                int comp, int n, const uint8_t *p, size_t size)
{
    const struct scene *s = &b->t.model.p.s;
    uint64_t n_symbols = 0;
    struct coder c;

    for (int k = comp; k < comp + n; k++)
        for (size_t a = 0; a < (size_t)s->h.n_anchors; a++)
            n_symbols += (uint64_t)has(s, type, k, a);
    annex_b_steps_head(b->out, name, p, size);
    open_substream(&c, p, size, n_symbols);
    for (int k = comp; k < comp + n; k++)
        for (size_t a = 0; a < (size_t)s->h.n_anchors; a++) {
            const int32_t *mu = spec_mu(&b->t.model, type, k, a);
            const int g = sigma_index(mu[type_dim(&s->h, type)]);
            struct coder before = c;
            char what[2 * ANNEX_B_NOTE];
            int32_t x;
            int n_text;

            if (!has(s, type, k, a))
                continue;
            x = decode_symbol(&c, 0, mu[0], g);
            n_text = snprintf(what, sizeof what,
                              "component %d, anchor %zu: mu %" PRId32
                              ", sigma index %d, k = %" PRId32,
                              k, a, mu[0], g, x);
            if (annex_b_escape(mu[0], g, x) >= 0)
                snprintf(what + n_text, sizeof what - (size_t)n_text, ", escape with x = %" PRId32,
                         annex_b_escape(mu[0], g, x));
            annex_b_step(b->out, &before, &c, 0, what);
        }
    return p + size;
}

static inline void annex_b_tile_done(void *user, uint32_t number)
{
    static const char *const name[TYPES] = { "feature_substream", "scaling_substream",
                                             "offset_substream", "phi_substream", "tau_substream" };
    annex_b_tile *b = user;
    const struct header *h = &b->t.model.p.s.h;
    uint32_t prob[7] = { 0 };
    const uint8_t *at = b->payload + 4, *size, *p;
    int comp = 0;

    spec_tile_done(&b->t, number);
    for (int i = 0; i < 7; i++)
        if (i == 0 ? h->temporal_mask : h->offset_mask) {
            prob[i] = load16(at);
            at += 2;
        }
    size = at;
    p = at + 4 * spec_n_substreams(h);
    if (h->temporal_mask) {
        p = annex_b_masks(b, p, load32(size), prob);
        size += 4;
    }
    for (int i = 0; i < h->n_slices; comp += (int)h->slice[i++], size += 4)
        p = annex_b_attributes(b, name[FEATURE], FEATURE, comp, (int)h->slice[i], p, load32(size));
    for (int type = SCALING; type < TYPES; type++)
        if (type_dim(h, type) > 0) {
            p = annex_b_attributes(b, name[type], type, 0, type_dim(h, type), p, load32(size));
            size += 4;
        }
}

static inline void annex_b_hashes(FILE *out, const char *name, const spec_bytes *b)
{
    uint8_t xxh[16], sha[TED4_SHA256_SIZE];
    ted4_sha256 h;

    canonical(xxh3_128(b->data, b->size), xxh);
    ted4_sha256_init(&h);
    ted4_sha256_add(&h, b->data, b->size);
    ted4_sha256_end(&h, sha);
    fprintf(out, "| %s | %zu | `", name, b->size);
    for (int i = 0; i < 16; i++)
        fprintf(out, "%02x", xxh[i]);
    fprintf(out, "` | `");
    for (int i = 0; i < TED4_SHA256_SIZE; i++)
        fprintf(out, "%02x", sha[i]);
    fprintf(out, "` |\n");
}

static inline void annex_b_query(FILE *out, const spec_model *m, uint32_t num, uint32_t den,
                                 const float *camera)
{
    float record[16][14];

    fprintf(out,
            "\nTime %" PRIu32 "/%" PRIu32
            ", camera centre (%g, %g, %g):\n\n| record | position | scale | rotation | opacity | "
            "colour |\n|---|---|---|---|---|---|\n",
            num, den, (double)camera[0], (double)camera[1], (double)camera[2]);
    for (size_t a = 0, i = 0; a < (size_t)m->p.s.h.n_anchors; a++) {
        const int n = anchor_records(&m->p.s, m->p.net_r, a, num, den, camera, record);

        for (int k = 0; k < n; k++, i++) {
            fprintf(out, "| %zu", i);
            for (int c = 0; c < 14; c++) {
                uint32_t pattern;

                memcpy(&pattern, &record[k][c], 4);
                fprintf(out, "%s`%08" PRIx32 "` %.6g",
                        c == 0 || c == 3 || c == 6 || c == 10 || c == 11 ? " | " : "<br>", pattern,
                        (double)record[k][c]);
            }
            fprintf(out, " |\n");
        }
    }
}

static inline void annex_b_values(FILE *out, const struct scene *s)
{
    static const char *const name[TYPES] = { "feature", "scaling", "offset", "phi", "tau" };

    fprintf(out, "\n| anchor | type | step index | q | values k q |\n|---|---|---|---|---|\n");
    for (size_t a = 0; a < (size_t)s->h.n_anchors; a++)
        for (int type = 0; type < TYPES; type++) {
            if (type_dim(&s->h, type) == 0 || (type == PHI_TYPE && !s->dynamic[a]))
                continue;

            const int i = s->step_index[type][a];

            fprintf(out, "| %zu | %s | %d | %g |", a, name[type], i,
                    (double)(from_bits(s->h.step[type]) * from_bits(STEP[i])));
            for (int c = 0; c < type_dim(&s->h, type); c++) {
                if (has(s, type, c, a))
                    fprintf(out, " %g", (double)value_of(s, type, c, a));
                else
                    fprintf(out, " -");
            }
            fprintf(out, " |\n");
        }
}

/* The records of one file at n_times times, and all its tiers. */
static inline void annex_b_results(FILE *out, int section, spec_tiers *t, int n_times)
{
    static const float camera[3] = { 0.0f, 0.0f, -2.0f };
    const uint32_t den = n_times > 1 ? (uint32_t)n_times - 1 : 1;

    fprintf(out, "\n### B.%d.4 Records\n", section);
    for (int i = 0; i < n_times; i++)
        annex_b_query(out, &t->model, (uint32_t)i, den, camera);
    fprintf(out, "\n### B.%d.5 Tiers\n\n| tier | bytes | XXH3-128 | SHA-256 |\n|---|---|---|---|\n",
            section);
    for (int i = 0; i < N_TIERS; i++)
        annex_b_hashes(out, (const char *[]) { "T0", "T1", "T2", "T3", "T4" }[i], &t->tier[i]);
    for (int i = 0; i < n_times; i++) {
        spec_bytes t5 = { NULL, 0, 0 };
        char name[ANNEX_B_NOTE];

        spec_t5(&t5, &t->model, (uint32_t)i, den, camera);
        snprintf(name, sizeof name, "T5 at %d/%u", i, den);
        annex_b_hashes(out, name, &t5);
        free(t5.data);
    }
}

/* One file; closes with its tiers. */
static inline void annex_b_file(FILE *out, int section, const uint8_t *data, size_t size,
                                int n_times)
{
    annex_b_tile b = { .out = out };
    size_t at = 12;

    fprintf(out, "\n### B.%d.1 Bytes\n\n", section);
    annex_b_bytes(out, data, size);
    while (memcmp(data + at, "TILE", 4) != 0)
        at += 20 + load32(data + at + 8);
    b.payload = data + at + 12;
    b.t.model.tile_done = annex_b_tile_done;
    b.t.model.user = &b;
    fprintf(out,
            "\n"
            "### B.%d.2 Substreams\n\n"
            "Each substream has one lane. States are hexadecimal; a state below 10000 takes\n"
            "the next word. The last state of each substream is 00010000. The row of an\n"
            "escape covers all its bits.\n",
            section);
    spec_model_decode(&b.t.model, data, size);
    if (b.t.model.p.v.id != NULL)
        abort();
    spec_t0(&b.t.tier[0], &b.t.model, data, size);
    spec_t1(&b.t.tier[1], &b.t.model.p.s);
    fprintf(out, "\n### B.%d.3 Values\n", section);
    annex_b_values(out, &b.t.model.p.s);
    annex_b_results(out, section, &b.t, n_times);
    spec_tiers_free(&b.t);
}

static inline void annex_b(FILE *out)
{
    size_t size;
    uint8_t *data = annex_b_encode(annex_b_smallest(), &size);

    fprintf(out,
            "# Annex B (informative): worked examples\n\n"
            "This annex is generated by `make spec-annexes`: the bytes come from the reference\n"
            "encoder, and everything else from the code that this specification prints. A\n"
            "test checks this text against them.\n\n"
            "## B.1 The smallest file\n\n"
            "The file has one anchor, one Gaussian, a feature of one component, no motion\n"
            "and no masks, and all its weights and biases are 0. It has %zu bytes, and no\n"
            "valid file of profile Main has fewer: HEAD is shortest with one slice; 92 and 88 "
            "bytes of\n"
            "values cannot be coded in fewer than 11 bytes each (a zlib stream has 6 bytes\n"
            "around its blocks, and a literal, a match and an end take 34 bits); three\n"
            "substreams need a state each. (Profile Compact: B.3.)\n\n"
            "As all outputs of the hyperprior are 0, every mu is 0, every sigma index is 64\n"
            "(sigma is one step), and every step index is 128 (q = Q0). The Gaussian has\n"
            "opacity 0, as the heads are 0 too: the smallest file shows nothing.\n",
            size);
    annex_b_file(out, 1, data, size, 1);
    free(data);
    data = annex_b_encode(annex_b_dynamic(), &size);
    fprintf(out,
            "\n"
            "## B.2 A dynamic anchor\n\n"
            "The file has two anchors with two offsets each. Anchor 0 stands still and\n"
            "keeps one offset; anchor 1 moves, keeps both, and comes and goes (tau in B.2.3\n"
            "holds a_s, log2 b_s, a_f, log2 b_f). The second slice of the feature is\n"
            "predicted from the first; feature 1 of anchor 0 is far from its mean and needs\n"
            "an escape. The file has %zu bytes, most of them weights that are 0.\n\n"
            "At t = 1/2 the bank gives z = -1 + 1/2 (1 - (-1)) = 0 (11.2), so F_deform sees\n"
            "w z = 0 and nothing moves; at t = 1 it gives z = 1, so w = F_project(phi) =\n"
            "0.5 + 0.5 = 1, and F_deform adds 0.25 to x in normalised space, which is 0.5\n"
            "in the world, as 2^e = 2.\n",
            size);
    annex_b_file(out, 2, data, size, 5);
    free(data);
}

#endif
