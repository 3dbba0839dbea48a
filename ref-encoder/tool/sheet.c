/* sheet.c - see sheet.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "sheet.h"

#include <stdlib.h>
#include <string.h>

void ted4_sheet_error(const uint8_t *a, const uint8_t *b, size_t n, uint8_t *out)
{
    for (size_t i = 0; i < n; i++) {
        const int d = TED4_ERROR_GAIN * (a[i] > b[i] ? a[i] - b[i] : b[i] - a[i]);

        out[i] = (uint8_t)(d < 255 ? d : 255);
    }
}

int ted4_sheet_init(ted4_sheet *s, int width, int height, int rows)
{
    *s = (ted4_sheet){ width, height, rows, NULL };
    s->rgb = calloc((size_t)width * (size_t)height, 3 * TED4_SHEET_COLUMNS * (size_t)rows);
    return s->rgb == NULL ? -1 : 0;
}

void ted4_sheet_finish(ted4_sheet *s)
{
    free(s->rgb);
    s->rgb = NULL;
}

void ted4_sheet_put(ted4_sheet *s, int row, const uint8_t *truth, const uint8_t *ours)
{
    const size_t line = (size_t)s->width * 3;

    for (size_t y = 0; y < (size_t)s->height; y++) {
        uint8_t *const to =
            s->rgb + ((size_t)row * (size_t)s->height + y) * line * TED4_SHEET_COLUMNS;

        memcpy(to, truth + y * line, line);
        memcpy(to + line, ours + y * line, line);
        ted4_sheet_error(truth + y * line, ours + y * line, line, to + 2 * line);
    }
}
