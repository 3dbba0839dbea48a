/* ted4tolerance.c - class T (spec E): thresholds for the queries of streams, computed by rule, and
 * whether a decoder's records keep them.
 *     ted4tolerance judge FILE.ted4 QUERIES.json FOLDER   FOLDER/T5-0.bin, T5-1.bin, ...: as CMD
 *         --ted4-run FILE --tiers T5 --dump FOLDER leaves them
 *     ted4tolerance table ID.json...                      thresholds of vectors, by their
 *         descriptors, as lines of thresholds.csv
 * QUERIES.json: a list of queries, or a descriptor.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <getopt.h>
#include <inttypes.h>
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "class_t.h"
#include "ted4.h"
#include "tool/arguments.h"
#include "tool/cli.h"
#include "tool/contract.h"
#include "tool/json_file.h"

enum { MAX_PATH = 4096 };

enum { OPT_HELP, OPT_VERSION, N_OPTIONS };

static const ted4_argument OPTIONS[N_OPTIONS] = {
    [OPT_HELP] = TED4_ARGUMENT_HELP,
    [OPT_VERSION] = TED4_ARGUMENT_VERSION,
};

static const ted4_command COMMAND = {
    "ted4tolerance",
    "judge FILE.ted4 QUERIES.json FOLDER\n"
    "       ted4tolerance table ID.json...",
    "Computes the thresholds of class T (annex E of the specification). judge: do a decoder's "
    "records, FOLDER/T5-0.bin, T5-1.bin and so on, keep those of the queries? QUERIES.json is a "
    "list of queries, or a descriptor of a vector. table: thresholds of vectors, by their "
    "descriptors, as lines of CSV.",
    OPTIONS,
    N_OPTIONS,
    "Exit codes: 0 class T can be claimed, or the table is made; 1 it cannot be\n"
    "claimed, or the file was refused; 3 usage, input, output or resources.\n\n"
    "Example:\n"
    "  ted4dec --ted4-run a.ted4 --tiers T5 --queries q.json --dump out\n"
    "  ted4tolerance judge a.ted4 q.json out\n",
    NULL,
};

static int complain(const char *what, const char *which)
{
    fprintf(stderr, "ted4tolerance: %s: %s\n", what, which);
    return TED4_EXIT_TOOL;
}

/* The list of queries in a file: itself, or of a descriptor. NULL: there is none, and it has been
 * said why. */
static json_t *load_list(const char *path)
{
    char why[256];
    json_t *const all = ted4_json_load(path, why, sizeof why);
    json_t *const list = json_is_array(all) ? all : json_object_get(all, "queries");

    if (all == NULL)
        complain(path, why);
    else if (!json_is_array(list))
        complain(path, "no list of queries");
    json_t *const found = json_is_array(list) ? json_incref(list) : NULL;

    json_decref(all);
    return found;
}

/* The queries of a file, which the caller frees, and their number. NULL: it has been said why. */
static class_t_query *load_queries(const char *path, size_t *n)
{
    json_t *const list = load_list(path);
    class_t_query *const q = list != NULL ? calloc(json_array_size(list) + 1, sizeof *q) : NULL;
    int bad = q == NULL;

    *n = json_array_size(list);
    if (list != NULL && q == NULL)
        complain(path, "no memory");
    for (size_t i = 0; i < *n && !bad; i++) {
        ted4_query read;
        char text[100];

        bad = ted4_contract_query(json_array_get(list, i), &read) != 0;
        if (bad) {
            snprintf(text, sizeof text, "query %zu: %s", i, TED4_CONTRACT_QUERY);
            complain(path, text);
        } else {
            q[i] = (class_t_query) { read.num,
                                     read.den,
                                     { read.camera[0], read.camera[1], read.camera[2] } };
        }
    }
    json_decref(list);
    if (!bad)
        return q;
    free(q);
    return NULL;
}

