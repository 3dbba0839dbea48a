/* recipe.c - see recipe.h. Lines are read once; a vector under `each` is evaluated again for every
 * value.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "recipe.h"

#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "text.h"

enum { MAX_EACH = 4, MAX_NAMES = 6, MAX_DEPTH = 8 };

/* The lines of a file without comments and line ends. */
typedef struct {
    char **line;
    int *number;
    int n;
    const char *name;
} source;

typedef struct {
    char *name;
    source *from;
    int first, end;
} preset;

/* `each a:b in 1:2 3:4`: the names, and the values that they take together. */
typedef struct {
    char *name[MAX_NAMES];
    int n_names;
    char **value;
    int n_values;
} each;

typedef struct {
    conf_recipes *out;
    preset *presets;
    int n_presets;
    each each[MAX_EACH];
    int n_each, at[MAX_EACH];
} reader;

_Noreturn void conf_line_bad(const conf_line *l, const char *why)
{
    conf_die("%s:%d: %s: %s", l->file, l->number, l->word[0], why);
}

long long conf_line_number(const conf_line *l, int i, long long low, long long high)
{
    char *end;
    long long v;

    if (i >= l->n)
        conf_line_bad(l, "a number is missing");
    errno = 0;
    v = strtoll(l->word[i], &end, 0);
    if (*end != '\0' || end == l->word[i] || errno != 0 || v < low || v > high) {
        fprintf(stderr, "ted4conf: \"%s\"\n", l->word[i]);
        conf_line_bad(l, "no number, or out of range");
    }
    return v;
}

const conf_line *conf_line_find(const conf_recipe *r, const char *name)
{
    for (size_t i = 0; i < r->n; i++)
        if (strcmp(r->line[i].word[0], name) == 0)
            return &r->line[i];
    return NULL;
}

static source *read_source(const char *path, const char *name)
{
    source *s = conf_alloc(1, sizeof *s);
    conf_bytes b;
    char *p;
    int number = 0;

    if (!conf_read(path, &b))
        conf_die("%s: cannot be read", path);
    s->name = name;
    for (p = (char *)b.data; *p != '\0';) {
        char *end = strchr(p, '\n'), *const next = end != NULL ? end + 1 : p + strlen(p);
        char *hash;

        number++;
        if (end != NULL)
            *end = '\0';
        hash = strchr(p, '#');
        if (hash != NULL && (hash == p || isspace((unsigned char)hash[-1])))
            *hash = '\0';
        while (isspace((unsigned char)*p))
            p++;
        for (end = p + strlen(p); end > p && isspace((unsigned char)end[-1]);)
            *--end = '\0';
        if (*p != '\0') {
            s->line = realloc(s->line, (size_t)(s->n + 1) * sizeof *s->line);
            s->number = realloc(s->number, (size_t)(s->n + 1) * sizeof *s->number);
            if (s->line == NULL || s->number == NULL)
                conf_die("no memory");
            s->line[s->n] = conf_copy(p);
            s->number[s->n++] = number;
        }
        p = next;
    }
    conf_free(&b);
    return s;
}

static void free_source(source *s)
{
    conf_list_free(s->line, (size_t)s->n);
    free(s->number);
    free(s);
}

static int split(char *text, char **word, int capacity)
{
    int n = 0;

    for (char *p = strtok(text, " \t"); p != NULL && n < capacity; p = strtok(NULL, " \t"))
        word[n++] = p;
    return n;
}

/* Returns the current value of a name under `each`, or NULL if there is no such name. to: storage
 * for the value. */
static const char *value_of(const reader *r, const char *name, size_t length, char *to,
                            size_t capacity)
{
    for (int i = 0; i < r->n_each; i++) {
        const each *e = &r->each[i];
        const char *v = e->value[r->at[i]];

        for (int j = 0; j < e->n_names; j++) {
            const char *const end = v + strcspn(v, ":");

            if (strlen(e->name[j]) == length && memcmp(e->name[j], name, length) == 0) {
                snprintf(to, capacity, "%.*s", (int)(end - v), v);
                return to;
            }
            v = *end == ':' ? end + 1 : end;
        }
    }
    return NULL;
}

