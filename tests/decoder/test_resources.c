/* test_resources.c - spec 13.3, 13.4: counts the memory and work of the decoder for every vector of
 * the suite (bombs among them), for random headers, and for scenes of few and of many tiles. Memory
 * stays within M_E and within what the bytes have paid for (R-LVL-005), work within a constant
 * times W_E, and that of queries within W_R. Under max_work a file is refused exactly if W_E is
 * larger, after almost no work (R-LVL-008). The functions that do the work are wrapped by the
 * linker (strict.mk).
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdio.h>

#include "test.h"
#include <xxhash.h>
#define ZLIB_CONST
#include <zlib.h>
#include "fuzz/counting.h"
#include "kernel/strict_dense.h"
#include "recon/strict.h"
#include "norm/limits.h"
#include "random_scene.h"
#include "read/container.h"
#include "vector_files.h"

enum { N_SCENES = 40, FEW_VECTORS = 500 };

/* Networks are evaluated for 32 anchors at once, even if there are fewer. */
enum { WORK_CONSTANT = 32 };

/* The bytes of a stream pay for memory: at most 76 for each byte of POSN (6 per anchor, of which 2
 * C + 16 are kept and as many are working memory), 4128 for each byte of a zlib stream (1032 values
 * per 4 bytes, 16 bytes each); the rest is margin. */
static const uint64_t free_bytes = (uint64_t)1 << 20, paid_by_byte = 8192;

/* ---- work, counted ---- */

static uint64_t work;

XXH64_hash_t __real_XXH3_64bits(const void *data, size_t size);
XXH64_hash_t __wrap_XXH3_64bits(const void *data, size_t size);
int __real_inflate(z_streamp z, int flush);
int __wrap_inflate(z_streamp z, int flush);
void __real_ted4_prior_hyper_hidden(const ted4_prior *p, const uint16_t *position, size_t n,
                                    int16_t *hidden);
void __wrap_ted4_prior_hyper_hidden(const ted4_prior *p, const uint16_t *position, size_t n,
                                    int16_t *hidden);
void __real_ted4_prior_hyper_some(const ted4_prior *p, const ted4_int_layer *l, const int16_t *x,
                                  size_t n, int32_t *out);
void __wrap_ted4_prior_hyper_some(const ted4_prior *p, const ted4_int_layer *l, const int16_t *x,
                                  size_t n, int32_t *out);
void __real_ted4_prior_slice(const ted4_prior *p, unsigned m, const int16_t *ctx, size_t n,
                             int32_t *out);
void __wrap_ted4_prior_slice(const ted4_prior *p, unsigned m, const int16_t *ctx, size_t n,
                             int32_t *out);
uint32_t __real_ted4_gauss_find(unsigned g, int32_t fr, uint32_t slot, ted4_slots *slots);
uint32_t __wrap_ted4_gauss_find(unsigned g, int32_t fr, uint32_t slot, ted4_slots *slots);
ted4_strict_dense_fn __wrap_ted4_select_strict_dense(void);
ted4_status __real_ted4_prior_load(ted4_prior *p, const float *nete, const uint8_t *shift,
                                   ted4_error *e);
ted4_status __wrap_ted4_prior_load(ted4_prior *p, const float *nete, const uint8_t *shift,
                                   ted4_error *e);

XXH64_hash_t __wrap_XXH3_64bits(const void *data, size_t size)
{
    work += size;
    return __real_XXH3_64bits(data, size);
}

int __wrap_inflate(z_streamp z, int flush)
{
    const unsigned long before = z->total_out;
    const int verdict = __real_inflate(z, flush);

    work += z->total_out - before;
    return verdict;
}

static uint64_t products_of(const ted4_net_shape *n)
{
    uint64_t sum = 0;

    for (unsigned i = 0; i < n->n_layers; i++)
        sum += (uint64_t)n->dim[i] * n->dim[i + 1];
    return sum;
}

/* Anchors are evaluated in groups of 32. */
static uint64_t columns(size_t n)
{
    return (n + 31) / 32 * 32;
}

