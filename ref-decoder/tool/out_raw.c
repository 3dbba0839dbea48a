/* out_raw.c - the records of spec 11.6 unchanged: 14 little-endian binary32 each, in file order. If
 * all Gaussians are kept, these are the bytes that the hash of a query covers (spec 15.3).
 * SPDX-License-Identifier: BSD-2-Clause */
#include "export.h"

#include "record.h"

static int write_raw(FILE *f, const ted4_frame *x)
{
    const float *const column[TED4_RECORD_FLOATS] = TED4_RECORD_COLUMNS(x);

    for (size_t i = 0; i < x->n; i++) {
        uint8_t bytes[4 * TED4_RECORD_FLOATS];

        ted4_record_store(bytes, column, i);
        if (fwrite(bytes, sizeof bytes, 1, f) != 1)
            return -1;
    }
    return 0;
}

const ted4_format ted4_format_raw = {
    ".raw",
    "14 little-endian binary32 per Gaussian: position, scale, rotation w x y z, opacity, r g b", -1,
    write_raw
};
