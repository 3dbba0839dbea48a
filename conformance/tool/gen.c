/* gen.c - see gen.h. A vector is a file with its descriptor next to it. For a vector made on demand
 * only the descriptor is stored. Large vectors are made only on request.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "gen.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "build.h"
#include "suite.h"
#include "vector.h"

enum { CONF_LEVELS = 4 }; /* number of levels with bounds, numbered from 1 */

typedef struct {
    const conf_gen_options *o;
    char output[CONF_PATH];
    json_t *manifest;               /* array of entries */
    json_t *least[CONF_LEVELS + 1]; /* arrays of entries: the vectors for decoders of that level,
                                       without those of lower levels */
    json_t *counts;                 /* numbers of vectors by category, then by result */
    size_t bytes, n_bad, n_made;
} generator;

/* Writes a file, or with verify reports that the existing file differs. */
static void put(generator *g, const char *path, const void *data, size_t size)
{
    conf_bytes there;

    g->bytes += size;
    if (!g->o->verify) {
        conf_write(path, data, size);
        return;
    }
    if (!conf_read(path, &there)) {
        fprintf(stderr, "ted4conf: %s is missing\n", path);
        g->n_bad++;
        return;
    }
    if (there.size != size || memcmp(there.data, data, size) != 0) {
        fprintf(stderr, "ted4conf: %s differs from what its recipe gives\n", path);
        g->n_bad++;
    }
    conf_free(&there);
}

/* Prints one member per line with its value on that line, but an array of objects with one entry
 * per line. */
static void print_member(conf_bytes *b, const char *key, const json_t *value, int last)
{
    const int lines = json_is_array(value) && json_is_object(json_array_get(value, 0)) &&
                      json_array_size(value) > 8;

    conf_print(b, "\"%s\":", key);
    if (lines) {
        for (size_t i = 0; i < json_array_size(value); i++) {
            char *const text = json_dumps(json_array_get(value, i), JSON_COMPACT);

            conf_print(b, "%s\n%s", i == 0 ? "[" : ",", text);
            free(text);
        }
        conf_print(b, "]");
    } else {
        char *const text = json_dumps(value, JSON_COMPACT | JSON_ENCODE_ANY);

        conf_print(b, "%s", text);
        free(text);
    }
    conf_print(b, last ? "\n" : ",\n");
}

/* hash: set to the hash of the written text, in the form of a manifest; may be NULL. */
static void put_json(generator *g, const char *path, json_t *o, char *hash)
{
    conf_bytes b = { NULL, 0, 0 };
    char whole[CONF_HASH + 1];
    const char *key;
    json_t *value;
    size_t left = json_object_size(o);

    conf_print(&b, "{\n");
    json_object_foreach(o, key, value) print_member(&b, key, value, --left == 0);
    conf_print(&b, "}\n");
    put(g, path, b.data, b.size);
    conf_hash(whole, b.data, b.size);
    if (hash != NULL)
        snprintf(hash, CONF_SHORT_HASH + 1, "%.*s", CONF_SHORT_HASH, whole);
    conf_free(&b);
}

static void count(generator *g, const char *group, const char *what)
{
    json_t *o = json_object_get(g->counts, group);

    if (o == NULL) {
        o = json_object();
        json_object_set_new(g->counts, group, o);
    }
    json_object_set_new(o, what, json_integer(json_integer_value(json_object_get(o, what)) + 1));
}

/* Writes the descriptor next to its file and adds an entry to the manifest. */
static void note(generator *g, json_t *d)
{
    const char *const result =
        json_string_value(json_object_get(json_object_get(d, "expect"), "result"));
    const char *const folder = json_string_value(json_object_get(d, "category"));
    const json_int_t level =
        strcmp(result, "valid") == 0 ? json_integer_value(json_object_get(d, "level")) : 1;
    json_t *e = json_object();
    char path[CONF_PATH], hash[CONF_SHORT_HASH + 1];

    conf_path(path, "%s/%s/%s.json", g->output, folder,
              json_string_value(json_object_get(d, "id")));
    put_json(g, path, d, hash);
    json_object_set(e, "id", json_object_get(d, "id"));
    json_object_set_new(e, "folder", json_string(folder));
    json_object_set(e, "bytes", json_object_get(d, "bytes"));
    json_object_set(e, "sha256", json_object_get(d, "sha256"));
    json_object_set_new(e, "json", json_string(hash));
    if (json_object_get(d, "demand") != NULL)
        json_object_set(e, "demand", json_object_get(d, "demand"));
    json_array_append_new(g->manifest, e);
    if (level <= CONF_LEVELS)
        json_array_append(g->least[level], e);
    count(g, "result", result);
    count(g, "folder", folder);
}

/* Keeps the suite's descriptor of a large vector. */
static void keep(generator *g, const conf_recipe *r)
{
    char path[CONF_PATH];
    json_t *d;
    json_error_t why;

    conf_path(path, "%s/vectors/%s/%s.json", g->o->suite, conf_line_find(r, "category")->word[1],
              r->id);
    d = json_load_file(path, 0, &why);
    if (d == NULL)
        conf_die("%s: %s: gen --large makes it", path, why.text);
    note(g, d);
    json_decref(d);
}

