/* findings.c - see findings.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "findings.h"

#include <inttypes.h>
#include <jansson.h>
#include <stdio.h>
#include "cli.h"
#include "json_string.h"
#include "ted4.h"

static const char *const severity_name[] = { "error", "warning", "hint" };

typedef struct {
    const char *path;
    json_t *list; /* NULL: print text */
    int quiet;
    int count[3]; /* by severity */
    int no_memory;
} report;

static void print_text(const report *r, const ted4_finding *f)
{
    if (r->quiet && f->severity != TED4_ERROR)
        return;
    printf("%s: %s: byte %zu%s%s: %s", r->path, severity_name[f->severity], f->offset,
           f->where != NULL ? ", " : "", f->where != NULL ? f->where : "", f->text);
    for (unsigned i = 0; i < f->n_values; i++)
        printf("%s%" PRId64, i == 0 ? ": " : ", ", f->value[i]);
    printf(" [%s] (%s)\n", f->id, f->rule);
}

static void keep(report *r, const ted4_finding *f)
{
    json_t *const o = json_pack("{s:s, s:s, s:I, s:s, s:s}", "severity", severity_name[f->severity],
                                "id", f->id, "offset", (json_int_t)f->offset, "rule", f->rule,
                                "text", f->text);

    if (f->where != NULL)
        json_object_set_new(o, "where", json_string(f->where));
    if (f->n_values > 0) {
        json_t *const values = json_array();

        for (unsigned i = 0; i < f->n_values; i++)
            json_array_append_new(values, json_integer(f->value[i]));
        json_object_set_new(o, "values", values);
    }
    if (json_array_append_new(r->list, o) != 0)
        r->no_memory = 1;
}

static void take(void *user, const ted4_finding *f)
{
    report *const r = user;

    r->count[f->severity]++;
    if (r->list != NULL)
        keep(r, f);
    else
        print_text(r, f);
}

static void print_json(const report *r, ted4_status verdict, size_t size)
{
    json_t *const o = json_pack("{s:o, s:I, s:s, s:{s:i, s:i, s:i}, s:O}", "file",
                                ted4_json_string(r->path), "bytes", (json_int_t)size, "verdict",
                                ted4_verdict_name(ted4_status_verdict(verdict)), "counts",
                                severity_name[0], r->count[0], severity_name[1], r->count[1],
                                severity_name[2], r->count[2], "findings", r->list);

    json_dumpf(o, stdout, JSON_COMPACT);
    putchar('\n');
    json_decref(o);
}

int ted4_findings_print(const char *path, const uint8_t *data, size_t size, const ted4_options *o,
                        int json, int quiet)
{
    report r = { .path = path, .list = json ? json_array() : NULL, .quiet = quiet };
    const ted4_status verdict = ted4_validate(data, size, o, take, &r);

    if (json)
        print_json(&r, verdict, size);
    json_decref(r.list);
    if (r.no_memory || ted4_status_verdict(verdict) == TED4_LIMIT)
        return TED4_EXIT_TOOL;
    return r.count[TED4_ERROR] > 0     ? TED4_EXIT_REFUSED
           : r.count[TED4_WARNING] > 0 ? TED4_EXIT_WARNED
                                       : TED4_EXIT_FINE;
}
