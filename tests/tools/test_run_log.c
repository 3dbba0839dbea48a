/* test_run_log.c - the log that ted4enc writes during training: the contents of its lines, and that
 * a resumed run continues one log.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <jansson.h>

#include "test.h"
#include "mishap.h"
#include "tool/run_log.h"
#include "train/monitor/checkpoint.h"
#include "train/monitor/monitor.h"

static double number(const json_t *line, const char *name)
{
    const json_t *v = json_object_get(line, name);

    if (!json_is_number(v))
        fail_msg("no number %s in a line of the log", name);
    return json_number_value(v);
}

/* Sums and last values of the lines read so far. */
typedef struct {
    double step, seconds, cpu;
} log_state;

/* Every line has what a chart needs, and its values are plausible. */
static void check_line(const json_t *line, log_state *s, double size)
{
    static const char *const names[] = { "lambda",  "loss",    "l1",     "ssim",
                                         "psnr",    "anchors", "moving", "splats",
                                         "bytes",   "ms",      "cpu_ms", "gaussian_pixels_per_s",
                                         "seconds", "skipped", "clamped" };
    static const char *const types[] = { "positions", "masks", "feature",  "scaling", "offset",
                                         "phi",       "tau",   "networks", "frame" };
    static const char *const learnt[] = { "feature", "scaling", "offset", "phi", "masks",
                                          "centres", "heads",   "motion", "bank" };
    const json_t *gradients = json_object_get(line, "gradients"),
                 *peaks = json_object_get(line, "peaks");
    const char *stage = json_string_value(json_object_get(line, "stage"));
    const double step = number(line, "step"), steps = step - s->step, bytes = number(line, "bytes");
    double sum = 0;

    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
        assert_true(number(line, names[i]) >= 0);
    for (size_t i = 0; i < sizeof types / sizeof types[0]; i++)
        sum += number(json_object_get(line, "bytes_by_type"), types[i]);
    for (size_t i = 0; i < sizeof learnt / sizeof learnt[0]; i++) {
        assert_true(number(gradients, learnt[i]) > 0);
        assert_true(number(gradients, learnt[i]) < 1000);
        assert_true(number(peaks, learnt[i]) >= (step == 500 ? 1 : 0));
        assert_true(number(peaks, learnt[i]) < 100);
    }
    assert_int_equal((number(gradients, "prior") > 0), (step == 750));
    assert_int_equal((number(gradients, "steps") > 0), (step == 750));
    assert_true(number(gradients, "tau") >= 0);
    assert_true(number(gradients, "colour") >= 0);
    assert_true(number(gradients, "pose") >= 0);
    assert_int_equal(json_object_size(gradients), TED4_TERMS);
    assert_int_equal(json_object_size(peaks), TED4_TERMS);
    assert_true(number(line, "rollbacks") == 0);
    assert_int_equal(json_array_size(json_object_get(line, "bits")), TED4_TYPES);
    assert_true(fabs(sum - bytes) <= 5);
    assert_true(steps > 0);
    assert_non_null(stage);
    assert_string_equal(stage, step <= STAGE1 ? "1" : step < 860 ? "2" : "2i");
    /* In the last line it is the size of the file. */
    assert_true(step <= STAGE1 ? bytes == 0
                               : fabs(bytes - size) <= (step < STEPS ? 0.05 * size : 0));
    assert_string_equal(json_string_value(json_object_get(line, "split")), "test");
    assert_true(step == STEPS ? number(line, "left") < 60 : number(line, "left") >= 0);
    assert_true(number(line, "anchors") > 50);
    assert_true(number(line, "moving") > 0);
    assert_true(number(line, "moving") <= number(line, "anchors"));
    assert_true(number(line, "psnr") > 10);
    assert_true(number(line, "splats") > 0);
    assert_true(number(line, "skipped") == 0);
    /* seconds are rounded to hundredths, milliseconds to thousandths. */
    assert_true(fabs(number(line, "seconds") - s->seconds - 1e-3 * steps * number(line, "ms")) <
                0.011 + 1e-6 * steps);
    assert_true(fabs(number(line, "cpu_seconds") - s->cpu - 1e-3 * steps * number(line, "cpu_ms")) <
                0.011 + 1e-6 * steps);
    s->step = step;
    s->seconds = number(line, "seconds");
    s->cpu = number(line, "cpu_seconds");
}

