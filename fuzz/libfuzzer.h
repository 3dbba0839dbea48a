/* libfuzzer.h - libFuzzer's own mutations, in the form that mutate.h takes.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_FUZZ_LIBFUZZER_H
#define TED4_FUZZ_LIBFUZZER_H

#include <stddef.h>
#include <stdint.h>
#if defined(__has_feature)
#if __has_feature(memory_sanitizer)
#define FUZZ_MSAN 1
#include <sanitizer/msan_interface.h>
#endif
#endif

size_t LLVMFuzzerMutate(uint8_t *data, size_t size, size_t max_size);
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max_size, unsigned seed);

/* MSan does not see what libFuzzer writes, so the bytes are marked as initialised. */
static inline size_t fuzz_libfuzzer_bytes(uint8_t *data, size_t size, size_t max_size)
{
    const size_t n = LLVMFuzzerMutate(data, size, max_size);

#ifdef FUZZ_MSAN
    __msan_unpoison(data, n);
#endif
    return n;
}

#endif
