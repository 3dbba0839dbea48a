/* mishap.h - runs the program ted4enc on a small scene in its own folder, and keeps the output of
 * an undisturbed run for comparison. For test_mishaps.c, test_mishaps_scene.c and test_run_log.c.
 * Looks for the program in $TED4_BUILD (set by tests/run.sh).
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_MISHAP_H
#define TED4_MISHAP_H

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "ball_trainer.h"
#include "test.h"
#include "train/monitor/checkpoint.h"

enum { MOST_WORDS = 64, MOST_BYTES = 1 << 20, MOST_LOG = 1 << 16, STAGE1 = 700, STEPS = 900 };

/* The output of a run. */
typedef struct {
    ball_file file;
    char log[MOST_LOG];
} outcome;

static const char *build;  /* NULL: the tests are skipped */
static tiny_folder folder; /* holds scene/, out/, and err: standard error of the last run */
static outcome reference;  /* of an undisturbed run */

/* ---- the program ---- */

/* Small networks, one thread, and no picture kept in memory. The log has a line for every 250
 * steps. */
static const char *const usual[] = { "ted4enc",
                                     "scene",
                                     "-f",
                                     "-j1",
                                     "-q",
                                     "--preset",
                                     "draft",
                                     "--iterations",
                                     "700,200",
                                     "--cache",
                                     "0",
                                     "--set",
                                     "offsets=4",
                                     "--set",
                                     "feature=8",
                                     "--set",
                                     "phi=4",
                                     "--set",
                                     "bank_dim=8",
                                     "--set",
                                     "deform_width=8",
                                     "--set",
                                     "head_width=12",
                                     "--set",
                                     "hyper_width=8",
                                     "--set",
                                     "ar_width=8",
                                     "--set",
                                     "slices=2",
                                     "--set",
                                     "octaves=4",
                                     "--set",
                                     "init_anchors=150",
                                     "--set",
                                     "max_anchors=260",
                                     "--set",
                                     "grow_every=20",
                                     "--set",
                                     "capacity=0",
                                     "--set",
                                     "motion_worth=0.02",
                                     NULL };

static inline int has_checkpoint(const char *arguments)
{
    return strstr(arguments, "--checkpoint ") != NULL;
}

/* Becomes the program, in the child process; a checkpoint is written after every step, unless the
 * arguments say when. Files cannot grow beyond limit bytes (0: any size); the write fails instead
 * of raising a signal. */
