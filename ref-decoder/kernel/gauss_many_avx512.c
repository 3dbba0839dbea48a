/* gauss_many_avx512.c - twin of gauss_symbol of read/reader.c for up to eight lanes at a time: spec 9.2, 9.4 with the arithmetic of norm/gaussian.h in each
 * 32-bit element. Lanes share one sequence of words, read in the order of lanes, which is what expanding words into the lanes that want one does.
 * SPDX-License-Identifier: BSD-2-Clause */
#if defined(__x86_64__)

#include <immintrin.h>
#include "kernel/gauss_kernel.h"
#include "norm/gaussian.h"

/* Lanes of a group at most, bytes of words that a group may look at, and guesses, each set right by one. */
enum { GROUP = 8, WORDS = 16, TRIES = 3 };

/* Models of a group: half window, INV, fraction of mu, size of the alphabet. */
typedef struct {
    __m256i hw, inv, fr, size;
} models;

static __m256i all(int32_t x)
{
    return _mm256_set1_epi32(x);
}

static __m256i clamp(__m256i x, __m256i low, __m256i high)
{
    return _mm256_min_epi32(_mm256_max_epi32(x, low), high);
}

/* Tables are looked up by loads, one an element: gather instructions take several times as long where processors are mended against leaks through them. */
static __m256i look_up(const int32_t *table, __m256i index)
{
    _Alignas(32) int32_t i[GROUP];

    _mm256_store_si256((void *)i, index);
    return _mm256_setr_epi32(table[i[0]], table[i[1]], table[i[2]], table[i[3]], table[i[4]], table[i[5]], table[i[6]], table[i[7]]);
}

static __m256i look_up_bytes(const int32_t *table, const uint8_t *i)
{
    return _mm256_setr_epi32(table[i[0]], table[i[1]], table[i[2]], table[i[3]], table[i[4]], table[i[5]], table[i[6]], table[i[7]]);
}

static __m256i half_windows(const uint8_t *i)
{
    const uint16_t *half = ted4_half;

    return _mm256_setr_epi32(half[i[0]], half[i[1]], half[i[2]], half[i[3]], half[i[4]], half[i[5]], half[i[6]], half[i[7]]);
}

/* Two neighbours of PHI. */
static __m128i pair(int32_t i)
{
    return _mm_loadl_epi64((const void *)&ted4_phi[i]);
}

/* PHI at each index and at the next one. */
static void look_up_phi(__m256i index, __m256i *low, __m256i *high)
{
    _Alignas(32) int32_t i[GROUP];

    _mm256_store_si256((void *)i, index);

    const __m128i ab = _mm_unpacklo_epi64(pair(i[0]), pair(i[1])), cd = _mm_unpacklo_epi64(pair(i[2]), pair(i[3]));
    const __m128i ef = _mm_unpacklo_epi64(pair(i[4]), pair(i[5])), gh = _mm_unpacklo_epi64(pair(i[6]), pair(i[7]));
    const __m256i a = _mm256_set_m128i(cd, ab), b = _mm256_set_m128i(gh, ef);

    *low = _mm256_permutex2var_epi32(a, _mm256_setr_epi32(0, 2, 4, 6, 8, 10, 12, 14), b);
    *high = _mm256_permutex2var_epi32(a, _mm256_setr_epi32(1, 3, 5, 7, 9, 11, 13, 15), b);
}

