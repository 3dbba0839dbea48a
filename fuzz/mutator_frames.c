/* mutator_frames.c - libFuzzer's entry point to mutate.h for the harness that reads frames only.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "libfuzzer.h"
#include "mutate.h"

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max_size, unsigned seed)
{
    return fuzz_mutate_frames(data, size, max_size, seed, fuzz_libfuzzer_bytes);
}