/* Returns the line with {name}, {name+1}, {name-1} replaced. */
static char *replace(const reader *r, const source *s, int i)
{
    conf_bytes out = { NULL, 0, 0 };
    const char *p = s->line[i];

    conf_add(&out, "", 0);
    while (*p != '\0') {
        const char *const end = *p == '{' ? strchr(p, '}') : NULL;
        const size_t name = end != NULL ? strcspn(p + 1, "+-}") : 0;
        char value[64];

        if (end == NULL) {
            conf_add(&out, p++, 1);
            continue;
        }
        if (value_of(r, p + 1, name, value, sizeof value) == NULL)
            conf_die("%s:%d: unknown {%.*s}", s->name, s->number[i], (int)name, p + 1);
        if (p + 1 + name == end)
            conf_print(&out, "%s", value);
        else
            conf_print(&out, "%lld", strtoll(value, NULL, 0) + strtoll(p + 1 + name, NULL, 10));
        p = end + 1;
    }
    return (char *)out.data;
}

static const preset *find_preset(const reader *r, const char *name)
{
    for (int i = 0; i < r->n_presets; i++)
        if (strcmp(r->presets[i].name, name) == 0)
            return &r->presets[i];
    return NULL;
}

static void add_line(conf_recipe *v, const source *s, int i, char *text)
{
    conf_line *l;
    const char *rest = text + strcspn(text, " \t");

    v->line = realloc(v->line, (v->n + 1) * sizeof *v->line);
    if (v->line == NULL)
        conf_die("no memory");
    l = &v->line[v->n++];
    memset(l, 0, sizeof *l);
    l->rest = conf_copy(rest + strspn(rest, " \t"));
    l->file = s->name;
    l->number = s->number[i];
    l->text = text;
    l->n = split(text, l->word, CONF_WORDS);
    if (l->n == CONF_WORDS)
        conf_line_bad(l, "too many words");
}

static void add_lines(reader *r, conf_recipe *v, const source *s, int first, int end, int depth)
{
    for (int i = first; i < end; i++) {
        char *text = replace(r, s, i);
        const preset *p;

        if (strncmp(text, "use ", 4) != 0) {
            add_line(v, s, i, text);
            continue;
        }
        p = find_preset(r, text + 4);
        if (p == NULL || depth == MAX_DEPTH)
            conf_die("%s:%d: no preset \"%s\"", s->name, s->number[i], text + 4);
        free(text);
        add_lines(r, v, p->from, p->first, p->end, depth + 1);
    }
}

/* Ids are file names, so "slice[0]" becomes "slice0". */
static char *tidy_id(char *id)
{
    char *to = id;

    for (const char *from = id; *from != '\0'; from++)
        if (*from != '[' && *from != ']')
            *to++ = *from;
    *to = '\0';
    return id;
}

static void add_vector(reader *r, const source *s, int first, int end)
{
    conf_recipe *v;
    char *head = replace(r, s, first);

    r->out->recipe = realloc(r->out->recipe, (r->out->n + 1) * sizeof *r->out->recipe);
    if (r->out->recipe == NULL)
        conf_die("no memory");
    v = &r->out->recipe[r->out->n++];
    memset(v, 0, sizeof *v);
    v->id = tidy_id(conf_copy(head + 7));
    v->file = s->name;
    free(head);
    for (size_t i = 0; i + 1 < r->out->n; i++)
        if (strcmp(r->out->recipe[i].id, v->id) == 0)
            conf_die("%s:%d: a second %s", s->name, s->number[first], v->id);
    add_lines(r, v, s, first + 1, end, 0);
}

/* Adds a vector for every combination of the values of `each`. */
static void add_vectors(reader *r, const source *s, int first, int end)
{
    int i;

    memset(r->at, 0, sizeof r->at);
    do {
        add_vector(r, s, first, end);
        for (i = r->n_each - 1; i >= 0 && ++r->at[i] == r->each[i].n_values; i--)
            r->at[i] = 0;
    } while (i >= 0);
    for (i = 0; i < r->n_each; i++) {
        for (int j = 0; j < r->each[i].n_names; j++)
            free(r->each[i].name[j]);
        for (int j = 0; j < r->each[i].n_values; j++)
            free(r->each[i].value[j]);
        free(r->each[i].value);
    }
    memset(r->each, 0, sizeof r->each);
    r->n_each = 0;
}

