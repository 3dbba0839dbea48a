/* picture_path.c - see picture_path.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "data/picture_path.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "data/data_util.h"

static const char *const extensions[] = { ".png", ".jpg", ".jpeg", ".PNG", ".JPG", ".JPEG" };

enum { N_EXTENSIONS = sizeof extensions / sizeof extensions[0], LONGEST = 5 };

/* Returns the length of the picture extension at the end of a name, or 0 if there is none. */
static size_t extension(const char *name)
{
    const size_t n = strlen(name);

    for (int i = 0; i < N_EXTENSIONS; i++) {
        const size_t k = strlen(extensions[i]);
        if (n > k && strcmp(name + n - k, extensions[i]) == 0)
            return k;
    }
    return 0;
}

int ted4_picture_is_named(const char *name)
{
    return extension(name) > 0;
}

/* Tries the first size bytes of base with each of the extensions. path must have room for the
 * result. Returns 1 if such a file exists, else 0. */
static int with_extension(char *path, const char *base, size_t size)
{
    for (int i = 0; i < N_EXTENSIONS; i++) {
        sprintf(path, "%.*s%s", (int)size, base, extensions[i]);
        if (ted4_is_file(path))
            return 1;
    }
    return 0;
}

/* Tries folder/name with the extensions of ted4_picture_find, and returns as it does. */
static int try_name(const char *folder, const char *name, char **found)
{
    char *base = ted4_path_join(folder, name);
    char *path = base == NULL ? NULL : malloc(strlen(base) + LONGEST + 1);
    int result = path == NULL ? -1 : 0;

    if (path != NULL) {
        const size_t n = strlen(base), k = extension(base);
        strcpy(path, base);
        result = ted4_is_file(path) || with_extension(path, base, n) ||
                 (k > 0 && with_extension(path, base, n - k));
    }
    free(base);
    if (result == 1)
        *found = path;
    else
        free(path);
    return result;
}

static int try_folders(const char *folder, const char *name, const char *part, char **path)
{
    const char *const places[] = { "images", part, "rgb", "frames" };
    int result = 0;

    for (size_t i = 0; i < sizeof places / sizeof places[0] && result == 0; i++) {
        char *place = places[i] == NULL ? NULL : ted4_path_join(folder, places[i]);
        if (places[i] == NULL)
            continue;
        result = place == NULL ? -1 : try_name(place, name, path);
        free(place);
    }
    return result;
}

int ted4_picture_find(const char *folder, const char *name, const char *part, char **path)
{
    int result = try_name(folder, name, path);
    char *copy = result == 0 ? ted4_text_copy(name) : NULL;

    if (result != 0 || copy == NULL)
        return result != 0 ? result : -1;
    for (char *s = copy; (s = strchr(s, '\\')) != NULL;)
        *s = '/';
    const char *const bare = strncmp(copy, "./", 2) == 0 ? copy + 2 : copy, *tail = copy;
    result = try_name(folder, tail, path);
    for (const char *slash; result == 0 && (slash = strchr(tail, '/')) != NULL;) {
        tail = slash + 1;
        if (*tail != 0 && *tail != '/')
            result = try_name(folder, tail, path);
    }
    if (result == 0 && tail == bare && *tail != 0)
        result = try_folders(folder, tail, part, path);
    free(copy);
    return result;
}

double ted4_picture_number(const char *name)
{
    const char *slash = strrchr(name, '/'), *base = slash == NULL ? name : slash + 1;
    const char *dot = strrchr(base, '.');
    const char *end = dot == NULL ? base + strlen(base) : dot, *begin;
    double v = 0;

    while (end > base && !isdigit((unsigned char)end[-1]))
        end--;
    for (begin = end; begin > base && isdigit((unsigned char)begin[-1]); begin--)
        ;
    if (begin == end)
        return -1;
    if (end - begin > 15) /* a double holds 15 digits */
        return -2;
    for (; begin < end; begin++)
        v = 10 * v + (*begin - '0');
    return v;
}
