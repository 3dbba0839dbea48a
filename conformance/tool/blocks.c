/* blocks.c - see blocks.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "blocks.h"

#include <stdlib.h>
#include <string.h>
#include "pack.h"

typedef struct {
    conf_bytes *out;
    unsigned byte, n; /* the bits of the byte under way */
} bit_string;

static void put_bit(bit_string *s, unsigned bit)
{
    s->byte |= bit << s->n++;
    if (s->n == 8) {
        const uint8_t byte = (uint8_t)s->byte;

        conf_add(s->out, &byte, 1);
        s->byte = s->n = 0;
    }
}

static void fill(bit_string *s, unsigned bit)
{
    while (s->n != 0)
        put_bit(s, bit);
}

static void put_number(bit_string *s, unsigned long value, unsigned long n)
{
    for (unsigned long i = 0; i < n; i++)
        put_bit(s, (unsigned)(value >> i & 1));
}

/* Returns 0 if the first size characters of text are no word. */
static int put_word(bit_string *s, const char *text, size_t size)
{
    if (text[0] == ':') {
        for (size_t i = 1; i < size; i++)
            if (text[i] == '0' || text[i] == '1')
                put_bit(s, text[i] == '1');
            else
                return 0;
        return size > 1;
    }
    if (size == 5 && strncmp(text, "empty", 5) == 0) {
        put_number(s, 0, 3);
        fill(s, 0);
        put_number(s, 0xffff0000, 32);
        return 1;
    }
    if ((size == 5 && strncmp(text, "zeros", 5) == 0) ||
        (size == 4 && strncmp(text, "ones", 4) == 0)) {
        fill(s, text[0] == 'o');
        return 1;
    }

    char *end;
    const unsigned long value = strtoul(text, &end, 10);

    if (end == text || *end != '/')
        return 0;
    put_number(s, value, strtoul(end + 1, &end, 10));
    return end == text + size;
}

void conf_blocks(conf_bytes *out, const conf_line *l, int i, const uint8_t *data, size_t size)
{
    bit_string s = { out, 0, 0 };
    uint8_t check[4];

    conf_add(out, "\x78\x01", 2);
    for (; i < l->n; i++) {
        const size_t n = strcspn(l->word[i], "*");
        const unsigned long times = l->word[i][n] == '*' ? strtoul(l->word[i] + n + 1, NULL, 10)
                                                         : 1;

        for (unsigned long k = 0; k < times; k++)
            if (!put_word(&s, l->word[i], n))
                conf_line_bad(l, "no bits");
    }
    fill(&s, 0);
    conf_adler(check, data, size);
    conf_add(out, check, sizeof check);
}
