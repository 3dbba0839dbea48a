/* test_choose_spans.c - train/step/choose_spans.c: what changes no picture takes the cheapest
 * symbol, the change of activation is that of spec 11.4, and the file has what was chosen.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>

#include "cloud_case.h"
#include "norm/half.h"
#include "norm/scene.h"
#include "norm/tables.h"
#include "test.h"
#include "train/math/random.h"
#include "train/step/choose_spans.h"
#include "train/step/export_scene.h"
#include "train/step/stages.h"
#include "write/encode.h"

enum { FRAMES = 9, LONG = 1501, TIMES = 2 * LONG - 1, SPANS = 300, LONG_SPANS = 40, WIDE = 40 };
#define assert_near(a, b, most) assert_true(fabs((a) - (b)) <= (most))
#define MOST_BITS               (4 * 32) /* more than any span takes */
#define WORTH                   1e-5 /* as choose_spans.h has it: a mean squared change per bit */

/* Symbols with a step of 1/16: a_s and a_f from -2 to 3, widths from 2^-6 to 2^2. */
static ted4_coded_span random_span(uint64_t seed)
{
    ted4_coded_span s = { .step = 0.0625f };

    for (int i = 0; i < TED4_SPAN_PARTS; i++) {
        const uint64_t r = ted4_mix(seed * 8 + (uint64_t)i);
        const int low = i % 2 ? -96 : -32, n = i % 2 ? 128 : 80;

        s.k[i] = low + (int)(r % (uint64_t)n);
        s.mu[i] = (low + (int)((r >> 16) % (uint64_t)n)) * 256 + (int)((r >> 32) % 256);
        s.sigma[i] = (uint8_t)(64 + (r >> 40) % 64);
    }
    if (s.k[0] > s.k[2])
        s.k[2] = s.k[0];
    return s;
}

static double activation(const ted4_coded_span *s, double t)
{
    const double q = (double)s->step, start = s->k[0] * q, end = s->k[2] * q;
    const double b = fmax(exp2(s->k[t < start ? 1 : 3] * q), 0x1p-12);
    const double u = t < start ? (t - start) / b : t > end ? (t - end) / b : 0;

    return exp(-u * u);
}

static double change(const ted4_coded_span *a, const ted4_coded_span *b, int frames)
{
    const int n = 2 * frames - 1;
    double sum = 0;

    for (int i = 0; i < n; i++) {
        const double t = n > 1 ? (double)i / (n - 1) : 0;

        sum += pow(activation(a, t) - activation(b, t), 2) / n;
    }
    return sum;
}

static double measured_change(const ted4_coded_span *a, const ted4_coded_span *b, int frames)
{
    const size_t n = ted4_span_n_times((uint32_t)frames);
    static float time[TIMES], activation[2][TIMES];
    double sum = 0;

    for (size_t i = 0; i < n; i++)
        time[i] = ted4_span_time(i, n);
    ted4_span_activation(a, time, n, activation[0]);
    ted4_span_activation(b, time, n, activation[1]);
    for (size_t i = 0; i < n; i++)
        sum += pow((double)activation[0][i] - (double)activation[1][i], 2);
    return sum / (double)n;
}

static double cost(const ted4_coded_span *s, const ted4_coded_span *given, int frames)
{
    return measured_change(s, given, frames) + WORTH * ted4_span_bits(s);
}

static void choose(ted4_coded_span *s, int frames)
{
    ted4_span_choose(s, ted4_span_n_times((uint32_t)frames));
}

static void test_change(void **state)
{
    (void)state;
    for (uint64_t i = 0; i < SPANS; i++)
        for (int frames = 1; frames <= FRAMES; frames += 4) {
            const ted4_coded_span a = random_span(i), b = random_span(i + SPANS);

            assert_near(measured_change(&a, &b, frames), change(&a, &b, frames), 1e-5);
        }
}

/* Edges before the first frame and after the last: whatever they are, activation is 1. */
static void test_out_of_sight(void **state)
{
    const ted4_coded_span always = {
        .step = 0.0625f,
        .mu = { -5 * 256, 7 * 256, 20 * 256 + 100, -9 * 256 - 100 },
        .sigma = { 90, 90, 90, 90 },
        .k = { -30, 50, 70, -60 },
    };
    const int want[TED4_SPAN_PARTS] = { -5, 7, 20, -9 };
    ted4_coded_span s = always;

    (void)state;
    choose(&s, FRAMES);
    for (int i = 0; i < TED4_SPAN_PARTS; i++)
        assert_int_equal(s.k[i], want[i]);
    assert_near(measured_change(&s, &always, FRAMES), 0, 0);
    s = always;
    s.k[1] = -20;      /* a steep edge */
    s.mu[0] = 8 * 256; /* in the middle of the sequence, where the edge must not follow */
    s.mu[1] = -20 * 256;
    choose(&s, FRAMES);
    assert_in_range(s.k[0], 0, 1);
    assert_true(measured_change(&s, &always, FRAMES) < 1e-3);
}

/* No choice costs more than the given symbols; symbols lie between those and their means. */
static void test_never_worse(void **state)
{
    int changed = 0;

    (void)state;
    for (uint64_t i = 0; i < SPANS; i++) {
        const ted4_coded_span given = random_span(i);
        ted4_coded_span s = given;

        choose(&s, FRAMES);
        assert_true(cost(&s, &given, FRAMES) <= cost(&given, &given, FRAMES));
        assert_true(s.k[0] <= s.k[2]);
        for (int part = 0; part < TED4_SPAN_PARTS; part++) {
            const int mean = ted4_round_shift(s.mu[part], TED4_MU_BITS), from = given.k[part];

            assert_true(from < mean ? s.k[part] >= from && s.k[part] <= mean
                                    : s.k[part] <= from && s.k[part] >= mean);
            changed += s.k[part] != from;
        }
    }
    assert_true(changed > SPANS / 2);
}

