/* pack.c - see pack.h. A match is searched for only at the last position with the same four bytes,
 * and at distance 1.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "pack.h"

#include <stdlib.h>
#include <string.h>
#include "base/bytes.h"

enum {
    LITERALS = 288,
    DISTANCES = 30,
    END = 256,
    LEAST = 4,
    MOST = 258,
    HASH = 1 << 14,
    WINDOW = 32768
};

typedef struct {
    uint16_t length, distance; /* distance 0: length is a literal */
} token;

typedef struct {
    conf_bytes *out;
    uint32_t bits;
    unsigned n;
} bit_writer;

/* The length of every code. The lengths determine the codes (RFC 1951, 3.2.2). */
typedef struct {
    uint8_t length[LITERALS];
    uint16_t code[LITERALS];
} codes;

static void put_bits(bit_writer *w, uint32_t value, unsigned n)
{
    for (unsigned i = 0; i < n; i++) {
        w->bits |= (value >> i & 1) << w->n++;
        if (w->n == 8) {
            const uint8_t byte = (uint8_t)w->bits;

            conf_add(w->out, &byte, 1);
            w->bits = w->n = 0;
        }
    }
}

static void to_byte(bit_writer *w)
{
    while (w->n != 0)
        put_bits(w, 0, 1);
}

/* Huffman codes are written from their highest bit on. */
static void put_code(bit_writer *w, const codes *c, unsigned symbol)
{
    for (unsigned i = c->length[symbol]; i > 0; i--)
        put_bits(w, c->code[symbol] >> (i - 1) & 1, 1);
}

static void make_codes(codes *c)
{
    unsigned next = 0;

    for (unsigned length = 1; length <= 15; length++, next <<= 1)
        for (unsigned i = 0; i < LITERALS; i++)
            if (c->length[i] == length)
                c->code[i] = (uint16_t)next++;
}

/* Makes a complete code, of nearly equal lengths, for the n symbols in use. */
static void level_codes(codes *c, const uint8_t *used, unsigned n_symbols)
{
    unsigned n = 0, bits = 1, shorter, seen = 0;

    memset(c, 0, sizeof *c);
    for (unsigned i = 0; i < n_symbols; i++)
        n += used[i];
    while (1u << bits < n)
        bits++;
    shorter = (1u << bits) - n;
    for (unsigned i = 0; i < n_symbols; i++)
        if (used[i])
            c->length[i] = (uint8_t)(bits - (seen++ < shorter && bits > 1));
    make_codes(c);
}

static void fixed_codes(codes *literal, codes *distance)
{
    memset(distance, 0, sizeof *distance);
    for (unsigned i = 0; i < LITERALS; i++)
        literal->length[i] = i < 144 ? 8 : i < 256 ? 9 : i < 280 ? 7 : 8;
    memset(distance->length, 5, DISTANCES);
    make_codes(literal);
    make_codes(distance);
}

static size_t match(const uint8_t *data, size_t size, size_t at, size_t from)
{
    size_t n = 0;

    while (n < MOST && at + n < size && data[from + n] == data[at + n])
        n++;
    return n;
}

/* Returns the tokens of the data, an owned array. */
static token *find_tokens(const uint8_t *data, size_t size, size_t *n)
{
    token *t = conf_alloc(size + 1, sizeof *t);
    size_t *last = conf_alloc(HASH, sizeof *last);

    *n = 0;
    for (size_t at = 0; at < size;) {
        size_t best = 0, distance = 0;

        if (at > 0) {
            best = match(data, size, at, at - 1);
            distance = 1;
        }
        if (at + LEAST <= size) {
            const size_t slot = ted4_load32(data + at) * 2654435761u >> 18;
            const size_t from = last[slot];

            if (from > 0 && at - (from - 1) <= WINDOW && match(data, size, at, from - 1) > best) {
                best = match(data, size, at, from - 1);
                distance = at - (from - 1);
            }
            last[slot] = at + 1;
        }
        t[(*n)++] = best >= LEAST ? (token) { (uint16_t)best, (uint16_t)distance }
                                  : (token) { data[at], 0 };
        at += best >= LEAST ? best : 1;
    }
    free(last);
    return t;
}