void __wrap_ted4_prior_hyper_hidden(const ted4_prior *p, const uint16_t *position, size_t n,
                                    int16_t *hidden)
{
    const ted4_int_layer *last = ted4_prior_last(p);

    work += columns(n) * (products_of(&p->hyper_shape) - (uint64_t)last->in * last->out);
    __real_ted4_prior_hyper_hidden(p, position, n, hidden);
}

/* Counts products, and one sum per output. */
void __wrap_ted4_prior_hyper_some(const ted4_prior *p, const ted4_int_layer *l, const int16_t *x,
                                  size_t n, int32_t *out)
{
    work += columns(n) * (l->in + (uint64_t)1) * l->out;
    __real_ted4_prior_hyper_some(p, l, x, n, out);
}

void __wrap_ted4_prior_slice(const ted4_prior *p, unsigned m, const int16_t *ctx, size_t n,
                             int32_t *out)
{
    work += columns(n) * products_of(&p->slice_shape[m]);
    __real_ted4_prior_slice(p, m, ctx, n, out);
}

uint32_t __wrap_ted4_gauss_find(unsigned g, int32_t fr, uint32_t slot, ted4_slots *slots)
{
    work++;
    return __real_ted4_gauss_find(g, fr, slot, slots);
}

/* Counts products for all 32 anchors of a row. */
static void counted_dense(const ted4_strict_layer *l, const float *x, float *y)
{
    work += (uint64_t)TED4_ROW * l->in * l->out;
    ted4_strict_dense_plain(l, x, y);
}

ted4_strict_dense_fn __wrap_ted4_select_strict_dense(void)
{
    return counted_dense;
}

/* Every value is read. */
ted4_status __wrap_ted4_prior_load(ted4_prior *p, const float *nete, const uint8_t *shift,
                                   ted4_error *e)
{
    work += products_of(&p->hyper_shape);
    for (unsigned m = 1; m < p->n_slices; m++)
        work += products_of(&p->slice_shape[m]);
    return __real_ted4_prior_load(p, nete, shift, e);
}

/* ---- formulas ---- */

/* Parses HEAD of a file whose first frames are valid. Returns 1, or 0 if no bound follows from
 * it. */
static int head_of(const uint8_t *data, size_t size, ted4_header *h, ted4_shape *shape)
{
    ted4_reader r;
    ted4_chunk_place p;
    int before = -1;
    uint8_t profile = 0;

    memset(h, 0, sizeof *h);
    ted4_reader_init(&r, data, 0, size, 1);
    (void)ted4_container_header(&r, &profile);
    p = ted4_container_judge(&r, &before);
    if (r.base.error.code != TED4_OK)
        return 0;
    ted4_reader_init(&r, data, p.payload, p.end, 0);
    ted4_walk_header(&r.base, h, shape, TED4_LEVEL_UNBOUNDED, UINT64_MAX);
    return r.base.error.code == TED4_OK;
}

static uint64_t values(const ted4_shape *s)
{
    return (uint64_t)s->n_nete + s->n_netr + s->n_bank;
}

/* M_E of 13.3 with J = 1; saturates. */
static uint64_t memory_bound(const ted4_header *h, const ted4_shape *s, uint64_t b)
{
    const uint64_t n = h->n_anchors, tile = h->tile_size, c = ted4_count_symbols(h, s) / n;
    const uint64_t n_t = ((tile < n ? tile : n) + 63) / 64 * 64;

    return ((uint64_t)1 << 20) + b + 16 * values(s) + n * (2 * c + 16) +
           n_t * (4 * (uint64_t)s->n_outputs + 2 * (uint64_t)h->feature_dim + 11) +
           ((uint64_t)1 << 17);
}

/* W_E of 13.4 */
static uint64_t work_bound(const ted4_header *h, const ted4_shape *s, uint64_t b)
{
    const uint64_t n = h->n_anchors,
                   symbols = ted4_count_symbols(h, s) + n * (h->n_offsets + (uint64_t)1);

    return b + 4 * values(s) + n * (ted4_count_products(h, s) + s->n_outputs) + symbols;
}

