/* test_mishaps_scene.c - ted4enc as a program, when a picture disappears or changes during
 * training, when a checkpoint was made from other pictures, or when a value is not finite: one line
 * on standard error gives the reason, the exit status is 3, and the last checkpoint leads to the
 * same bytes as a run without disturbance. Only a search for a size that has found a file keeps it.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "test.h"
#include "mishap.h"
#include "train/monitor/checkpoint.h"

/* ---- pictures ---- */

/* Both ends of a named pipe. A program that writes its log to the pipe cannot get beyond step 250
 * while the pipe is full. */
typedef struct {
    int read, write;
} gate;

static void close_gate(const gate *g)
{
    static const char bytes[4096];

    for (size_t size = sizeof bytes; size > 0; size /= 2)
        while (write(g->write, bytes, size) > 0)
            continue;
}

static gate make_gate(const char *path)
{
    gate g;

    must(mkfifo(path, 0600) == 0, path);
    g.read = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    g.write = open(path, O_WRONLY | O_NONBLOCK | O_CLOEXEC);
    assert_true(g.read >= 0);
    assert_true(g.write >= 0);
    return g;
}

static void open_gate(const gate *g)
{
    char bytes[4096];

    while (read(g->read, bytes, sizeof bytes) > 0)
        continue;
}

static void remove_gate(const gate *g)
{
    close(g->read);
    close(g->write);
    gone("gate");
}

/* Starts a run that waits at the pipe, and waits until it has written a checkpoint. */
static pid_t start_until_checkpoint(void)
{
    const pid_t child = start("-o out/x.ted4 --checkpoint out/c --log gate", 0);
    int status;

    while (!is_there("out/c")) {
        if (waitpid(child, &status, WNOHANG) != 0)
            fail_msg("the run was over before it wrote a checkpoint");
        pause_us(1000);
    }
    return child;
}

/* Damages a picture while the program runs, which must notice it; then repairs the picture. */
static void spoil(void (*damage)(const char *path), const char *what)
{
    static const char name[] = "scene/images/c1_f2.png";
    const gate g = make_gate(tiny_path(&folder, "gate"));

    close_gate(&g);

    const pid_t child = start_until_checkpoint();
    ball_file whole = read_file(name);

    damage(tiny_path(&folder, name));
    open_gate(&g);
    assert_int_equal(finish(child), 3);
    remove_gate(&g);
    expect_words(what);
    expect_files("c");
    tiny_bytes(&folder, name, whole.bytes, whole.size);
    free(whole.bytes);
    resume_to_reference();
}

static void take_away(const char *path)
{
    must(remove(path) == 0, path);
}

static void cut_short(const char *path)
{
    must(truncate(path, 100) == 0, path);
}

/* Replaces the picture by another of the same size, by renaming a new file, so that nobody reads a
 * part of it. */
static void exchange(const char *path)
{
    tiny_picture(&folder, "other.png", BALL_W, BALL_H, 7);
    must(rename(tiny_path(&folder, "other.png"), path) == 0, path);
}

static void test_pictures(void **state)
{
    (void)state;
    begin_test();
    spoil(take_away, "c1_f2.png: No such file");
    spoil(cut_short, "c1_f2.png: PNG");
    spoil(exchange, "c1_f2.png: the file has changed");
}

/* Starts a search for a size, and takes a picture away after its first trial, which is the
 * reference. Returns the exit status. */
static int search_without_picture(size_t target)
{
    static const char name[] = "scene/images/c1_f2.png";
    const gate g = make_gate(tiny_path(&folder, "gate"));
    char arguments[128], line[MOST_LOG] = "";
    ball_file whole = read_file(name);
    size_t n = 0;
    int status;

    snprintf(arguments, sizeof arguments, "-o out/x.ted4 --log gate --target-size %zu", target);

    const pid_t child = start(arguments, 0);

    while (strstr(line, "{\"step\":900,\"stage") == NULL) {
        const ssize_t more = read(g.read, line + n, sizeof line - 1 - n);

        if (more > 0)
            line[n += (size_t)more] = 0;
        else if (waitpid(child, &status, WNOHANG) != 0)
            fail_msg("the search was over before its first trial");
        else
            pause_us(1000);
    }
    close_gate(&g);
    take_away(tiny_path(&folder, name));
    open_gate(&g);
    status = finish(child);
    remove_gate(&g);
    tiny_bytes(&folder, name, whole.bytes, whole.size);
    free(whole.bytes);
    return status;
}

/* A search for a size that cannot go on leaves the file that fits, if it has one. */
static void test_search(void **state)
{
    (void)state;
    begin_test();
    assert_int_equal(search_without_picture(2 * reference.file.size), 0);
    expect_words("c1_f2.png: No such file");
    expect_words("the file of lambda 0.002 is kept");
    expect_files("x.ted4");
    expect_same("out/x.ted4", &reference.file);

    assert_int_equal(search_without_picture(reference.file.size / 2), 3);
    expect_words("c1_f2.png: No such file");
    expect_files("");
}

/* A checkpoint belongs to the pictures from which it was made. */
static void test_other_scene(void **state)
{
    static const char name[] = "scene/images/c1_f2.png";
    ball_file whole;

    (void)state;
    begin_test();
    make_checkpoint();
    whole = read_file(name);
    exchange(tiny_path(&folder, name));
    assert_int_equal(run("-o out/x.ted4 --checkpoint out/c --resume", 0), 3);
    expect_words("out/c: not a checkpoint of this scene");
    tiny_bytes(&folder, name, whole.bytes, whole.size);
    free(whole.bytes);
    assert_int_equal(run("-o out/x.ted4 --checkpoint out/c --resume --downscale 2", 0), 3);
    expect_words("out/c: not a checkpoint of this scene");
    assert_int_equal(run("-o out/x.ted4 --checkpoint out/c --resume --max-frames 3", 0), 3);
    expect_words("out/c: not a checkpoint of this scene");
    resume_to_reference();
}

/* ---- a value that is not finite ---- */

/* Puts a value that is not finite into the state in a checkpoint. */
static void poison(const char *name)
{
    ted4_dataset d;
    ted4_trainer t;

    begin_usual(&t, &d);
    if (ted4_checkpoint_load(&t, tiny_path(&folder, name)) != 0)
        fail_msg("%s", t.message.text);
    *ted4_anchor_value(&t.anchors, TED4_ROW_VALUE, 5, t.layout.first[TED4_FEATURE]) = NAN;
    end_usual(&t, &d, name);
}

/* Tests the program; the trainer's part is tested in test_nan.c. */
static void test_not_finite(void **state)
{
    ball_file good, bad, after;

    (void)state;
    begin_test();
    make_checkpoint();
    good = read_file("out/c");
    poison("out/c");
    bad = read_file("out/c");
    assert_int_equal(run("-o out/x.ted4 --checkpoint out/c --resume", 0), 3);
    expect_words("not finite at step 700");
    expect_files("c");
    after = read_file("out/c");
    ball_check_same(&bad, &after);
    tiny_bytes(&folder, "out/c", good.bytes, good.size);
    resume_to_reference();
    free(good.bytes);
    free(bad.bytes);
    free(after.bytes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_pictures),
        cmocka_unit_test(test_search),
        cmocka_unit_test(test_other_scene),
        cmocka_unit_test(test_not_finite),
    };

    return cmocka_run_group_tests_name("changed pictures and values that are not finite", tests,
                                       set_up, tear_down);
}