/* The decision on poses, which are right. */
static void check_poses(const json_t *line)
{
    assert_string_equal(json_string_value(json_object_get(line, "event")), "poses");
    assert_true(number(line, "step") == STAGE1 / 5 + 1);
    assert_true(number(line, "rollbacks") == 0);
    assert_true(number(line, "moved") > 0);
    assert_true(number(line, "moved") < 0.25);
    assert_true(json_is_false(json_object_get(line, "refined")));
}

/* Still anchors are closed before step 455, the 456th. */
static void check_closing(const json_t *line, const log_state *s)
{
    assert_string_equal(json_string_value(json_object_get(line, "event")), "closing");
    assert_true(s->step == 250);
    assert_true(number(line, "step") == 456);
    assert_true(number(line, "rollbacks") == 0);
    assert_true(number(line, "moving") > 0);
    assert_true(number(line, "moving") <= number(line, "anchors"));
    assert_true(number(line, "closed") > 0);
    assert_true(number(line, "closed") < number(line, "moving"));
}

static void test_log(void **state)
{
    log_state s = { 0, 0, 0 };
    int events = 0;

    (void)state;
    begin_test();
    for (const char *at = reference.log; *at != 0; at = strchr(at, '\n') + 1) {
        json_t *line =
            json_loadb(at, (size_t)(strchr(at, '\n') - at), JSON_REJECT_DUPLICATES, NULL);

        assert_non_null(line);
        if (json_object_get(line, "event") == NULL)
            check_line(line, &s, (double)reference.file.size);
        else if (events++ == 0)
            check_poses(line);
        else
            check_closing(line, &s);
        json_decref(line);
    }
    assert_int_equal(events, 2);
    assert_true(s.step == STEPS);
    assert_true(s.cpu > 0);
}

/* Makes a checkpoint of the end of stage 1 in out/c, and the log of the same run to its end. Logs
 * of two runs would not match: their clocks differ if one of them had to wait for the machine. */
static void make_checkpoint_and_log(char log[MOST_LOG])
{
    run_calmly("--stage1 out/s --log out/l");
    read_text("out/l", log, MOST_LOG);
    gone("out/l");
    gone("out/x.ted4");
    must(rename(tiny_path(&folder, "out/s"), tiny_path(&folder, "out/c")) == 0, "out/c");
    expect_files("c");
}

/* A log that is ahead of the checkpoint, with half a line at its end, becomes one consistent
 * log. */
static void test_log_goes_on(void **state)
{
    char log[MOST_LOG], text[MOST_LOG + 16];

    (void)state;
    begin_test();
    make_checkpoint_and_log(log);
    snprintf(text, sizeof text, "%s{\"step\":77", log);
    tiny_text(&folder, "out/l", text);
    run_calmly("--checkpoint out/c --resume --log out/l");
    expect_log("out/l", reference.log);
    expect_same("out/x.ted4", &reference.file);
    gone("out/c");
    expect_files("");
}

/* Lines from after a rollback of which the checkpoint does not know are removed. */
static void test_log_before_rollback(void **state)
{
    char log[MOST_LOG], text[MOST_LOG + 256];
    const char *second;

    (void)state;
    begin_test();
    make_checkpoint_and_log(log);
    second = strstr(log, "{\"step\":750,");
    assert_non_null(second);
    snprintf(text, sizeof text,
             "%.*s{\"step\":500,\"event\":\"rollback\",\"rollbacks\":1,\"failed\":640}\n{\"step\":"
             "600,\"stage\":\"1\"}\n",
             (int)(second - log), log);
    tiny_text(&folder, "out/l", text);
    run_calmly("--checkpoint out/c --resume --log out/l");
    expect_log("out/l", reference.log);
    expect_same("out/x.ted4", &reference.file);
}

