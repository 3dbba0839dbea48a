/* mutate_tool.c - changes one file once, without libFuzzer: mutate SEED FROM TO.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdio.h>
#include <stdlib.h>
#include "lcg.h"
#include "mutate.h"

enum { MAX_SIZE = 1 << 16 };

static uint32_t state = 1;

/* Changes a few bytes; the same seed gives the same changes. */
static size_t some_bytes(uint8_t *data, size_t size, size_t max_size)
{
    (void)max_size;
    for (int i = 0; size > 0 && i < 3; i++) {
        (void)lcg_next(&state);
        data[state % size] ^= (uint8_t)(1u << (state >> 16) % 8);
    }
    return size;
}

int main(int argc, char **argv)
{
    static uint8_t data[MAX_SIZE];
    FILE *f = argc == 4 ? fopen(argv[2], "rb") : NULL;
    size_t n;

    if (f == NULL) {
        fprintf(stderr, "mutate: usage: mutate SEED FROM TO\n");
        return 3;
    }
    n = fread(data, 1, MAX_SIZE / 2, f);
    fclose(f);
    state = (uint32_t)strtoul(argv[1], NULL, 10);
    n = fuzz_mutate_file(data, n, MAX_SIZE, state, some_bytes);
    f = fopen(argv[3], "wb");
    return f != NULL && fwrite(data, 1, n, f) == n && fclose(f) == 0 ? 0 : 3;
}
