/* ted4enc.c - trains a scene and writes it as a .ted4 file.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "check_report.h"
#include "data/dataset.h"
#include "data/scatter.h"
#include "file_out.h"
#include "tool/threads.h"
#include "request.h"
#include "stop.h"
#include "ted4.h"
#include "tool/cli.h"
#include "train/model/header_from_options.h"
#include "train/step/trainer_init.h"
#include "training.h"

static int complain(ted4_teller *teller, const char *text)
{
    ted4_teller_error(teller, "%s", text);
    return TED4_EXIT_TOOL;
}

/* Peak resident memory of this process, MiB. */
static double peak_mib(void)
{
    struct rusage u;

    return getrusage(RUSAGE_SELF, &u) == 0 ? (double)u.ru_maxrss / 1024.0 : 0.0;
}

/* Seconds for loading the scene and starting, and for training, coding and verification; train
 * includes the training time of the earlier runs that were resumed. */
typedef struct {
    double setup, train;
} times;

static void report(const ted4_request *r, const ted4_trainer *t, ted4_teller *teller,
                   const ted4_coded *c, times s)
{
    const ted4_verified *v = &c->verified;

    if (r->json)
        printf("{\"bytes\":%zu,\"lambda\":%.7g,\"setup_s\":%.2f,\"train_s\":%.2f,\"steps\":%llu,"
               "\"ms_per_step\":%.3f,\"anchors\":%u,"
               "\"gaussians\":%zu,\"dynamic\":%u,\"estimated_bits\":%.0f,\"coded_bits\":%.0f,"
               "\"probe_with_time\":%.6f,\"probe_without\":%.6f,\"rollbacks\":%llu,\"peak_mib\":%."
               "0f,\"hash\":\"%s\"}\n",
               c->size, c->lambda, s.setup, s.train, (unsigned long long)t->iteration,
               1e3 * s.train / (double)(t->iteration > 0 ? t->iteration : 1), v->anchors,
               v->gaussians, v->dynamic, v->estimated_bits, v->coded_bits, t->search.probe_loss[0],
               t->search.probe_loss[1], (unsigned long long)t->monitor.state.rollbacks, peak_mib(),
               v->hash);
    else
        ted4_teller_say(
            teller,
            "%s: %zu bytes, %u anchors (%u move), %zu Gaussians, trained in %.1f s, hash %s",
            r->out, c->size, v->anchors, v->dynamic, v->gaussians, s.train, v->hash);
}

/* Exit status of a run that was ended by a signal, minus the number of the signal. */
enum { SIGNALLED = 128 };

/* Trains, codes and writes the file. Returns the exit status. */
static int run(const ted4_request *r, ted4_trainer *t, ted4_teller *teller, double begin)
{
    const double start = ted4_seconds();
    ted4_training training;
    ted4_coded coded = { 0 };
    int bad = ted4_training_begin(&training, r, t, teller) != 0;
    const double before = t->seconds;

    if (!bad && r->target_size > 0)
        bad = ted4_training_target(&training, &coded) != 0;
    else if (!bad)
        bad = ted4_training_go(&training, ted4_trainer_total(t)) != 0 ||
              ted4_training_code(&training, &coded) != 0;
    /* The file is written before the log is closed, so that it is not lost if closing fails. */
    bad = bad ||
          ted4_file_write(r->out, coded.bytes, coded.size, training.why, sizeof training.why) != 0;
    bad = ted4_training_end(&training, bad) != 0;
    if (!bad)
        report(r, t, teller, &coded, (times) { start - begin, before + ted4_seconds() - start });

    const int over = r->target_size > 0 && coded.size > r->target_size;

    ted4_coded_free(&coded);
    if (bad && training.stopped != 0) {
        ted4_teller_say(teller, "%s", training.why);
        return SIGNALLED + training.stopped;
    }
    if (bad)
        return complain(teller, training.why);
    if (over)
        ted4_teller_error(teller,
                          "warning: no lambda gave %zu bytes or less; this is the smallest file",
                          r->target_size);
    return over ? TED4_EXIT_WARNED : TED4_EXIT_FINE;
}

