/* suite.c - see suite.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "suite.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Lists may be nested up to this depth; a greater depth means a cycle. */
enum { CONF_LISTS = 8 };

typedef struct {
    conf_entry *entry;
    size_t n;
} list;

static conf_entry *add(list *l)
{
    l->entry = realloc(l->entry, (l->n + 1) * sizeof *l->entry);
    if (l->entry == NULL)
        conf_die("no memory");
    memset(&l->entry[l->n], 0, sizeof *l->entry);
    return &l->entry[l->n++];
}

static void load(list *l, const char *folder, const char *name)
{
    conf_entry *e = add(l);
    conf_bytes text;
    json_error_t why;
    char hash[CONF_HASH + 1];

    snprintf(e->id, sizeof e->id, "%.*s", (int)(strlen(name) - 5), name);
    conf_path(e->path, "%s/%s", folder, name);
    conf_path(e->file, "%s/%s.ted4", folder, e->id);
    if (!conf_read(e->path, &text))
        conf_die("%s: cannot be read", e->path);
    e->descriptor = json_loadb((const char *)text.data, text.size, 0, &why);
    if (e->descriptor == NULL)
        conf_die("%s:%d: %s", e->path, why.line, why.text);
    conf_hash(hash, text.data, text.size);
    memcpy(e->hash, hash, CONF_SHORT_HASH);
    conf_free(&text);
}

static void walk(list *l, const char *folder)
{
    size_t n;
    char **name = conf_list(folder, "", &n);

    for (size_t i = 0; i < n; i++) {
        const size_t length = strlen(name[i]);
        char path[CONF_PATH];

        if (length > 5 && strcmp(name[i] + length - 5, ".json") == 0) {
            if (strcmp(name[i], "SUITE.json") != 0)
                load(l, folder, name[i]);
        } else if (strchr(name[i], '.') == NULL) {
            conf_path(path, "%s/%s", folder, name[i]);
            walk(l, path);
        }
    }
    conf_list_free(name, n);
}

static int by_id(const void *a, const void *b)
{
    return strcmp(((const conf_entry *)a)->id, ((const conf_entry *)b)->id);
}

static void take(list *chosen, const list *l, const char *id)
{
    conf_entry *e = add(chosen);

    snprintf(e->id, sizeof e->id, "%s", id);
    for (size_t i = 0; i < l->n; i++)
        if (strcmp(l->entry[i].id, id) == 0) {
            *e = l->entry[i];
            json_incref(e->descriptor);
        }
}

/* Adds the entries that the list names, in its order. depth: how deep the list is nested. */
static void take_all(list *chosen, const list *l, const char *path, int depth)
{
    const char *const slash = strrchr(path, '/');
    conf_bytes text;
    char *rest;

    if (depth == CONF_LISTS || !conf_read(path, &text))
        conf_die("%s: cannot be read", path);
    for (char *id = strtok_r((char *)text.data, " \t\r\n", &rest); id != NULL;
         id = strtok_r(NULL, " \t\r\n", &rest)) {
        char other[CONF_PATH];

        if (id[0] == '@') {
            conf_path(other, "%.*s%s", slash != NULL ? (int)(slash - path + 1) : 0, path, id + 1);
            take_all(chosen, l, other, depth + 1);
        } else {
            take(chosen, l, id);
        }
    }
    conf_free(&text);
}

/* Keeps only the entries that the list names. */
static void choose(list *l, const char *path)
{
    list chosen = { NULL, 0 };

    take_all(&chosen, l, path, 0);
    conf_suite_free(l->entry, l->n);
    *l = chosen;
}

conf_entry *conf_suite_load(const char *folder, const char *path, size_t *n)
{
    list l = { NULL, 0 };

    walk(&l, folder);
    if (l.n > 0)
        qsort(l.entry, l.n, sizeof *l.entry, by_id);
    if (path != NULL)
        choose(&l, path);
    *n = l.n;
    return l.entry;
}

void conf_suite_free(conf_entry *e, size_t n)
{
    for (size_t i = 0; i < n; i++)
        json_decref(e[i].descriptor);
    free(e);
}