/* ted4_gauss_cum */
static __m256i cum(const models *g, __m256i j)
{
    const __m256i  d = _mm256_sub_epi32(_mm256_slli_epi32(_mm256_sub_epi32(_mm256_sub_epi32(j, all(1)), g->hw), 8),
                                        _mm256_add_epi32(all(128), g->fr));
    const __m256i  z = clamp(_mm256_srai_epi32(_mm256_mullo_epi32(d, g->inv), 11), all(-(1 << 17)), all(1 << 17));
    /* The last entry is reached from the one before, with b = 256. */
    const __m256i  at = _mm256_add_epi32(z, all(1 << 17)), i = _mm256_min_epi32(_mm256_srli_epi32(at, 8), all(TED4_N_PHI - 2));
    const __m256i  b = _mm256_sub_epi32(at, _mm256_slli_epi32(i, 8));
    __m256i        low, high;

    look_up_phi(i, &low, &high);

    const __m256i  p = _mm256_add_epi32(low, _mm256_srli_epi32(_mm256_mullo_epi32(_mm256_sub_epi32(high, low), b), 8));
    const __m256i  share = _mm256_mullo_epi32(_mm256_srli_epi32(p, 8), _mm256_sub_epi32(all(1 << TED4_SLOT_BITS), g->size));
    const __m256i  inner = _mm256_add_epi32(_mm256_srli_epi32(share, TED4_SLOT_BITS), j);
    const __mmask8 none = _mm256_cmpeq_epi32_mask(j, _mm256_setzero_si256()), whole = _mm256_cmpeq_epi32_mask(j, g->size);

    return _mm256_mask_mov_epi32(_mm256_mask_mov_epi32(inner, none, _mm256_setzero_si256()), whole, all(1 << TED4_SLOT_BITS));
}

/* guess of norm/gaussian.c */
static __m256i guess(const models *m, __m256i g, __m256i slot)
{
    const __m256i where = look_up(ted4_where, _mm256_srli_epi32(slot, 8));
    const __m256i step = look_up(ted4_stepi + 128, _mm256_slli_epi32(_mm256_and_si256(g, all(15)), 1));
    const __m256i d = _mm256_srav_epi32(_mm256_mullo_epi32(where, step), _mm256_sub_epi32(all(22), _mm256_srli_epi32(g, 4)));
    const __m256i near = _mm256_srai_epi32(_mm256_add_epi32(_mm256_add_epi32(d, all(128)), m->fr), 8);

    return clamp(_mm256_add_epi32(_mm256_add_epi32(near, all(1)), m->hw), _mm256_setzero_si256(), _mm256_sub_epi32(m->size, all(1)));
}

/* Symbols that hold their slots: from <= slot < to. */
typedef struct {
    __m256i j, from, to;
} symbols;

/* The lanes of which the guess is far off, in the tails of wide models, one by one. */
static void find_alone(const models *m, const uint8_t *sigma, __m256i slot, __mmask8 lanes, symbols *s)
{
    _Alignas(32) int32_t  fr[GROUP];
    _Alignas(32) uint32_t at[GROUP], j[GROUP], from[GROUP], to[GROUP];

    _mm256_store_si256((void *)fr, m->fr);
    _mm256_store_si256((void *)at, slot);
    for (unsigned i = 0; i < GROUP; i++) {
        ted4_slots slots = { 0, 0 };

        j[i] = lanes >> i & 1 ? ted4_gauss_find(sigma[i], fr[i], at[i], &slots) : 0;
        from[i] = slots.start;
        to[i] = slots.start + slots.freq;
    }
    s->j = _mm256_mask_load_epi32(s->j, lanes, j);
    s->from = _mm256_mask_load_epi32(s->from, lanes, from);
    s->to = _mm256_mask_load_epi32(s->to, lanes, to);
}

/* A guess that is one off shares one of its two bounds with the next one. */
static symbols find(const models *m, __m256i g, const uint8_t *sigma, __m256i slot, __mmask8 active)
{
    symbols  s = { .j = guess(m, g, slot) };
    __mmask8 below, above;

    s.from = cum(m, s.j);
    s.to = cum(m, _mm256_add_epi32(s.j, all(1)));
    for (int i = 1;; i++) {
        below = _mm256_mask_cmplt_epi32_mask(active, slot, s.from);
        above = _mm256_mask_cmpge_epi32_mask(active, slot, s.to);
        if ((below | above) == 0)
            return s;
        if (i == TRIES)
            break;

        const __m256i j = _mm256_mask_add_epi32(_mm256_mask_sub_epi32(s.j, below, s.j, all(1)), above, s.j, all(1));
        const __m256i bound = cum(m, _mm256_mask_add_epi32(j, above, j, all(1))), from = s.from;

        s.j = j;
        s.from = _mm256_mask_mov_epi32(_mm256_mask_mov_epi32(from, below, bound), above, s.to);
        s.to = _mm256_mask_mov_epi32(_mm256_mask_mov_epi32(s.to, below, from), above, bound);
    }
    find_alone(m, sigma, slot, below | above, &s);
    return s;
}

