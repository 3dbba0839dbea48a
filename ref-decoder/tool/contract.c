/* contract.c - see contract.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "contract.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include "base/bytes.h"
#include "cli.h"
#include "json_file.h"
#include "tier_hash.h"

enum { MAX_PATH = 4096, T5 = 5 };

static const char NO_MEMORY[] = "out of memory";

typedef struct {
    const char *input, *queries, *dump;
    int tier[TED4_TIERS]; /* 1: requested */
    uint64_t max_bytes, max_work;
    int lenient;
    int failed; /* 1: not the stream's fault, and it has been said what it is */
} request;

static int usage(const char *text)
{
    fprintf(stderr, "ted4dec: %s (see conformance/README.md)\n", text);
    return TED4_EXIT_TOOL;
}

/* Says why there is no answer, the first time. */
static void fail(request *r, const char *what, const char *why)
{
    if (!r->failed)
        fprintf(stderr, "ted4dec: %s: %s\n", what, why);
    r->failed = 1;
}

int ted4_contract_asked(int argc, char **argv)
{
    return argc > 1 && strncmp(argv[1], "--ted4-", 7) == 0;
}

static int print(json_t *o)
{
    if (o == NULL)
        return usage(NO_MEMORY);
    json_dumpf(o, stdout, JSON_COMPACT);
    putchar('\n');
    json_decref(o);
    return ted4_cli_end("ted4dec", TED4_EXIT_FINE);
}

static json_t *capabilities(void)
{
    return json_pack(
        "{s:i, s:s, s:s, s:s, s:[s,s], s:i, s:[s,s,s,s,s,s], s:o, s:b, s:b, s:[], s:[s,s]}",
        "protocol", 1, "name", "ted4dec", "version", TED4_VERSION, "spec", TED4_SPEC_VERSION,
        "profiles", "Main", "Compact", "max_level", 31, "tiers", "T0", "T1", "T2", "T3", "T4", "T5",
        "class", ted4_recon_class_x() ? json_string("X") : json_null(), "strict", 1, "lenient", 1,
        "declines", "knobs", "max_alloc_total", "max_work");
}

/* Parses a list such as "T0,T3". Returns 0, or -1. */
static int parse_tiers(request *r, const char *text)
{
    for (;; text += 3) {
        if (text[0] != 'T' || text[1] < '0' || text[1] > '5' || (text[2] != ',' && text[2] != '\0'))
            return -1;
        r->tier[text[1] - '0'] = 1;
        if (text[2] == '\0')
            return 0;
    }
}

static int parse_knob(request *r, const char *text)
{
    const char *const is = strchr(text, '=');
    uint64_t *const knob = strncmp(text, "max_alloc_total=", 16) == 0 ? &r->max_bytes
                           : strncmp(text, "max_work=", 9) == 0       ? &r->max_work
                                                                      : NULL;
    char *end;

    if (knob == NULL || is[1] < '0' || is[1] > '9')
        return -1;
    *knob = strtoull(is + 1, &end, 10);
    return *end == '\0' && *knob > 0 ? 0 : -1;
}

/* Parses "strict" or "lenient". Returns 0, or -1. */
static int parse_mode(request *r, const char *text)
{
    r->lenient = strcmp(text, "lenient") == 0;
    return r->lenient || strcmp(text, "strict") == 0 ? 0 : -1;
}

static int parse(request *r, int argc, char **argv)
{
    memset(r, 0, sizeof *r);
    if (argc < 3 || argc % 2 == 0 || strcmp(argv[1], "--ted4-run") != 0)
        return -1;
    r->input = argv[2];
    for (int i = 3; i + 1 < argc; i += 2) {
        int bad = 0;

        if (strcmp(argv[i], "--tiers") == 0)
            bad = parse_tiers(r, argv[i + 1]);
        else if (strcmp(argv[i], "--queries") == 0)
            r->queries = argv[i + 1];
        else if (strcmp(argv[i], "--knob") == 0)
            bad = parse_knob(r, argv[i + 1]);
        else if (strcmp(argv[i], "--mode") == 0)
            bad = parse_mode(r, argv[i + 1]);
        else if (strcmp(argv[i], "--dump") == 0)
            r->dump = argv[i + 1];
        else
            bad = -1;
        if (bad != 0)
            return -1;
    }
    return 0;
}

/* Opens the file of a tier in the folder of --dump. number: of the query, or -1. Returns NULL if
 * --dump is not given or the file cannot be created. */
