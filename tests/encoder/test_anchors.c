/* test_anchors.c - voxel sets (train/math/voxel_set.h) and blocks of anchors
 * (train/model/anchors.h).
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdlib.h>

#include "test.h"
#include "anchor_checks.h"
#include "cloud_case.h"
#include "train/math/voxel_set.h"

static cloud_case cloud;

/* ---- voxels ---- */

static void test_voxel_set(void **state)
{
    enum { N = 5000 };
    ted4_voxel_set c;

    (void)state;
    assert_int_equal(ted4_voxel_set_init(&c, N), 0);
    for (int round = 0; round < 2; round++) {
        for (uint64_t i = 0; i < N; i++)
            assert_int_equal(ted4_voxel_set_add(&c, i * i + 1), 1);
        for (uint64_t i = 0; i < N; i++)
            assert_int_equal(ted4_voxel_set_add(&c, i * i + 1), 0);
        assert_int_equal(c.n, N);
        ted4_voxel_set_clear(&c);
        assert_int_equal(c.n, 0);
    }
    ted4_voxel_set_finish(&c);
    assert_int_equal(ted4_voxel_set_init(&c, 0), 0);
    ted4_voxel_set_finish(&c);
}

/* Points of one voxel share a key, neighbouring voxels never do, even in the finest grid. */
static void test_voxel_key(void **state)
{
    static const double sizes[] = { 2, 0.3, 0.01, 0x1p-19 };

    (void)state;
    for (size_t s = 0; s < sizeof sizes / sizeof sizes[0]; s++)
        for (uint64_t i = 0; i < 500; i++) {
            const double voxel = sizes[s], most = floor(1 / voxel) - 2;
            double at[3];
            float p[3], q[3];
            uint64_t key;

            for (uint64_t j = 0; j < 3; j++) {
                at[j] = rint((2 * (double)ted4_uniform(i, j) - 1) * fmax(most, 0));
                p[j] = (float)(at[j] * voxel);
                const double off = s < 3 ? 0.9 * ((double)ted4_uniform(i, 3 + j) - 0.5) : 0;

                q[j] = (float)((at[j] + off) * voxel);
            }
            key = ted4_voxel_key(p, voxel);
            assert_int_not_equal(key, 0);
            assert_int_equal(key, ted4_voxel_key(q, voxel));
            for (int j = 0; j < 6; j++) {
                memcpy(q, p, sizeof q);
                q[j / 2] = (float)((at[j / 2] + (j % 2 ? 1 : -1)) * voxel);
                assert_int_not_equal(ted4_voxel_key(q, voxel), key);
            }
        }
}

/* ---- blocks of anchors ---- */

/* A number that identifies anchor, kind of row and row. */
static float mark(size_t i, int kind, int row)
{
    return (float)(1 + i) + 0.001f * (float)row + 10000.0f * (float)kind;
}

static void mark_all(ted4_anchors *a)
{
    for (int k = 0; k < TED4_ROWS; k++)
        for (size_t i = 0; i < a->n; i++)
            for (int r = 0; r < a->rows[k]; r++)
                *ted4_anchor_value(a, (ted4_row)k, i, r) = mark(i, k, r);
}

/* Asserts that anchor i holds the marks that anchor was had. */
static void check_marks(const ted4_anchors *a, size_t i, size_t was)
{
    for (int k = 0; k < TED4_ROWS; k++)
        for (int r = 0; r < a->rows[k]; r++)
            if (k != TED4_ROW_POSITION)
                assert_true(*ted4_anchor_value(a, (ted4_row)k, i, r) == mark(was, k, r));
}

static void test_resize(void **state)
{
    static const size_t sizes[] = { 1, 31, 32, 33, 64, 40, 400, 399, 65, 2, 0, 5, 1000 };
    ted4_trainer t;
    ted4_anchors a;

    (void)state;
    cloud_make(&cloud, 5);
    cloud_begin(&cloud, &t);
    assert_int_equal(ted4_anchors_init(&a, &t.layout), 0);
    anchors_check(&a);
    for (size_t s = 0; s < sizeof sizes / sizeof sizes[0]; s++) {
        const size_t before = a.n, kept = before < sizes[s] ? before : sizes[s];

        mark_all(&a);
        assert_int_equal(ted4_anchors_resize(&a, sizes[s]), 0);
        assert_int_equal(a.n, sizes[s]);
        anchors_check(&a);
        for (size_t i = 0; i < kept; i++)
            check_marks(&a, i, i);
        for (size_t i = kept; i < a.n; i++)
            for (int k = 0; k < TED4_ROWS; k++)
                for (int r = 0; r < a.rows[k]; r++)
                    assert_true(*ted4_anchor_value(&a, (ted4_row)k, i, r) == 0.0f);
    }
    ted4_anchors_finish(&a);
    ted4_trainer_finish(&t);
}

static void test_select(void **state)
{
    enum { N = 75, KEPT = 41 };
    ted4_trainer t;
    uint32_t order[N];

    (void)state;
    cloud_make(&cloud, 5);
    cloud_begin(&cloud, &t);
    assert_int_equal(ted4_anchors_resize(&t.anchors, N), 0);
    mark_all(&t.anchors);
    for (uint32_t i = 0; i < N; i++)
        order[i] = i * 7 % N; /* 7 and 75 have no common factor */
    assert_int_equal(ted4_anchors_select(&t.anchors, order, KEPT), 0);
    assert_int_equal(t.anchors.n, KEPT);
    anchors_check(&t.anchors);
    for (size_t i = 0; i < KEPT; i++)
        check_marks(&t.anchors, i, order[i]);
    assert_int_equal(ted4_anchors_select(&t.anchors, order, 0), 0);
    anchors_check(&t.anchors);
    ted4_trainer_finish(&t);
}

/* Morton order of binary16 positions; anchors with equal positions keep their order. */
static void test_sort(void **state)
{
    enum { N = 200 };
    ted4_trainer t;
    ted4_anchors *a = &t.anchors;
    int ties = 0;

    (void)state;
    cloud_make(&cloud, 5);
    cloud_begin(&cloud, &t);
    assert_int_equal(ted4_anchors_resize(a, N), 0);
    mark_all(a);
    for (size_t i = 0; i < N; i++)
        for (int j = 0; j < 3; j++) /* the last 50 nearly coincide with the first */
            *ted4_anchor_value(a, TED4_ROW_POSITION, i, j) =
                (2.0f * ted4_uniform((uint64_t)j, i % 150) - 1.0f) *
                (i < 150 ? 1.0f : 1.0f + 0x1p-23f);
    assert_int_equal(ted4_anchors_sort(a, NULL), 0);
    anchors_check(a);
    for (size_t i = 0; i < N; i++) {
        const float was = *ted4_anchor_value(a, TED4_ROW_VALUE, i, 0) - 1.0f;

        check_marks(a, i, (size_t)was);
        if (i == 0)
            continue;
        assert_true(anchors_morton(a, i - 1) <= anchors_morton(a, i));
        if (anchors_morton(a, i - 1) == anchors_morton(a, i)) {
            ties++;
            assert_true(*ted4_anchor_value(a, TED4_ROW_VALUE, i - 1, 0) < was + 1.0f);
        }
    }
    assert_true(ties >= 45);
    ted4_trainer_finish(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_voxel_set), cmocka_unit_test(test_voxel_key),
        cmocka_unit_test(test_resize),    cmocka_unit_test(test_select),
        cmocka_unit_test(test_sort),
    };

    return cmocka_run_group_tests_name("anchors", tests, NULL, NULL);
}