/* W_R of 13.4 */
static uint64_t query_bound(const ted4_scene *s)
{
    ted4_info info;
    uint64_t products = 0;

    ted4_scene_info(s, &info);
    for (int i = 0; i < TED4_NETS_R; i++)
        products += products_of(&s->shape.netr[i]);
    return s->head.n_anchors * products + 20 * (uint64_t)info.n_gaussians;
}

/* Rows contain 32 anchors, and anchors that move have rows of their own. Returns the work of a
 * query. */
static uint64_t hold_query(const ted4_scene *s, const char *name)
{
    static const ted4_query q = { 1, 2, { 0, 0, 0 } };
    ted4_options o = { .max_work = query_bound(s) };
    ted4_recon *r;
    ted4_gaussians g;

    work = 0;
    assert_int_equal(ted4_recon_new(&r, s, &o), TED4_OK);
    (void)ted4_recon_query(r, &q, NULL, &g);
    ted4_recon_free(r);
    if (work > 2 * WORK_CONSTANT * o.max_work)
        fail_msg("%s: %zu steps of a query", name, (size_t)work);
    o.max_work--;
    assert_int_equal(ted4_recon_new(&r, s, &o), TED4_E_LIMIT_WORK);
    assert_null(r);
    return work;
}

/* Decodes a file that needs one step more than allowed: only pass 1 and HEAD have been read. */
static void hold_refused(const uint8_t *data, size_t size, uint64_t bound, ted4_status verdict,
                         const char *name)
{
    counting_memory memory = { 0 };
    ted4_options o = { .allocator = counting_allocator(&memory), .max_work = bound };
    ted4_scene *s;

    if (verdict == TED4_OK) {
        assert_int_equal(ted4_decode(data, size, &o, &s, NULL), TED4_OK);
        ted4_scene_free(s);
    }
    o.max_work--;
    memory = (counting_memory) { 0 };
    work = 0;
    if (ted4_decode(data, size, &o, &s, NULL) != TED4_E_LIMIT_WORK && verdict == TED4_OK)
        fail_msg("%s: not refused", name);
    if (work > size || memory.most > 1 << 16 || memory.held > 0)
        fail_msg("%s: %zu steps, %zu bytes of what is refused", name, (size_t)work,
                 (size_t)memory.most);
}

static void hold(const uint8_t *data, size_t size, const char *name)
{
    counting_memory memory = { 0 };
    ted4_options o = { .allocator = counting_allocator(&memory), .max_bytes = UINT64_MAX };
    ted4_header h;
    ted4_shape shape;
    ted4_scene *s;
    const int known = head_of(data, size, &h, &shape);
    ted4_status verdict;
    uint64_t did;

    work = 0;
    verdict = ted4_decode(data, size, &o, &s, NULL);
    did = work;
    if (verdict == TED4_OK)
        (void)hold_query(s, name);
    ted4_scene_free(s);
    if (memory.most > free_bytes + paid_by_byte * size ||
        (known && memory.most > memory_bound(&h, &shape, size)))
        fail_msg("%s: %zu bytes of memory", name, (size_t)memory.most);
    if (known ? did > WORK_CONSTANT * work_bound(&h, &shape, size) : did > size)
        fail_msg("%s: %zu steps", name, (size_t)did);
    assert_int_equal(memory.held, 0);
    if (known)
        hold_refused(data, size, work_bound(&h, &shape, size), verdict, name);
}

/* ---- tests ---- */

static void vectors(void **state)
{
    (void)state;
    assert_true(each_vector("", hold) > FEW_VECTORS);
}

static void hold_scene(const ted4_scene *s, const char *name)
{
    uint8_t *data;
    size_t size;

    assert_int_equal(ted4_encode(s, 0, NULL, &data, &size, NULL), TED4_OK);
    hold(data, size, name);
    free(data);
}

static void random_headers(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < N_SCENES; seed++) {
        ted4_scene *s = random_scene(seed);
        char name[32];

        snprintf(name, sizeof name, "scene %d", (int)seed);
        hold_scene(s, name);
        ted4_scene_free(s);
    }
}