/* Sets the status line for the time before training. */
static void now(ted4_teller *teller, ted4_teller_kind kind, const char *name)
{
    ted4_facts f = { .kind = kind };

    snprintf(f.name, sizeof f.name, "%s", name);
    ted4_teller_now(teller, &f);
}

static int encode(const ted4_request *r, ted4_dataset *d, const ted4_parallel *p,
                  ted4_teller *teller, double begin)
{
    ted4_train_options options = r->options;
    ted4_trainer t;

    now(teller, TED4_TELL_STARTING, "placing first anchors");
    if (ted4_header_settle(&options, d) != 0)
        return complain(teller, "no memory to look for flicker");

    const int status = ted4_trainer_init(&t, &options, d, p) != 0 ? complain(teller, t.message.text)
                                                                  : run(r, &t, teller, begin);

    ted4_trainer_finish(&t);
    return status;
}

enum { FEWEST_DECODERS = 4 };

static int is_device(const char *path)
{
    struct stat s;

    return stat(path, &s) == 0 && !S_ISREG(s.st_mode) && !S_ISDIR(s.st_mode);
}

/* Tests before hours of training whether all output files can be written. Returns 0 or an exit
 * status. */
static int check_outputs(const ted4_request *r, ted4_teller *teller)
{
    char why[1024];

    if (r->check)
        return 0;
    if (ted4_file_writable(r->out, r->force, why, sizeof why) != 0 ||
        (r->checkpoint != NULL && ted4_file_writable(r->checkpoint, 1, why, sizeof why) != 0) ||
        (r->stage1 != NULL && ted4_file_writable(r->stage1, 1, why, sizeof why) != 0) ||
        (r->log != NULL && !is_device(r->log) &&
         ted4_file_writable(r->log, 1, why, sizeof why) != 0))
        return complain(teller, why);
    return 0;
}

/* Number of threads that decode pictures in advance: none for a single thread; otherwise as many as
 * there are threads, but at least FEWEST_DECODERS. */
static int decoders(const ted4_parallel *p)
{
    const int n = ted4_threads_count(p);

    return n == 1 ? 0 : n < FEWEST_DECODERS ? FEWEST_DECODERS : n;
}

/* Prints the warnings of the loaders from number from on. Returns the number of all warnings. */
static size_t warn(ted4_teller *teller, const ted4_dataset *d, size_t from)
{
    for (size_t i = from; i < d->n_warnings; i++)
        ted4_teller_error(teller, "warning: %s", d->warnings[i]);
    return d->n_warnings;
}

/* Callback of the loader while it unpacks a video. frames: number of frames so far. */
static void unpacking(void *teller, const char *video, size_t frames)
{
    const char *base = strrchr(video, '/');
    ted4_facts f = { .kind = TED4_TELL_UNPACKING, .step = frames };

    snprintf(f.name, sizeof f.name, "%s", base != NULL ? base + 1 : video);
    ted4_teller_now(teller, &f);
}

static void say_found(ted4_teller *teller, const ted4_dataset *d)
{
    size_t tests = 0;
    int low = d->n_pictures > 0 ? d->pictures[0].camera.width : 0, high = low;

    for (size_t i = 0; i < d->n_pictures; i++) {
        const int width = d->pictures[i].camera.width;

        tests += d->pictures[i].is_test;
        low = width < low ? width : low;
        high = width > high ? width : high;
    }

    char size[40];

    if (low == high)
        snprintf(size, sizeof size, "%d x %d", low,
                 d->n_pictures > 0 ? d->pictures[0].camera.height : 0);
    else
        snprintf(size, sizeof size, "%d to %d wide", low, high);
    ted4_teller_say(
        teller, "%s: %zu training pictures, %zu held out, of %u camera%s and %u time%s, %s pixels",
        d->layout, d->n_pictures - tests, tests, (unsigned)d->n_cameras,
        d->n_cameras == 1 ? "" : "s", (unsigned)d->n_frames, d->n_frames == 1 ? "" : "s", size);
}

