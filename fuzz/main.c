/* main.c - replays files through a fuzzing harness, without libFuzzer: fz_x FILE... Used by `make fuzz-replay`.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "harness.h"

enum { MAX_INPUT = 1 << 20 };

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int main(int argc, char **argv)
{
    static uint8_t buffer[MAX_INPUT];

    for (int i = 1; i < argc; i++) {
        FILE        *f = fopen(argv[i], "rb");
        const size_t n = f != NULL ? fread(buffer, 1, sizeof buffer, f) : 0;
        uint8_t     *data = malloc(n > 0 ? n : 1);      /* of its own size, so that reading past it is seen */

        if (f == NULL || data == NULL) {
            perror(argv[i]);
            return 3;
        }
        fclose(f);
        for (size_t j = 0; j < n; j++)
            data[j] = buffer[j];
        LLVMFuzzerTestOneInput(data, n);
        free(data);
    }
    printf("%d files\n", argc - 1);
    return 0;
}
