/* text.h - what the suite's tool does all the time: bytes that grow, files, folders, giving up with
 * a reason. A tool that runs out of memory or cannot write says so and ends; nothing here returns
 * such a failure.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_TEXT_H
#define CONF_TEXT_H

#include <stddef.h>
#include <stdint.h>

enum { CONF_PATH = 1024 };

/* Says why on stderr and ends the program with exit code 3. */
_Noreturn void conf_die(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* Zeroed memory, never NULL; to be freed with free(). */
void *conf_alloc(size_t n, size_t size);
char *conf_copy(const char *text);

/* All zero is an empty one. data is owned and followed by a 0 that size does not count. */
typedef struct {
    uint8_t *data;
    size_t size, capacity;
} conf_bytes;

void conf_add(conf_bytes *b, const void *data, size_t size);
void conf_print(conf_bytes *b, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* Makes room for size bytes at an offset, or takes size bytes away from there. */
void conf_insert(conf_bytes *b, size_t at, const void *data, size_t size);
void conf_remove(conf_bytes *b, size_t at, size_t size);
void conf_free(conf_bytes *b);

/* 1, or 0: no such file. */
int conf_read(const char *path, conf_bytes *b);
/* Makes the folders on the way. */
void conf_write(const char *path, const void *data, size_t size);
void conf_make_folder(const char *path);
/* Names in a folder that end in suffix, sorted as bytes; an owned array of owned names. */
char **conf_list(const char *folder, const char *suffix, size_t *n);
void conf_list_free(char **name, size_t n);

/* A path in to, which has room for CONF_PATH; ends the program when it is longer. */
void conf_path(char *to, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Lower-case hexadecimal of n bytes; to has room for 2 n + 1. */
void conf_hex(char *to, const uint8_t *bytes, size_t n);
/* SHA-256 in hexadecimal; a manifest names a descriptor by the first CONF_SHORT_HASH digits. */
enum { CONF_HASH = 64, CONF_SHORT_HASH = 16 };
void conf_hash(char to[CONF_HASH + 1], const void *data, size_t size);
/* XXH3-64 of a text: seeds of recipes. */
uint64_t conf_seed(const char *text);

#endif
