/* run_report.c - writes the results of `ted4conf run` as JSON
 * (conformance/schema/results.schema.json), JUnit XML, and an HTML page.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "run.h"
#include "tool/json_string.h"

static const char *folder_of(const conf_entry *e)
{
    const char *const s = json_string_value(json_object_get(e->descriptor, "category"));

    return s != NULL ? s : "unknown";
}

static json_t *counts(const conf_run_result *r)
{
    json_t *o = json_object();

    for (int i = 0; i < CONF_OUTCOMES; i++)
        json_object_set_new(o, conf_outcome_name[i], json_integer((json_int_t)r->count[i]));
    return o;
}

void conf_run_write_json(const conf_run_result *r)
{
    json_t *list = json_array();
    json_t *o = json_pack("{s:i, s:s, s:o, s:b, s:o, s:o, s:o*, s:o}", "schema", 1, "suite",
                          CONF_SUITE_VERSION, "command", ted4_json_string(r->options->decoder),
                          "conforms", r->passed, "reason", ted4_json_string(r->reason), "counts",
                          counts(r), "capabilities", json_incref(r->capabilities), "vectors", list);
    char *text;

    for (size_t i = 0; i < r->n; i++)
        json_array_append_new(list,
                              json_pack("{s:s, s:s, s:s, s:o, s:f}", "id", r->entry[i].id,
                                        "category", folder_of(&r->entry[i]), "outcome",
                                        conf_outcome_name[r->verdict[i].outcome], "reason",
                                        ted4_json_string(r->verdict[i].reason), "ms", r->ms[i]));
    text = json_dumps(o, JSON_INDENT(1));
    if (text == NULL)
        conf_die("results that are no UTF-8");
    conf_write(r->options->json, text, strlen(text));
    free(text);
    json_decref(o);
}

/* Appends a text with the characters escaped that XML, HTML and their attributes do not allow. */
static void escaped(conf_bytes *b, const char *text)
{
    for (; *text != '\0'; text++)
        switch (*text) {
        case '<': conf_print(b, "&lt;"); break;
        case '>': conf_print(b, "&gt;"); break;
        case '&': conf_print(b, "&amp;"); break;
        case '"': conf_print(b, "&quot;"); break;
        default:
            conf_print(b, "%c",
                       (unsigned char)*text < 32 || (unsigned char)*text > 126 ? ' ' : *text);
        }
}

/* The reason that is not a vector's, as a test case that fails. */
static void junit_reason(conf_bytes *b, const conf_run_result *r)
{
    conf_print(b, "<testcase classname=\"decoder\" name=\"verdict\"><failure message=\"");
    escaped(b, r->reason);
    conf_print(b, "\"/></testcase>\n");
}

void conf_run_write_junit(const conf_run_result *r)
{
    static const char *const element[CONF_OUTCOMES] = { NULL,      "failure", "error",
                                                        "skipped", "error",   "skipped" };
    const size_t more = r->reason[0] != '\0';
    conf_bytes b = { NULL, 0, 0 };

    conf_print(&b,
               "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuite name=\"TED4 conformance "
               "%s\" tests=\"%zu\" failures=\"%zu\" "
               "errors=\"%zu\" skipped=\"%zu\">\n",
               CONF_SUITE_VERSION, r->n + more, r->count[CONF_FAIL] + more,
               r->count[CONF_NO_ANSWER] + r->count[CONF_MISSING],
               r->count[CONF_DECLINED] + r->count[CONF_NOT_RUN]);
    for (size_t i = 0; i < r->n; i++) {
        const conf_verdict *v = &r->verdict[i];

        conf_print(&b, "<testcase classname=\"%s\" name=\"%s\" time=\"%.4f\"",
                   folder_of(&r->entry[i]), r->entry[i].id, r->ms[i] / 1e3);
        if (element[v->outcome] == NULL) {
            conf_print(&b, "/>\n");
            continue;
        }
        conf_print(&b, "><%s message=\"", element[v->outcome]);
        escaped(&b, v->reason);
        conf_print(&b, "\"/></testcase>\n");
    }
    if (more)
        junit_reason(&b, r);
    conf_print(&b, "</testsuite>\n");
    conf_write(r->options->junit, b.data, b.size);
    conf_free(&b);
}

static void html_counts(conf_bytes *b, const conf_run_result *r)
{
    conf_print(b, "<table><tr>");
    for (int i = 0; i < CONF_OUTCOMES; i++)
        conf_print(b, "<th>%s</th>", conf_outcome_name[i]);
    conf_print(b, "</tr><tr>");
    for (int i = 0; i < CONF_OUTCOMES; i++)
        conf_print(b, "<td>%zu</td>", r->count[i]);
    conf_print(b, "</tr></table>\n");
}

void conf_run_write_html(const conf_run_result *r)
{
    conf_bytes b = { NULL, 0, 0 };

    conf_print(&b,
               "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>TED4 "
               "conformance</title><style>\n"
               "body{font:15px "
               "sans-serif;margin:2em;max-width:90em}table{border-collapse:collapse;margin:1em 0}"
               "td,th{border:1px solid #bbb;padding:.2em "
               ".6em;text-align:left}.pass{background:#dfd}.fail,.no,.missing{background:#fcc}"
               "</style></head><body>\n<h1>TED4 conformance suite %s</h1>\n<p>Decoder: <code>",
               CONF_SUITE_VERSION);
    escaped(&b, r->options->decoder);
    conf_print(&b, "</code></p>\n<p class=\"%s\"><strong>%s</strong> ", r->passed ? "pass" : "fail",
               r->passed ? "conforms" : "does not conform");
    escaped(&b, r->reason);
    conf_print(&b, "</p>\n");
    html_counts(&b, r);
    conf_print(&b, "<table><tr><th>vector</th><th>category</th><th>outcome</th><th>reason</"
                   "th><th>intent</th></tr>\n");
    for (size_t i = 0; i < r->n; i++) {
        const char *const intent =
            json_string_value(json_object_get(r->entry[i].descriptor, "intent"));

        conf_print(&b, "<tr class=\"%s\"><td>%s</td><td>%s</td><td>%s</td><td>",
                   conf_outcome_name[r->verdict[i].outcome], r->entry[i].id,
                   folder_of(&r->entry[i]), conf_outcome_name[r->verdict[i].outcome]);
        escaped(&b, r->verdict[i].reason);
        conf_print(&b, "</td><td>");
        escaped(&b, intent != NULL ? intent : "");
        conf_print(&b, "</td></tr>\n");
    }
    conf_print(&b, "</table></body></html>\n");
    conf_write(r->options->html, b.data, b.size);
    conf_free(&b);
}
