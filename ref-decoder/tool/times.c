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
    uint32_t whole;
    const char *p = read_digits(text, &whole);

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

static uint64_t divisor64(uint64_t a, uint64_t b)
{
    while (b != 0) {
        const uint64_t rest = a % b;

        a = b;
        b = rest;
    }
    return a;
}

/* Returns rne(num most / den) for num < den < 2^62 and most < 2^24, by long multiplication and
 * division. */
static uint32_t scaled(uint64_t num, uint64_t den, uint32_t most)
{
    uint64_t quotient = 0, rest = 0;

    for (int bit = 23; bit >= 0; bit--) {
        quotient *= 2;
        rest *= 2;
        if (rest >= den) {
            rest -= den;
            quotient++;
        }
        if ((most >> bit & 1) != 0) {
            rest += num;
            if (rest >= den) {
                rest -= den;
                quotient++;
            }
        }
    }
    return (uint32_t)(quotient + (2 * rest > den || (2 * rest == den && quotient % 2 == 1)));
}

/* Multiplies two numbers, both divided by powers of 2 where the product needs more than 62 bits.
 * *shift grows by the number of bits lost. */
static uint64_t product(uint64_t a, uint64_t b, int *shift)
{
    const uint64_t most = (uint64_t)1 << 62;

    while (b != 0 && a > most / b) {
        if (a > b)
            a /= 2;
        else
            b /= 2;
        ++*shift;
    }
    return a * b;
}

ted4_time ted4_time_of_seconds(ted4_seconds s, uint32_t n_frames, uint32_t rate_num,
                               uint32_t rate_den)
{
    const uint32_t last = n_frames - 1, most = DENOMINATORS - 1;
    uint64_t a = s.num, b = s.den, c = rate_num, d = rate_den, common;
    int up = 0, down = 0;

    if (last == 0 || s.num == 0)
        return (ted4_time) { 0, 1 };
    common = divisor64(a, d);
    a /= common;
    d /= common;
    common = divisor64(c, b);
    c /= common;
    b /= common;
    uint64_t num = product(a, c, &up), den = product(product(b, d, &down), last, &down);

    for (; up > down; down++)
        den /= 2;
    for (; down > up; up++)
        num /= 2;
    if (num >= den)
        return (ted4_time) { 1, 1 };
    common = divisor64(den, num);
    num /= common;
    den /= common;
    return den < DENOMINATORS ? (ted4_time) { (uint32_t)num, (uint32_t)den }
                              : (ted4_time) { scaled(num, den, most), most };
}

/* Returns the greatest common divisor; a >= 1. */
static uint32_t divisor(uint32_t a, uint32_t b)
{
    while (b != 0) {
        const uint32_t rest = a % b;

        a = b;
        b = rest;
    }
    return a;
}

/* Returns rne(a / b), which fits in 32 bits. */
static uint32_t nearest(uint64_t a, uint32_t b)
{
    const uint64_t whole = a / b, twice = a % b * 2;

    return (uint32_t)(whole + (twice > b || (twice == b && whole % 2 == 1)));
}

ted4_time ted4_time_of_frame(uint32_t frame, uint32_t n_frames)
{
    const uint32_t last = n_frames > 1 ? n_frames - 1 : 1, most = DENOMINATORS - 1;
    const uint32_t common = last < DENOMINATORS ? 1 : divisor(last, frame);
    const ted4_time t = { frame / common, last / common };

    return t.den < DENOMINATORS ? t : (ted4_time) { nearest((uint64_t)t.num * most, t.den), most };
}
