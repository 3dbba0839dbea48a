/* test_variants.c - every variant of the method, trained from pictures to a file: the file declares
 * its variant and can be written again from the decoded scene; parts that the variant lacks are
 * absent; the rate that training optimised is the rate of the file within 1 %; and quality is about
 * right. Variants of stage 2 from one stage 1: test_stage1.c. Gradients of each variant:
 * test_generate_grad.c, test_rate_grad.c.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "test.h"
#include "ball_decoded.h"
#include "ball_group.h"
#include "norm/scene.h"
#include "train/step/export_scene.h"
#include "train/step/stages.h"

enum { MOST_OPTIONS = 2 };

/* The variant as declared in a file. */
typedef struct {
    int motion, bank, activation, temporal_mask, offset_mask, view, linear, factorised, slices;
} traits;

static traits traits_of(const ted4_header *h)
{
    return (traits) { h->motion,
                      h->bank_rows > 0,
                      h->activation,
                      h->temporal_mask,
                      h->offset_mask,
                      h->view,
                      h->scale_domain == TED4_SCALE_LINEAR,
                      h->prior == TED4_PRIOR_FACTORISED,
                      h->n_slices };
}

typedef struct {
    const char *name, *option[MOST_OPTIONS];
    traits want;
    double psnr; /* lower bound, over the training pictures */
} variant;

/* Traits of the whole method: { 1, 1, 1, 1, 1, 1, 0, 0, 2 }. The bounds of PSNR are 5 dB or more
 * below the usual results. */
static const variant variants[] = {
    { "whole", { NULL }, { 1, 1, 1, 1, 1, 1, 0, 0, 2 }, 28 },
    { "no motion", { "motion=0" }, { 0, 0, 1, 0, 1, 1, 0, 0, 2 }, 28 },
    { "concat", { "motion=2" }, { 2, 1, 1, 1, 1, 1, 0, 0, 2 }, 28 },
    { "inr", { "motion=3" }, { 3, 0, 1, 1, 1, 1, 0, 0, 2 }, 28 },
    { "no activation", { "activation=0" }, { 1, 1, 0, 1, 1, 1, 0, 0, 2 }, 23 },
    { "no progressive", { "progressive=0" }, { 1, 1, 1, 1, 1, 1, 0, 0, 2 }, 28 },
    { "no temporal mask", { "temporal_mask=0" }, { 1, 1, 1, 0, 1, 1, 0, 0, 2 }, 28 },
    { "no offset mask", { "offset_mask=0" }, { 1, 1, 1, 1, 0, 1, 0, 0, 2 }, 28 },
    { "factorised", { "factorised=1" }, { 1, 1, 1, 1, 1, 1, 0, 1, 2 }, 28 },
    { "no autoregression", { "slices=1" }, { 1, 1, 1, 1, 1, 1, 0, 0, 1 }, 28 },
    { "no view", { "view=0" }, { 1, 1, 1, 1, 1, 0, 0, 0, 2 }, 28 },
    { "full view", { "view=2" }, { 1, 1, 1, 1, 1, 2, 0, 0, 2 }, 28 },
    { "linear scale",
      { "linear_scale=1", "step_scaling=0.001" },
      { 1, 1, 1, 1, 1, 1, 1, 0, 2 },
      28 },
    { "no colour", { "colour=0" }, { 1, 1, 1, 1, 1, 1, 0, 0, 2 }, 28 },
};

static void check_rate(const variant *v, ted4_trainer *t, const ted4_scene *s)
{
    double estimate[TED4_TYPES], sum = 0, coded = 0;
    ted4_bits bits;

    assert_int_equal(ted4_integer_rate(t, estimate), 0);
    assert_int_equal(ted4_count(s, NULL, &bits, NULL), TED4_OK);
    for (int y = 0; y < TED4_TYPES; y++) {
        sum += estimate[y];
        coded += bits.type[y];
    }
    if (!(coded >= 5000 && fabs(sum - coded) <= 0.01 * coded))
        fail_msg("%s: %.0f bits estimated, %.0f coded", v->name, sum, coded);
}

