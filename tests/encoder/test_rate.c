/* test_rate.c - the files of train/rate: bits against the model in double precision, the noise, the
 * quantiser, threads, unused lanes, the integer mode, and clamped outputs (annex D.1: sigma clamped
 * from below, steps near 0).
 * SPDX-License-Identifier: BSD-2-Clause */
#include "test.h"
#include "larger.h"
#include "tool/threads.h"
#include "norm/prior.h"
#include "odd_threads.h"
#include "rate_ref.h"
#include "train/rate/rate_parts.h"

static int close_to(double got, double want, double relative, double absolute)
{
    return fabs(got - want) <= absolute + relative * fabs(want);
}

static void fill_noise(ref_world *w, float *noise[REF_BLOCKS])
{
    for (int i = 0; i < REF_BLOCKS; i++) {
        noise[i] = ref_floats((size_t)w->layout.n_channels * TED4_LANES);
        ref_noise(w, i, noise[i]);
    }
}

/* Compares the bits of every type, and the steps, with the model in double precision, for any set
 * of used lanes. */
static void check_world(ref_world *w)
{
    double bits[TED4_TYPES], want[TED4_TYPES] = { 0 }, total = 0.0;
    float *noise[REF_BLOCKS];

    w->lanes[1] = 0x80f00f05u;
    fill_noise(w, noise);
    assert_int_equal(ref_run(w, NULL, bits), 0);
    const ref_model m = ref_model_make(w);

    for (int i = 0; i < REF_BLOCKS; i++)
        for (int j = 0; j < TED4_LANES; j++) {
            ref_anchor a;
            ref_result r;

            if (!(w->lanes[i] >> j & 1))
                continue;
            ref_anchor_make(w, &m, i, j, noise[i], &a);
            ref_evaluate(&m, &a, NULL, &r);
            for (int t = 0; t < TED4_TYPES; t++) {
                want[t] += r.bits[t];
                total += r.bits[t];
                assert_true(
                    close_to((double)w->steps[i][t * TED4_LANES + j], r.steps[t], 1e-5, 0.0));
            }
        }
    assert_true(total > 100.0);
    for (int t = 0; t < TED4_TYPES; t++)
        assert_true(close_to(bits[t], want[t], 1e-5, 1e-3));
    for (int i = 0; i < REF_BLOCKS; i++)
        free(noise[i]);
}

static void variant(ted4_header *h, int which)
{
    *h = ref_header();
    if (which == 1)
        h->prior = TED4_PRIOR_FACTORISED, h->pe_octaves = h->hyper_layers = 0, h->hyper_width = 0;
    if (which == 2)
        h->n_slices = 1, h->slice[0] = h->feature_dim, h->ar_width = 0;
    if (which == 3)
        h->motion = TED4_MOTION_NONE, h->phi_dim = 0, h->bank_rows = 0, h->bank_dim = 0,
        h->deform_layers = 0, h->deform_width = 0, h->temporal_mask = h->activation = 0;
    if (which == 4)
        h->offset_mask = h->temporal_mask = 0, h->hyper_layers = 0, h->hyper_width = 0;
}

enum { VARIANTS = 6 }; /* the last variant: static phase */

static void test_values(void **state)
{
    (void)state;
    for (int which = 0; which < VARIANTS; which++)
        for (int quant = TED4_QUANT_NOISE; quant <= TED4_QUANT_ROUND; quant++) {
            static ref_world w;
            ted4_header h;

            variant(&h, which);
            ref_world_make(&w, &h);
            w.in.quant = (ted4_quant)quant;
            w.in.activation = which != VARIANTS - 1;
            check_world(&w);
            ref_world_finish(&w);
        }
}

