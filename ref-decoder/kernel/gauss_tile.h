/* gauss_tile.h - spec 9.2, 9.4: the variant of gauss_symbol of read/reader.c for several lanes at a
 * time. Each 32-bit element of a vector holds one lane and computes as norm/gaussian.h does. All
 * lanes read from one sequence of words, in the order of lanes; expand() distributes the words. The
 * including file defines VECTOR, the size of a vector in bytes, includes gauss_vector.h for the
 * types, and defines these operations, which differ between machines:
 *     vi all(int32_t x)                           x in each lane
 *     vi least(vi a, vi b), most(vi a, vi b)      minimum and maximum, signed
 *     mask less(vi a, vi b), equal(vi a, vi b), either(mask a, mask b), lanes_of(unsigned bits)
 *     unsigned bits_of(mask m)                    bit i is for lane i
 *     vi choose(mask m, vi yes, vi no)
 *     void pairs(const int32_t *table, vi i, vi *low, vi *high)       table[i], table[i + 1]
 *     vi indices(const uint8_t *sigma)            sigma[i] in lane i
 *     vi scales(vi sigma)                         STEPI[128 + 2 (sigma mod 16)]
 *     vi expand(unsigned wants, const uint8_t *words)     the next 16-bit word for each lane whose
 *                                                 bit of wants is 1; may read LANES words
 *     void narrow(int16_t *to, vi x)              stores the low half of each lane
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_GAUSS_TILE_H
#define TED4_GAUSS_TILE_H

#include <string.h>
#include "base/bytes.h"
#include "kernel/gauss_kernel.h"
#include "norm/gaussian.h"

/* ROWS: the largest number of vectors that are processed together, because each one waits for table
 * lookups most of the time. TRIES: the largest number of guesses of a bound. */
enum { ROWS = 4, TRIES = 4 };

/* Specifiers of functions that are rarely called, and of those that must be inlined. */
#define TED4_SELDOM static __attribute__((noinline))
#define TED4_ALWAYS static inline __attribute__((always_inline))

/* INV and the half window of each sigma index, side by side. */
typedef struct {
    int32_t of[2 * TED4_N_SIGMA];
} model_table;

/* The models of a vector of lanes: sigma index, INV, half window, fractional part of mu, and size
 * of the alphabet. */
typedef struct {
    vi g, inv, hw, fr, size;
} models;

/* Symbols j whose slots are [from, to). */
typedef struct {
    vi j, from, to;
} symbols;

/* A vector of lanes that is being processed: the models; the states x, the slots, and the values k
 * of the symbols; the symbols s; the index of the first lane; and sets of lanes as bits: those to
 * be read, those with an escape, and those whose k is out of range. */
typedef struct {
    models m;
    vi x, slot, k;
    symbols s;
    unsigned first, active, escape, outside;
} row;

static inline vi load(const void *from)
{
    vi x;

    memcpy(&x, from, sizeof x);
    return x;
}

static inline vi clamp(vi x, vi low, vi high)
{
    return least(most(x, low), high);
}

static inline void fill_models(model_table *t)
{
    for (int g = 0; g < TED4_N_SIGMA; g++) {
        t->of[2 * g] = ted4_inv[g];
        t->of[2 * g + 1] = ted4_half[g];
    }
}

/* The vector form of ted4_gauss_inner. */
static inline vi inner(const models *g, vi j)
{
    const vi d = (j - 1 - g->hw) * 256 - 128 - g->fr;
    const vi at = clamp((vi)((vu)d * (vu)g->inv) >> 11, all(-(1 << 17)), all(1 << 17)) + (1 << 17);
    /* The last entry is computed from the one before it, with b = 256. */
    const vi i = least(at >> 8, all(TED4_N_PHI - 2)), b = at - i * 256;
    vi low, high;

    pairs(ted4_phi, i, &low, &high);

    const vi p = low + (((high - low) * b) >> 8);
    const vu share = (vu)(p >> 8) * (vu)((1 << TED4_SLOT_BITS) - g->size);

    return (vi)(share >> TED4_SLOT_BITS) + j;
}

/* The vector form of ted4_gauss_cum. */
static inline vi cum(const models *g, vi j)
{
    return choose(equal(j, all(0)), all(0),
                  choose(equal(j, g->size), all(1 << TED4_SLOT_BITS), inner(g, j)));
}

/* Guesses the bound between two symbols that is nearest to slot, as guess of norm/gaussian.c does,
 * but interpolates in the table and first removes the slots that all symbols receive equally. For
 * that, 21/32 of the alphabet counts on average, as symbols far from the mean hold less of it. */
