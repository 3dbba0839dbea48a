/* test_memory.c - the memory limits that SECURITY.md promises: under every limit the library holds
 * at most max_bytes for a scene, and at most as much again while something is made from it (a
 * validator's findings, what a lenient decoder saves, tiers, records); all of it comes from the
 * caller's allocator and is freed. Vectors of the suite, bombs among them, run under limits from
 * nothing to more than they need. A loop over a number that a file only claims would never end.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdio.h>
#include <unistd.h>

#include "test.h"
#include "fuzz/counting.h"
#include "ted4.h"

enum { MAX_PATH = 1024, MAX_FILE = 1 << 20, FEW_VECTORS = 100, TIERS = 5, PATIENCE = 600 };

/* A file, and the options of one use of it under a limit. */
typedef struct {
    const char *name;
    const uint8_t *data;
    size_t size;
    counting_memory memory;
    ted4_options o;
} use;

static void sink(void *user, const void *bytes, size_t size)
{
    (void)user;
    (void)bytes;
    (void)size;
}

static void finding(void *user, const ted4_finding *f)
{
    *(int *)user += f->severity == TED4_ERROR;
}

/* Asserts that at most times the limit is held, and nothing at the end. */
static void judge(const use *u, uint64_t times, const char *what)
{
    if (u->memory.most / times > u->o.max_bytes || u->memory.held != 0)
        fail_msg("%s, %s: %llu bytes held at most, %llu at the end; the bound is %llu", u->name,
                 what, (unsigned long long)u->memory.most, (unsigned long long)u->memory.held,
                 (unsigned long long)u->o.max_bytes);
}

static use under(const use *u, uint64_t bound, counting_memory *m)
{
    use v = *u;

    *m = (counting_memory) { 0 };
    v.o.allocator = counting_allocator(m);
    v.o.max_bytes = bound;
    return v;
}

/* Makes everything that can be made from a decoded scene, each time under the same limit. */
static void made_of(const use *u, uint64_t bound, const ted4_scene *s)
{
    static const ted4_query q = { 0, 1, { 0, 0, 0 } };
    counting_memory m;
    use v;

    for (int tier = 1; tier < TIERS; tier++) {
        v = under(u, bound, &m);
        (void)ted4_dump_tier(s, tier, &v.o, sink, NULL);
        v.memory = m;
        judge(&v, 1, "a tier");
    }

    ted4_recon *r;
    ted4_gaussians g;

    v = under(u, bound, &m);
    if (ted4_recon_new(&r, s, &v.o) == TED4_OK)
        (void)ted4_recon_query(r, &q, NULL, &g);
    ted4_recon_free(r);
    v.memory = m;
    judge(&v, 1, "records");
}

static void hold(const use *u, uint64_t bound)
{
    counting_memory m;
    use v = under(u, bound, &m);
    ted4_scene *s;
    ted4_salvage what;
    int errors = 0;
    const ted4_status verdict = ted4_decode(u->data, u->size, &v.o, &s, NULL);

    if (s != NULL)
        made_of(u, bound, s);
    ted4_scene_free(s);
    v.memory = m;
    judge(&v, 1, "decoding");

    v = under(u, bound, &m);
    (void)ted4_decode_lenient(u->data, u->size, &v.o, &s, &what);
    ted4_scene_free(s);
    v.memory = m;
    judge(&v, 1, "lenient decoding");

    v = under(u, bound, &m);
    (void)ted4_dump_syntax(u->data, u->size, &v.o, sink, NULL, NULL);
    v.memory = m;
    judge(&v, 1, "T0");

    v = under(u, bound, &m);
    (void)ted4_validate(u->data, u->size, &v.o, finding, &errors);
    v.memory = m;
    judge(&v, 2, "validating");
    assert_true(verdict == TED4_OK || errors > 0);
}

/* Tries limits around the memory that decoding takes without a tight limit. */
static void hold_all(const char *name, const uint8_t *data, size_t size)
{
    static const int part[] = { 0, 4, 7, 8, 16 }; /* in eighths of that memory */
    const use u = { .name = name, .data = data, .size = size };
    counting_memory m;
    use v = under(&u, (uint64_t)1 << 28, &m);
    ted4_scene *s;

    (void)ted4_decode(data, size, &v.o, &s, NULL);
    ted4_scene_free(s);
    for (size_t i = 0; i < sizeof part / sizeof *part; i++)
        hold(&u, m.most * (uint64_t)part[i] / 8 + 1);
}

static void vectors(void **state)
{
    static const char files[] = "cd conformance/vectors && find limit worked tolerant valid/masks "
                                "content -name '*.ted4' | LC_ALL=C sort";
    static uint8_t data[MAX_FILE];
    char name[MAX_PATH], path[2 * MAX_PATH];
    int n = 0;
    FILE *list;

    (void)state;
    (void)alarm(PATIENCE);
    list = popen(files, "r");
    assert_non_null(list);
    while (fgets(name, sizeof name, list) != NULL) {
        FILE *f;

        name[strcspn(name, "\n")] = '\0';
        snprintf(path, sizeof path, "conformance/vectors/%s", name);
        f = fopen(path, "rb");
        assert_non_null(f);
        hold_all(name, data, fread(data, 1, sizeof data, f));
        fclose(f);
        n++;
    }
    pclose(list);
    (void)alarm(0);
    assert_true(n > FEW_VECTORS);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(vectors) };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