static inline void become_program(const char *arguments, rlim_t limit)
{
    char path[1024], words[1024];
    const char *argv[MOST_WORDS];
    int n = 0;

    for (; usual[n] != NULL; n++)
        argv[n] = usual[n];
    if (has_checkpoint(arguments)) {
        argv[n++] = "--checkpoint-every";
        argv[n++] = "0";
    }
    snprintf(words, sizeof words, "%s", arguments);
    for (char *w = strtok(words, " "); w != NULL && n < MOST_WORDS - 1; w = strtok(NULL, " "))
        argv[n++] = w;
    argv[n] = NULL;
    signal(SIGXFSZ, SIG_IGN);
    const struct rlimit size = { limit, limit };
    const int err = open(tiny_path(&folder, "err"), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    snprintf(path, sizeof path, "%s/ted4enc", build);
    if (err < 0 || dup2(err, STDERR_FILENO) < 0 || chdir(folder.path) != 0 ||
        (limit > 0 && setrlimit(RLIMIT_FSIZE, &size) != 0))
        _exit(100);
    execv(path, (char *const *)(uintptr_t)argv);
    _exit(101);
}

static inline pid_t start(const char *arguments, rlim_t limit)
{
    const pid_t child = fork();

    assert_true(child >= 0);
    if (child == 0)
        become_program(arguments, limit);
    return child;
}

/* Returns the exit status of the child, or 1000 plus the signal that ended it. */
static inline int finish(pid_t child)
{
    int status;

    assert_int_equal(waitpid(child, &status, 0), child);
    return WIFSIGNALED(status) ? 1000 + WTERMSIG(status) : WEXITSTATUS(status);
}

static inline int run(const char *arguments, rlim_t limit)
{
    return finish(start(arguments, limit));
}

static inline void pause_us(long us)
{
    const struct timespec t = { us / 1000000, us % 1000000 * 1000 };

    nanosleep(&t, NULL);
}

/* ---- what the program leaves ---- */

static inline ball_file read_file(const char *name)
{
    ball_file f = { malloc(MOST_BYTES), 0 };
    FILE *in = fopen(tiny_path(&folder, name), "rb");

    if (f.bytes == NULL || in == NULL)
        fail_msg("%s cannot be read", name);
    f.size = fread(f.bytes, 1, MOST_BYTES, in);
    fclose(in);
    return f;
}

static inline void read_text(const char *name, char *text, size_t size)
{
    ball_file f = read_file(name);

    assert_true(f.size < size);
    memcpy(text, f.bytes, f.size);
    text[f.size] = 0;
    free(f.bytes);
}

static inline int is_there(const char *name)
{
    return access(tiny_path(&folder, name), F_OK) == 0;
}

static inline void gone(const char *name)
{
    must(remove(tiny_path(&folder, name)) == 0, name);
}

/* Asserts that standard error is one line of ted4enc that contains what. */
static inline void expect_words(const char *what)
{
    char text[4096];

    read_text("err", text, sizeof text);

    const char *end = strchr(text, '\n');

    if (strncmp(text, "ted4enc: ", 9) != 0 || end == NULL || end[1] != 0 ||
        strstr(text, what) == NULL)
        fail_msg("stderr \"%s\", expected one line with \"%s\"", text, what);
}

/* Asserts that out/ contains exactly the files named. */
static inline void expect_files(const char *names)
{
    char found[512] = "", *at = found;
    DIR *d = opendir(tiny_path(&folder, "out"));

    assert_non_null(d);
    for (struct dirent *e = readdir(d); e != NULL; e = readdir(d))
        if (e->d_name[0] != '.') {
            at += snprintf(at, (size_t)(found + sizeof found - at), " %s", e->d_name);
            if (strstr(names, e->d_name) == NULL)
                fail_msg("out/ holds %s, expected only: %s", e->d_name, names);
        }
    closedir(d);
    assert_int_equal(strlen(found), strlen(names) > 0 ? strlen(names) + 1 : 0);
}

static inline void expect_same(const char *name, const ball_file *want)
{
    ball_file f = read_file(name);

    ball_check_same(want, &f);
    free(f.bytes);
    gone(name);
}

/* Asserts that the log has the lines of the undisturbed run, except for the times at their ends,
 * and that no time decreases. */
static inline void expect_log(const char *name, const char *want)
{
    char text[MOST_LOG];
    const char *got = text;
    double before = 0, worked = 0;

    read_text(name, text, sizeof text);
    while (*want != 0) {
        const char *times = strstr(want, "\"ms\":"), *seconds = strstr(got, "\"seconds\":"),
                   *cpu = strstr(got, "\"cpu_seconds\":");

        assert_non_null(times);
        assert_non_null(seconds);
        assert_non_null(cpu);
        assert_int_equal(strncmp(got, want, (size_t)(times - want)), 0);
        assert_true(strtod(seconds + 10, NULL) >= before);
        assert_true(strtod(cpu + 14, NULL) >= worked);
        before = strtod(seconds + 10, NULL);
        worked = strtod(cpu + 14, NULL);
        want = strchr(want, '\n') + 1;
        got = strchr(got, '\n') + 1;
    }
    assert_int_equal(*got, 0);
    gone(name);
}

/* Runs the program undisturbed. */
static inline void run_calmly(const char *arguments)
{
    char words[512];

    snprintf(words, sizeof words, "-o out/x.ted4 %s%s",
             has_checkpoint(arguments) ? "--checkpoint-every 60 " : "", arguments);
    if (run(words, 0) != 0)
        expect_words("nothing at all");
}

/* Resumes from the checkpoint in out/c and asserts that the file is that of the reference. */
static inline void resume_to_reference(void)
{
    run_calmly("--checkpoint out/c --resume");
    expect_same("out/x.ted4", &reference.file);
    gone("out/c");
}

/* Leaves in out/c a checkpoint of the end of stage 1, and no other file in out/. */
static inline void make_checkpoint(void)
{
    run_calmly("--stage1 out/s");
    gone("out/x.ted4");
    must(rename(tiny_path(&folder, "out/s"), tiny_path(&folder, "out/c")) == 0, "out/c");
    expect_files("c");
}

/* ---- set-up ---- */

static inline outcome make_outcome(const char *options)
{
    char words[256];
    outcome r;

    snprintf(words, sizeof words, "--log out/l %s", options);
    run_calmly(words);
    r.file = read_file("out/x.ted4");
    read_text("out/l", r.log, sizeof r.log);
    gone("out/x.ted4");
    gone("out/l");
    return r;
}

static inline int set_up(void **state)
{
    (void)state;
    build = getenv("TED4_BUILD");
    if (build == NULL)
        return 0;
    folder = tiny_new();
    (void)tiny_path(&folder, "out/x.ted4"); /* creates the folder */

    tiny_folder scene;

    snprintf(scene.path, sizeof scene.path, "%s", tiny_path(&folder, "scene"));
    must(mkdir(scene.path, 0777) == 0, scene.path);
    ball_scene(&scene, 5, 1);
    reference = make_outcome("");
    return 0;
}

static inline int tear_down(void **state)
{
    (void)state;
    if (build == NULL)
        return 0;
    free(reference.file.bytes);
    tiny_free(&folder);
    return 0;
}

/* Every test calls this first: empties out/, whatever the previous test has left there. */
static inline void begin_test(void)
{
    if (build == NULL) {
        print_message("skipped: TED4_BUILD is not set\n");
        skip();
    }
    tiny_remove_path(tiny_path(&folder, "out"));
    (void)tiny_path(&folder, "out/x.ted4");
}

/* The options that usual[] gives. */
static inline ted4_train_options usual_options(void)
{
    ted4_train_options o;

    assert_int_equal(ted4_options_preset(&o, "draft"), 0);
    o.stage1 = STAGE1;
    o.stage2 = STEPS - STAGE1;
    for (size_t i = 0; usual[i] != NULL; i++)
        if (strcmp(usual[i], "--set") == 0)
            ball_set(&o, usual[i + 1]);
    return o;
}

/* Begins a trainer of the usual run over the scene; end_usual finishes both. */
static inline void begin_usual(ted4_trainer *t, ted4_dataset *d)
{
    const ted4_dataset_options wanted = { .downscale = 1, .white = 1, .cache_bytes = 1 << 20 };
    const ted4_train_options o = usual_options();
    ted4_message m;

    if (ted4_dataset_load(d, tiny_path(&folder, "scene"), &wanted, &m) != 0 ||
        ted4_dataset_verify(d, NULL, &m) != 0)
        fail_msg("%s", m.text);
    ball_begin(t, &o, d, NULL);
}

/* Writes the trainer's state as the checkpoint name, without ted4_checkpoint_save, which refuses
 * values that are not finite. */
static inline void end_usual(ted4_trainer *t, ted4_dataset *d, const char *name)
{
    ted4_snapshot s = { NULL, 0 };

    assert_int_equal(ted4_snapshot_take(t, &s), 0);
    tiny_bytes(&folder, name, s.bytes, s.size);
    ted4_snapshot_free(&s);
    ted4_trainer_finish(t);
    ted4_dataset_free(d);
}

#endif