/* These return the symbol of a length or distance, and set the number and the value of its extra
 * bits. */
static unsigned length_symbol(unsigned length, unsigned *extra, unsigned *value)
{
    unsigned symbol = 257, base = 3;

    *extra = 0;
    if (length == MOST) {
        *value = 0;
        return 285;
    }
    for (;; symbol++) {
        *extra = symbol < 265 ? 0 : (symbol - 261) / 4;
        if (length < base + (1u << *extra))
            break;
        base += 1u << *extra;
    }
    *value = length - base;
    return symbol;
}

static unsigned distance_symbol(unsigned distance, unsigned *extra, unsigned *value)
{
    unsigned symbol = 0, base = 1;

    for (;; symbol++) {
        *extra = symbol < 4 ? 0 : symbol / 2 - 1;
        if (distance < base + (1u << *extra))
            break;
        base += 1u << *extra;
    }
    *value = distance - base;
    return symbol;
}

static void put_tokens(bit_writer *w, const codes *literal, const codes *distance, const token *t,
                       size_t n)
{
    for (size_t i = 0; i < n; i++) {
        unsigned extra, value;

        if (t[i].distance == 0) {
            put_code(w, literal, t[i].length);
            continue;
        }
        put_code(w, literal, length_symbol(t[i].length, &extra, &value));
        put_bits(w, value, extra);
        put_code(w, distance, distance_symbol(t[i].distance, &extra, &value));
        put_bits(w, value, extra);
    }
    put_code(w, literal, END);
}

/* RFC 1951, 3.2.7, without repeat codes. over: 1: one length is too short. */
static void put_dynamic(bit_writer *w, const token *t, size_t n, int over)
{
    static const uint8_t order[19] = { 16, 17, 18, 0, 8,  7, 9,  6, 10, 5,
                                       11, 4,  12, 3, 13, 2, 14, 1, 15 };
    uint8_t used[LITERALS] = { 0 }, far[DISTANCES] = { 0 }, lengths[19] = { 0 };
    codes literal, distance, length;

    used[END] = far[0] = far[1] = 1;
    for (size_t i = 0; i < n; i++) {
        unsigned extra, value;

        used[t[i].distance == 0 ? t[i].length : length_symbol(t[i].length, &extra, &value)] = 1;
        if (t[i].distance > 0)
            far[distance_symbol(t[i].distance, &extra, &value)] = 1;
    }
    level_codes(&literal, used, LITERALS - 2);
    level_codes(&distance, far, DISTANCES);
    if (over)
        literal.length[END] = 1;
    for (unsigned i = 0; i < LITERALS - 2; i++)
        lengths[literal.length[i]] = 1;
    for (unsigned i = 0; i < DISTANCES; i++)
        lengths[distance.length[i]] = 1;
    level_codes(&length, lengths, 19);
    put_bits(w, 2, 2);
    put_bits(w, LITERALS - 2 - 257, 5);
    put_bits(w, DISTANCES - 1, 5);
    put_bits(w, 19 - 4, 4);
    for (unsigned i = 0; i < 19; i++)
        put_bits(w, length.length[order[i]], 3);
    for (unsigned i = 0; i < LITERALS - 2; i++)
        put_code(w, &length, literal.length[i]);
    for (unsigned i = 0; i < DISTANCES; i++)
        put_code(w, &length, distance.length[i]);
    put_tokens(w, &literal, &distance, t, n);
}

static void put_stored(bit_writer *w, const uint8_t *data, size_t size, int last, int wrong)
{
    uint8_t head[4];

    put_bits(w, (uint32_t)last, 1);
    put_bits(w, 0, 2);
    to_byte(w);
    ted4_store16(head, (uint16_t)size);
    ted4_store16(head + 2, (uint16_t)(~size ^ (wrong ? 1u : 0u)));
    conf_add(w->out, head, sizeof head);
    conf_add(w->out, data, size);
}

void conf_adler(uint8_t check[4], const uint8_t *data, size_t size)
{
    uint32_t a = 1, b = 0;

    for (size_t i = 0; i < size; i++) {
        a = (a + data[i]) % 65521;
        b = (b + a) % 65521;
    }
    for (int i = 0; i < 4; i++)
        check[i] = (uint8_t)((i < 2 ? b : a) >> (i % 2 == 0 ? 8 : 0));
}