/* NaN in unused lanes has no effect on sums, gradients or steps of the other lanes. */
static void test_unused_lanes(void **state)
{
    static ref_world w;
    const ted4_header h = ref_header();
    double bits[TED4_TYPES], again[TED4_TYPES];

    (void)state;
    ref_world_make(&w, &h);
    const size_t block = (size_t)w.layout.n_channels * TED4_LANES;
    float *d_net = ref_floats(w.layout.n_net), *d_attr = ref_floats(block);

    w.lanes[2] = 0x00ff0ff0u;
    assert_int_equal(ref_run(&w, NULL, bits), 0);
    memcpy(d_net, w.d_net, w.layout.n_net * sizeof *d_net);
    memcpy(d_attr, w.d_attr[2], block * sizeof *d_attr);
    for (size_t i = 0; i < block; i++)
        if (!(w.lanes[2] >> i % TED4_LANES & 1)) {
            assert_true(w.d_attr[2][i] == 0.0f);
            w.attr[2][i] = w.d_value[2][i] = NAN;
            w.position[2][i % (3 * TED4_LANES)] = NAN;
        }
    assert_int_equal(ref_run(&w, NULL, again), 0);
    assert_memory_equal(bits, again, sizeof bits);
    assert_memory_equal(d_net, w.d_net, w.layout.n_net * sizeof *d_net);
    assert_memory_equal(d_attr, w.d_attr[2], block * sizeof *d_attr);
    free(d_net);
    free(d_attr);
    ref_world_finish(&w);
}

/* Mean 0, variance 1/12, a flat distribution, and no correlation between channels, lanes, blocks or
 * keys: each within 5 standard deviations. */
static void test_noise(void **state)
{
    static ref_world w;
    const ted4_header h = ref_header();
    enum { BLOCKS = 2048 };
    double sum = 0.0, square = 0.0, bins[16] = { 0 }, n = 0.0;
    double channels = 0.0, lanes = 0.0, blocks = 0.0, keys = 0.0;

    (void)state;
    ref_world_make(&w, &h);
    const size_t size = (size_t)w.layout.n_channels * TED4_LANES;
    const int count = w.layout.offset_logit;
    float *now = ref_floats(size), *before = ref_floats(size), *other = ref_floats(size);

    for (uint32_t b = 0; b < BLOCKS; b++) {
        w.block[0] = b;
        w.in.key = 5;
        ref_noise(&w, 0, now);
        w.in.key = 6;
        ref_noise(&w, 0, other);
        for (int c = 0; c < count; c++)
            for (int j = 0; j < TED4_LANES; j++) {
                const double u = (double)now[c * TED4_LANES + j];

                assert_true(u > -0.5);
                assert_true(u < 0.5);
                sum += u;
                square += u * u;
                bins[(int)((u + 0.5) * 16.0)] += 1.0;
                n += 1.0;
                lanes += u * (double)now[c * TED4_LANES + (j + 1) % TED4_LANES];
                channels += u * (double)now[(c + 1) % count * TED4_LANES + j];
                blocks += u * (double)before[c * TED4_LANES + j];
                keys += u * (double)other[c * TED4_LANES + j];
            }
        memcpy(before, now, size * sizeof *now);
    }
    const double five = 5.0 / sqrt(n); /* 5 standard deviations of a mean of n */

    assert_true(fabs(sum / n) < five * sqrt(1.0 / 12.0));
    assert_true(fabs(square / n - 1.0 / 12.0) < five * sqrt(1.0 / 180.0));
    for (int i = 0; i < 16; i++)
        assert_true(fabs(bins[i] / n - 1.0 / 16.0) < five * 0.25);
    assert_true(fabs(lanes / n) < five / 12.0);
    assert_true(fabs(channels / n) < five / 12.0);
    assert_true(fabs(blocks / n) < five / 12.0);
    assert_true(fabs(keys / n) < five / 12.0);
    free(now);
    free(before);
    free(other);
    ref_world_finish(&w);
}

/* Values become k q with the nearest k within the range of symbols; logits are unchanged; a_f is
 * never before a_s, in either mode. */
