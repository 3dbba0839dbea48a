/* test_exchange.c - sums over views that several processes have drawn, and over chunks
 * (train/state/exchange.h, view_exchange.h, chunk_exchange.h). The processes are threads here,
 * which exchange through common memory.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>

#include "rank_threads.h"
#include "train/state/chunk_exchange.h"
#include "train/state/view_exchange.h"

enum { SIZE = (1 << 22) + 1000, STRIDE = 997 };

/* What the ranks of one run have in common. */
static struct {
    size_t n_views;
    float *sum[MOST_RANKS];
} run;

typedef struct {
    ted4_exchange x;
    ted4_view_sums sums;
    int first;
} process;

/* Value i of a view: sums of three such numbers depend on their order. */
static float value(size_t view, size_t i)
{
    return 1.0f / (float)(3 + view * 7 + i % STRIDE) * (view % 3 == 1 ? -1e4f : 1.0f);
}

static float tree(size_t from, size_t to, size_t i)
{
    size_t half = 1;

    if (to - from == 1)
        return value(from, i);
    while (2 * half < to - from)
        half *= 2;
    return tree(from, from + half, i) + tree(from + half, to, i);
}

/* One process: draws its views, and sums over all. */
static void *work(void *arg)
{
    process *p = arg;
    size_t first, end;

    ted4_exchange_views(&p->x, run.n_views, &first, &end);
    assert_int_equal(ted4_view_sums_begin(&p->sums, SIZE, end > first ? end - first : 1), 0);
    for (size_t view = first; view < end; view++) {
        float *to = ted4_view_sums_next(&p->sums);

        for (size_t i = 0; i < SIZE; i++)
            to[i] = value(view, i);
        ted4_view_sums_add(&p->sums, NULL);
    }
    run.sum[p->x.rank] = ted4_view_sums_total(&p->sums, NULL);
    assert_int_equal(ted4_view_exchange(&p->x, &p->sums, 0, run.n_views, NULL), 0);
    p->first = ted4_exchange_first(&p->x, p->x.rank < 2 ? 0 : (int)p->x.rank);
    return NULL;
}

static void start(process *p, size_t n, size_t n_views)
{
    run.n_views = n_views;
    memset(p, 0, n * sizeof *p);
    rank_run(n, p, sizeof *p, work);
}

static void test_sums(void **state)
{
    static const struct {
        size_t ranks, views;
    } runs[] = { { 1, 4 },  { 2, 2 }, { 2, 4 }, { 2, 3 }, { 3, 4 },
                 { 3, 16 }, { 4, 2 }, { 4, 7 }, { 5, 5 }, { 6, 13 } };
    static process p[MOST_RANKS];

    (void)state;
    for (size_t k = 0; k < sizeof runs / sizeof runs[0]; k++) {
        const size_t n = runs[k].ranks;

        start(p, n, runs[k].views);
        for (size_t r = 0; r < n; r++) {
            for (size_t i = 0; i < SIZE; i += i < STRIDE || i + 1000 > SIZE ? 1 : STRIDE / 2)
                assert_true(run.sum[r][i] == tree(0, runs[k].views, i));
            assert_int_equal(p[r].first, n > 2 ? 2 : 0);
            assert_true(n == 1 || p[r].x.bytes > 0);
            ted4_view_sums_finish(&p[r].sums);
        }
    }
}

/* Sums over chunks: what the ranks of one run have in common. */
enum { CHUNK_SIZE = 1003, MOST_CHUNKS = 32 };

static struct {
    size_t n;
    int add;
} chunks;

typedef struct {
    ted4_exchange x;
    ted4_view_sums sums;
    float chunk[MOST_CHUNKS][CHUNK_SIZE], to[CHUNK_SIZE];
} chunk_process;