/* Makes a checkpoint of step 300 with a value that is not finite; if good is set, with the state of
 * step 250 that the monitor keeps. */
static void poison(int good)
{
    ted4_dataset d;
    ted4_trainer t;

    begin_usual(&t, &d);
    ball_train(&t, 300);
    *ted4_anchor_value(&t.anchors, TED4_ROW_VALUE, 5, t.layout.first[TED4_OFFSET]) = NAN;
    if (!good)
        ted4_monitor_forget(&t);
    end_usual(&t, &d, "out/c");
}

/* Resumes a run from a poisoned checkpoint, and kills it after its log has lines of steps after the
 * rollback. Returns its status: 0 if it had ended by then. */
static int kill_after_rollback(void)
{
    char text[MOST_LOG] = "", part[64];

    begin_test();
    poison(1);

    const pid_t child = start("-o out/x.ted4 --checkpoint out/c --resume --log out/l", 0);

    for (int i = 0; i < 60000 && strstr(text, "\"step\":500") == NULL; i++) {
        pause_us(1000);
        if (is_there("out/l"))
            read_text("out/l", text, sizeof text);
    }
    assert_non_null(strstr(text, "\"step\":500"));
    kill(child, SIGKILL);

    const int status = finish(child);

    /* It may have been about to write a checkpoint. */
    snprintf(part, sizeof part, "out/c.%ld.part", (long)child);
    if (is_there(part))
        gone(part);
    return status;
}

/* The log records what the monitor does. */
static void test_rollback(void **state)
{
    char text[MOST_LOG];
    ball_file first, second;
    int status = 0;

    (void)state;
    begin_test();
    poison(1);
    run_calmly("--checkpoint out/c --resume --log out/l");
    read_text("out/l", text, sizeof text);
    assert_ptr_equal(
        strstr(text, "{\"step\":250,\"event\":\"rollback\",\"rollbacks\":1,\"failed\":300,"
                     "\"cause\":\"not finite\","
                     "\"term\":\"value of "
                     "offset\",\"anchor\":5,\"factor\":0.5}\n{\"step\":456,\"event\":\"closing\","),
        text);
    assert_non_null(strstr(strchr(text, '\n'), "\"rollbacks\":1,"));
    first = read_file("out/x.ted4");

    /* Killed afterwards: the same file results, and the log still records the rollback. */
    for (int tries = 0; tries < 20 && status == 0; tries++)
        status = kill_after_rollback();
    assert_int_equal(status, 1000 + SIGKILL);
    run_calmly("--checkpoint out/c --resume --log out/l");
    second = read_file("out/x.ted4");
    ball_check_same(&first, &second);
    expect_log("out/l", text);
    free(first.bytes);
    free(second.bytes);

    poison(0);
    assert_int_equal(run("-o out/y.ted4 --checkpoint out/c --resume --log out/l", 0), 3);
    expect_words(
        "value of offset of anchor 5 is not finite at step 300; there is no good state before it");
    read_text("out/l", text, sizeof text);
    assert_non_null(strstr(text, "\"event\":\"failure\",\"rollbacks\":0,\"failed\":300,"));
    expect_files("c l x.ted4");
}

/* A trainer that takes no steps, for logs in out/l, whose path is path. */
typedef struct {
    tiny_folder scene;
    ted4_dataset d;
    ted4_trainer t;
    char path[600];
} idle_trainer;

static void begin_idle(idle_trainer *i)
{
    const ted4_train_options o = ball_options();

    begin_test();
    snprintf(i->path, sizeof i->path, "%s", tiny_path(&folder, "out/l"));
    ball_load(&i->scene, &i->d, 3, 1);
    ball_begin(&i->t, &o, &i->d, NULL);
}

