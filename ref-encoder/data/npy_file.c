/* npy_file.c - see npy_file.h. A file consists of "\x93NUMPY", the version (2 bytes), the length of
 * the header (2 bytes, or 4 from version 2 on), the header, which is a Python dictionary as text,
 * and the numbers.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "data/npy_file.h"

#include <ctype.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "data/data_util.h"

typedef struct {
    char text[512];             /* the header */
    size_t rows, columns, item; /* item: size of a number in bytes */
    const uint8_t *data;        /* borrowed */
    size_t size;
} table;

static const char *after(const char *text, const char *key)
{
    const char *at = strstr(text, key);

    if (at == NULL)
        return "";
    for (at += strlen(key); isspace((unsigned char)*at) || *at == ':'; at++)
        ;
    return at;
}

/* Refuses numbers of another type, given as the header says it: in quotes, unless it is a list. */
static int wrong_type(const char *path, const char *type, ted4_message *m)
{
    const size_t n = *type == '\'' ? strcspn(type + 1, "'") + 2 : strcspn(type, ",}");

    return *type == 0 ? ted4_say(m, "%s: no type of numbers, expected '<f4' or '<f8'", path)
                      : ted4_say(m, "%s: numbers of type %.*s, expected '<f4' or '<f8'", path,
                                 (int)n, type);
}

static int read_header(table *t, const char *path, const uint8_t *p, size_t size, ted4_message *m)
{
    unsigned long rows = 0, columns = 0;

    if (size < 12 || memcmp(p, "\x93NUMPY", 6) != 0 || p[6] < 1 || p[6] > 3)
        return ted4_say(m, "%s: not a NumPy array file", path);
    const size_t start = p[6] == 1 ? 10 : 12;
    const size_t length = p[6] == 1 ? (size_t)p[8] | (size_t)p[9] << 8
                                    : (size_t)p[8] | (size_t)p[9] << 8 | (size_t)p[10] << 16 |
                                          (size_t)p[11] << 24;
    if (length > size - start)
        return ted4_say(m, "%s: NumPy header cut short", path);
    snprintf(t->text, sizeof t->text, "%.*s",
             (int)(length < sizeof t->text ? length : sizeof t->text - 1), (const char *)p + start);
    const char *type = after(t->text, "'descr'");
    t->item = strncmp(type, "'<f8'", 5) == 0 ? 8 : strncmp(type, "'<f4'", 5) == 0 ? 4 : 0;
    if (t->item == 0)
        return wrong_type(path, type, m);
    if (strncmp(after(t->text, "'fortran_order'"), "False", 5) != 0)
        return ted4_say(m, "%s: Fortran order, expected C order", path);
    char end = 0, last = 0;
    const char *shape = after(t->text, "'shape'");
    const int found = sscanf(shape, "(%9lu , %9lu %c %c", &rows, &columns, &end, &last);
    if (found < 3 || (end != ')' && !(end == ',' && last == ')')))
        return ted4_say(m, "%s: shape %.*s), expected two dimensions", path,
                        (int)strcspn(shape, ")}\n"), shape);
    t->rows = rows;
    t->columns = columns;
    t->data = p + start + length;
    t->size = size - start - length;
    return 0;
}

/* Returns number i of the table, whatever the byte order of this machine. */
static double number(const table *t, size_t i)
{
    uint64_t bits = 0;
    double v;
    float narrow;

    for (size_t k = t->item; k-- > 0;)
        bits = bits << 8 | t->data[t->item * i + k];
    if (t->item == sizeof v) {
        memcpy(&v, &bits, sizeof v);
        return v;
    }
    const uint32_t low = (uint32_t)bits;
    memcpy(&narrow, &low, sizeof narrow);
    return narrow;
}

static int read_table(table *t, const char *path, size_t columns, double **v, ted4_message *m)
{
    const size_t n = t->rows * columns;

    if (t->columns != columns || t->rows == 0 || t->rows > SIZE_MAX / sizeof **v / columns)
        return ted4_say(m, "%s: shape (%zu, %zu), expected rows of %zu numbers", path, t->rows,
                        t->columns, columns);
    if (t->size != n * t->item)
        return ted4_say(m, "%s: %zu bytes of numbers, its shape (%zu, %zu) needs %zu", path,
                        t->size, t->rows, t->columns, n * t->item);
    *v = malloc(n * sizeof **v);
    if (*v == NULL)
        return ted4_say_no_memory(m);
    for (size_t i = 0; i < n; i++) {
        (*v)[i] = number(t, i);
        if (!isfinite((*v)[i])) {
            free(*v);
            *v = NULL;
            return ted4_say(m, "%s: row %zu, column %zu is not finite", path, i / columns,
                            i % columns);
        }
    }
    return 0;
}

int ted4_npy_read(const char *path, size_t columns, double **v, size_t *rows, ted4_message *m)
{
    table t;
    uint8_t *bytes;
    size_t size;

    *v = NULL;
    *rows = 0;
    if (ted4_read_whole(path, &bytes, &size, m) != 0)
        return -1;
    int result = read_header(&t, path, bytes, size, m);
    if (result == 0)
        result = read_table(&t, path, columns, v, m);
    if (result == 0)
        *rows = t.rows;
    free(bytes);
    return result;
}
