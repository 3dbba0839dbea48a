/* corpus_write.c - see corpus.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "corpus.h"

#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

const char *corpus_folder;

void corpus_write(const char *group, const char *file, const void *data, size_t size)
{
    char path[4096];
    FILE *f;

    (void)snprintf(path, sizeof path, "%s/%s", corpus_folder, group);
    (void)mkdir(path, 0777);
    (void)snprintf(path, sizeof path, "%s/%s/%s", corpus_folder, group, file);
    f = fopen(path, "wb");
    if (f == NULL || fwrite(data, 1, size, f) != size || fclose(f) != 0) {
        perror(path);
        exit(3);
    }
}
