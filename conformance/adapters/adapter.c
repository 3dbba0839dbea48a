/* adapter.c - see adapter.h. Tiers are hashed with SHA-256 as they come.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "adapter.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "tool/sha256.h"

enum { TIERS = 6, MAX_QUERIES = 1 << 16, BAD = 3 };

typedef struct {
    const char *input, *queries;
    int tier[TIERS]; /* asked for? */
    uint64_t max_bytes, max_work;
} request;

typedef struct {
    uint8_t *data; /* owned, followed by a 0 that size does not count */
    size_t size;
} file;

static int usage(const char *why)
{
    fprintf(stderr, "%s\n", why);
    return BAD;
}

static int capabilities(const ted4_adapter *a)
{
    printf("{\"protocol\":1,\"name\":\"%s\",\"version\":\"%s\",\"spec\":\"1.0\",\"profiles\":["
           "\"Main\"],\"max_level\":%d,"
           "\"tiers\":[\"T0\",\"T1\",\"T2\",\"T3\",\"T4\"%s],\"class\":%s,\"strict\":true,"
           "\"declines\":[],\"knobs\":[%s%s%s]}\n",
           a->name, a->version, a->max_level, a->class_x ? ",\"T5\"" : "",
           a->class_x ? "\"X\"" : "null", a->bounded ? "\"max_alloc_total\"" : "",
           a->bounded && a->bounded_work ? "," : "", a->bounded_work ? "\"max_work\"" : "");
    return 0;
}

/* 0, or -1. */
static int read_file(file *f, const char *path)
{
    FILE *in = fopen(path, "rb");
    size_t capacity = 1 << 16, n = 1;

    f->size = 0;
    f->data = in != NULL ? malloc(capacity + 1) : NULL;
    while (f->data != NULL && n > 0) {
        if (f->size == capacity) {
            uint8_t *const more = realloc(f->data, 2 * capacity + 1);

            if (more == NULL)
                free(f->data);
            f->data = more;
            capacity *= 2;
        }
        n = f->data != NULL ? fread(f->data + f->size, 1, capacity - f->size, in) : 0;
        f->size += n;
    }
    if (in != NULL && ferror(in)) {
        free(f->data);
        f->data = NULL;
    }
    if (in != NULL)
        fclose(in);
    if (f->data != NULL)
        f->data[f->size] = 0;
    return f->data != NULL ? 0 : -1;
}

static int parse(request *r, int argc, char **argv)
{
    static const char memory[] = "max_alloc_total=", work[] = "max_work=";

    memset(r, 0, sizeof *r);
    if (argc < 3 || strcmp(argv[1], "--ted4-run") != 0)
        return -1;
    r->input = argv[2];
    for (int i = 3; i + 1 < argc; i += 2) {
        const char *const value = argv[i + 1];

        if (strcmp(argv[i], "--queries") == 0)
            r->queries = value;
        else if (strcmp(argv[i], "--knob") == 0 && strncmp(value, memory, sizeof memory - 1) == 0)
            r->max_bytes = strtoull(value + sizeof memory - 1, NULL, 10);
        else if (strcmp(argv[i], "--knob") == 0 && strncmp(value, work, sizeof work - 1) == 0)
            r->max_work = strtoull(value + sizeof work - 1, NULL, 10);
        else if (strcmp(argv[i], "--tiers") != 0)
            return -1;
        for (const char *t = value; strcmp(argv[i], "--tiers") == 0 && t != NULL;
             t = strchr(t, ',') != NULL ? strchr(t, ',') + 1 : NULL)
            if (t[0] == 'T' && t[1] >= '0' && t[1] < '0' + TIERS)
                r->tier[t[1] - '0'] = 1;
    }
    return 0;
}

/* A hash under way. */
typedef struct {
    ted4_sha256 hash;
    uint64_t size;
} sum;

static void add(void *user, const void *bytes, size_t size)
{
    sum *s = user;

    ted4_sha256_add(&s->hash, bytes, size);
    s->size += size;
}

static void begin(sum *s)
{
    ted4_sha256_init(&s->hash);
    s->size = 0;
}

static void print_sum(sum *s)
{
    uint8_t out[TED4_SHA256_SIZE];

    ted4_sha256_end(&s->hash, out);
    printf("{\"bytes\":%llu,\"sha256\":\"", (unsigned long long)s->size);
    for (int i = 0; i < TED4_SHA256_SIZE; i++)
        printf("%02x", out[i]);
    printf("\"}");
}