static void test_quantise(void **state)
{
    static ref_world w;
    const ted4_header h = ref_header();

    (void)state;
    ref_world_make(&w, &h);
    const ted4_layout *l = &w.layout;
    const size_t size = (size_t)l->n_channels * TED4_LANES;
    const int tau = l->first[TED4_TAU];
    float *out = ref_floats(size), *steps = w.steps[0];

    for (int i = 0; i < TED4_TYPES * TED4_LANES; i++)
        steps[i] = (float)(0.02 + 0.01 * ref_uniform());
    w.attr[0][3] = 1e9f;
    w.attr[0][4] = -1e9f;
    w.attr[0][5] = 40000.0f * steps[5];
    w.attr[0][6] = -40000.0f * steps[6];
    for (int quant = TED4_QUANT_NOISE; quant <= TED4_QUANT_ROUND; quant++) {
        int raised = 0;

        ted4_quantise(l, (ted4_quant)quant, w.attr[0], steps, 3, 9, out);
        for (int t = 0; t < TED4_TYPES; t++)
            for (size_t i = 0; i < l->shape.dim[t] * (size_t)TED4_LANES; i++) {
                const size_t at = (size_t)l->first[t] * TED4_LANES + i;
                const float q = steps[(size_t)t * TED4_LANES + i % TED4_LANES];
                const float k = rintf(w.attr[0][at] / q);

                if (t == TED4_TAU && i / TED4_LANES == 2)
                    continue;
                if (quant == TED4_QUANT_ROUND)
                    assert_true(out[at] == fminf(fmaxf(k, -32767.0f), 32767.0f) * q);
                else
                    assert_true(fabsf(out[at] - w.attr[0][at]) <=
                                q * 0.5f + 1e-6f * fabsf(w.attr[0][at]));
            }
        for (int j = 0; j < TED4_LANES; j++) {
            const float start = out[tau * TED4_LANES + j];
            const float end = out[(tau + 2) * TED4_LANES + j];

            assert_true(start <= end);
            raised += start == end;
        }
        assert_true(raised > 4);
        assert_memory_equal(out + l->offset_logit * TED4_LANES,
                            w.attr[0] + l->offset_logit * TED4_LANES,
                            (size_t)(l->n_channels - l->offset_logit) * TED4_LANES * sizeof *out);
    }
    free(out);
    ref_world_finish(&w);
}

/* More visible blocks than a wave takes. */
enum { MANY = TED4_RATE_CHUNK * TED4_RATE_WAVE + 21 };

typedef struct {
    ref_world w;
    const float *attr[MANY], *position[MANY];
    float *d_attr[MANY], *steps[MANY], *d_net;
    uint32_t lanes[MANY], block[MANY];
    ted4_rate_input in;
    double bits[TED4_TYPES];
} crowd;

static void crowd_make(crowd *c)
{
    const ted4_header h = ref_header();

    ref_world_make(&c->w, &h);
    for (uint32_t i = 0; i < MANY; i++) {
        c->attr[i] = c->w.attr[i % REF_BLOCKS];
        c->position[i] = c->w.position[i % REF_BLOCKS];
        c->d_attr[i] = ref_floats((size_t)c->w.layout.n_channels * TED4_LANES);
        c->steps[i] = ref_floats(TED4_TYPES * TED4_LANES);
        c->lanes[i] = ~i;
        c->block[i] = i;
    }
    c->d_net = ref_floats(c->w.layout.n_net);
    c->in = c->w.in;
    c->in.attr = c->attr;
    c->in.position = c->position;
    c->in.lanes = c->lanes;
    c->in.block = c->block;
    ted4_rate_pack(c->w.rate, c->w.net);
}

static void crowd_finish(crowd *c)
{
    for (int i = 0; i < MANY; i++) {
        free(c->d_attr[i]);
        free(c->steps[i]);
    }
    free(c->d_net);
    ref_world_finish(&c->w);
}

/* Runs n visible blocks, starting at first, with gradients from zero. Returns a hash of the
 * gradients of the values. */
