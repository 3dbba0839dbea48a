/* cover_rules.c - goals for rules (from annex G), error identifiers (from status.def) and pairs of
 * features. A rule that binds streams needs a valid vector, and two that break it if it names an
 * error. A rule that binds decoders needs a vector. Rules that no file can show are listed with the
 * reason in conformance/rules-elsewhere.txt; rules that bind others need a vector or a line in that
 * file.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/status.h"
#include "cover.h"
#include "features.h"

enum { MAX_RULES = 400 };

typedef struct {
    char id[16], binds[24];
    int refusable; /* 1: names an error that a stream can cause */
    int elsewhere; /* 1: listed in rules-elsewhere.txt */
    size_t n_valid, n_other;
} rule;

typedef struct {
    rule rule[MAX_RULES];
    size_t n;
} rules;

static void orphan(conf_cover *c, const char *what, const char *why)
{
    char text[200];

    snprintf(text, sizeof text, "%s: %s", what, why);
    json_array_append_new(c->orphans, json_string(text));
}

static rule *find(rules *r, const char *id)
{
    for (size_t i = 0; i < r->n; i++)
        if (strcmp(r->rule[i].id, id) == 0)
            return &r->rule[i];
    return NULL;
}

/* Reads rows of the index, such as | R-CON-001 | 5.1 | stream | MUST | `con.magic` | */
static void read_index(rules *r, const char *spec)
{
    char path[CONF_PATH];
    conf_bytes text;

    conf_path(path, "%s/annex-g-rules.md", spec);
    if (!conf_read(path, &text))
        conf_die("%s: no index of rules", path);
    for (char *line = strtok((char *)text.data, "\n"); line != NULL; line = strtok(NULL, "\n")) {
        rule *const x = &r->rule[r->n];
        char errors[200] = "";

        if (r->n == MAX_RULES ||
            sscanf(line, "| %15s | %*s | %23s | %*s | %199[^|]", x->id, x->binds, errors) < 2 ||
            strncmp(x->id, "R-", 2) != 0)
            continue;
        x->refusable = strchr(errors, '`') != NULL && strcmp(x->binds, "stream") == 0;
        r->n++;
    }
    conf_free(&text);
}

/* Reads lines "R-ABC-nnn reason", which list the rules that no file can show. */
static void read_elsewhere(conf_cover *c, rules *r, const char *suite)
{
    char path[CONF_PATH];
    conf_bytes text;

    conf_path(path, "%s/rules-elsewhere.txt", suite);
    if (!conf_read(path, &text))
        return;
    for (char *line = strtok((char *)text.data, "\n"); line != NULL; line = strtok(NULL, "\n")) {
        char id[16];
        rule *x;

        if (line[0] == '#' || sscanf(line, "%15s", id) != 1)
            continue;
        x = find(r, id);
        if (x == NULL)
            orphan(c, id, "in rules-elsewhere.txt, but no rule");
        else if (strcmp(x->binds, "stream") == 0)
            orphan(c, id, "in rules-elsewhere.txt, but a stream can break it");
        else
            x->elsewhere = 1;
    }
    conf_free(&text);
}

static const char *result_of(const conf_entry *e)
{
    return json_string_value(json_object_get(json_object_get(e->descriptor, "expect"), "result"));
}

static void count_rules(conf_cover *c, rules *r, const conf_entry *e)
{
    const json_t *const list = json_object_get(e->descriptor, "rules");
    const int valid = strcmp(result_of(e), "valid") == 0;

    for (size_t i = 0; i < json_array_size(list); i++) {
        rule *const x = find(r, json_string_value(json_array_get(list, i)));

        if (x == NULL) {
            orphan(c, e->id, "its rule is not in the specification");
            continue;
        }
        x->n_valid += valid;
        x->n_other += !valid;
        conf_reach(c, "rules that bind others, or that no vector shows", e->id, "%s", x->id);
        conf_reach(c, "rules: shown by a vector", e->id, "%s", x->id);
        if (valid)
            conf_reach(c, "rules of streams: kept by a vector", e->id, "%s", x->id);
        else if (x->n_other >= 2)
            conf_reach(c, "rules of streams: broken by two vectors", e->id, "%s", x->id);
    }
    if (json_array_size(list) == 0)
        orphan(c, e->id, "no rule");
}