static FILE *open_dump(request *r, int tier, int number)
{
    char path[MAX_PATH];
    FILE *f;

    if (r->dump == NULL)
        return NULL;
    snprintf(path, sizeof path, number < 0 ? "%s/T%d.bin" : "%s/T%d-%d.bin", r->dump, tier, number);
    f = fopen(path, "wb");
    if (f == NULL)
        fail(r, path, strerror(errno));
    return f;
}

static void close_dump(request *r, FILE *f)
{
    if (f == NULL)
        return;

    const int bad = ferror(f); /* asked first: fclose takes the stream away */

    if (fclose(f) != 0 || bad)
        fail(r, r->dump, strerror(errno));
}

/* Returns the hashes of one of the tiers T0 to T4. *verdict is set if memory runs out. */
static json_t *tier_e(request *r, const void *data, size_t size, const ted4_scene *s,
                      const ted4_options *o, int tier, ted4_status *verdict)
{
    FILE *const keep = open_dump(r, tier, -1);
    ted4_tier_hash *h = ted4_tier_hash_new(keep);
    ted4_error e;
    json_t *answer;

    if (h == NULL)
        fail(r, r->input, NO_MEMORY);
    else
        *verdict = tier == 0 ? ted4_dump_syntax(data, size, o, ted4_tier_hash_add, h, &e)
                             : ted4_dump_tier(s, tier, o, ted4_tier_hash_add, h);
    answer = ted4_tier_hash_end(h);
    close_dump(r, keep);
    return answer;
}

int ted4_contract_query(const json_t *from, ted4_query *q)
{
    const json_t *const t = json_object_get(from, "t"), *const cam = json_object_get(from, "cam");

    if (json_array_size(t) != 2 || json_array_size(cam) != 3)
        return -1;
    for (size_t i = 0; i < 2; i++) {
        const json_t *const v = json_array_get(t, i);

        if (!json_is_integer(v) || json_integer_value(v) < 0 || json_integer_value(v) > UINT32_MAX)
            return -1;
        *(i == 0 ? &q->num : &q->den) = (uint32_t)json_integer_value(v);
    }
    for (size_t i = 0; i < 3; i++) {
        if (!json_is_number(json_array_get(cam, i)))
            return -1;
        q->camera[i] = (float)json_number_value(json_array_get(cam, i));
    }
    return 0;
}

static json_t *records(request *r, ted4_recon *recon, const ted4_query *q, int number)
{
    ted4_gaussians g;
    const ted4_status verdict = ted4_recon_query(recon, q, NULL, &g);

    if (verdict != TED4_OK)
        return json_pack("{s:s}", "error", ted4_status_id(verdict));

    FILE *const keep = open_dump(r, T5, number);
    ted4_tier_hash *h = ted4_tier_hash_new(keep);
    json_t *answer;

    if (h != NULL)
        ted4_tier_records(&g, ted4_tier_hash_add, h);
    answer = ted4_tier_hash_end(h);
    close_dump(r, keep);
    return answer;
}

/* Returns the list of --queries, or an empty one; NULL after a message. */
static json_t *load_queries(request *r)
{
    char why[256];
    json_t *const list = r->queries != NULL ? ted4_json_load(r->queries, why, sizeof why)
                                            : json_array();

    if (json_is_array(list))
        return list;
    if (r->queries == NULL)
        fail(r, r->input, NO_MEMORY);
    else
        fail(r, r->queries, list == NULL ? why : "expected a list of queries");
    json_decref(list);
    return NULL;
}

/* Returns an array with one entry per query. *verdict is set if memory runs out; r->failed is set
 * if the queries cannot be read. */
static json_t *tier_r(request *r, const ted4_scene *s, const ted4_options *o, ted4_status *verdict)
{
    json_t *const queries = load_queries(r), *const answer = json_array();
    ted4_recon *recon = NULL;

    if (json_array_size(queries) > 0)
        *verdict = ted4_recon_new(&recon, s, o);
    for (size_t i = 0; *verdict == TED4_OK && i < json_array_size(queries); i++) {
        char text[256];
        ted4_query q;

        if (ted4_contract_query(json_array_get(queries, i), &q) == 0) {
            if (json_array_append_new(answer, records(r, recon, &q, (int)i)) != 0)
                fail(r, r->input, NO_MEMORY);
            continue;
        }
        snprintf(text, sizeof text, "query %zu: %s", i, TED4_CONTRACT_QUERY);
        fail(r, r->queries, text);
    }
    ted4_recon_free(recon);
    json_decref(queries);
    return answer;
}

