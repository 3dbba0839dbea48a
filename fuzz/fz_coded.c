/* fz_coded.c - what profile Compact codes with adaptive bits (spec 9.5): u8 kind, u8 depth or
 * number of integers, u16 number of leaves or an exponent, then bytes. Kinds 0 and 1: the octree
 * of 8.2; 2 and 3: integers with expected lengths (9.6); 4 and 5: the weights of a unit (7.6). Even
 * kinds: values from the input pass through writer and reader. Odd ones: the rest of the input is
 * itself a substream. Claims: what is written is read back, and a byte more or less is refused; a
 * substream that is accepted equals the one that the writer makes from its values, and its
 * positions are different and in the order of their keys; the tree has exactly the number of leaves
 * that was asked for, and nothing behind that is written; a weight is legal, and the nearest
 * binary32, or infinite. SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <string.h>
#include "harness.h"
#include "norm/coded_weights.h"
#include "norm/half.h"
#include "norm/octree.h"
#include "places.h"
#include "read/reader.h"
#include "write/coder_write.h"

enum { MAX_N = 256, SIZES = 4, GUARD = 0xabcd };

typedef enum { TREE, INTEGERS, WEIGHTS } what;

/* The values of one substream, of whichever kind. */
typedef struct {
    what kind;
    size_t n;
    unsigned depth;
    int exponent;
    uint16_t position[3 * (MAX_N + 1)]; /* the last one is a guard */
    int32_t k[MAX_N];
    uint8_t expected[MAX_N];
    float x[MAX_N];
} values;

/* Codes all values with a writer or a reader. Returns 0 if the tree has another number of leaves.
 */
static int walk(ted4_coder *c, values *v)
{
    uint32_t size;
    int right = 1;
    ted4_integer_model m;

    ted4_integer_model_init(&m);
    c->ops->sizes(c, &size, 1);
    c->ops->open(c, 1);
    if (v->kind == TREE)
        right = c->error.code != TED4_OK || ted4_octree_walk(c, v->depth, v->n, v->position);
    else if (v->kind == WEIGHTS)
        ted4_code_weights(c, &m, v->exponent, v->x, v->n);
    else
        for (size_t i = 0; i < v->n; i++)
            v->k[i] = ted4_code_integer(c, &m, v->expected[i], c->reads ? 0 : v->k[i]);
    if (right)
        c->ops->close(c);
    return right;
}

/* Returns 1 if the substream is accepted. */
static int read_all(const uint8_t *data, size_t size, values *v)
{
    ted4_reader r;
    int right;

    ted4_reader_init(&r, data, 0, size, 0);
    memset(v->position, 0xff, sizeof v->position);
    v->position[3 * v->n] = GUARD;
    right = walk(&r.base, v);
    fuzz_require(v->position[3 * v->n] == GUARD, "no more leaves than there is room for");
    fuzz_require(r.base.error.code != TED4_OK || r.base.pos == size, "every byte read");
    return right && r.base.error.code == TED4_OK;
}

static void same(const values *a, const values *b)
{
    if (a->kind == TREE)
        fuzz_require(memcmp(a->position, b->position, 3 * a->n * sizeof *a->position) == 0,
                     "the same positions");
    else if (a->kind == INTEGERS)
        fuzz_require(memcmp(a->k, b->k, a->n * sizeof *a->k) == 0, "the same integers");
    else
        fuzz_require(memcmp(a->x, b->x, a->n * sizeof *a->x) == 0, "the same weights");
}

static void there_and_back(values *v)
{
    static values back;
    ted4_writer w;
    uint8_t *d;

    ted4_writer_init(&w);
    fuzz_require(walk(&w.base, v) && w.base.error.code == TED4_OK, "written");
    back = *v;
    fuzz_require(read_all(w.out.data, w.out.size, &back), "read");
    same(&back, v);
    d = calloc(w.out.size + 2, 1);
    fuzz_require(d != NULL, "memory");
    memcpy(d, w.out.data, w.out.size);
    for (int more = -2; more <= 2; more++)
        if (more != 0) {
            const size_t size = w.out.size + (size_t)more;

            ted4_store32(d, (uint32_t)(size - SIZES));
            fuzz_require(!read_all(d, size, &back), "another length is refused");
        }
    free(d);
    if (v->kind == TREE) {
        back.n = v->n + 1;
        fuzz_require(v->n == MAX_N || !read_all(w.out.data, w.out.size, &back), "a leaf less");
        back.n = v->n - 1;
        fuzz_require(v->n == 1 || !read_all(w.out.data, w.out.size, &back), "a leaf more");
    }
    ted4_writer_finish(&w);
}

