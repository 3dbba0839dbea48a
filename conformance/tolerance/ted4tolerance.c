/* ted4tolerance.c - class T (spec E): thresholds for the queries of streams, computed by rule, and
 * whether a decoder's records keep them.
 *     ted4tolerance judge FILE.ted4 QUERIES.json FOLDER   FOLDER/T5-0.bin, T5-1.bin, ...: as CMD
 *         --ted4-run FILE --tiers T5 --dump FOLDER leaves them
 *     ted4tolerance table ID.json...                      thresholds of vectors, by their
 *         descriptors, as lines of thresholds.csv
 * QUERIES.json: a list of queries, or a descriptor. Exit codes: 0 class T can be claimed, or the
 * table is made; 1 it cannot; 3 usage, input, resources.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "class_t.h"
#include "ted4.h"
#include "tool/cli.h"

enum { MAX_PATH = 4096 };

static const char HELP[] =
    "Usage: ted4tolerance judge FILE.ted4 QUERIES.json FOLDER\n"
    "       ted4tolerance table ID.json...\n"
    "Computes the thresholds of class T (annex E of the specification).\n\n"
    "  judge        do a decoder's records keep the thresholds of these queries?\n"
    "               FOLDER/T5-0.bin, T5-1.bin, ...: as the decoder's contract\n"
    "               (--ted4-run FILE --tiers T5 --dump FOLDER) leaves them;\n"
    "               QUERIES.json: a list of queries, or a descriptor of a vector\n"
    "  table        thresholds of vectors, by their descriptors, as lines of CSV\n"
    "  -h, --help     this text\n"
    "  -V, --version  print the version\n\n"
    "Exit codes: 0 class T can be claimed, or the table is made; 1 it cannot be\n"
    "claimed; 3 usage, input or resources.\n\n"
    "Example:\n"
    "  ted4dec --ted4-run a.ted4 --tiers T5 --queries q.json --dump out\n"
    "  ted4tolerance judge a.ted4 q.json out\n";

static int complain(const char *what, const char *which)
{
    fprintf(stderr, "ted4tolerance: %s: %s\n", what, which);
    return TED4_EXIT_TOOL;
}

/* Element i of a list of queries. 1, or 0: there is none, or it is none. */
static int get_query(const json_t *list, size_t i, class_t_query *q)
{
    const json_t *const o = json_array_get(list, i), *const t = json_object_get(o, "t"),
                        *const cam = json_object_get(o, "cam");

    if (json_array_size(t) != 2 || json_array_size(cam) != 3)
        return 0;
    q->num = (uint32_t)json_integer_value(json_array_get(t, 0));
    q->den = (uint32_t)json_integer_value(json_array_get(t, 1));
    for (size_t j = 0; j < 3; j++)
        q->camera[j] = (float)json_number_value(json_array_get(cam, j));
    return 1;
}

/* The list in a file: itself, or of a descriptor. NULL: there is none. */
static json_t *load_queries(const char *path)
{
    json_t *const all = json_load_file(path, 0, NULL);
    json_t *const list = json_is_array(all) ? all : json_object_get(all, "queries");

    if (list != NULL && list != all) {
        json_incref(list);
        json_decref(all);
    } else if (list == NULL) {
        json_decref(all);
    }
    return list;
}

/* The stream of a file; NULL, and it has been said why. */
static class_t *open_stream(const char *path)
{
    size_t size;
    const char *why = "cannot be read";
    uint8_t *const data = ted4_read_file(path, &size);
    class_t *const c = data != NULL ? class_t_open(data, size, &why) : NULL;

    free(data);
    if (c == NULL)
        complain(path, why);
    return c;
}

static int judge(const char *file, const char *queries, const char *folder)
{
    json_t *const list = load_queries(queries), *const said = json_array();
    class_t *c;
    int good = 1;

    if (list == NULL || json_array_size(list) == 0)
        return complain(queries, "no queries");
    c = open_stream(file);
    if (c == NULL)
        return TED4_EXIT_TOOL;
    for (size_t i = 0; i < json_array_size(list); i++) {
        char path[MAX_PATH];
        class_t_query q;
        const char *verdict;
        uint8_t *records;
        size_t size = 0;

        if (!get_query(list, i, &q))
            return complain(queries, "not a query");
        snprintf(path, sizeof path, "%s/T5-%zu.bin", folder, i);
        records = ted4_read_file(path, &size);
        verdict = class_t_judge(c, &q, records, size);
        good &= strcmp(verdict, "kept") == 0;
        json_array_append_new(said, json_string(verdict));
        free(records);
    }
    json_t *const o = json_pack("{s:s?, s:o}", "class", good ? "T" : NULL, "queries", said);

    json_dumpf(o, stdout, JSON_COMPACT);
    putchar('\n');
    json_decref(o);
    json_decref(list);
    class_t_close(c);
    return good ? 0 : 1;
}

/* Exponent of a power of two; "-": nothing was judged. */
static void print_exponent(double x)
{
    int e;

    if (x == 0) {
        printf(",-");
    } else {
        (void)frexp(x, &e);
        printf(",%d", e - 1);
    }
}

/* Lines of one vector: id, query, records, and for each group the exponents of peak and rms.
 * Queries without an answer have none. */
static int print_vector(const char *descriptor)
{
    json_t *const list = load_queries(descriptor);
    const char *name = strrchr(descriptor, '/');
    const int n = (int)strlen(descriptor) - 5; /* without .json */
    char path[MAX_PATH];
    class_t *c;
    class_t_query q;

    name = name == NULL ? descriptor : name + 1;
    snprintf(path, sizeof path, "%.*s.ted4", n > 0 ? n : 0, descriptor);
    c = open_stream(path);
    if (c == NULL)
        return TED4_EXIT_TOOL;
    for (size_t i = 0; get_query(list, i, &q); i++) {
        class_t_thresholds t;

        if (!class_t_bounds(c, &q, &t))
            continue;
        printf("%.*s,%zu,%zu", (int)strlen(name) - 5, name, i, t.n);
        for (int g = 0; g < CLASS_T_GROUPS; g++) {
            print_exponent(t.peak[g]);
            print_exponent(t.rms[g]);
        }
        printf("\n");
    }
    json_decref(list);
    class_t_close(c);
    return 0;
}

int main(int argc, char **argv)
{
    int code = 0;

    if (argc == 2 && (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0)) {
        fputs(HELP, stdout);
    } else if (argc == 2 && (strcmp(argv[1], "--version") == 0 || strcmp(argv[1], "-V") == 0)) {
        puts("ted4tolerance " TED4_VERSION " (specification " TED4_SPEC_VERSION ")");
    } else if (argc == 5 && strcmp(argv[1], "judge") == 0) {
        code = judge(argv[2], argv[3], argv[4]);
    } else if (argc >= 3 && strcmp(argv[1], "table") == 0) {
        for (int i = 2; code == 0 && i < argc; i++)
            code = print_vector(argv[i]);
    } else {
        return complain("usage", "ted4tolerance judge FILE.ted4 QUERIES.json FOLDER | table "
                                 "ID.json... (see --help)");
    }
    return ted4_cli_end("ted4tolerance", code);
}