static void end_idle(idle_trainer *i)
{
    gone("out/l");
    ted4_trainer_finish(&i->t);
    ted4_dataset_free(&i->d);
    tiny_free(&i->scene);
}

/* Works until the processor's clock has advanced by seconds, as the log measures it. */
static void work(ted4_run_log *l, ted4_trainer *t, double seconds)
{
    const double end = l->cpu_seconds + seconds;

    while (l->cpu_seconds < end)
        ted4_run_log_tick(l, t);
}

/* Writes the line of a step. Returns the values of cpu_seconds and ms in it, the last line of the
 * file. */
static void put(ted4_run_log *l, ted4_trainer *t, uint64_t step, double *cpu, double *ms)
{
    char text[MOST_LOG], why[256];

    t->iteration = step;
    assert_int_equal(ted4_run_log_step(l, t, why, sizeof why), 0);
    read_text("out/l", text, sizeof text);
    text[strlen(text) - 1] = 0;

    const char *last = strrchr(text, '\n') == NULL ? text : strrchr(text, '\n');

    *cpu = strtod(strstr(last, "\"cpu_seconds\":") + 14, NULL);
    *ms = strtod(strstr(last, "\"ms\":") + 5, NULL);
}

/* Training that was discarded counts in the log's seconds, but in no step's milliseconds; a resumed
 * log counts from its last line. */
static void test_thrown_away(void **state)
{
    idle_trainer idle;
    ted4_trainer *const t = &idle.t;
    ted4_run_log l;
    double cpu, ms, began;
    char why[256];

    (void)state;
    begin_idle(&idle);
    assert_int_equal(ted4_run_log_open(&l, idle.path, t, 0, NULL, why, sizeof why), 0);
    work(&l, t, 0.1);
    put(&l, t, 100, &cpu, &ms);
    work(&l, t, 0.1);
    t->iteration = 0;
    assert_int_equal(ted4_run_log_cut(&l, t, why, sizeof why), 0);
    began = t->seconds;
    work(&l, t, 0.1);
    put(&l, t, 100, &cpu, &ms);
    assert_true(cpu >= 0.299);
    assert_true(t->seconds >= 0.299);
    assert_true(ms > 0);
    assert_true(fabs(1e-3 * 100 * ms - (t->seconds - began)) < 1e-3);
    assert_int_equal(ted4_run_log_close(&l, why, sizeof why), 0);

    assert_int_equal(ted4_run_log_open(&l, idle.path, t, 1, NULL, why, sizeof why), 0);
    work(&l, t, 0.1);
    put(&l, t, 200, &cpu, &ms);
    assert_true(cpu >= 0.399);
    assert_int_equal(ted4_run_log_close(&l, why, sizeof why), 0);
    end_idle(&idle);
}

/* Writes a line for each step of a trial that begins at the trainer's step. */
static void put_trial(ted4_run_log *l, ted4_trainer *t, const uint64_t *step, size_t n)
{
    double cpu, ms;

    ted4_run_log_begin_trial(l, t);
    for (size_t i = 0; i < n; i++)
        put(l, t, step[i], &cpu, &ms);
}

/* A rollback inside a trial of a search for a size cuts no line of the trials before. */
static void test_trials_apart(void **state)
{
    static const uint64_t step[] = { 1000, 1250, 1500 };
    idle_trainer idle;
    ted4_trainer *const t = &idle.t;
    ted4_run_log l;
    double cpu, ms;
    char why[256], before[MOST_LOG], after[MOST_LOG];

    (void)state;
    begin_idle(&idle);
    assert_int_equal(ted4_run_log_open(&l, idle.path, t, 0, NULL, why, sizeof why), 0);
    put(&l, t, 800, &cpu, &ms);
    put_trial(&l, t, step, 3);
    t->iteration = 800;
    put_trial(&l, t, step, 1);
    read_text("out/l", before, sizeof before);
    put(&l, t, 1250, &cpu, &ms);
    t->iteration = 1000;
    assert_int_equal(ted4_run_log_cut(&l, t, why, sizeof why), 0);
    read_text("out/l", after, sizeof after);
    assert_string_equal(after, before);
    assert_int_equal(ted4_run_log_close(&l, why, sizeof why), 0);
    end_idle(&idle);
}