static json_t *refusal(const ted4_error *e)
{
    const ted4_verdict v = ted4_status_verdict(e->code);
    json_t *o =
        json_pack("{s:s, s:s}", "result", ted4_verdict_name(v), "error", ted4_status_id(e->code));

    if (v == TED4_INVALID || v == TED4_UNSUPPORTED)
        json_object_set_new(o, "offset", json_integer((json_int_t)e->offset));
    return o;
}

/* Returns the requested tiers from T<first> on. *verdict is set if memory runs out. */
static json_t *tiers(request *r, int first, const void *data, size_t size, const ted4_scene *s,
                     const ted4_options *o, ted4_status *verdict)
{
    json_t *t = json_object();

    for (int i = first; i < TED4_TIERS && *verdict == TED4_OK; i++)
        if (r->tier[i]) {
            const char name[3] = { 'T', (char)('0' + i), '\0' };

            if (json_object_set_new(t, name,
                                    i == T5 ? tier_r(r, s, o, verdict)
                                            : tier_e(r, data, size, s, o, i, verdict)) != 0)
                fail(r, r->input, NO_MEMORY);
        }
    return t;
}

static json_t *answer_valid(request *r, const void *data, size_t size, const ted4_scene *s,
                            const ted4_options *o)
{
    ted4_error e = { TED4_OK, 0 };
    json_t *t = tiers(r, 0, data, size, s, o, &e.code);

    if (e.code == TED4_OK)
        return json_pack("{s:s, s:o}", "result", "valid", "tiers", t);
    json_decref(t);
    return refusal(&e);
}

/* Returns the strict verdict together with what the lenient decoder could recover (spec 3.3). T0
 * exists for valid files only. */
static json_t *answer_salvage(request *r, const ted4_scene *s, const ted4_salvage *what,
                              const ted4_options *o)
{
    json_t *answer = refusal(&what->verdict);
    ted4_status verdict = TED4_OK;
    ted4_info info;
    char hash[2 * sizeof info.hash + 1];

    ted4_scene_info(s, &info);
    ted4_hex(hash, info.hash, sizeof info.hash);
    json_object_set_new(
        answer, "salvage",
        json_pack("{s:I, s:I, s:I, s:I, s:s, s:I, s:s, s:o}", "tiles", (json_int_t)what->n_tiles,
                  "tiles_declared", (json_int_t)what->tiles_declared, "anchors",
                  (json_int_t)info.n_anchors, "anchors_declared",
                  (json_int_t)what->anchors_declared, "error", ted4_status_id(what->stop.code),
                  "offset", (json_int_t)what->stop.offset, "hash", hash, "tiers",
                  tiers(r, 1, NULL, 0, s, o, &verdict)));
    if (verdict != TED4_OK)
        fail(r, r->input, ted4_status_text(verdict));
    return answer;
}

static json_t *answer_scene(request *r, const void *data, size_t size, const ted4_scene *s,
                            const ted4_salvage *what)
{
    ted4_options o;

    memset(&o, 0, sizeof o);
    o.max_bytes = r->max_bytes; /* the knob max_work bounds W_E, which decoding has enforced */
    if (s == NULL)
        return refusal(&what->verdict);
    return what->verdict.code == TED4_OK ? answer_valid(r, data, size, s, &o)
                                         : answer_salvage(r, s, what, &o);
}

static int answer_run(request *r)
{
    ted4_salvage what = { .verdict = { TED4_E_IO, 0 } };
    ted4_scene *s = NULL;
    ted4_options o;
    size_t size;
    uint8_t *data;
    json_t *answer;

    if (r->dump != NULL && mkdir(r->dump, 0777) != 0 && errno != EEXIST) {
        fail(r, r->dump, strerror(errno));
        return TED4_EXIT_TOOL;
    }
    data = ted4_read_file(r->input, &size);
    memset(&o, 0, sizeof o);
    o.max_bytes = r->max_bytes;
    o.max_work = r->max_work;
    if (data != NULL && r->lenient)
        (void)ted4_decode_lenient(data, size, &o, &s, &what);
    else if (data != NULL)
        (void)ted4_decode(data, size, &o, &s, &what.verdict);
    answer = answer_scene(r, data, size, s, &what);
    ted4_scene_free(s);
    free(data);
    if (!r->failed)
        return print(answer);
    json_decref(answer);
    return TED4_EXIT_TOOL;
}

int ted4_contract(int argc, char **argv)
{
    request r;

    ted4_cli_begin();
    if (ted4_cli_kernels("ted4dec") != 0)
        return TED4_EXIT_TOOL;
    if (argc == 2 && strcmp(argv[1], "--ted4-capabilities") == 0)
        return print(capabilities());
    return parse(&r, argc, argv) == 0 ? answer_run(&r)
                                      : usage("bad command line of the driver contract");
}
