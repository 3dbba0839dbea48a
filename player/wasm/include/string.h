/* string.h - what the decoder takes of ISO C 7.24, for wasm32 without an operating system (libc.c).
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_WASM_STRING_H
#define TED4_WASM_STRING_H

#include <stddef.h>

void *memcpy(void *restrict to, const void *restrict from, size_t n);
void *memmove(void *to, const void *from, size_t n);
void *memset(void *to, int byte, size_t n);
int memcmp(const void *a, const void *b, size_t n);
size_t strlen(const char *text);
int strcmp(const char *a, const char *b);
int strncmp(const char *a, const char *b, size_t n);

#endif
