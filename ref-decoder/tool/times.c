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
