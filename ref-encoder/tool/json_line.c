/* json_line.c - see json_line.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "json_line.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

void ted4_json_line_begin(ted4_json_line *l)
{
    memset(l, 0, sizeof *l);
    l->file = open_memstream(&l->text, &l->size);
    if (l->file != NULL)
        fputc('{', l->file);
    l->first = 1;
}

int ted4_json_line_end(ted4_json_line *l)
{
    if (l->file == NULL)
        return -1;
    fputs("}\n", l->file);

    const int bad = ferror(l->file);

    return fclose(l->file) != 0 || bad ? -1 : 0;
}

void ted4_json_line_free(ted4_json_line *l)
{
    free(l->text);
}

void ted4_json_line_put(ted4_json_line *l, const char *name, const char *format, ...)
{
    va_list arguments;

    if (l->file == NULL)
        return;
    if (!l->first)
        fputc(',', l->file);
    l->first = 0;
    if (name != NULL)
        fprintf(l->file, "\"%s\":", name);
    va_start(arguments, format);
    vfprintf(l->file, format, arguments);
    va_end(arguments);
}

void ted4_json_line_fixed(ted4_json_line *l, const char *name, int decimals, double x)
{
    if (isfinite(x))
        ted4_json_line_put(l, name, "%.*f", decimals, x);
    else
        ted4_json_line_put(l, name, "null");
}

void ted4_json_line_digits(ted4_json_line *l, const char *name, int digits, double x)
{
    if (isfinite(x))
        ted4_json_line_put(l, name, "%.*g", digits, x);
    else
        ted4_json_line_put(l, name, "null");
}

void ted4_json_line_open(ted4_json_line *l, const char *name, const char *bracket)
{
    ted4_json_line_put(l, name, "%s", bracket);
    l->first = 1;
}

void ted4_json_line_close(ted4_json_line *l, const char *bracket)
{
    if (l->file != NULL)
        fputs(bracket, l->file);
    l->first = 0;
}