/* The text behind "name":[ of the object at p; NULL: it has none. */
static char *member(char *p, const char *name)
{
    char *const end = strchr(p, '}'), *const at = strstr(p, name),
                *const list = at != NULL ? strchr(at, '[') : NULL;

    return end != NULL && list != NULL && list < end ? list + 1 : NULL;
}

/* [{"t":[num,den],"cam":[x,y,z]}, ...]: next query behind *p. 1, 0: there is none, -1: what stands
 * there is none. */
static int next_query(char **p, uint32_t *num, uint32_t *den, float camera[3])
{
    char *const object = *p != NULL ? strchr(*p, '{') : NULL;
    char *t, *cam;

    if (object == NULL)
        return 0;
    t = member(object, "\"t\"");
    cam = member(object, "\"cam\"");
    if (t == NULL || cam == NULL)
        return -1;
    *num = (uint32_t)strtoul(t, &t, 10);
    *den = *t == ',' ? (uint32_t)strtoul(t + 1, &t, 10) : 0;
    for (int i = 0; i < 3; i++) {
        camera[i] = strtof(cam, &cam);
        cam += *cam == ',';
    }
    *p = strchr(object, '}') + 1;
    return 1;
}

static int print_records(const ted4_adapter *a, void *scene, char *queries)
{
    const char *comma = "";
    uint32_t num, den;
    float camera[3];
    int more;

    printf(",\"T5\":[");
    while ((more = next_query(&queries, &num, &den, camera)) > 0) {
        sum s;
        const char *error;

        begin(&s);
        error = a->query(scene, num, den, camera, add, &s);
        printf("%s", comma);
        if (error != NULL)
            printf("{\"error\":\"%s\"}", error);
        else
            print_sum(&s);
        comma = ",";
    }
    printf("]");
    return more;
}

/* 0, or -1. */
static int print_valid(const ted4_adapter *a, const request *r, void *scene)
{
    const char *comma = "";
    file queries = { NULL, 0 };
    int bad = 0;

    printf("{\"result\":\"valid\",\"tiers\":{");
    for (int i = 0; i < TIERS - 1 && bad == 0; i++) {
        sum s;

        if (!r->tier[i])
            continue;
        begin(&s);
        bad = a->tier(scene, i, add, &s);
        printf("%s\"T%d\":", comma, i);
        print_sum(&s);
        comma = ",";
    }
    if (bad == 0 && r->queries != NULL && a->class_x && r->tier[TIERS - 1])
        bad = read_file(&queries, r->queries) != 0 ||
                      print_records(a, scene, (char *)queries.data) != 0
                  ? -1
                  : 0;
    printf("}}\n");
    free(queries.data);
    return bad;
}

static int run(const ted4_adapter *a, const request *r)
{
    ted4_adapter_verdict v = { "invalid", "", 0 };
    file f;
    void *scene;
    int bad = 0;

    if (read_file(&f, r->input) != 0) {
        printf("{\"result\":\"io\",\"error\":\"io.read\"}\n");
        return 0;
    }
    scene = a->decode(f.data, f.size, r->max_bytes, r->max_work, &v);
    if (scene != NULL)
        bad = print_valid(a, r, scene);
    else if (strcmp(v.result, "limit") == 0)
        printf("{\"result\":\"limit\",\"error\":\"%s\"}\n", v.error);
    else
        printf("{\"result\":\"%s\",\"error\":\"%s\",\"offset\":%llu}\n", v.result, v.error,
               (unsigned long long)v.offset);
    if (scene != NULL)
        a->release(scene);
    free(f.data);
    return bad != 0 || fflush(stdout) != 0 ? BAD : 0;
}

int ted4_adapter_main(const ted4_adapter *a, int argc, char **argv)
{
    request r;

    if (argc == 2 && strcmp(argv[1], "--ted4-capabilities") == 0)
        return capabilities(a);
    return parse(&r, argc, argv) == 0 ? run(a, &r)
                                      : usage("usage: --ted4-capabilities | --ted4-run FILE "
                                              "--tiers T0,.. [--queries FILE] [--knob NAME=VALUE]");
}