/* Fills every number of a line that can be so with x. */
static void fill(ted4_run_log *l, ted4_trainer *t, double x)
{
    ted4_progress *p = &t->progress;

    p->loss = p->l1 = p->ssim = p->splats = p->splat_pixels = x;
    l->left = x;
    l->preview = (ted4_preview) { .psnr = x, .bytes = x, .positions = x, .masks = x };
    for (int k = 0; k < TED4_TYPES; k++)
        p->bits[k] = l->preview.type[k] = x;
    for (int k = 0; k < TED4_TERMS; k++)
        t->monitor.state.gradient[k].peak = x;
}

/* A training that has diverged is told as JSON, too: large numbers in full, and null for what is
 * not finite. */
static void test_diverged(void **state)
{
    static const double values[] = { 1e300, -1e300, NAN, INFINITY };
    static const char *const names[] = { "loss", "l1", "ssim", "psnr", "splats", "bytes", "left" };
    idle_trainer idle;
    ted4_trainer *const t = &idle.t;
    ted4_run_log l;
    char why[256], text[MOST_LOG];

    (void)state;
    begin_idle(&idle);
    for (size_t i = 0; i < sizeof values / sizeof values[0]; i++) {
        assert_int_equal(ted4_run_log_open(&l, idle.path, t, 0, NULL, why, sizeof why), 0);
        fill(&l, t, values[i]);
        assert_int_equal(ted4_run_log_step(&l, t, why, sizeof why), 0);
        t->poses.moved = values[i];
        assert_int_equal(ted4_run_log_poses(&l, t, why, sizeof why), 0);
        assert_int_equal(ted4_run_log_close(&l, why, sizeof why), 0);
        read_text("out/l", text, sizeof text);

        char *const second = strchr(text, '\n') + 1;
        json_t *line = json_loadb(text, (size_t)(second - text), JSON_DECODE_INT_AS_REAL, NULL),
               *poses = json_loads(second, 0, NULL);

        assert_non_null(line);
        assert_non_null(poses);
        for (size_t k = 0; k < sizeof names / sizeof names[0]; k++)
            if (isfinite(values[i]))
                assert_true(number(line, names[k]) == values[i]);
            else
                assert_true(json_is_null(json_object_get(line, names[k])));
        assert_int_equal(json_is_null(json_object_get(poses, "moved")), !isfinite(values[i]));
        json_decref(line);
        json_decref(poses);
    }
    end_idle(&idle);
}

/* A file that is not a log is not changed, whether or not its last line has an end. */
static void test_wrong_log(void **state)
{
    static const char *const wrong[] = { "dear diary\n", "dear diary", "{\"frames\": []}" };
    char text[64];

    (void)state;
    begin_test();
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        tiny_text(&folder, "out/l", wrong[i]);
        assert_int_equal(run("-o out/x.ted4 --log out/l --checkpoint out/c --resume", 0), 3);
        expect_words("out/l: there, but not a log of ted4enc");
        read_text("out/l", text, sizeof text);
        assert_string_equal(text, wrong[i]);
        gone("out/l");
    }
    expect_files("");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_log),
        cmocka_unit_test(test_log_goes_on),
        cmocka_unit_test(test_log_before_rollback),
        cmocka_unit_test(test_rollback),
        cmocka_unit_test(test_thrown_away),
        cmocka_unit_test(test_trials_apart),
        cmocka_unit_test(test_diverged),
        cmocka_unit_test(test_wrong_log),
    };

    return cmocka_run_group_tests_name("run log", tests, set_up, tear_down);
}