static uint64_t crowd_run(crowd *c, const ted4_parallel *p, size_t first, size_t n)
{
    const size_t size = (size_t)c->w.layout.n_channels * TED4_LANES;
    uint64_t sum = 0;

    c->in.n_visible = n;
    c->in.attr = c->attr + first;
    c->in.position = c->position + first;
    c->in.lanes = c->lanes + first;
    c->in.block = c->block + first;
    for (size_t i = first; i < first + n; i++)
        memset(c->d_attr[i], 0, size * sizeof(float));
    memset(c->d_net, 0, c->w.layout.n_net * sizeof(float));
    assert_int_equal(ted4_rate_evaluate(c->w.rate, &c->in, p, NULL, c->d_attr + first, c->d_net,
                                        c->steps + first, c->bits),
                     0);
    for (size_t i = first; i < first + n; i++)
        for (size_t j = 0; j < size; j++)
            sum = sum * 0x9e3779b97f4a7c15u + ted4_float_bits(c->d_attr[i][j]);
    return sum;
}

/* All results are bit-identical in any order and for any number of threads. */
static void test_threads(void **state)
{
    static crowd c;
    ted4_parallel runs[2] = { { odd_backwards, NULL } };
    double bits[TED4_TYPES];

    (void)state;
    crowd_make(&c);
    ted4_threads_init(&runs[1], 3);
    const size_t net = c.w.layout.n_net * sizeof(float);
    float *d_net = ref_floats(c.w.layout.n_net);
    const uint64_t sum = crowd_run(&c, NULL, 0, MANY);

    memcpy(bits, c.bits, sizeof bits);
    memcpy(d_net, c.d_net, net);
    for (int i = 0; i < 2; i++) {
        assert_int_equal(crowd_run(&c, &runs[i], 0, MANY), sum);
        assert_memory_equal(bits, c.bits, sizeof bits);
        assert_memory_equal(d_net, c.d_net, net);
    }
    free(d_net);
    crowd_finish(&c);
}

/* Chunks and waves lose nothing: the result for all visible blocks is the sum of the results for
 * single ones. */
static void test_sums(void **state)
{
    static crowd c;
    double bits[TED4_TYPES] = { 0 };

    (void)state;
    crowd_make(&c);
    const size_t n = c.w.layout.n_net;
    double *d_net = calloc(n, sizeof *d_net), scale = 0.0;

    for (size_t i = 0; i < MANY; i++) {
        crowd_run(&c, NULL, i, 1);
        for (int t = 0; t < TED4_TYPES; t++)
            bits[t] += c.bits[t];
        for (size_t j = 0; j < n; j++)
            d_net[j] += (double)c.d_net[j];
    }
    crowd_run(&c, NULL, 0, MANY);
    for (int t = 0; t < TED4_TYPES; t++)
        assert_true(close_to(c.bits[t], bits[t], 1e-12, 0.0));
    for (size_t j = 0; j < n; j++)
        scale = larger(scale, fabs(d_net[j]));
    assert_true(scale > 1.0);
    for (size_t j = 0; j < n; j++)
        assert_true(close_to((double)c.d_net[j], d_net[j], 1e-5, 1e-5 * scale));
    free(d_net);
    crowd_finish(&c);
}

/* The numbers are the same without gradients, and if only steps are requested. */
static void test_partial(void **state)
{
    static ref_world w;
    const ted4_header h = ref_header();
    double bits[TED4_TYPES], again[TED4_TYPES];
    float steps[REF_BLOCKS][TED4_TYPES * TED4_LANES];

    (void)state;
    ref_world_make(&w, &h);
    assert_int_equal(ref_run(&w, NULL, bits), 0);
    for (int i = 0; i < REF_BLOCKS; i++) {
        memcpy(steps[i], w.steps[i], sizeof steps[i]);
        memset(w.steps[i], 0, sizeof steps[i]);
    }
    assert_int_equal(ted4_rate_evaluate(w.rate, &w.in, NULL, NULL, NULL, NULL, w.steps, NULL), 0);
    for (int i = 0; i < REF_BLOCKS; i++)
        assert_memory_equal(steps[i], w.steps[i], sizeof steps[i]);
    assert_int_equal(ted4_rate_evaluate(w.rate, &w.in, NULL, NULL, NULL, NULL, w.steps, again), 0);
    assert_memory_equal(bits, again, sizeof bits);
    ref_world_finish(&w);
}

