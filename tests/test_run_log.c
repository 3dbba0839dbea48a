/* test_run_log.c - the log that ted4enc writes while it trains: what is in its lines, and that it is one log after a run was resumed.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <jansson.h>

#include "mishap.h"

static double number(const json_t *line, const char *name)
{
    const json_t *v = json_object_get(line, name);

    if (!json_is_number(v))
        fail_msg("no number %s in a line of the log", name);
    return json_number_value(v);
}

/* What the lines so far have come to. */
typedef struct { double step, seconds, cpu; } log_state;

/* What a chart needs is in every line, and makes sense. */
static void check_line(const json_t *line, log_state *s, double size)
{
    static const char *const names[] = { "lambda", "loss", "l1", "ssim", "psnr", "anchors", "moving", "splats", "bytes", "ms", "cpu_ms",
                                         "gaussian_pixels_per_s", "seconds" };
    static const char *const types[] = { "positions", "masks", "feature", "scaling", "offset", "phi", "tau", "networks" };
    const char  *stage = json_string_value(json_object_get(line, "stage"));
    const double step = number(line, "step"), steps = step - s->step, bytes = number(line, "bytes");
    double       sum = 0;

    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
        assert_true(number(line, names[i]) >= 0);
    for (size_t i = 0; i < sizeof types / sizeof types[0]; i++)
        sum += number(json_object_get(line, "bytes_by_type"), types[i]);
    assert_int_equal(json_array_size(json_object_get(line, "bits")), TED4_TYPES);
    assert_true(fabs(sum - bytes) <= 5 && steps > 0);
    assert_non_null(stage);
    assert_string_equal(stage, step <= STAGE1 ? "1" : step < 860 ? "2" : "2i");
    assert_true(step <= STAGE1 ? bytes == 0 : fabs(bytes - size) < (step < STEPS ? 0.3 : 0.1) * size);
    assert_true(number(line, "anchors") > 50 && number(line, "moving") > 0 && number(line, "moving") <= number(line, "anchors"));
    assert_true(number(line, "psnr") > 10 && number(line, "splats") > 0);
    /* seconds are rounded to hundredths, milliseconds to thousandths. */
    assert_true(fabs(number(line, "seconds") - s->seconds - 1e-3 * steps * number(line, "ms")) < 0.011 + 1e-6 * steps);
    s->step = step;
    s->seconds = number(line, "seconds");
    s->cpu += steps * number(line, "cpu_ms");
}

static void test_log(void **state)
{
    log_state s = { 0, 0, 0 };

    (void)state;
    begin_test();
    for (const char *at = reference.log; *at != 0; at = strchr(at, '\n') + 1) {
        json_t *line = json_loadb(at, (size_t)(strchr(at, '\n') - at), JSON_REJECT_DUPLICATES, NULL);

        assert_non_null(line);
        check_line(line, &s, (double)reference.file.size);
        json_decref(line);
    }
    assert_true(s.step == STEPS && s.cpu > 0);
}

/* A log that is ahead of the checkpoint, with half a line at its end, is one log afterwards. */
static void test_log_goes_on(void **state)
{
    char text[MOST_LOG + 16];

    (void)state;
    begin_test();
    make_checkpoint();
    snprintf(text, sizeof text, "%s{\"step\":77", reference.log);
    tiny_text(&folder, "out/l", text);
    run_calmly("--checkpoint out/c --resume --log out/l");
    expect_log("out/l", reference.log);
    expect_same("out/x", &reference.file);
    gone("out/c");
    expect_files("");
}

/* What is not a log is left alone. */
static void test_wrong_log(void **state)
{
    char text[64];

    (void)state;
    begin_test();
    tiny_text(&folder, "out/l", "dear diary\n");
    assert_int_equal(run("-o out/x --log out/l --checkpoint out/c --resume", 0), 3);
    expect_words("out/l: there, but not a log of ted4enc");
    read_text("out/l", text, sizeof text);
    assert_string_equal(text, "dear diary\n");
    gone("out/l");
    expect_files("");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_log),
        cmocka_unit_test(test_log_goes_on),
        cmocka_unit_test(test_wrong_log),
    };

    return cmocka_run_group_tests_name("run log", tests, set_up, tear_down);
}