static void put_head(conf_bytes *out, conf_pack_way way, conf_pack_fault fault)
{
    uint8_t head[2] = { way == CONF_PACK_SMALL ? 0x08 : 0x78, 0 };

    if (fault == CONF_PACK_METHOD)
        head[0] = 0x77;
    if (fault == CONF_PACK_WINDOW)
        head[0] = 0x88;
    if (fault == CONF_PACK_DICTIONARY)
        head[1] = 0x20;
    head[1] = (uint8_t)(head[1] + 31 - (head[0] * 256 + head[1]) % 31);
    if (fault == CONF_PACK_CHECK)
        head[1] ^= 1;
    conf_add(out, head, sizeof head);
    if (fault == CONF_PACK_DICTIONARY)
        conf_add(out, "\0\0\0\1", 4);
}

static void put_body(bit_writer *w, const uint8_t *data, size_t size, conf_pack_way way,
                     conf_pack_fault fault)
{
    codes literal, distance;
    size_t n,
        stored = way == CONF_PACK_MIXED || fault == CONF_PACK_STORED ? size < 5 ? size : 5 : 0;
    token *t;

    if (fault == CONF_PACK_NOT_SHORTER) {
        put_stored(w, data, size, 1, 0);
        return;
    }
    if (stored > 0)
        put_stored(w, data, stored, 0, fault == CONF_PACK_STORED);
    t = find_tokens(data + stored, size - stored, &n);
    put_bits(w, 1, 1);
    if (fault == CONF_PACK_BLOCK3) {
        put_bits(w, 3, 2);
    } else if (way == CONF_PACK_DYNAMIC) {
        put_dynamic(w, t, n, fault == CONF_PACK_OVER);
    } else {
        put_bits(w, 1, 2);
        fixed_codes(&literal, &distance);
        if (fault == CONF_PACK_DISTANCE)
            put_tokens(w, &literal, &distance, (const token[]) { { 'x', 0 }, { 5, 2 } }, 2);
        put_tokens(w, &literal, &distance, t, n);
    }
    to_byte(w);
    free(t);
}

void conf_pack(conf_bytes *out, const uint8_t *data, size_t size, conf_pack_way way,
               conf_pack_fault fault)
{
    bit_writer w = { .out = out };
    conf_bytes other = { NULL, 0, 0 };
    uint8_t check[4];

    if (fault == CONF_PACK_EMPTY)
        return;
    conf_add(&other, data, fault == CONF_PACK_SHORT ? size - 4 : size);
    if (fault == CONF_PACK_LONG)
        conf_add(&other, "\0\0\0\0", 4);
    put_head(out, way, fault);
    put_body(&w, other.data, other.size, way, fault);
    conf_adler(check, other.data, other.size);
    check[3] ^= fault == CONF_PACK_ADLER;
    conf_add(out, check, fault == CONF_PACK_CUT ? 3 : 4);
    if (fault == CONF_PACK_TRAILING)
        conf_add(out, "", 1);
    conf_free(&other);
}

static int index_of(const char *const *name, int n, const char *what)
{
    for (int i = 0; i < n; i++)
        if (strcmp(name[i], what) == 0)
            return i;
    return -1;
}

int conf_pack_way_of(const char *name)
{
    static const char *const way[] = { "fixed", "dynamic", "mixed", "small" };

    return index_of(way, 4, name);
}

int conf_pack_fault_of(const char *name)
{
    static const char *const fault[CONF_PACK_FAULTS] = {
        "good",     "adler", "check",  "method",   "window", "dictionary", "short",       "long",
        "trailing", "cut",   "block3", "distance", "stored", "over",       "not-shorter", "empty"
    };

    return index_of(fault, CONF_PACK_FAULTS, name);
}

void conf_shuffle(uint8_t *to, const float *values, size_t n)
{
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < 4; j++)
            to[j * n + i] = (uint8_t)(ted4_float_bits(values[i]) >> 8 * j);
}
