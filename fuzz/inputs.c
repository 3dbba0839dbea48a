/* inputs.c - see inputs.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "inputs.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#define FUZZ(name, seeds, covers) fuzz_entry fuzz_##name;
#include "list.def"
#undef FUZZ

const fuzz_harness fuzz_list[] = {
#define FUZZ(name, seeds, covers) { #name, #seeds, fuzz_##name },
#include "list.def"
#undef FUZZ
    { NULL, NULL, NULL }
};

fuzz_entry *fuzz_find(const char *name)
{
    for (const fuzz_harness *h = fuzz_list; h->name != NULL; h++)
        if (strcmp(h->name, name) == 0)
            return h->run;
    return NULL;
}

static int replay_file(fuzz_entry *run, const char *path, size_t size)
{
    FILE *const f = fopen(path, "rb");
    uint8_t *const data = malloc(size > 0 ? size : 1);
    const int whole = f != NULL && data != NULL && fread(data, 1, size, f) == size;

    if (f != NULL)
        fclose(f);
    if (whole)
        (void)run(data, size);
    free(data);
    return whole ? 0 : -1;
}

static int no_dots(const struct dirent *e)
{
    return e->d_name[0] != '.';
}

static int replay_folder(fuzz_entry *run, const char *path, size_t *n)
{
    struct dirent **list;
    const int count = scandir(path, &list, no_dots, alphasort);
    int result = count < 0 ? -1 : 0;
    char name[4096];

    for (int i = 0; i < count; i++) {
        (void)snprintf(name, sizeof name, "%s/%s", path, list[i]->d_name);
        result |= fuzz_replay(run, name, n);
        free(list[i]);
    }
    if (count >= 0)
        free(list);
    return result;
}

int fuzz_replay(fuzz_entry *run, const char *path, size_t *n)
{
    struct stat s;

    if (stat(path, &s) != 0)
        return -1;
    if (S_ISDIR(s.st_mode))
        return replay_folder(run, path, n);
    ++*n;
    return replay_file(run, path, (size_t)s.st_size);
}