/* Gradients may be added in place, in the blocks that hold the gradients from rendering. */
static void test_shared_gradients(void **state)
{
    static ref_world w;
    const ted4_header h = ref_header();
    double bits[TED4_TYPES];

    (void)state;
    ref_world_make(&w, &h);
    float *d_net = ref_floats(w.layout.n_net);

    assert_int_equal(ref_run(&w, NULL, bits), 0);
    assert_int_equal(ted4_rate_evaluate(w.rate, &w.in, NULL, (const float *const *)w.d_value,
                                        w.d_value, d_net, w.steps, bits),
                     0);
    assert_memory_equal(d_net, w.d_net, w.layout.n_net * sizeof *d_net);
    free(d_net);
    ref_world_finish(&w);
}

/* Traps 3 and 5 of annex D.1: biases drive sigma and steps far out of range. Steps stay within 2^-4
 * .. 2^(127/32) of Q0, and gradient descent brings both back. */
static void test_clamped_outputs_recover(void **state)
{
    static ref_world w;
    const ted4_header h = ref_header();
    double bits[TED4_TYPES];

    (void)state;
    for (int high = 0; high < 2; high++) {
        ref_world_make(&w, &h);
        const ted4_shape *s = &w.layout.shape;
        const unsigned v = s->first_step_output, sigma = s->first_output[TED4_SCALING] + 6;

        for (unsigned t = 0; t < TED4_TYPES; t++)
            *ref_bias(&w, v + t) = high ? 40.0f : -40.0f;
        for (unsigned c = 0; c < 6; c++)
            *ref_bias(&w, sigma + c) = high ? 40.0f : -40.0f;
        assert_int_equal(ref_run(&w, NULL, bits), 0);
        for (int t = 0; t < TED4_TYPES; t++)
            for (int j = 0; j < TED4_LANES; j++)
                assert_true(close_to((double)w.steps[0][t * TED4_LANES + j],
                                     (double)h.step[t] * exp2(high ? REF_V_MAX : REF_V_MIN), 1e-6,
                                     0.0));
        const float *d = w.d_net + (ref_bias(&w, 0) - w.net);

        for (unsigned c = 0; c < 6; c++) /* down is impossible if low, up if high */
            assert_true(high ? d[sigma + c] > 0.0f : d[sigma + c] < 0.0f);
        if (!high)
            assert_true(d[v + TED4_FEATURE] < 0.0f);
        ref_world_finish(&w);
    }
}

/* TED4_QUANT_INTEGER equals the decoder: bits from mu, sigma index and step index of norm/prior.h,
 * with an integer k. */
static double integer_bits(const ref_world *w, const ted4_prior *p, int visible, double *bits)
{
    const ted4_layout *l = &w->layout;
    const ted4_shape *s = &l->shape;
    static int32_t out[REF_MAX_OUTPUTS * TED4_PRIOR_BLOCK], add[REF_MAX_OUTPUTS * TED4_PRIOR_BLOCK];
    static int16_t context[REF_MAX_CHANNELS * TED4_PRIOR_BLOCK];
    uint16_t position[TED4_LANES][3];
    double total = 0.0;

    for (int j = 0; j < TED4_LANES; j++)
        for (int a = 0; a < 3; a++)
            position[j][a] = ted4_float_to_half(w->position[visible][a * TED4_LANES + j]);
    ted4_prior_hyper(p, position[0], TED4_LANES, out);
    for (unsigned t = 0; t < TED4_TYPES; t++)
        for (unsigned c = 0; c < s->dim[t]; c++) {
            if (t == TED4_FEATURE && c == l->head.slice[0]) {
                ted4_prior_slice(p, 1, context, TED4_LANES, add);
                for (unsigned i = 0; i < 2u * l->head.slice[1]; i++)
                    for (int j = 0; j < TED4_LANES; j++)
                        out[(c + i + (i >= l->head.slice[1] ? s->dim[0] - l->head.slice[1] : 0u)) *
                                64 +
                            (unsigned)j] += add[i * 64 + (unsigned)j];
            }
            for (int j = 0; j < TED4_LANES; j++) {
                const uint8_t i =
                    ted4_step_index(out[(s->first_step_output + t) * 64 + (unsigned)j]);
                const float q = l->head.step[t] * ted4_bits_float(ted4_step[i]);
                const float x = w->attr[visible][((unsigned)l->first[t] + c) * 32 + (unsigned)j];
                const int16_t k = (int16_t)rintf(x / q);
                const unsigned at = s->first_output[t] + c;
                const uint8_t g = ted4_sigma_index(out[(at + s->dim[t]) * 64 + (unsigned)j]);
                const double b = ref_bits(k - out[at * 64 + (unsigned)j] / 256.0, (g - 64) / 16.0);

                assert_true(w->steps[visible][t * TED4_LANES + (unsigned)j] == q);
                if (t == TED4_FEATURE)
                    context[c * 64 + (unsigned)j] = ted4_context(k, i, l->head.context_bits);
                if (t == TED4_TAU && c == 2)
                    continue; /* the test ensures a_f > a_s separately */
                bits[t] += b;
                total += b;
            }
        }
    return total;
}