static int has_illegal(const values *v)
{
    for (size_t i = 0; v->kind == WEIGHTS && i < v->n; i++)
        if (!ted4_float_legal(ted4_float_bits(v->x[i])))
            return 1;
    return 0;
}

static void check_order(const values *v)
{
    for (size_t i = 1; v->kind == TREE && i < v->n; i++)
        fuzz_require(ted4_octree_key(v->position + 3 * i, v->depth) >
                         ted4_octree_key(v->position + 3 * i - 3, v->depth),
                     "keys increase");
}

static void any_bytes(fuzz_source *in, values *v)
{
    const size_t n = (size_t)(in->end - in->at);
    uint8_t *const d = malloc(n + SIZES);
    ted4_writer w;

    fuzz_require(d != NULL, "memory");
    ted4_store32(d, (uint32_t)n);
    memcpy(d + SIZES, in->at, n);
    if (read_all(d, n + SIZES, v) && !has_illegal(v)) {
        check_order(v);
        ted4_writer_init(&w);
        fuzz_require(walk(&w.base, v) && w.base.error.code == TED4_OK && w.out.size == n + SIZES &&
                         memcmp(w.out.data, d, n + SIZES) == 0,
                     "the writer's own bytes");
        ted4_writer_finish(&w);
    }
    free(d);
}

/* spec 7.6: what a weight is, in doubles, which hold all of them exactly. */
static void check_weight(int32_t k, int exponent)
{
    const float x = ted4_weight_value(k, exponent);
    const double exact = ldexp(k, exponent);
    const int legal = k == 0 || ((double)(float)k == (double)k && fabs(exact) >= 0x1p-126 &&
                                 fabs(exact) < 0x1p128);

    fuzz_require(legal ? (double)x == exact && ted4_float_legal(ted4_float_bits(x)) : x == INFINITY,
                 "the value of a weight");
}

static void take_values(fuzz_source *in, values *v)
{
    for (size_t i = 0; v->kind == TREE && i < 3 * v->n; i++)
        v->position[i] = fuzz_u16(in) % 0x3c01 | (fuzz_u8(in) & 1 ? 0x8000 : 0);
    if (v->kind == TREE)
        fuzz_require(fuzz_settle(v->position, v->n, v->depth), "places enough");
    for (size_t i = 0; v->kind != TREE && i < v->n; i++) {
        v->expected[i] = fuzz_u8(in) % TED4_INTEGER_LENGTHS;
        v->k[i] = (int32_t)(fuzz_u32(in) & 0x7fffffff) >> v->expected[i];
        v->k[i] = fuzz_u8(in) & 1 ? -v->k[i] : v->k[i];
        check_weight(v->k[i], v->exponent);
        v->x[i] = ted4_weight_value(v->k[i], v->exponent);
        if (!ted4_float_legal(ted4_float_bits(v->x[i])))
            v->x[i] = 0;
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const uint8_t depths[] = { 6, 7, 8, 9, 10, 11, 12, 16 };
    static values v;
    fuzz_source in = { data, data + size };
    const unsigned kind = fuzz_u8(&in) % 6, small = fuzz_u8(&in), number = fuzz_u16(&in);

    if (size < 4)
        return 0;
    memset(&v, 0, sizeof v);
    v.kind = (what)(kind / 2);
    v.depth = depths[small % sizeof depths];
    v.n = 1 + (v.kind == TREE ? number : small) % MAX_N;
    v.exponent = (int)(number % 513) - 256;
    if (kind % 2 == 0) {
        take_values(&in, &v);
        there_and_back(&v);
        return 0;
    }
    for (size_t i = 0; v.kind == INTEGERS && i < v.n; i++)
        v.expected[i] = (uint8_t)((number + i) % TED4_INTEGER_LENGTHS);
    any_bytes(&in, &v);
    return 0;
}