/* One group, from lane on. 0: nothing was taken. */
static int take(ted4_gauss_lanes *d, unsigned lane, __mmask8 active, const int32_t *mu, const uint8_t *sigma, int16_t *k)
{
    const __m256i mean = _mm256_loadu_si256((const void *)mu), g = _mm256_cvtepu8_epi32(_mm_loadl_epi64((const void *)sigma));
    const __m256i x = _mm256_maskz_loadu_epi32(active, d->state + lane), slot = _mm256_and_si256(x, all(0xffff));
    models        m = { .hw = half_windows(sigma), .inv = look_up_bytes(ted4_inv, sigma), .fr = _mm256_and_si256(mean, all(255)) };

    m.size = _mm256_add_epi32(_mm256_add_epi32(m.hw, m.hw), all(4));

    const symbols  s = find(&m, g, sigma, slot, active);
    const __m256i  symbol = _mm256_add_epi32(_mm256_srai_epi32(mean, TED4_MU_BITS), _mm256_sub_epi32(_mm256_sub_epi32(s.j, all(1)), m.hw));
    const __mmask8 escapes = _mm256_mask_cmpeq_epi32_mask(active, s.j, _mm256_setzero_si256())
                           | _mm256_mask_cmpeq_epi32_mask(active, s.j, _mm256_sub_epi32(m.size, all(1)));
    const __mmask8 outside = _mm256_mask_cmpgt_epi32_mask(active, _mm256_abs_epi32(symbol), all(32767));

    if ((escapes | outside) != 0)
        return 0;

    const __m256i  y = _mm256_sub_epi32(_mm256_add_epi32(_mm256_mullo_epi32(_mm256_sub_epi32(s.to, s.from), _mm256_srli_epi32(x, TED4_SLOT_BITS)), slot), s.from);
    const __mmask8 wants = _mm256_mask_cmplt_epu32_mask(active, y, all(1 << TED4_SLOT_BITS));
    const __m256i  words = _mm256_cvtepu16_epi32(_mm_loadu_si128((const void *)d->word));
    const __m256i  next = _mm256_mask_or_epi32(y, wants, _mm256_slli_epi32(y, 16), _mm256_maskz_expand_epi32(wants, words));

    _mm256_mask_storeu_epi32(d->state + lane, active, next);
    d->word += 2 * __builtin_popcount(wants);
    _mm256_mask_cvtepi32_storeu_epi16(k, active, symbol);
    return 1;
}

size_t ted4_gauss_many_avx512(ted4_gauss_lanes *d, size_t n, const int32_t *mu, const uint8_t *sigma, int16_t *k)
{
    const unsigned group = d->n_lanes < GROUP ? d->n_lanes : GROUP;
    const __mmask8 active = (__mmask8)((1u << group) - 1);
    unsigned       lane = d->lane;
    size_t         done = 0;

    if (lane % group != 0)
        return 0;
    /* Whole vectors of mu and sigma are looked at, whatever the group. */
    while (n - done >= GROUP && d->end - d->word >= WORDS) {
        if (!take(d, lane, active, mu + done, sigma + done, k + done))
            break;
        done += group;
        lane = (lane + group) & (d->n_lanes - 1);
    }
    return done;
}

#else
typedef int ted4_gauss_many_avx512_is_for_x86_64;
#endif
