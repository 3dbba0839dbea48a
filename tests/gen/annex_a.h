/* annex_a.h - the text of annex A: tables from their formulas (table_math.h), each with its hash.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_ANNEX_A_H
#define TED4_ANNEX_A_H

#include <inttypes.h>
#include <stdio.h>
#include "table_math.h"
#include "tool/sha256.h"

static inline void annex_a_hash(FILE *out, const struct table *t)
{
    uint8_t digest[TED4_SHA256_SIZE];
    ted4_sha256 h;

    ted4_sha256_init(&h);
    for (int i = 0; i < t->n; i++) {
        const uint32_t v = (uint32_t)t->entry(i);
        const uint8_t bytes[4] = { (uint8_t)v, (uint8_t)(v >> 8), (uint8_t)(v >> 16),
                                   (uint8_t)(v >> 24) };

        ted4_sha256_add(&h, bytes, 4);
    }
    ted4_sha256_end(&h, digest);
    for (int i = 0; i < TED4_SHA256_SIZE; i++)
        fprintf(out, "%02x", digest[i]);
}

static inline void annex_a(FILE *out)
{
    fprintf(out, "# Annex A (normative): tables\n\n"
                 "The entries are printed in row order; i counts from 0.\n"
                 "sigma = 2^((g - 64) / 16). `rne` is taken of the exact real number. The SHA-256\n"
                 "is that of the entries as 32-bit little-endian integers in two's complement.\n\n"
                 "Where a formula and a printed entry differ, the entry counts.\n");
    for (int i = 0; i < N_ANNEX; i++) {
        const struct table *t = &table_list[i];
        const int hex = t->entry == table_step;

        fprintf(out, "\n## A.%d %s\n\n`%s[i]` = %s; %d entries. SHA-256\n`", i + 1, t->name,
                t->name, t->text, t->n);
        annex_a_hash(out, t);
        fprintf(out, "`\n\n```\n");
        for (int k = 0; k < t->n; k++) {
            fprintf(out, hex ? "0x%08" PRIx64 : "%" PRId64, t->entry(k));
            fprintf(out, "%s", k + 1 == t->n ? "\n" : k % 8 == 7 ? ",\n" : ", ");
        }
        fprintf(out, "```\n");
    }
}

#endif
