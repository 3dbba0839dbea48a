/* text.h - helpers of the suite's tool: growing byte arrays, files, folders, and ending with a
 * message. A tool that runs out of memory or cannot write prints a message and ends; no function
 * here returns such a failure.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_TEXT_H
#define CONF_TEXT_H

#include <stddef.h>
#include <stdint.h>

enum { CONF_PATH = 1024 };

/* Prints a message to stderr and ends the program with exit code 3. */
_Noreturn void conf_die(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* Returns zeroed memory, never NULL, for the caller to free with free(). */
void *conf_alloc(size_t n, size_t size);
char *conf_copy(const char *text);

/* A byte array; all zero is an empty one. data is owned and followed by a 0 that size does not
 * count. */
typedef struct {
    uint8_t *data;
    size_t size, capacity;
} conf_bytes;

void conf_add(conf_bytes *b, const void *data, size_t size);
void conf_print(conf_bytes *b, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* Insert size bytes at an offset, or remove size bytes there. */
void conf_insert(conf_bytes *b, size_t at, const void *data, size_t size);
void conf_remove(conf_bytes *b, size_t at, size_t size);
void conf_free(conf_bytes *b);

/* Returns 1, or 0 if the file does not exist. */
int conf_read(const char *path, conf_bytes *b);
/* Creates missing folders of the path. */
void conf_write(const char *path, const void *data, size_t size);
/* Ends the program if conf_write could not write the file. Leaves an existing file as it is. */
void conf_write_try(const char *path);
void conf_make_folder(const char *path); /* "": that of a file in the root, which is there */
/* Returns the names in a folder that end in suffix, sorted as bytes: an owned array of owned names.
 */
char **conf_list(const char *folder, const char *suffix, size_t *n);
void conf_list_free(char **name, size_t n);

/* Prints a path to to, which has room for CONF_PATH. Ends the program if the path is longer. */
void conf_path(char *to, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Writes n bytes as lower-case hexadecimal; to has room for 2 n + 1. */
void conf_hex(char *to, const uint8_t *bytes, size_t n);
/* Writes the SHA-256 in hexadecimal. A manifest identifies a descriptor by the first
 * CONF_SHORT_HASH digits. */
enum { CONF_HASH = 64, CONF_SHORT_HASH = 16 };
void conf_hash(char to[CONF_HASH + 1], const void *data, size_t size);
/* Returns the XXH3-64 of a text, used as the seed of a recipe. */
uint64_t conf_seed(const char *text);

#endif