/* The stream of a file; NULL, and it has been said why, with the exit code in *code. */
static class_t *open_stream(const char *path, int *code)
{
    size_t size;
    const char *id;
    uint64_t offset = 0;
    uint8_t *const data = ted4_read_file(path, &size);

    if (data == NULL) {
        *code = ted4_report_unread("ted4tolerance", path, 0);
        return NULL;
    }
    class_t *const c = class_t_open(data, size, &id, &offset);

    free(data);
    if (c == NULL && id != NULL) {
        fprintf(stderr, "ted4tolerance: %s: byte %" PRIu64 ": refused [%s]\n", path, offset, id);
        *code = TED4_EXIT_REFUSED;
    } else if (c == NULL) {
        *code = complain(path, "no memory");
    }
    return c;
}

/* Prints what is said of the records in the folder. Returns 1 if all are kept. */
static int judge_all(const class_t *c, const class_t_query *q, size_t n, const char *folder)
{
    json_t *const said = json_array();
    int good = 1;

    for (size_t i = 0; i < n; i++) {
        char path[MAX_PATH];
        const char *verdict;
        uint8_t *records;
        size_t size = 0;

        snprintf(path, sizeof path, "%s/T5-%zu.bin", folder, i);
        records = ted4_read_file(path, &size);
        verdict = class_t_judge(c, &q[i], records, size);
        good &= strcmp(verdict, "kept") == 0;
        json_array_append_new(said, json_string(verdict));
        free(records);
    }
    json_t *const o = json_pack("{s:s?, s:o}", "class", good ? "T" : NULL, "queries", said);

    json_dumpf(o, stdout, JSON_COMPACT);
    putchar('\n');
    json_decref(o);
    return good;
}

static int judge(const char *file, const char *queries, const char *folder)
{
    size_t n;
    int code = TED4_EXIT_TOOL;
    class_t_query *const q = load_queries(queries, &n);
    class_t *const c = q != NULL ? open_stream(file, &code) : NULL;

    if (c != NULL && n == 0)
        complain(queries, "the list of queries is empty");
    else if (c != NULL)
        code = judge_all(c, q, n, folder) ? TED4_EXIT_FINE : TED4_EXIT_REFUSED;
    class_t_close(c);
    free(q);
    return code;
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
    const char *name = strrchr(descriptor, '/');
    const int n = (int)strlen(descriptor) - 5; /* without .json */
    char path[MAX_PATH];
    size_t queries;
    int code = TED4_EXIT_TOOL;
    class_t_query *const q = load_queries(descriptor, &queries);

    name = name == NULL ? descriptor : name + 1;
    snprintf(path, sizeof path, "%.*s.ted4", n > 0 ? n : 0, descriptor);
    class_t *const c = q != NULL ? open_stream(path, &code) : NULL;

    for (size_t i = 0; c != NULL && i < queries; i++) {
        class_t_thresholds t;

        if (!class_t_bounds(c, &q[i], &t))
            continue;
        printf("%.*s,%zu,%zu", (int)strlen(name) - 5, name, i, t.n);
        for (int g = 0; g < CLASS_T_GROUPS; g++) {
            print_exponent(t.peak[g]);
            print_exponent(t.rms[g]);
        }
        printf("\n");
    }
    free(q);
    if (c == NULL)
        return code;
    class_t_close(c);
    return TED4_EXIT_FINE;
}

int main(int argc, char **argv)
{
    const char *value;
    const int option = ted4_arguments_next(&COMMAND, argc, argv, &value);
    char **const word = argv + optind;
    const int n = argc - optind;
    int code = TED4_EXIT_FINE;

    if (option != TED4_ARGUMENTS_END)
        return option == TED4_ARGUMENTS_DONE ? TED4_EXIT_FINE : TED4_EXIT_TOOL;
    if (n == 4 && strcmp(word[0], "judge") == 0)
        code = judge(word[1], word[2], word[3]);
    else if (n >= 2 && strcmp(word[0], "table") == 0)
        for (int i = 1; code == TED4_EXIT_FINE && i < n; i++)
            code = print_vector(word[i]);
    else
        return complain("usage", "judge FILE.ted4 QUERIES.json FOLDER | table ID.json... (see "
                                 "--help)");
    return ted4_cli_end("ted4tolerance", code);
}
