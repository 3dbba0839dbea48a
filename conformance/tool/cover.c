/* cover.c - see cover.h: collects the goals and reports which are reached.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "cover.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Prints a group and returns the number of its goals that no vector reaches. */
static size_t tell(const char *name, json_t *group, int verbose, json_t *report)
{
    const char *goal;
    json_t *value, *missing = json_array();
    size_t n = 0;

    json_object_foreach(group, goal, value)
    {
        n++;
        if (json_integer_value(json_array_get(value, 1)) == 0)
            json_array_append_new(missing, json_string(goal));
        else if (verbose)
            printf("    %s: %s\n", goal, json_string_value(json_array_get(value, 0)));
    }
    printf("%-40s %6zu of %6zu\n", name, n - json_array_size(missing), n);
    for (size_t i = 0; i < json_array_size(missing); i++)
        printf("  not reached: %s\n", json_string_value(json_array_get(missing, i)));
    json_array_append_new(
        report, json_pack("{s:s, s:I, s:I, s:O}", "group", name, "goals", (json_int_t)n, "reached",
                          (json_int_t)(n - json_array_size(missing)), "missing", missing));
    n = json_array_size(missing);
    json_decref(missing);
    return n;
}

static void write_html(const char *path, const conf_cover *c)
{
    conf_bytes b = { NULL, 0, 0 };
    const char *name, *goal;
    json_t *group, *value;

    conf_print(
        &b, "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>TED4 "
            "coverage</title><style>"
            "body{font:15px sans-serif;margin:2em}table{border-collapse:collapse}td,th{border:1px "
            "solid #bbb;padding:.1em .5em}"
            ".no{background:#fcc}</style></head><body>\n<h1>What the vectors cover</h1>\n");
    json_object_foreach(c->groups, name, group)
    {
        conf_print(&b,
                   "<details><summary>%s: %zu "
                   "goals</summary><table><tr><th>goal</th><th>vectors</th><th>first</th></tr>\n",
                   name, json_object_size(group));
        json_object_foreach(group, goal, value)
        {
            const json_int_t n = json_integer_value(json_array_get(value, 1));

            conf_print(&b, "<tr%s><td>%s</td><td>%lld</td><td>%s</td></tr>\n",
                       n == 0 ? " class=\"no\"" : "", goal, (long long)n,
                       json_string_value(json_array_get(value, 0)));
        }
        conf_print(&b, "</table></details>\n");
    }
    conf_print(&b, "</body></html>\n");
    conf_write(path, b.data, b.size);
    conf_free(&b);
}

static int report(const conf_cover *c, const conf_cover_options *o)
{
    json_t *list = json_array(), *group;
    const char *name;
    size_t n_missing = 0;

    json_object_foreach(c->groups, name, group) n_missing += tell(name, group, o->verbose, list);
    for (size_t i = 0; i < json_array_size(c->orphans); i++)
        printf("orphan: %s\n", json_string_value(json_array_get(c->orphans, i)));
    if (o->json != NULL) {
        json_t *const all = json_pack("{s:O, s:O}", "groups", list, "orphans", c->orphans);
        char *const text = json_dumps(all, JSON_INDENT(1));

        conf_write(o->json, text, strlen(text));
        free(text);
        json_decref(all);
    }
    if (o->html != NULL)
        write_html(o->html, c);
    json_decref(list);
    return n_missing > 0 || json_array_size(c->orphans) > 0;
}

int conf_cover_run(const conf_cover_options *o)
{
    conf_cover c = { json_object(), json_array() };
    conf_triples triples;
    char path[CONF_PATH];
    conf_entry *e;
    size_t n;
    int code;

    conf_path(path, "%s/vectors", o->suite);
    e = conf_suite_load(path, NULL, &n);
    conf_cover_rules(&c, o->spec, o->suite, e, n);
    conf_cover_syntax_goals(&c);
    conf_cover_model_goals(&c);
    for (size_t i = 0; i < n; i++) {
        const char *const result = json_string_value(
            json_object_get(json_object_get(e[i].descriptor, "expect"), "result"));
        conf_bytes file;

        if (!conf_read(e[i].file, &file)) {
            if (json_object_get(e[i].descriptor, "demand") == NULL)
                conf_die("%s: cannot be read", e[i].file);
            continue;
        }
        conf_cover_syntax(&c, &e[i], &file);
        if (strcmp(result, "valid") == 0)
            conf_cover_model(&c, &e[i], &file);
        conf_free(&file);
    }
    code = report(&c, o);
    triples = conf_cover_triples(e, n);
    printf("reported only: triples of features          %6zu of %6zu\n", triples.reached,
           triples.possible);
    conf_suite_free(e, n);
    json_decref(c.groups);
    json_decref(c.orphans);
    return code;
}
