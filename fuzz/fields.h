/* fields.h - the fixed-width fields of a file and their offsets, as the decoder's trace reports
 * them.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_FUZZ_FIELDS_H
#define TED4_FUZZ_FIELDS_H

#include <stddef.h>
#include <stdint.h>

typedef struct {
    size_t at;
    unsigned width; /* bytes: 1, 2, 4 or 8 */
} fuzz_field;

/* Finds the fields that the decoder meets before it stops, at most most. Returns their number. */
size_t fuzz_fields(const uint8_t *data, size_t size, fuzz_field *fields, size_t most);

#endif