/* Asserts that one symbol, the others being at their means, becomes the cheapest of all between its
 * own and its mean: the search does not end too soon, and leaves out no time that matters. It
 * relies on bits that only become fewer on the way to the mean, which is wrong by a bit where
 * escapes begin and frequencies are rounded. */
static void check_cheapest(ted4_coded_span given, int part, int frames)
{
    const int mean = ted4_round_shift(given.mu[part], TED4_MU_BITS);
    ted4_coded_span s, any;
    double least = INFINITY;

    for (int other = 0; other < TED4_SPAN_PARTS; other++)
        given.mu[other] = other == part ? given.mu[other] : given.k[other] * 256;
    s = any = given;
    choose(&s, frames);
    for (;; any.k[part] += mean > any.k[part] ? 1 : -1) {
        if (any.k[0] <= any.k[2])
            least = fmin(least, cost(&any, &given, frames));
        if (any.k[part] == mean)
            break;
    }
    assert_near(cost(&s, &given, frames), least, WORTH * 1.001);
}

static void test_cheapest(void **state)
{
    (void)state;
    for (uint64_t i = 0; i < SPANS; i++)
        for (int part = 0; part < TED4_SPAN_PARTS; part++) {
            check_cheapest(random_span(i), part, FRAMES);
            if (i < LONG_SPANS)
                check_cheapest(random_span(i), part, LONG);
        }
}

static cloud_case cloud;

/* span: a_s, log2 b_s, a_f, log2 b_f of the first anchor; spread: how far the others differ. */
static void begin(ted4_trainer *t, const float span[TED4_SPAN_PARTS], float spread)
{
    cloud_make(&cloud, FRAMES);
    cloud_begin(&cloud, t);
    for (size_t i = 0; i < t->anchors.n; i++)
        for (int c = 0; c < TED4_SPAN_PARTS; c++)
            *ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i, t->layout.first[TED4_TAU] + c) =
                span[c] - spread * (float)(i % WIDE);
    assert_int_equal(ted4_stage2_begin(t), 0);
    assert_int_equal(ted4_integer_begin(t), 0);
    assert_int_equal(t->layout.head.activation, 1);
}

/* The file that such a trainer makes; the caller frees it. bits: of tau in the file, and by the
 * trainer's own count. */
static ted4_scene *export_with(const float span[TED4_SPAN_PARTS], float spread, int capacity,
                               double bits[2])
{
    double estimate[TED4_TYPES];
    ted4_trainer t;
    ted4_scene *s;
    ted4_bits file;

    begin(&t, span, spread);
    t.opt.capacity = capacity;
    assert_int_equal(ted4_export_scene(&t, &s), 0);
    assert_int_equal(ted4_count(s, NULL, &file, NULL), TED4_OK);
    assert_int_equal(ted4_integer_rate(&t, estimate), 0);
    bits[0] = file.type[TED4_TAU];
    bits[1] = estimate[TED4_TAU];
    ted4_trainer_finish(&t);
    return s;
}

/* With --capacity auto the file has fewer bits of spans, with fixed it has the nearest symbols; the
 * trainer's estimate is that of the file. */
static void test_exported(void **state)
{
    static const float span[TED4_SPAN_PARTS] = { -0.4f, -3, 0.7f, -3 };
    double bits[2][2];

    (void)state;
    for (int capacity = 0; capacity < 2; capacity++) {
        ted4_scene_free(export_with(span, 0.003f, capacity, bits[capacity]));
        assert_near(bits[capacity][1], bits[capacity][0], 0.02 * bits[capacity][0] + 8);
    }
    assert_true(bits[1][0] < 0.95 * bits[0][0]);
}

static ted4_coded_span file_span(const ted4_scene *s, size_t i)
{
    ted4_coded_span span = { .step = s->head.step[TED4_TAU] *
                                     ted4_bits_float(ted4_step[s->step_index[TED4_TAU][i]]) };

    for (int c = 0; c < TED4_SPAN_PARTS; c++)
        span.k[c] = s->symbol[TED4_TAU][(size_t)c * s->head.n_anchors + i];
    return span;
}

/* Training may leave the end before the start, where the file has both at the start. What is chosen
 * changes the activation of that file only as much as its bits are worth. */
static void test_crossed(void **state)
{
    static const float span[TED4_SPAN_PARTS] = { -0.02f, -2, -0.5f, -1 };
    double bits[2][2];
    ted4_scene *nearest = export_with(span, 0.004f, 0, bits[0]);
    ted4_scene *chosen = export_with(span, 0.004f, 1, bits[1]);
    size_t moved = 0;

    (void)state;
    assert_true(nearest->head.n_anchors == chosen->head.n_anchors && nearest->head.n_anchors > 0);
    for (size_t i = 0; i < nearest->head.n_anchors; i++) {
        const ted4_coded_span a = file_span(nearest, i), b = file_span(chosen, i);

        assert_int_equal(a.k[0], a.k[2]);
        moved += a.k[0] != b.k[0];
        assert_true(measured_change(&a, &b, FRAMES) <= WORTH * MOST_BITS);
    }
    assert_true(moved > 0);
    ted4_scene_free(nearest);
    ted4_scene_free(chosen);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_change),      cmocka_unit_test(test_out_of_sight),
        cmocka_unit_test(test_never_worse), cmocka_unit_test(test_cheapest),
        cmocka_unit_test(test_exported),    cmocka_unit_test(test_crossed),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
