/* json_field.c - see json_field.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "data/json_field.h"

#include <math.h>
#include <stdlib.h>
#include "data/data_util.h"
#include "data/frame_rate.h"

json_t *ted4_json_read(const char *path, ted4_message *m)
{
    json_error_t e;
    uint8_t *text;
    size_t size;

    if (ted4_read_whole(path, &text, &size, m) != 0)
        return NULL;
    const size_t mark = ted4_mark_size(text, size);
    json_t *root = json_loadb((const char *)text + mark, size - mark, JSON_REJECT_DUPLICATES, &e);
    free(text);
    if (root == NULL)
        ted4_say(m, "%s:%d: not valid JSON: %s", path, e.line, e.text);
    return root;
}

int ted4_json_number(const json_t *object, const char *where, const char *name, double *v,
                     ted4_message *m)
{
    const json_t *field = json_object_get(object, name);

    if (field == NULL)
        return 0;
    if (!json_is_number(field) || !isfinite(json_number_value(field)))
        return ted4_say(m, "%s.%s: expected a number", where, name);
    *v = json_number_value(field);
    return 1;
}

int ted4_json_time(const json_t *object, const char *where, const char *name, double *v,
                   ted4_message *m)
{
    static const double most = 1e300;
    const int found = ted4_json_number(object, where, name, v, m);

    if (found <= 0 || fabs(*v) <= most)
        return found;
    return ted4_say(m, "%s.%s: %g, expected at most %g on either side of 0", where, name, *v, most);
}

int ted4_json_text(const json_t *object, const char *where, const char *name, const char **v,
                   ted4_message *m)
{
    const json_t *field = json_object_get(object, name);

    if (field == NULL)
        return 0;
    if (!json_is_string(field))
        return ted4_say(m, "%s.%s: expected a string", where, name);
    *v = json_string_value(field);
    return 1;
}

/* Appends the numbers of a list to v[high]. Returns 0, or -1 if the list holds anything else or too
 * many numbers. */
static int gather(const json_t *list, double *v, size_t *n, size_t high)
{
    for (size_t i = 0; i < json_array_size(list); i++) {
        const json_t *item = json_array_get(list, i);
        const int nested = json_is_array(item);
        if (nested && gather(item, v, n, high) != 0)
            return -1;
        if (nested)
            continue;
        if (!json_is_number(item) || !isfinite(json_number_value(item)) || *n >= high)
            return -1;
        v[(*n)++] = json_number_value(item);
    }
    return 0;
}

int ted4_json_numbers(const json_t *object, const char *where, const char *name, double *v,
                      size_t low, size_t high, ted4_message *m)
{
    const json_t *field = json_object_get(object, name);
    size_t n = 0;

    if (field == NULL)
        return 0;
    if (!json_is_array(field) || gather(field, v, &n, high) != 0 || n < low)
        return low == high
                   ? ted4_say(m, "%s.%s: expected %zu numbers", where, name, low)
                   : ted4_say(m, "%s.%s: expected %zu to %zu numbers", where, name, low, high);
    return (int)n;
}

/* Reads row i of the matrix into v[4]. Returns 0, or -1 if it is not four finite numbers. */
static int read_row(const json_t *matrix, size_t i, double v[4])
{
    const json_t *row = json_array_get(matrix, i);

    if (json_array_size(row) != 4)
        return -1;
    for (size_t j = 0; j < 4; j++) {
        const json_t *number = json_array_get(row, j);
        v[j] = json_number_value(number);
        if (!json_is_number(number) || !isfinite(v[j]))
            return -1;
    }
    return 0;
}

int ted4_json_affine(const json_t *object, const char *where, const char *name, double v[12],
                     ted4_message *m)
{
    const json_t *matrix = json_object_get(object, name);
    const size_t rows = json_array_size(matrix);
    double last[4] = { 0, 0, 0, 1 };

    if (matrix == NULL)
        return 0;
    int bad = rows != 3 && rows != 4;
    for (size_t i = 0; i < 3 && !bad; i++)
        bad = read_row(matrix, i, v + 4 * i) != 0;
    if (bad || (rows == 4 && read_row(matrix, 3, last) != 0))
        return ted4_say(m, "%s.%s: expected 4x4 numbers", where, name);
    if (fabs(last[0]) + fabs(last[1]) + fabs(last[2]) + fabs(last[3] - 1) > 1e-6)
        return ted4_say(m, "%s.%s: last row %g %g %g %g, expected 0 0 0 1", where, name, last[0],
                        last[1], last[2], last[3]);
    return 1;
}

int ted4_json_rate(const json_t *object, const char *where, double *rate, ted4_message *m)
{
    uint32_t num, den;
    const int found = ted4_json_number(object, where, "fps", rate, m);

    if (found <= 0 || *rate == 0 || ted4_frame_rate(*rate, &num, &den) == 0)
        return found;
    return ted4_say(
        m, "%s.fps: %g, expected frames per second from 1/%d to %d, or 0 where they are not known",
        where, *rate, TED4_RATE_MOST, TED4_RATE_MOST);
}