static void check_file(const variant *v, const ball_file *f)
{
    ted4_scene *back;
    ted4_info info;
    ted4_error e = { TED4_OK, 0 };
    ball_file again;
    const double psnr = ball_decoded_psnr(f, &balls, &info);

    assert_int_equal(ted4_decode(f->bytes, f->size, NULL, &back, NULL), TED4_OK);
    assert_int_equal(ted4_encode(back, 0, NULL, &again.bytes, &again.size, &e), TED4_OK);
    ball_check_same(f, &again);
    free(again.bytes);

    const traits got = traits_of(&back->head);

    if (memcmp(&got, &v->want, sizeof got) != 0)
        fail_msg("%s: motion %d, bank %d, activation %d, masks %d %d, view %d, linear %d, "
                 "factorised %d, slices %d",
                 v->name, got.motion, got.bank, got.activation, got.temporal_mask, got.offset_mask,
                 got.view, got.linear, got.factorised, got.slices);
    ted4_scene_free(back);
    if (v->want.motion == 0)
        assert_int_equal(info.n_dynamic, 0);
    else if (!v->want.temporal_mask)
        assert_int_equal(info.n_dynamic, info.n_anchors);
    if (!v->want.offset_mask)
        assert_int_equal(info.n_gaussians, (size_t)info.n_anchors * info.n_offsets);
    if (!(psnr >= v->psnr))
        fail_msg("%s: %.2f dB", v->name, psnr);
}

static ball_file code(const variant *v, ted4_trainer *t)
{
    ted4_scene *s;
    ted4_error e = { TED4_OK, 0 };
    ball_file f;

    if (ted4_export_scene(t, &s) != 0)
        fail_msg("%s: %s", v->name, t->message.text);
    check_rate(v, t, s);
    assert_int_equal(ted4_encode(s, 0, NULL, &f.bytes, &f.size, &e), TED4_OK);
    ted4_scene_free(s);
    return f;
}

/* Colour correction was learnt, and does not affect the file. */
static void check_colour(const variant *v, ted4_trainer *t, const ball_file *f)
{
    int learnt = 0;

    for (size_t c = 0; c < t->colour.n_cameras; c++)
        for (int k = 0; k < TED4_COLOUR_VALUES; k++) {
            learnt += t->colour.value[c][k] != 0.0f;
            t->colour.value[c][k] = 0.5f;
        }
    assert_int_equal(learnt > 0, t->opt.colour);

    ball_file again = code(v, t);

    ball_check_same(f, &again);
    free(again.bytes);
}

static void check_variant(const variant *v, ball_file *f)
{
    ted4_train_options o = ball_options();
    ted4_trainer t;

    for (int i = 0; i < MOST_OPTIONS && v->option[i] != NULL; i++)
        ball_set(&o, v->option[i]);
    ball_begin(&t, &o, &balls, NULL);
    ball_train(&t, ted4_trainer_total(&t));
    *f = code(v, &t);
    check_file(v, f);
    check_colour(v, &t, f);
    ted4_trainer_finish(&t);
}

/* Every option has an effect: all files differ. */
static void test_variants(void **state)
{
    enum { N = sizeof variants / sizeof variants[0] };
    ball_file f[N];

    (void)state;
    for (size_t i = 0; i < N; i++) {
        check_variant(&variants[i], &f[i]);
        for (size_t k = 0; k < i; k++)
            if (f[k].size == f[i].size && memcmp(f[k].bytes, f[i].bytes, f[i].size) == 0)
                fail_msg("%s gives the file of %s", variants[i].name, variants[k].name);
    }
    for (size_t i = 0; i < N; i++)
        free(f[i].bytes);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(test_variants) };

    return cmocka_run_group_tests_name("variants", tests, set_up, tear_down);
}
