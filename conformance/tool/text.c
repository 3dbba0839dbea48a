/* text.c - see text.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "text.h"

#include <dirent.h>
#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>
#include "base/bytes.h"
#include "tool/sha256.h"

_Noreturn void conf_die(const char *format, ...)
{
    va_list a;

    va_start(a, format);
    fputs("ted4conf: ", stderr);
    vfprintf(stderr, format, a);
    fputc('\n', stderr);
    va_end(a);
    exit(3);
}

void *conf_alloc(size_t n, size_t size)
{
    void *p = calloc(n > 0 ? n : 1, size > 0 ? size : 1);

    if (p == NULL)
        conf_die("no memory");
    return p;
}

char *conf_copy(const char *text)
{
    const size_t n = strlen(text) + 1;

    return memcpy(conf_alloc(n, 1), text, n);
}

static void reserve(conf_bytes *b, size_t size)
{
    if (b->size + size + 1 > b->capacity) {
        b->capacity = 2 * (b->size + size) + 64;
        b->data = realloc(b->data, b->capacity);
        if (b->data == NULL)
            conf_die("no memory");
    }
}

void conf_add(conf_bytes *b, const void *data, size_t size)
{
    reserve(b, size);
    if (size > 0)
        memcpy(b->data + b->size, data, size);
    b->size += size;
    b->data[b->size] = 0;
}

void conf_print(conf_bytes *b, const char *format, ...)
{
    va_list a;
    int n;

    va_start(a, format);
    n = vsnprintf(NULL, 0, format, a);
    va_end(a);
    reserve(b, (size_t)n);
    va_start(a, format);
    (void)vsnprintf((char *)b->data + b->size, (size_t)n + 1, format, a);
    va_end(a);
    b->size += (size_t)n;
}

void conf_insert(conf_bytes *b, size_t at, const void *data, size_t size)
{
    if (at > b->size)
        conf_die("place %zu lies outside of %zu bytes", at, b->size);
    reserve(b, size);
    memmove(b->data + at + size, b->data + at, b->size - at + 1);
    if (size > 0)
        memcpy(b->data + at, data, size);
    b->size += size;
}

void conf_remove(conf_bytes *b, size_t at, size_t size)
{
    if (at > b->size || size > b->size - at)
        conf_die("%zu bytes from %zu lie outside of %zu bytes", size, at, b->size);
    memmove(b->data + at, b->data + at + size, b->size - at - size + 1);
    b->size -= size;
}

void conf_free(conf_bytes *b)
{
    free(b->data);
    *b = (conf_bytes) { NULL, 0, 0 };
}

int conf_read(const char *path, conf_bytes *b)
{
    FILE *f = fopen(path, "rb");
    uint8_t piece[1 << 14];
    size_t n;

    *b = (conf_bytes) { NULL, 0, 0 };
    if (f == NULL)
        return 0;
    conf_add(b, "", 0);
    while ((n = fread(piece, 1, sizeof piece, f)) > 0)
        conf_add(b, piece, n);
    if (ferror(f))
        conf_die("%s: %s", path, strerror(errno));
    fclose(f);
    return 1;
}

void conf_make_folder(const char *path)
{
    char part[CONF_PATH];

    conf_path(part, "%s", path);
    for (char *p = part + 1; part[0] != '\0'; p++)
        if (*p == '/' || *p == '\0') {
            const char end = *p;

            *p = '\0';
            if (mkdir(part, 0777) != 0 && errno != EEXIST)
                conf_die("%s: %s", part, strerror(errno));
            if (end == '\0')
                return;
            *p = end;
        }
}

/* Makes the folder of a file, and opens the file. */
static FILE *open_made(const char *path, const char *mode)
{
    char folder[CONF_PATH];
    const char *slash = strrchr(path, '/');

    if (slash != NULL) {
        conf_path(folder, "%.*s", (int)(slash - path), path);
        conf_make_folder(folder);
    }
    return fopen(path, mode);
}

void conf_write(const char *path, const void *data, size_t size)
{
    FILE *f = open_made(path, "wb");

    if (f == NULL || fwrite(data, 1, size, f) != size || fclose(f) != 0)
        conf_die("%s: %s", path, strerror(errno));
}

void conf_write_try(const char *path)
{
    const int is_new = access(path, F_OK) != 0;
    FILE *f = open_made(path, "ab");

    if (f == NULL || fclose(f) != 0)
        conf_die("%s: %s", path, strerror(errno));
    if (is_new)
        unlink(path);
}

static int by_bytes(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

char **conf_list(const char *folder, const char *suffix, size_t *n)
{
    DIR *d = opendir(folder);
    char **name = NULL;
    struct dirent *e;
    size_t count = 0;

    *n = 0;
    if (d == NULL)
        return NULL;
    while ((e = readdir(d)) != NULL) {
        const size_t length = strlen(e->d_name), end = strlen(suffix);

        if (e->d_name[0] == '.' || length < end || strcmp(e->d_name + length - end, suffix) != 0)
            continue;
        name = realloc(name, (count + 1) * sizeof *name);
        if (name == NULL)
            conf_die("no memory");
        name[count++] = conf_copy(e->d_name);
    }
    closedir(d);
    if (count > 0)
        qsort(name, count, sizeof *name, by_bytes);
    *n = count;
    return name;
}

void conf_list_free(char **name, size_t n)
{
    for (size_t i = 0; i < n; i++)
        free(name[i]);
    free(name);
}

void conf_path(char *to, const char *format, ...)
{
    va_list a;
    int n;

    va_start(a, format);
    n = vsnprintf(to, CONF_PATH, format, a);
    va_end(a);
    if (n < 0 || n >= CONF_PATH)
        conf_die("path too long: %.80s...", to);
}

void conf_hex(char *to, const uint8_t *bytes, size_t n)
{
    ted4_hex(to, bytes, n);
}

void conf_hash(char to[CONF_HASH + 1], const void *data, size_t size)
{
    uint8_t sha[TED4_SHA256_SIZE];
    ted4_sha256 h;

    ted4_sha256_init(&h);
    ted4_sha256_add(&h, data, size);
    ted4_sha256_end(&h, sha);
    conf_hex(to, sha, sizeof sha);
}

uint64_t conf_seed(const char *text)
{
    return XXH3_64bits(text, strlen(text));
}