static inline vi bound_near(const models *m, vi slot)
{
    const vi even = ((slot - (1 << 15)) * ((m->size * 21) >> 5)) >> TED4_SLOT_BITS;
    const vi at = slot + even - 128, i = clamp(at >> 8, all(0), all(TED4_N_WHERE - 2));
    vi low, high;

    pairs(ted4_where, i, &low, &high);

    const vi where = low + (((high - low) * clamp(at - i * 256, all(-128), all(384))) >> 8);
    const vi d = (where * scales(m->g)) >> (22 - (m->g >> 4));

    return clamp(((d + 256 + m->fr) >> 8) + 1 + m->hw, all(1), m->size - 1);
}

/* Returns the symbols between the bound near the slot, whose value is bound, and the next one in
 * the direction of the slot. */
static inline symbols beside(const models *m, vi slot, vi near, vi bound)
{
    const mask below = less(slot, bound);
    const vi other = cum(m, choose(below, near - 1, near + 1));

    return (symbols) { choose(below, near - 1, near), least(bound, other), most(bound, other) };
}

/* Does the same with three bounds that are computed at once. This is more work, but has less
 * latency if there is only one row. */
static inline symbols around(const models *m, vi slot, vi near)
{
    const vi bound = inner(m, near), before = cum(m, near - 1), after = cum(m, near + 1);
    const mask below = less(slot, bound);

    return (symbols) { choose(below, near - 1, near), choose(below, before, bound),
                       choose(below, bound, after) };
}

/* Returns those of the lanes whose symbol does not contain the slot. */
static inline unsigned missed(const symbols *s, vi slot, unsigned lanes)
{
    return (bits_of(less(slot, s->from)) | ~bits_of(less(slot, s->to))) & lanes;
}

/* Finds the symbols of the lanes for which no guess was close enough, one by one. */
static void find_alone(const models *m, vi slot, unsigned lanes, symbols *s)
{
    int32_t g[LANES], fr[LANES], at[LANES], j[LANES], from[LANES], to[LANES];

    memcpy(g, &m->g, sizeof g);
    memcpy(fr, &m->fr, sizeof fr);
    memcpy(at, &slot, sizeof at);
    memcpy(j, &s->j, sizeof j);
    memcpy(from, &s->from, sizeof from);
    memcpy(to, &s->to, sizeof to);
    for (; lanes != 0; lanes &= lanes - 1) {
        const unsigned i = (unsigned)__builtin_ctz(lanes);
        ted4_slots slots;

        j[i] = (int32_t)ted4_gauss_find((unsigned)g[i], fr[i], (uint32_t)at[i], &slots);
        from[i] = (int32_t)slots.start;
        to[i] = (int32_t)(slots.start + slots.freq);
    }
    s->j = load(j);
    s->from = load(from);
    s->to = load(to);
}

/* Corrects guesses that missed. In wide models, symbols have few slots, so a guess can be off by
 * several symbols. The width of the guessed symbol gives the distance to the next guess. */
TED4_SELDOM void find_again(const models *m, vi slot, unsigned lanes, symbols *s)
{
    for (int i = 1; i < TRIES && lanes != 0; i++) {
        const vf steps = __builtin_convertvector(slot - s->from, vf) /
                         __builtin_convertvector(s->to - s->from, vf);
        const vi near = clamp(s->j + __builtin_convertvector(steps, vi), all(1), m->size - 1);
        const symbols next = beside(m, slot, near, inner(m, near));
        const mask these = lanes_of(lanes);

        s->j = choose(these, next.j, s->j);
        s->from = choose(these, next.from, s->from);
        s->to = choose(these, next.to, s->to);
        lanes = missed(s, slot, lanes);
    }
    if (lanes != 0)
        find_alone(m, slot, lanes, s);
}

/* Sets the models and slots of a row. Reads LANES elements of mu and sigma. */
TED4_ALWAYS void begin_row(row *r, const uint32_t *state, const model_table *t, const int32_t *mu,
                           const uint8_t *sigma)
{
    r->m.g = indices(sigma);
    pairs(t->of, r->m.g * 2, &r->m.inv, &r->m.hw);
    r->m.size = r->m.hw + r->m.hw + 4;
    r->k = load(mu);
    r->m.fr = r->k & 255;
    r->x = load(state + r->first);
    r->slot = r->x & 0xffff;
}

/* Sets the values of the symbols, and the sets of active lanes that need special treatment: those
 * with an escape, and those whose value does not fit 16 bits. */
TED4_ALWAYS void end_row(row *r)
{
    const vi k = (r->k >> TED4_MU_BITS) + (r->s.j - 1 - r->m.hw);

    r->k = k;
    r->escape = bits_of(either(equal(r->s.j, all(0)), equal(r->s.j, r->m.size - 1))) & r->active;
    r->outside = bits_of(either(less(all(32767), k), less(k, all(-32767)))) & r->active &
                 ~r->escape;
}