static void set_rule_goals(conf_cover *c, const rules *r)
{
    for (size_t i = 0; i < r->n; i++) {
        const rule *const x = &r->rule[i];

        if (x->elsewhere || (strcmp(x->binds, "stream") != 0 && strcmp(x->binds, "decoder") != 0)) {
            conf_goal(c, "rules that bind others, or that no vector shows", "%s", x->id);
            if (x->elsewhere)
                conf_reach(c, "rules that bind others, or that no vector shows",
                           "rules-elsewhere.txt", "%s", x->id);
            continue;
        }
        conf_goal(c, "rules: shown by a vector", "%s", x->id);
        if (strcmp(x->binds, "stream") == 0)
            conf_goal(c, "rules of streams: kept by a vector", "%s", x->id);
        if (x->refusable)
            conf_goal(c, "rules of streams: broken by two vectors", "%s", x->id);
    }
}

/* Every identifier that a stream can cause needs at least two vectors. */
static void cover_errors(conf_cover *c, const conf_entry *e, size_t n)
{
    size_t count[TED4_N_STATUS] = { 0 };

    for (int s = 1; s < TED4_N_STATUS; s++)
        if (ted4_status_verdict((ted4_status)s) != TED4_IO)
            conf_goal(c, "error identifiers: two vectors", "%s", ted4_status_id((ted4_status)s));
    for (size_t i = 0; i < n; i++) {
        const char *const id =
            json_string_value(json_object_get(json_object_get(e[i].descriptor, "expect"), "error"));
        const json_t *t5 = json_object_get(json_object_get(e[i].descriptor, "tiers"), "T5");

        for (int s = 1; s < TED4_N_STATUS; s++) {
            int hit = id != NULL && strcmp(id, ted4_status_id((ted4_status)s)) == 0;

            for (size_t q = 0; q < json_array_size(t5); q++) {
                const char *const error =
                    json_string_value(json_object_get(json_array_get(t5, q), "error"));

                hit |= error != NULL && strcmp(error, ted4_status_id((ted4_status)s)) == 0;
            }
            count[s] += (size_t)hit;
            if (hit && count[s] >= (s == TED4_E_QUERY ? 1u : 2u))
                conf_reach(c, "error identifiers: two vectors", e[i].id, "%s",
                           ted4_status_id((ted4_status)s));
        }
    }
}

static int holds(const json_t *features, const char *name)
{
    for (size_t i = 0; i < json_array_size(features); i++)
        if (strcmp(json_string_value(json_array_get(features, i)), name) == 0)
            return 1;
    return 0;
}

typedef void on_pair(conf_cover *c, const char *a, const char *b, const conf_entry *e);

static void set_pair(conf_cover *c, const char *a, const char *b, const conf_entry *e)
{
    (void)e;
    if (!conf_feature_excludes(a, b))
        conf_goal(c, "pairs of features", "%s with %s", a, b);
}

static void reach_pair(conf_cover *c, const char *a, const char *b, const conf_entry *e)
{
    const json_t *const f = json_object_get(e->descriptor, "features");

    if (holds(f, a) && holds(f, b))
        conf_reach(c, "pairs of features", e->id, "%s with %s", a, b);
}

static void each_pair(conf_cover *c, const conf_entry *e, on_pair *what)
{
    for (size_t g = 0; g < conf_n_feature_groups; g++)
        for (size_t h = g + 1; h < conf_n_feature_groups; h++)
            for (size_t i = 0; i < 5 && conf_feature_groups[g][i] != NULL; i++)
                for (size_t j = 0; j < 5 && conf_feature_groups[h][j] != NULL; j++)
                    what(c, conf_feature_groups[g][i], conf_feature_groups[h][j], e);
}

void conf_cover_rules(conf_cover *c, const char *spec, const char *suite, const conf_entry *e,
                      size_t n)
{
    rules *r = conf_alloc(1, sizeof *r);

    read_index(r, spec);
    read_elsewhere(c, r, suite);
    set_rule_goals(c, r);
    for (size_t i = 0; i < n; i++)
        count_rules(c, r, &e[i]);
    cover_errors(c, e, n);
    each_pair(c, NULL, set_pair);
    for (size_t i = 0; i < n; i++)
        if (strcmp(result_of(&e[i]), "valid") == 0)
            each_pair(c, &e[i], reach_pair);
    free(r);
}