/* Work equals the formula, instead of only being below 32 times it: in a scene of whole groups each
 * anchor is evaluated once. */
static void tight(void **state)
{
    random_source r = random_seed(21);
    ted4_header h = random_paper_header(2048), back;
    ted4_shape shape;
    ted4_scene *s, *decoded;
    uint8_t *data;
    size_t size;

    (void)state;
    h.tile_size = 256;
    s = random_scene_of(&r, &h, 0);
    assert_int_equal(ted4_encode(s, 0, NULL, &data, &size, NULL), TED4_OK);
    assert_true(head_of(data, size, &back, &shape));
    work = 0;
    assert_int_equal(ted4_decode(data, size, NULL, &decoded, NULL), TED4_OK);
    assert_true(work < work_bound(&back, &shape, size));
    assert_true(work > work_bound(&back, &shape, size) / 2);
    ted4_scene_free(decoded);
    ted4_scene_free(s);
    free(data);
}

/* Keeps only the first keep bytes of the payload of the chunk of that type, with a correct hash.
 * Returns the file's size. */
static size_t shorten(uint8_t *data, size_t size, const char *type, size_t keep)
{
    size_t at = 12;

    while (memcmp(data + at, type, 4) != 0)
        at += 20 + ted4_load32(data + at + 8);

    const size_t next = at + 20 + ted4_load32(data + at + 8);

    ted4_store32(data + at + 8, (uint32_t)keep);
    ted4_store64(data + at + 12 + keep, __real_XXH3_64bits(data + at, 12 + keep));
    memmove(data + at + 20 + keep, data + next, size - next);
    return at + 20 + keep + (size - next);
}

/* Returns the memory taken by a file whose chunk of that type has only keep bytes. */
static uint64_t memory_of(const uint8_t *file, size_t size, const char *type, size_t keep)
{
    counting_memory memory = { 0 };
    const ted4_options o = { .allocator = counting_allocator(&memory) };
    uint8_t *const data = malloc(size);
    ted4_scene *s;

    assert_non_null(data);
    memcpy(data, file, size);
    assert_int_equal(ted4_decode(data, shorten(data, size, type, keep), &o, &s, NULL),
                     TED4_E_CON_PAYLOAD_SIZE);
    free(data);
    return memory.most;
}

/* R-LVL-005: values that are not deflated must all be present before memory is allocated for them;
 * those of a network before memory for its integers is. */
static void raw_values_are_paid_for(void **state)
{
    random_source r = random_seed(23);
    const ted4_header h = random_paper_header(64);
    ted4_scene *s = random_scene_of(&r, &h, 0);
    ted4_shape shape;
    uint8_t *data;
    size_t size;

    (void)state;
    ted4_shape_make(&shape, &h);
    s->nete.mode = s->netr.mode = TED4_BLOB_RAW;
    assert_int_equal(ted4_encode(s, 0, NULL, &data, &size, NULL), TED4_OK);
    assert_int_equal(memory_of(data, size, "NETE", shape.n_units + 4 * shape.n_nete),
                     memory_of(data, size, "NETE", shape.n_units + 1));
    assert_int_equal(memory_of(data, size, "NETR", 4 * shape.n_netr),
                     memory_of(data, size, "NETR", 1));
    free(data);
    ted4_scene_free(s);
}

/* The same for a query of a scene in which all anchors move. */
static void tight_query(void **state)
{
    random_source r = random_seed(22);
    ted4_header h = random_paper_header(2048);
    ted4_scene *s;
    uint64_t did;

    (void)state;
    h.temporal_mask = 0;
    s = random_scene_of(&r, &h, 0);
    did = hold_query(s, "tight");
    assert_true(did < query_bound(s));
    assert_true(did > query_bound(s) * 9 / 10);
    ted4_scene_free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(vectors),     cmocka_unit_test(random_headers),
        cmocka_unit_test(tight),       cmocka_unit_test(raw_values_are_paid_for),
        cmocka_unit_test(tight_query),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