/* Advances the states of some consecutive lanes past their symbols, none of which is an escape.
 * Returns 1, or 0 with nothing changed if words are missing. */
TED4_ALWAYS int take(ted4_gauss_lanes *d, const row *r, unsigned lanes)
{
    const vi y = (vi)((vu)(r->s.to - r->s.from) * ((vu)r->x >> TED4_SLOT_BITS) + (vu)r->slot -
                      (vu)r->s.from);
    const mask low = equal((vi)((vu)y >> TED4_SLOT_BITS), all(0));
    const unsigned wants = bits_of(low) & lanes;
    const size_t left = (size_t)(d->end - d->word), used = 2 * (size_t)__builtin_popcount(wants);
    uint8_t last[2 * LANES] = { 0 };
    const uint8_t *word = d->word;
    uint32_t *state = d->state + r->first;

    if (left < sizeof last) {
        if (used > left)
            return 0;
        memcpy(last, word, left);
        word = last;
    }

    vi next = choose(low, (vi)((vu)y << 16) | expand(wants, word), y);

    if (lanes != (1u << LANES) - 1)
        next = choose(lanes_of(lanes), next, load(state));
    memcpy(state, &next, sizeof next);
    d->word += used;
    return 1;
}

/* The state of a lane while it reads an escape, and the remaining words. */
typedef struct {
    uint32_t x;
    const uint8_t *word, *end;
} alone;

/* Does the same as ted4_rans_dec_take. Returns 1, or 0 if a word is missing. */
static int take_alone(alone *a, uint32_t from, uint32_t freq)
{
    a->x = freq * (a->x >> TED4_SLOT_BITS) + (a->x & 0xffff) - from;
    if (a->x >> TED4_SLOT_BITS == 0) {
        if (a->word == a->end)
            return 0;
        a->x = a->x << 16 | ted4_load16(a->word);
        a->word += 2;
    }
    return 1;
}

/* Returns one bit of an escape, or -1 if a word is missing. */
static int bit_alone(alone *a)
{
    const uint32_t one = a->x >> 15 & 1;

    return take_alone(a, one << 15, 1u << 15) ? (int)one : -1;
}

/* spec 9.4, Escapes: returns e, or -1 if the escape is invalid or a word is missing. */
static int32_t escape_alone(alone *a)
{
    int32_t value = 1;
    int n = 0, bit;

    while ((bit = bit_alone(a)) == 1)
        if (++n > TED4_ESCAPE_BITS)
            return -1;
    for (; bit >= 0 && n > 0; n--) {
        bit = bit_alone(a);
        value = 2 * value + bit;
    }
    return bit < 0 ? -1 : value - 1;
}

/* Reads the symbol of a lane that has an escape. Returns 1, or 0 with nothing changed if the reader
 * has to treat the symbol separately. */
static int take_escape(ted4_gauss_lanes *d, const row *r, unsigned lane, int16_t *k)
{
    int32_t j[LANES], from[LANES], to[LANES], symbol[LANES], hw[LANES];

    memcpy(j, &r->s.j, sizeof j);
    memcpy(from, &r->s.from, sizeof from);
    memcpy(to, &r->s.to, sizeof to);
    memcpy(symbol, &r->k, sizeof symbol);
    memcpy(hw, &r->m.hw, sizeof hw);

    alone a = { d->state[r->first + lane], d->word, d->end };

    if (!take_alone(&a, (uint32_t)from[lane], (uint32_t)(to[lane] - from[lane])))
        return 0;

    /* An escape with e = 0 stands for the next value after the window. */
    const int32_t e = escape_alone(&a), value = j[lane] == 0 ? symbol[lane] - e : symbol[lane] + e;

    if (e < 0 || value < -32767 || value > 32767)
        return 0;
    *k = (int16_t)value;
    d->state[r->first + lane] = a.x;
    d->word = a.word;
    return 1;
}

/* Reads a row in pieces: the lanes between escapes together, and escapes one by one. Returns the
 * set of lanes that were read. */
TED4_SELDOM unsigned take_with_escapes(ted4_gauss_lanes *d, const row *r, int16_t *k)
{
    unsigned left = r->active, care = r->escape | r->outside;

    while (care != 0) {
        const unsigned it = care & -care, before = left & (it - 1);

        if (before != 0 && !take(d, r, before))
            return r->active & ~left;
        left &= ~before;
        if ((it & r->outside) != 0 ||
            !take_escape(d, r, (unsigned)__builtin_ctz(it), k + __builtin_ctz(it)))
            return r->active & ~left;
        left &= ~it;
        care &= ~it;
    }
    return left == 0 || take(d, r, left) ? r->active : r->active & ~left;
}

