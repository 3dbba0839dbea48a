/* test_stack.c - how much of their thread's stack the library's calls use, for every vector of the
 * suite: no more than SECURITY.md promises.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <pthread.h>
#include <stdlib.h>

#include "test.h"
#include "use_kernels.h"
#include "ted4.h"
#include "vector_files.h"

/* PROMISED: bytes, including those of a thread's stack that the system keeps for itself. */
enum { PROMISED = 256 << 10, STACK = 1 << 20, PAINT = 0xa5, FEW_VECTORS = 250 };

typedef struct {
    const uint8_t *data;
    size_t size;
} file;

static unsigned char *stack;
static size_t deepest;
static char where[1024];

static void keep_nothing(void *user, const void *bytes, size_t size)
{
    (void)user;
    (void)bytes;
    (void)size;
}

static void find_nothing(void *user, const ted4_finding *f)
{
    (void)user;
    (void)f;
}

static void look_at(const ted4_scene *s)
{
    static const ted4_query q = { 1, 3, { 1, 2, 3 } };
    ted4_recon *r;
    ted4_gaussians g;

    for (int tier = 1; tier <= 4; tier++)
        (void)ted4_dump_tier(s, tier, NULL, keep_nothing, NULL);
    if (ted4_recon_new(&r, s, NULL) == TED4_OK) {
        (void)ted4_recon_query(r, &q, NULL, &g);
        ted4_recon_free(r);
    }
}

static void *every_call(void *arg)
{
    const file *f = arg;
    ted4_scene *s;
    ted4_error e;
    ted4_salvage what;

    if (ted4_decode(f->data, f->size, NULL, &s, &e) == TED4_OK)
        look_at(s);
    ted4_scene_free(s);
    (void)ted4_decode_lenient(f->data, f->size, NULL, &s, &what);
    ted4_scene_free(s);
    (void)ted4_validate(f->data, f->size, NULL, find_nothing, NULL);
    (void)ted4_dump_syntax(f->data, f->size, NULL, keep_nothing, NULL, &e);
    return NULL;
}

/* Runs the calls on a stack filled with a pattern. Stacks grow downwards here. */
static void measure(const uint8_t *data, size_t size, const char *path)
{
    file f = { data, size };
    pthread_attr_t attributes;
    pthread_t thread;
    size_t untouched = 0;

    memset(stack, PAINT, STACK);
    assert_int_equal(pthread_attr_init(&attributes), 0);
    assert_int_equal(pthread_attr_setstack(&attributes, stack, STACK), 0);
    assert_int_equal(pthread_create(&thread, &attributes, every_call, &f), 0);
    assert_int_equal(pthread_join(thread, NULL), 0);
    pthread_attr_destroy(&attributes);
    while (untouched < STACK && stack[untouched] == PAINT)
        untouched++;
    if (STACK - untouched > deepest) {
        deepest = STACK - untouched;
        snprintf(where, sizeof where, "%s", path);
    }
}

static void depth(void **state)
{
    (void)state;
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    print_message("skipped: sanitizers have stacks of their own\n");
    skip();
#endif
    stack = aligned_alloc(1 << 16, STACK);
    assert_non_null(stack);
    for (int plain = 0; plain < 2; plain++) {
        use_kernels(plain ? "plain" : NULL);
        deepest = 0;
        assert_true(each_vector("", measure) > FEW_VECTORS);
        print_message("%s kernels: %zu bytes of stack (%s)\n", plain ? "plain" : "the level's",
                      deepest, where);
        assert_true(deepest <= PROMISED);
    }
    use_kernels(NULL);
    free(stack);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(depth),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