static void add_value(each *e, const char *text)
{
    e->value = realloc(e->value, (size_t)(e->n_values + 1) * sizeof *e->value);
    if (e->value == NULL)
        conf_die("no memory");
    e->value[e->n_values++] = conf_copy(text);
}

/* Parses `each a:b in 1:2 3:4` or `each a in 0..9`. */
static void add_each(reader *r, const source *s, int at)
{
    char *text = conf_copy(s->line[at]), *word[CONF_WORDS], number[24];
    int n = split(text, word, CONF_WORDS);
    each *e = &r->each[r->n_each++];

    if (n < 4 || strcmp(word[2], "in") != 0 || r->n_each > MAX_EACH)
        conf_die("%s:%d: bad each", s->name, s->number[at]);
    for (char *p = word[1]; *p != '\0' && e->n_names < MAX_NAMES;) {
        const size_t length = strcspn(p, ":");

        e->name[e->n_names] = conf_alloc(length + 1, 1);
        memcpy(e->name[e->n_names++], p, length);
        p += length + (p[length] == ':');
    }
    for (int i = 3; i < n; i++) {
        char *const dots = strstr(word[i], "..");

        if (dots == NULL) {
            add_value(e, word[i]);
            continue;
        }
        for (long v = strtol(word[i], NULL, 10), end = strtol(dots + 2, NULL, 10); v <= end; v++) {
            snprintf(number, sizeof number, "%ld", v);
            add_value(e, number);
        }
    }
    free(text);
}

static int find_end(const source *s, int i)
{
    while (i < s->n && strcmp(s->line[i], "end") != 0)
        i++;
    if (i == s->n)
        conf_die("%s: an end is missing", s->name);
    return i;
}

static void read_file(reader *r, source *s)
{
    for (int i = 0; i < s->n; i++) {
        const int first = i;

        if (strncmp(s->line[i], "each ", 5) == 0) {
            add_each(r, s, i);
        } else if (strncmp(s->line[i], "preset ", 7) == 0) {
            i = find_end(s, i);
            r->presets = realloc(r->presets, (size_t)(r->n_presets + 1) * sizeof *r->presets);
            if (r->presets == NULL)
                conf_die("no memory");
            r->presets[r->n_presets++] = (preset) { s->line[first] + 7, s, first + 1, i };
        } else if (strncmp(s->line[i], "vector ", 7) == 0) {
            i = find_end(s, i);
            add_vectors(r, s, first, i);
        } else {
            conf_die("%s:%d: neither each, preset nor vector", s->name, s->number[i]);
        }
    }
}

void conf_recipes_load(conf_recipes *out, const char *folder)
{
    reader r = { .out = out };
    source **s;

    memset(out, 0, sizeof *out);
    out->file = conf_list(folder, ".rcp", &out->n_files);
    if (out->n_files == 0)
        conf_die("%s: no recipes", folder);
    s = conf_alloc(out->n_files, sizeof *s);
    for (size_t i = 0; i < out->n_files; i++) {
        char path[CONF_PATH];

        conf_path(path, "%s/%s", folder, out->file[i]);
        s[i] = read_source(path, out->file[i]);
        read_file(&r, s[i]);
    }
    for (size_t i = 0; i < out->n_files; i++)
        free_source(s[i]);
    free(s);
    free(r.presets);
}

void conf_recipes_free(conf_recipes *r)
{
    for (size_t i = 0; i < r->n; i++) {
        for (size_t j = 0; j < r->recipe[i].n; j++) {
            free(r->recipe[i].line[j].text);
            free(r->recipe[i].line[j].rest);
        }
        free(r->recipe[i].line);
        free(r->recipe[i].id);
    }
    free(r->recipe);
    conf_list_free(r->file, r->n_files);
}