/* Reads the symbols of a number of rows from lane on; active is the set of wanted lanes of each
 * row. mu, sigma and k point to the elements of the first lane; those of all lanes are read or
 * written. Returns the number of symbols read. Rarely called functions receive copies of rows, so
 * that rows can stay in registers. */
TED4_ALWAYS unsigned take_rows(ted4_gauss_lanes *d, const model_table *t, unsigned lane,
                               const int rows, unsigned active, const int32_t *mu,
                               const uint8_t *sigma, int16_t *k)
{
    row r[ROWS];
    vi near[ROWS], bound[ROWS];
    unsigned n = 0;

    for (int i = 0; i < rows; i++) {
        r[i].first = lane + (unsigned)i * LANES;
        r[i].active = active;
        begin_row(&r[i], d->state, t, mu + i * LANES, sigma + i * LANES);
    }
    for (int i = 0; i < rows; i++)
        near[i] = bound_near(&r[i].m, r[i].slot);
    if (rows == 1) {
        for (int i = 0; i < rows; i++)
            r[i].s = around(&r[i].m, r[i].slot, near[i]);
    } else {
        for (int i = 0; i < rows; i++)
            bound[i] = inner(&r[i].m, near[i]);
        for (int i = 0; i < rows; i++)
            r[i].s = beside(&r[i].m, r[i].slot, near[i], bound[i]);
    }
    for (int i = 0; i < rows; i++) {
        const unsigned again = missed(&r[i].s, r[i].slot, active);

        if (again != 0) {
            const models m = r[i].m;
            symbols s = r[i].s;

            find_again(&m, r[i].slot, again, &s);
            r[i].s = s;
        }
        end_row(&r[i]);
        narrow(k + i * LANES, r[i].k);
    }
    for (int i = 0; i < rows; i++) {
        unsigned taken;

        if ((r[i].escape | r[i].outside) != 0) {
            const row copy = r[i];

            taken = take_with_escapes(d, &copy, k + i * LANES);
        } else {
            taken = take(d, &r[i], active) ? active : 0;
        }
        n += (unsigned)__builtin_popcount(taken);
        if (taken != active)
            break;
    }
    return n;
}

/* Reads n symbols of the row that begins at lane, starting with its lane number from. Accesses no
 * elements of mu, sigma and k beyond these. Returns the number of symbols read. */
TED4_SELDOM unsigned take_part(ted4_gauss_lanes *d, const model_table *t, unsigned lane,
                               unsigned from, unsigned n, const int32_t *mu, const uint8_t *sigma,
                               int16_t *k)
{
    int32_t mean[LANES] = { 0 };
    uint8_t g[LANES] = { 0 };
    int16_t symbol[LANES];

    memcpy(mean + from, mu, n * sizeof *mu);
    memcpy(g + from, sigma, n);

    const unsigned taken = take_rows(d, t, lane, 1, ((1u << n) - 1) << from, mean, g, symbol);

    memcpy(k, symbol + from, taken * sizeof *k);
    return taken;
}

/* A ted4_gauss_many that reads the given number of rows at a time while they are complete, and
 * single rows or parts of them otherwise. */
TED4_ALWAYS size_t many_rows(ted4_gauss_lanes *d, const int rows, size_t n, const int32_t *mu,
                             const uint8_t *sigma, int16_t *k)
{
    const unsigned width = d->n_lanes < LANES ? d->n_lanes : LANES, whole = width * (unsigned)rows;
    unsigned lane = d->lane, wanted, got;
    size_t done = 0;
    model_table t;

    fill_models(&t);
    do {
        const unsigned from = lane & (width - 1), rest = width - from;
        const size_t left = n - done;

        if (lane % whole == 0 && left >= (size_t)rows * LANES) {
            wanted = whole;
            got =
                take_rows(d, &t, lane, rows, (1u << width) - 1, mu + done, sigma + done, k + done);
        } else {
            wanted = left < rest ? (unsigned)left : rest;
            got = take_part(d, &t, lane - from, from, wanted, mu + done, sigma + done, k + done);
        }
        done += got;
        lane = (lane + got) & (d->n_lanes - 1);
    } while (got == wanted && done < n);
    return done;
}

/* A ted4_gauss_many that reads as many rows at a time as the substream has lanes for. */
static inline size_t many(ted4_gauss_lanes *d, size_t n, const int32_t *mu, const uint8_t *sigma,
                          int16_t *k)
{
    if (d->n_lanes >= 4 * LANES)
        return many_rows(d, 4, n, mu, sigma, k);
    if (d->n_lanes >= 2 * LANES)
        return many_rows(d, 2, n, mu, sigma, k);
    return many_rows(d, 1, n, mu, sigma, k);
}

#endif