static void *add_chunks(void *arg)
{
    chunk_process *p = arg;
    const size_t from = ted4_chunk_first(&p->x, p->x.rank, chunks.n);
    const size_t to = ted4_chunk_first(&p->x, p->x.rank + 1, chunks.n);
    const float *chunk[MOST_CHUNKS];

    for (size_t i = 0; i < CHUNK_SIZE; i++)
        p->to[i] = value(chunks.n, i);
    for (size_t c = 0; c < chunks.n; c++) {
        chunk[c] = p->chunk[c];
        for (size_t i = 0; i < CHUNK_SIZE; i++)
            p->chunk[c][i] = c >= from && c < to ? value(c, i) : NAN;
    }
    assert_int_equal(
        ted4_chunk_exchange(&p->x, &p->sums, chunk, chunks.n, CHUNK_SIZE, chunks.add, p->to), 0);
    return NULL;
}

static void test_chunks(void **state)
{
    static const struct {
        size_t ranks, chunks;
        int add;
    } runs[] = { { 2, 32, 0 }, { 3, 32, 1 }, { 6, 5, 1 }, { 6, 1, 0 }, { 5, 14, 1 } };
    static chunk_process p[MOST_RANKS];

    (void)state;
    for (size_t k = 0; k < sizeof runs / sizeof runs[0]; k++) {
        memset(p, 0, sizeof p);
        chunks.n = runs[k].chunks;
        chunks.add = runs[k].add;
        rank_run(runs[k].ranks, p, sizeof *p, add_chunks);
        for (size_t i = 0; i < CHUNK_SIZE; i++) {
            float sum = chunks.add ? value(chunks.n, i) + value(0, i) : value(0, i);

            for (size_t c = 1; c < chunks.n; c++)
                sum += value(c, i);
            for (size_t r = 0; r < runs[k].ranks; r++)
                assert_true(p[r].to[i] == sum);
        }
        for (size_t r = 0; r < runs[k].ranks; r++)
            ted4_view_sums_finish(&p[r].sums);
    }
}

/* Each view belongs to one rank, ranges are nodes of the tree, and no rank has more than twice its
 * share. One view alone belongs to all. */
static void test_views(void **state)
{
    (void)state;
    for (size_t n = 1; n <= TED4_MAX_RANKS; n++)
        for (size_t views = 1; views <= TED4_MAX_VIEWS; views++) {
            size_t next = 0, drawing = 0;

            for (size_t r = 0; r < n; r++) {
                const ted4_exchange x = { .rank = r, .n = n };
                size_t first, end, span = 1;

                ted4_exchange_views(&x, views, &first, &end);
                if (views == 1) {
                    assert_true(first == 0 && end == 1);
                    next = drawing = 1;
                    continue;
                }
                while (span < end - first)
                    span *= 2;
                assert_true(first == next && end >= first);
                assert_true(end == first || first % span == 0);
                assert_true(end == views || end - first == span);
                assert_true(end - first < 2 * ((views + n - 1) / n));
                next = end;
                drawing += end > first;
                assert_int_equal(ted4_exchange_drawing(&x, views),
                                 ted4_exchange_drawing(&(ted4_exchange) { .n = n }, views));
            }
            assert_int_equal(next, views);
            assert_int_equal(drawing, ted4_exchange_drawing(&(ted4_exchange) { .n = n }, views));
        }
}

static void test_alone(void **state)
{
    size_t first, end;
    int mine = 7, all = 0;

    (void)state;
    ted4_exchange_views(NULL, 13, &first, &end);
    assert_true(first == 0 && end == 13);
    assert_int_equal(ted4_exchange_drawing(NULL, 13), 1);
    ted4_exchange_gather(NULL, &mine, sizeof mine, &all);
    assert_int_equal(all, 7);
    assert_int_equal(ted4_exchange_first(NULL, 3), 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(test_sums), cmocka_unit_test(test_views),
                                        cmocka_unit_test(test_alone),
                                        cmocka_unit_test(test_chunks) };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