static void make(generator *g, const conf_recipe *r)
{
    const conf_line *const demand = conf_line_find(r, "demand");
    const int large = demand != NULL && conf_word_is(demand, 1, "large");
    conf_vector v;
    char path[CONF_PATH];

    if (large && !g->o->large) {
        keep(g, r);
        return;
    }
    if (!conf_vector_make(&v, r, g->o->suite))
        g->n_bad++;
    g->n_made++;
    conf_path(path, "%s/%s/%s.ted4", g->output, v.folder, r->id);
    if (demand == NULL || g->o->demand)
        put(g, path, v.file.data, v.file.size);
    note(g, v.descriptor);
    conf_vector_free(&v);
}

static int by_id(const void *a, const void *b)
{
    return strcmp(json_string_value(json_object_get(*(json_t *const *)a, "id")),
                  json_string_value(json_object_get(*(json_t *const *)b, "id")));
}

static json_t *sorted(const json_t *entries)
{
    const size_t n = json_array_size(entries);
    json_t **e = conf_alloc(n, sizeof *e), *out = json_array();

    for (size_t i = 0; i < n; i++)
        e[i] = json_array_get(entries, i);
    qsort(e, n, sizeof *e, by_id);
    for (size_t i = 0; i < n; i++)
        json_array_append(out, e[i]);
    free(e);
    return out;
}

static void put_manifest(generator *g)
{
    char path[CONF_PATH];
    json_t *o = json_pack("{s:s, s:i, s:s, s:s, s:s, s:I, s:O, s:o}", "suite", CONF_SUITE_VERSION,
                          "schema", 1, "spec", "1.0", "generator", "ted4conf gen", "license",
                          "CC0-1.0", "vectors", (json_int_t)json_array_size(g->manifest), "counts",
                          g->counts, "vector", sorted(g->manifest));

    conf_path(path, "%s/SUITE.json", g->o->output != NULL ? g->output : g->o->suite);
    put_json(g, path, o, NULL);
    json_decref(o);
}

/* Writes lists/level-N.txt, the vectors for decoders of level N: valid files up to that level, and
 * all other vectors. The list of a level begins with the list of the level below. */
static void put_level_lists(generator *g)
{
    for (int level = 1; level <= CONF_LEVELS; level++) {
        conf_bytes b = { NULL, 0, 0 };
        char path[CONF_PATH];
        json_t *list = sorted(g->least[level]);

        if (level > 1)
            conf_print(&b, "@level-%d.txt\n", level - 1);
        for (size_t i = 0; i < json_array_size(list); i++)
            conf_print(&b, "%s\n",
                       json_string_value(json_object_get(json_array_get(list, i), "id")));
        conf_path(path, "%s/lists/level-%d.txt", g->o->output != NULL ? g->output : g->o->suite,
                  level);
        put(g, path, b.data, b.size);
        conf_free(&b);
        json_decref(list);
    }
}

/* Reports vectors without a recipe. */
static void find_orphans(generator *g)
{
    size_t n;
    conf_entry *e;
    json_t *known = json_object();

    for (size_t i = 0; i < json_array_size(g->manifest); i++)
        json_object_set(known,
                        json_string_value(json_object_get(json_array_get(g->manifest, i), "id")),
                        json_true());
    e = conf_suite_load(g->output, NULL, &n);
    for (size_t i = 0; i < n; i++)
        if (json_object_get(known, e[i].id) == NULL) {
            fprintf(stderr, "ted4conf: %s: no recipe makes it\n", e[i].path);
            g->n_bad++;
        }
    conf_suite_free(e, n);
    json_decref(known);
}

int conf_gen(const conf_gen_options *o)
{
    generator g = { .o = o };
    conf_recipes r;
    char path[CONF_PATH];
    int some = 0;

    conf_path(g.output, "%s%s", o->output != NULL ? o->output : o->suite,
              o->output != NULL ? "" : "/vectors");
    conf_path(path, "%s/recipes", o->suite);
    conf_recipes_load(&r, path);
    g.manifest = json_array();
    for (int level = 1; level <= CONF_LEVELS; level++)
        g.least[level] = json_array();
    g.counts = json_object();
    for (size_t i = 0; i < r.n; i++)
        if (o->only == NULL || strncmp(r.recipe[i].id, o->only, strlen(o->only)) == 0) {
            make(&g, &r.recipe[i]);
            some = 1;
        }
    if (o->only == NULL) {
        put_manifest(&g);
        put_level_lists(&g);
        find_orphans(&g);
    }
    if (o->only != NULL && !some)
        conf_die("--only %s: no vector's id begins so", o->only);
    fprintf(stderr, "ted4conf: %zu vectors %s, %zu bytes with descriptors, %zu bad\n", g.n_made,
            o->verify ? "compared" : "made", g.bytes, g.n_bad);
    json_decref(g.manifest);
    for (int level = 1; level <= CONF_LEVELS; level++)
        json_decref(g.least[level]);
    json_decref(g.counts);
    conf_recipes_free(&r);
    return g.n_bad > 0;
}
