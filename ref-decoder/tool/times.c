/* times.c - see times.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "times.h"

#include <stddef.h>

enum { MAX_DECIMALS = 7, DENOMINATORS = 1 << 24 };

/* Reads decimal digits. Returns the position after them, or NULL if there are none or the number is
 * too large. */
static const char *read_digits(const char *p, uint32_t *out)
{
    uint64_t v = 0;

    if (*p < '0' || *p > '9')
        return NULL;
    for (; *p >= '0' && *p <= '9'; p++) {
        v = v * 10 + (uint64_t)(*p - '0');
        if (v >= UINT32_MAX)
            return NULL;
    }
    *out = (uint32_t)v;
    return p;
}

/* Reads an optional number. *out is unchanged if there is none. */
static const char *read_part(const char *p, uint32_t *out)
{
    return *p == ':' || *p == '\0' ? p : read_digits(p, out);
}

int ted4_range_parse(const char *text, ted4_range *r)
{
    const char *p;

    *r = (ted4_range) { 0, UINT32_MAX, 1 };
    p = read_part(text, &r->first);
    if (p == NULL || *text == '\0')
        return -1;
    if (*p == '\0') {
        r->end = r->first + 1;
        return 0;
    }
    if (*p++ != ':' || (p = read_part(p, &r->end)) == NULL)
        return -1;
    if (*p == ':')
        p = read_part(p + 1, &r->step);
    return p != NULL && *p == '\0' && r->step > 0 && r->end > r->first ? 0 : -1;
}

static int parse_decimals(const char *p, ted4_time *t)
{
    int n = 0;

    t->den = 1;
    if (*p == '.') {
        for (p++; *p >= '0' && *p <= '9' && n < MAX_DECIMALS; p++, n++) {
            t->num = t->num * 10 + (uint32_t)(*p - '0');
            t->den *= 10;
        }
        if (n == 0)
            return -1;
    }
    return *p == '\0' && t->num <= t->den ? 0 : -1;
}

int ted4_time_parse(const char *text, ted4_time *t)
{
    const char *p;

    if (*text == '.') {
        t->num = 0;
        return parse_decimals(text, t);
    }
    p = read_digits(text, &t->num);
    if (p == NULL)
        return -1;
    if (*p != '/')
        return t->num <= 1 ? parse_decimals(p, t) : -1;
    p = read_digits(p + 1, &t->den);
    return p != NULL && *p == '\0' && t->den >= 1 && t->den < DENOMINATORS && t->num <= t->den ? 0
                                                                                               : -1;
}

int ted4_seconds_parse(const char *text, ted4_seconds *s)
{
    enum { MAX_SECONDS = 1000000 };
    int n = 0;
    uint32_t whole = 0;
    const char *p = *text == '.' ? text : read_digits(text, &whole);

    if (p == NULL || whole >= MAX_SECONDS)
        return -1;
    *s = (ted4_seconds) { whole, 1 };
    if (*p == '.') {
        for (p++; *p >= '0' && *p <= '9' && n < MAX_DECIMALS; p++, n++) {
            s->num = s->num * 10 + (uint64_t)(*p - '0');
            s->den *= 10;
        }
        if (n == 0)
            return -1;
    }
    return p[0] == 's' && p[1] == '\0' ? 0 : -1;
}

/* Returns the greatest common divisor; a >= 1. */
static uint64_t divisor(uint64_t a, uint64_t b)
{
    while (b != 0) {
        const uint64_t rest = a % b;

        a = b;
        b = rest;
    }
    return a;
}

static void cancel(uint64_t *a, uint64_t *b)
{
    const uint64_t common = divisor(*a, *b);

    *a /= common;
    *b /= common;
}

/* An integer of 128 bits. */
typedef struct {
    uint64_t high, low;
} wide;

/* Returns a b, which must have at most 128 bits. */
static wide product(wide a, uint32_t b)
{
    const uint64_t first = (a.low & UINT32_MAX) * b, second = (a.low >> 32) * b + (first >> 32);

    return (wide) { a.high * b + (second >> 32), second << 32 | (first & UINT32_MAX) };
}

static int is_above(wide a, wide b)
{
    return a.high != b.high ? a.high > b.high : a.low > b.low;
}

/* R-HDR-005: returns the query of the time num / den, whose terms are the lowest if den is at
 * least 2^24; num <= den < 2^96. */
static ted4_time query(wide num, wide den)
{
    const uint32_t most = DENOMINATORS - 1;
    const wide twice = product(num, 2 * most); /* 2 most num is compared with (2 n + 1) den */
    uint32_t n = 0;                            /* floor(most num / den) */

    if (den.high == 0 && den.low <= most)
        return (ted4_time) { (uint32_t)num.low, (uint32_t)den.low };
    for (uint32_t bit = DENOMINATORS / 2; bit > 0; bit /= 2)
        if (!is_above(product(den, 2 * (n + bit)), twice))
            n += bit;

    const wide half = product(den, 2 * n + 1);
    const int above = is_above(twice, half), below = is_above(half, twice);

    return (ted4_time) { n + (uint32_t)(above || (!below && n % 2 == 1)), most };
}

ted4_time ted4_time_of_seconds(ted4_seconds s, uint32_t n_frames, uint32_t rate_num,
                               uint32_t rate_den)
{
    uint64_t up[2] = { s.num, rate_num }, down[3] = { s.den, rate_den, n_frames - 1 };

    if (n_frames == 1 || s.num == 0)
        return (ted4_time) { 0, 1 };
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 3; j++)
            cancel(&up[i], &down[j]);

    const wide num = product((wide) { 0, up[0] }, (uint32_t)up[1]);
    const wide den = product((wide) { 0, down[0] * down[1] }, (uint32_t)down[2]);

    return is_above(den, num) ? query(num, den) : (ted4_time) { 1, 1 };
}

ted4_time ted4_time_of_part(double part)
{
    enum { STEPS = 10000000 }; /* 10^MAX_DECIMALS, so that a part is as exact as a text */

    return (ted4_time) { (uint32_t)(part * STEPS + 0.5), STEPS };
}

ted4_time ted4_time_of_frame(uint32_t frame, uint32_t n_frames)
{
    uint64_t num = frame, den = n_frames > 1 ? n_frames - 1 : 1;

    if (den >= DENOMINATORS)
        cancel(&den, &num);
    return query((wide) { 0, num }, (wide) { 0, den });
}