/* Replaces the initial points if the scene has none, or none that are useful. Returns 0, or -1 with
 * *m filled. */
static int scatter(ted4_dataset *d, const ted4_request *r, const ted4_parallel *p,
                   ted4_teller *teller, ted4_message *m)
{
    ted4_scatter_options o = r->bounds;
    ted4_scattered what;

    now(teller, TED4_TELL_STARTING, "looking for initial points");
    o.seed = r->options.seed;
    if (ted4_dataset_scatter(d, &o, p, &what, m) != 0)
        return -1;
    if (what.outside > 0)
        ted4_teller_error(teller, "warning: %zu initial points outside the bounds are not used",
                          what.outside);
    if (what.scattered > 0 && what.given > 0)
        ted4_teller_error(teller,
                          "warning: most of the %zu initial points do not lie on what "
                          "pictures show; %zu others take their place",
                          what.given, what.scattered);
    return 0;
}

/* Loads the scene, and checks or encodes it as requested. Returns the exit status. */
static int work(const ted4_request *r, ted4_teller *teller, const ted4_parallel *p, double begin)
{
    const ted4_dataset_options wanted = { .downscale = r->downscale,
                                          .white = !r->black,
                                          .seed = r->options.seed,
                                          .cache_bytes = (size_t)r->cache_mib << 20,
                                          .max_frames = (uint32_t)r->max_frames,
                                          .premultiplied = r->premultiplied,
                                          .hold_out = r->hold_out,
                                          .n_hold_out = r->n_hold_out,
                                          .unpacking = unpacking,
                                          .user = teller };
    ted4_dataset d;
    ted4_message m;
    int status = TED4_EXIT_FINE;

    now(teller, TED4_TELL_LOADING, r->scene);
    ted4_teller_say(teller, "loading %s", r->scene);
    if (ted4_dataset_load(&d, r->scene, &wanted, &m) != 0) {
        if (r->check)
            ted4_check_report(NULL, &r->options, m.text, r->json);
        return complain(teller, m.text);
    }

    const size_t said = warn(teller, &d, 0);

    d.ahead = decoders(p);
    say_found(teller, &d);
    now(teller, TED4_TELL_STARTING, "looking at all pictures");

    const int bad = ted4_dataset_verify(&d, p, &m) != 0 || scatter(&d, r, p, teller, &m) != 0;

    if (r->check)
        ted4_check_report(&d, &r->options, bad ? m.text : NULL, r->json);
    if (bad)
        status = complain(teller, m.text);
    warn(teller, &d, said);
    if (status == TED4_EXIT_FINE && !r->check)
        status = encode(r, &d, p, teller, begin);
    ted4_dataset_free(&d);
    return status;
}

int main(int argc, char **argv)
{
    ted4_request r;
    ted4_parallel p;
    ted4_teller teller;
    const double begin = ted4_seconds();
    const int parsed = ted4_request_parse(&r, argc, argv);

    if (parsed != TED4_REQUEST_GO)
        return parsed == TED4_REQUEST_DONE ? TED4_EXIT_FINE : TED4_EXIT_TOOL;
    ted4_teller_begin(&teller, "ted4enc", r.quiet);
    ted4_stop_on_signals(r.quiet);

    int status = check_outputs(&r, &teller);

    if (status == TED4_EXIT_FINE) {
        ted4_threads_init(&p, r.threads);
        status = work(&r, &teller, &p, begin);
        ted4_threads_finish(&p);
    }
    if (fflush(stdout) != 0 || ferror(stdout))
        status = complain(&teller, "standard output cannot be written");
    ted4_teller_end(&teller);
    return status;
}
