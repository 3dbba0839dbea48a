/* encode_main.c - see encode_main.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "encode_main.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include "base/bytes.h"
#include "check_report.h"
#include "data/dataset.h"
#include "data/scatter.h"
#include "describe_trained.h"
#include "file_out.h"
#include "outputs.h"
#include "tool/threads.h"
#include "request.h"
#include "stop.h"
#include "ted4.h"
#include "tool/cli.h"
#include "tool/clock.h"
#include "tool/plural.h"
#include "train/model/header_from_options.h"
#include "train/step/trainer_init.h"
#include "training.h"
#include "transcode.h"

/* What a run of the program works with. All borrowed. */
typedef struct {
    const ted4_request *request;
    const ted4_parallel *parallel;
    ted4_teller *teller;
    ted4_exchange *exchange; /* NULL: alone */
    double begin;            /* of ted4_clock */
} encoder;

/* Returns whether this process writes files and messages. */
static int leads(const ted4_exchange *x)
{
    return x == NULL || x->rank == 0;
}

/* Says why this process ends, with --json also as an object; --check prints one of its own. If the
 * others do not end for the same reason, ends them, too. */
static int complain(const encoder *e, const char *text)
{
    const ted4_request *r = e->request;
    ted4_exchange *x = e->exchange;

    if (!r->check)
        ted4_check_report(NULL, &r->options, text, r->json);
    if (x != NULL && x->n > 1 && !x->meet(x->user)) {
        ted4_teller_error(e->teller, "rank %zu of %zu: %s", x->rank, x->n, text);
        x->end(x->user, TED4_EXIT_TOOL);
    } else if (leads(x)) {
        ted4_teller_error(e->teller, "%s", text);
    }
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

/* The beginning of what --json prints of a file. */
static void print_file(const ted4_request *r, size_t size)
{
    printf("{\"bytes\":%zu,\"profile\":\"%s\"", size,
           r->options.profile == TED4_PROFILE_COMPACT ? "compact" : "main");
}

static void report(const ted4_training *training, const ted4_coded *c, times s)
{
    const ted4_request *r = training->request;
    const ted4_trainer *t = training->trainer;
    const ted4_verified *v = &c->verified;
    const unsigned long long steps = t->iteration + training->again;

    if (r->json) {
        print_file(r, c->size);
        printf(",\"lambda\":%.7g,\"setup_s\":%.2f,\"train_s\":%.2f,\"steps\":%llu,"
               "\"ms_per_step\":%.3f,\"anchors\":%u,"
               "\"gaussians\":%zu,\"dynamic\":%u,\"estimated_bits\":%.0f,\"coded_bits\":%.0f,"
               "\"probe_with_time\":%.6f,\"probe_without\":%.6f,\"rollbacks\":%llu,\"peak_mib\":%."
               "0f,\"hash\":\"%s\"}\n",
               c->lambda, s.setup, s.train, steps, 1e3 * s.train / (double)(steps > 0 ? steps : 1),
               v->anchors, v->gaussians, v->dynamic, v->estimated_bits, v->coded_bits,
               t->search.probe_loss[0], t->search.probe_loss[1],
               (unsigned long long)t->monitor.state.rollbacks, peak_mib(), v->hash);
    } else {
        ted4_teller_say(
            training->teller,
            "%s: %zu bytes, %u anchor%s (%u move), %zu Gaussian%s, trained in %.1f s, hash %s",
            r->out, c->size, v->anchors, ted4_s(v->anchors), v->dynamic, v->gaussians,
            ted4_s(v->gaussians), s.train, v->hash);
    }
}

/* Exit status of a run that was ended by a signal, minus the number of the signal. */
enum { SIGNALLED = 128 };

/* Says what the exchange between ranks has cost, if there was any. */
static void say_exchange(const encoder *e)
{
    const ted4_exchange *x = e->exchange;

    if (x == NULL || x->n == 1)
        return;
    if (x->steps == 0)
        ted4_teller_say(e->teller, "%zu ranks have shared no step: each had one view", x->n);
    else
        ted4_teller_say(e->teller,
                        "%zu ranks have shared %llu step%s: rank 0 has sent %.0f bytes a step, and "
                        "spent %.1f ms a step on that and on waiting",
                        x->n, (unsigned long long)x->steps, ted4_s(x->steps),
                        (double)x->bytes / (double)x->steps, 1e3 * x->seconds / (double)x->steps);
}

/* Trains, codes and writes the file. Returns the exit status. */
static int run(const encoder *e, ted4_trainer *t)
{
    const ted4_request *r = e->request;
    ted4_teller *teller = e->teller;
    const double start = ted4_clock();
    ted4_training training;
    ted4_coded coded = { 0 };
    int bad = ted4_training_begin(&training, r, t, teller) != 0;
    const double before = t->seconds;

    if (!bad && r->target_size > 0)
        bad = ted4_training_target(&training, &coded) != 0;
    else if (!bad)
        bad = ted4_training_go(&training, 2) != 0 || ted4_training_code(&training, &coded) != 0;
    /* The file is written before the log is closed, so that it is not lost if closing fails. */
    if (leads(e->exchange) && coded.bytes != NULL) {
        const int written = ted4_file_keep(r->out, r->force, coded.bytes, coded.size, training.why,
                                           sizeof training.why) == 0;

        if (bad && written)
            ted4_teller_say(teller,
                            "%s: the file of lambda %.5g, %zu bytes, is kept; with -f, a new "
                            "search replaces it",
                            r->out, coded.lambda, coded.size);
        bad = bad || !written;
    }
    bad = ted4_training_end(&training, bad) != 0;
    if (!bad) {
        say_exchange(e);
        report(&training, &coded, (times) { start - e->begin, before + ted4_clock() - start });
    }

    const int over = r->target_size > 0 && coded.size > r->target_size;

    ted4_coded_free(&coded);
    if (bad && training.stopped != 0) {
        ted4_teller_say(teller, "%s", training.why);
        return SIGNALLED + training.stopped;
    }
    if (bad)
        return complain(e, training.why);
    if (over && leads(e->exchange))
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

static int encode(const encoder *e, ted4_dataset *d)
{
    ted4_train_options options = e->request->options;
    ted4_trainer t;

    now(e->teller, TED4_TELL_STARTING, "placing first anchors");
    if (ted4_header_settle(&options, d) != 0)
        return complain(e, "no memory to look for flicker");

    const int bad = ted4_trainer_init(&t, &options, d, e->parallel) != 0;

    t.exchange = e->exchange;

    const int status = bad ? complain(e, t.message.text) : run(e, &t);

    ted4_trainer_finish(&t);
    return status;
}

enum { FEWEST_DECODERS = 4 };

/* Tests before hours of training whether all output files can be written. Returns 0 or an exit
 * status. */
static int check_outputs(const encoder *e)
{
    char why[1024];

    if (e->request->check || !leads(e->exchange))
        return 0;
    return ted4_outputs_check(e->request, why, sizeof why) == 0 ? 0 : complain(e, why);
}

/* Number of threads that decode pictures in advance: none for a single thread; otherwise as many as
 * there are threads, but at least FEWEST_DECODERS. */
static int decoders(const ted4_parallel *p)
{
    const int n = ted4_threads_count(p);

    return n == 1 ? 0 : n < FEWEST_DECODERS ? FEWEST_DECODERS : n;
}

/* Prints the warnings of the loaders from number from on. Returns the number of all warnings. */
static size_t warn(const encoder *e, const ted4_dataset *d, size_t from)
{
    for (size_t i = from; i < d->n_warnings && leads(e->exchange); i++)
        ted4_teller_error(e->teller, "warning: %s", d->warnings[i]);
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
        teller, "%s: %zu training picture%s, %zu held out, of %u camera%s and %u time%s, %s pixels",
        d->layout, d->n_pictures - tests, ted4_s(d->n_pictures - tests), tests,
        (unsigned)d->n_cameras, ted4_s(d->n_cameras), (unsigned)d->n_frames, ted4_s(d->n_frames),
        size);
}

/* Replaces the initial points if the scene has none, or none that are useful. Returns 0, or -1 with
 * *m filled. */
static int scatter(const encoder *e, ted4_dataset *d, ted4_message *m)
{
    ted4_scatter_options o = e->request->bounds;
    ted4_teller *teller = e->teller;
    ted4_scattered what;

    now(teller, TED4_TELL_STARTING, "looking for initial points");
    o.seed = e->request->options.seed;
    if (ted4_dataset_scatter(d, &o, e->parallel, &what, m) != 0)
        return -1;
    if (!leads(e->exchange))
        return 0;
    if (what.outside > 0)
        ted4_teller_error(teller, "warning: %zu initial point%s outside the bounds %s not used",
                          what.outside, ted4_s(what.outside), what.outside == 1 ? "is" : "are");
    if (what.scattered > 0 && what.given > 0)
        ted4_teller_error(teller,
                          "warning: most of the %zu initial points do not lie on what "
                          "pictures show; %zu others take their place",
                          what.given, what.scattered);
    return 0;
}

/* Refuses the rate of --fps if the scene states another one. --check shows it; otherwise the scene
 * stays without one until the file is written, so that checkpoints go with every rate. */
static int set_rate(ted4_dataset *d, const ted4_request *r, ted4_message *m)
{
    if (r->rate > 0 && d->rate > 0 && r->rate != d->rate) {
        snprintf(m->text, sizeof m->text,
                 "--fps: the scene states %.9g frames per second, not %.9g", d->rate, r->rate);
        return -1;
    }
    if (r->rate > 0 && r->check)
        d->rate = r->rate;
    return 0;
}

/* Loads the scene, and checks or encodes it as requested. Returns the exit status. */
static int work(const encoder *e)
{
    const ted4_request *r = e->request;
    ted4_teller *teller = e->teller;
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

    const int unread = ted4_dataset_load(&d, r->scene, &wanted, &m) != 0;

    if (unread || set_rate(&d, r, &m) != 0 ||
        ted4_describe_possible(r, &d, m.text, sizeof m.text) != 0) {
        if (!unread)
            ted4_dataset_free(&d);
        if (r->check)
            ted4_check_report(NULL, &r->options, m.text, r->json);
        return complain(e, m.text);
    }

    const size_t said = warn(e, &d, 0);

    d.ahead = decoders(e->parallel);
    say_found(teller, &d);
    now(teller, TED4_TELL_STARTING, "looking at all pictures");

    const int bad = ted4_dataset_verify(&d, e->parallel, &m) != 0 || scatter(e, &d, &m) != 0;

    if (r->check)
        ted4_check_report(&d, &r->options, bad ? m.text : NULL, r->json);
    if (bad)
        status = complain(e, m.text);
    warn(e, &d, said);
    if (status == TED4_EXIT_FINE && !r->check)
        status = encode(e, &d);
    ted4_dataset_free(&d);
    return status;
}

/* Reads the file of --transcode. Returns NULL, with *status set and a message, if that fails. */
static uint8_t *read_input(const encoder *e, size_t *size, int *status)
{
    uint8_t *const file = ted4_read_ted4(e->request->transcode, size);

    if (file == NULL) {
        ted4_teller_clear(e->teller);
        *status = ted4_report_unread("ted4enc", e->request->transcode, e->request->json);
    }
    return file;
}

/* Says why a file became no other one. why: NULL if the file was refused for error. */
static int complain_of_input(const encoder *e, const ted4_error *error, const char *why)
{
    char text[1024];

    if (why == NULL) {
        ted4_teller_clear(e->teller);
        return ted4_report("ted4enc", e->request->transcode, error, e->request->json);
    }
    snprintf(text, sizeof text, "%s: %s", e->request->transcode, why);
    return complain(e, text);
}

/* Prints what --json says of the file that --transcode has made. Returns the exit status. */
static int report_transcoded(const encoder *e, const uint8_t *file, size_t size)
{
    const ted4_options options = { .max_bytes = UINT64_MAX, .parallel = e->parallel };
    ted4_error error = { TED4_OK, 0 };
    ted4_scene *scene;
    ted4_info info;
    char hash[33];

    if (ted4_decode(file, size, &options, &scene, &error) != TED4_OK)
        return complain(e, ted4_status_text(error.code));
    ted4_scene_info(scene, &info);
    ted4_scene_free(scene);
    ted4_hex(hash, info.hash, sizeof info.hash);
    print_file(e->request, size);
    printf(",\"anchors\":%" PRIu32 ",\"gaussians\":%zu,\"dynamic\":%" PRIu32 ",\"hash\":\"%s\"}\n",
           info.n_anchors, info.n_gaussians, info.n_dynamic, hash);
    return TED4_EXIT_FINE;
}

/* --transcode. Returns the exit status. */
static int transcode(const encoder *e)
{
    const ted4_request *r = e->request;
    size_t size, out_size, dropped;
    int sorted, status;
    uint8_t *const file = read_input(e, &size, &status), *out;
    ted4_error error = { TED4_OK, 0 };
    char text[1024];
    const char *why;

    if (file == NULL)
        return status;
    if (ted4_transcode(file, size, r->options.profile, e->parallel, &out, &out_size, &sorted,
                       &dropped, &error, &why) != 0) {
        free(file);
        return complain_of_input(e, &error, why);
    }
    if (sorted)
        ted4_teller_error(e->teller, "warning: anchors are in another order, with another hash");
    if (dropped > 0)
        ted4_teller_error(e->teller, "warning: %zu unknown chunk%s %s left out", dropped,
                          ted4_s(dropped), dropped == 1 ? "is" : "are");
    status = ted4_file_write(r->out, r->force, out, out_size, text, sizeof text) != 0
                 ? complain(e, text)
                 : TED4_EXIT_FINE;
    if (status == TED4_EXIT_FINE && r->json)
        status = report_transcoded(e, out, out_size);
    else if (status == TED4_EXIT_FINE)
        ted4_teller_say(e->teller, "%s: %zu bytes, from %zu", r->out, out_size, size);
    free(file);
    free(out);
    return status;
}

/* Returns how many threads this process takes; 0: as many as it may use cores. The processes of a
 * machine share its cores. A process that is bound to some of them takes no more than these. */
static int threads_of(const ted4_request *r, const ted4_exchange *x)
{
    const int allowed = ted4_threads_allowed(), cores = (int)sysconf(_SC_NPROCESSORS_ONLN);

    if (r->threads > 0 || x == NULL)
        return r->threads;

    const int share = cores > (int)x->neighbours ? cores / (int)x->neighbours : 1;

    return share < allowed ? share : allowed;
}

/* What no ranks share: they end at once, and rank 0 does it alone. */
static int is_for_one(const ted4_request *r)
{
    return r->check || r->transcode != NULL;
}

/* Parses the command line: rank 0 first, so that what is wrong with it is said once. Returns a
 * TED4_REQUEST_ value. */
static int parse(ted4_request *r, int argc, char **argv, ted4_exchange *x)
{
    int parsed = leads(x) ? ted4_request_parse(r, argc, argv) : TED4_REQUEST_GO;

    parsed = ted4_exchange_first(x, parsed);
    if (leads(x) || parsed != TED4_REQUEST_GO)
        return parsed;
    parsed = ted4_request_parse(r, argc, argv);
    r->quiet = 1;
    r->verbose = r->json = 0;
    r->log = NULL;
    return is_for_one(r) ? TED4_REQUEST_DONE : parsed;
}

int ted4_encoder_main(int argc, char **argv, ted4_exchange *x)
{
    ted4_request r;
    ted4_parallel p;
    ted4_teller teller;
    const double begin = ted4_clock();
    const int parsed = parse(&r, argc, argv, x);

    if (parsed != TED4_REQUEST_GO)
        return parsed == TED4_REQUEST_DONE ? TED4_EXIT_FINE : TED4_EXIT_TOOL;

    const encoder e = { &r, &p, &teller, is_for_one(&r) ? NULL : x, begin };

    ted4_teller_begin(&teller, "ted4enc", r.quiet);
    ted4_stop_on_signals(r.quiet);

    int status = check_outputs(&e);

    if (status == TED4_EXIT_FINE) {
        ted4_threads_init(&p, threads_of(&r, e.exchange));
        status = r.transcode != NULL ? transcode(&e) : work(&e);
        ted4_threads_finish(&p);
    }
    ted4_teller_end(&teller);
    return ted4_cli_end("ted4enc", status);
}