static void test_integer(void **state)
{
    static ref_world w;
    ted4_header h = ref_header();
    double bits[TED4_TYPES], want[TED4_TYPES] = { 0 }, rounded[TED4_TYPES];
    ted4_arena arena;
    ted4_prior prior;

    (void)state;
    h.n_slices = 2, h.slice[0] = 3, h.slice[1] = 4;
    h.offset_mask = h.temporal_mask = h.activation = 0;
    ref_world_make(&w, &h);
    uint8_t *shift = calloc(w.layout.shape.n_units, 1);

    for (size_t i = 0; i < w.layout.shape.n_units; i++)
        shift[i] = 11;
    for (size_t i = w.layout.nete; i < w.layout.n_net; i++)
        w.net[i] = rintf(w.net[i] * 2048.0f) / 2048.0f + 0.0f; /* no -0 */
    w.in.quant = TED4_QUANT_ROUND;
    assert_int_equal(ref_run(&w, NULL, rounded), 0);
    float *gradient = ref_floats(w.layout.n_net);

    memcpy(gradient, w.d_net, w.layout.n_net * sizeof *gradient);
    w.in.quant = TED4_QUANT_INTEGER;
    w.in.shift = shift;
    assert_int_equal(ref_run(&w, NULL, bits), 0);
    ted4_arena_init(&arena, NULL);
    assert_int_equal(ted4_prior_init(&prior, &h, &w.layout.shape, &arena), TED4_OK);
    assert_int_equal(ted4_prior_load(&prior, w.net + w.layout.nete, shift, NULL), TED4_OK);
    for (int i = 0; i < REF_BLOCKS; i++)
        integer_bits(&w, &prior, i, want);
    double inner = 0.0, a = 0.0, b = 0.0;

    for (size_t i = w.layout.nete; i < w.layout.n_net; i++) {
        inner += (double)gradient[i] * (double)w.d_net[i];
        a += (double)gradient[i] * (double)gradient[i];
        b += (double)w.d_net[i] * (double)w.d_net[i];
    }
    for (int t = 0; t < TED4_TAU; t++) {
        assert_true(close_to(bits[t], want[t], 1e-5, 1e-3));
        assert_true(close_to(bits[t], rounded[t], 0.02, 0.0));
    }
    assert_true(inner > 0.99 * sqrt(a * b));
    assert_true(close_to(a, b, 0.1, 0.0));
    shift[0] = 21; /* R-NET-003 */
    assert_int_equal(ref_run(&w, NULL, bits), -1);
    ted4_arena_finish(&arena);
    free(gradient);
    free(shift);
    ref_world_finish(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_values),
        cmocka_unit_test(test_unused_lanes),
        cmocka_unit_test(test_noise),
        cmocka_unit_test(test_quantise),
        cmocka_unit_test(test_threads),
        cmocka_unit_test(test_sums),
        cmocka_unit_test(test_partial),
        cmocka_unit_test(test_shared_gradients),
        cmocka_unit_test(test_clamped_outputs_recover),
        cmocka_unit_test(test_integer),
    };

    return cmocka_run_group_tests_name("rate", tests, NULL, NULL);
}
