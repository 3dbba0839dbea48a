/* mutator.c - libFuzzer's entry points to mutate.h, for the harnesses whose input is a .ted4 file.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "libfuzzer.h"
#include "mutate.h"

size_t LLVMFuzzerCustomCrossOver(const uint8_t *a, size_t a_size, const uint8_t *b, size_t b_size,
                                 uint8_t *to, size_t max_size, unsigned seed);

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max_size, unsigned seed)
{
    return fuzz_mutate_file(data, size, max_size, seed, fuzz_libfuzzer_bytes);
}

size_t LLVMFuzzerCustomCrossOver(const uint8_t *a, size_t a_size, const uint8_t *b, size_t b_size,
                                 uint8_t *to, size_t max_size, unsigned seed)
{
    return fuzz_cross_files(a, a_size, b, b_size, to, max_size, seed);
}
