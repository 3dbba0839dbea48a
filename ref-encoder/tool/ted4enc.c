/* ted4enc.c - trains a scene and writes it as a .ted4 file (decisions 5).
 * SPDX-License-Identifier: BSD-2-Clause */
#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "data/dataset.h"
#include "file_out.h"
#include "kernel/threads.h"
#include "run_log.h"
#include "ted4.h"
#include "train/checkpoint.h"
#include "train/make_scene.h"
#include "verify.h"
#include "write/encode.h"

enum { EXIT_FINE = 0, EXIT_TOOL = 3 };
enum { MAX_SETS = 64 };
enum { OPTION_PRESET = 256, OPTION_LAMBDA, OPTION_DOWNSCALE, OPTION_SEED, OPTION_ITERATIONS,
       OPTION_CHECKPOINT, OPTION_RESUME, OPTION_LOG, OPTION_SET, OPTION_CHECK, OPTION_JSON,
       OPTION_BLACK };

typedef struct {
    const char *scene, *out, *preset, *lambda, *checkpoint, *log, *iterations;
    const char *set[MAX_SETS];
    int         n_sets, downscale, threads, resume, check, json, force, quiet, verbose, black;
    uint32_t    seed;
} request;

static const struct { struct option o; const char *help; } table[] = {
    { { "output", required_argument, NULL, 'o' }, "FILE     the .ted4 file to write" },
    { { "preset", required_argument, NULL, OPTION_PRESET }, "NAME   draft, fast, medium (default), slow, paper" },
    { { "lambda", required_argument, NULL, OPTION_LAMBDA }, "X      weight of the rate, as --set lambda=X" },
    { { "downscale", required_argument, NULL, OPTION_DOWNSCALE }, "N   integer area averaging of the pictures" },
    { { "seed", required_argument, NULL, OPTION_SEED }, "S        same scene, options and seed: same bytes" },
    { { "threads", required_argument, NULL, 'j' }, "N     threads; 0 (default): all" },
    { { "iterations", required_argument, NULL, OPTION_ITERATIONS }, "A,B  steps of both stages" },
    { { "checkpoint", required_argument, NULL, OPTION_CHECKPOINT }, "FILE  saved every minute" },
    { { "resume", no_argument, NULL, OPTION_RESUME }, "         go on from the checkpoint if it is there" },
    { { "log", required_argument, NULL, OPTION_LOG }, "FILE      JSON lines of progress" },
    { { "set", required_argument, NULL, OPTION_SET }, "NAME=VALUE  any training option of the table below" },
    { { "check", no_argument, NULL, OPTION_CHECK }, "          say what the scene holds, and stop" },
    { { "black", no_argument, NULL, OPTION_BLACK }, "          pictures with alpha lie on black, not white" },
    { { "json", no_argument, NULL, OPTION_JSON }, "           result as JSON on stdout" },
    { { "force", no_argument, NULL, 'f' }, "          overwrite" },
    { { "quiet", no_argument, NULL, 'q' }, "          no progress" },
    { { "verbose", no_argument, NULL, 'v' }, "        progress lines, terminal or not" },
    { { "help", no_argument, NULL, 'h' }, "           this text" },
    { { "version", no_argument, NULL, 'V' }, "        versions" },
};

enum { N_OPTIONS = (int)(sizeof table / sizeof table[0]) };

static int complain(const char *text)
{
    fprintf(stderr, "ted4enc: %s\n", text);
    return EXIT_TOOL;
}

static void help(void)
{
    printf("usage: ted4enc SCENE -o out.ted4 [options]\n"
           "SCENE is a folder: COLMAP, D-NeRF/Blender or nerfstudio layout.\n\n");
    for (int i = 0; i < N_OPTIONS; i++) {
        if (table[i].o.val < 256)
            printf("  -%c, ", table[i].o.val);
        else
            printf("      ");
        printf("--%s %s\n", table[i].o.name, table[i].help);
    }
    printf("\nTraining options (--set), with their presets:\n");
    ted4_options_help(stdout);
    printf("\nExit status: 0 fine, 3 usage, input, output or resources.\n");
}

static int whole_number(const char *text, long lo, long hi, long *value)
{
    char *end;

    *value = strtol(text, &end, 10);
    return *text != '\0' && *end == '\0' && *value >= lo && *value <= hi;
}

/* 0 go on, 1 done, -1 wrong. */
static int take_option(request *r, int c, const char *value)
{
    long n = 0;

    switch (c) {
    case 'o': r->out = value; return 0;
    case 'j': r->threads = whole_number(value, 0, 1024, &n) ? (int)n : -1;
              return r->threads < 0 ? -1 : 0;
    case 'f': r->force = 1; return 0;
    case 'q': r->quiet = 1; return 0;
    case 'v': r->verbose = 1; return 0;
    case 'h': help(); return 1;
    case 'V': printf("ted4enc " TED4_VERSION " (specification " TED4_SPEC_VERSION ")\n"); return 1;
    case OPTION_PRESET: r->preset = value; return 0;
    case OPTION_LAMBDA: r->lambda = value; return 0;
    case OPTION_DOWNSCALE: r->downscale = whole_number(value, 1, 64, &n) ? (int)n : 0;
                           return r->downscale == 0 ? -1 : 0;
    case OPTION_SEED: if (!whole_number(value, 0, 0x7fffffff, &n)) return -1;
                      r->seed = (uint32_t)n; return 0;
    case OPTION_ITERATIONS: r->iterations = value; return 0;
    case OPTION_CHECKPOINT: r->checkpoint = value; return 0;
    case OPTION_RESUME: r->resume = 1; return 0;
    case OPTION_LOG: r->log = value; return 0;
    case OPTION_SET: if (r->n_sets >= MAX_SETS) return -1;
                     r->set[r->n_sets++] = value; return 0;
    case OPTION_CHECK: r->check = 1; return 0;
    case OPTION_JSON: r->json = 1; return 0;
    case OPTION_BLACK: r->black = 1; return 0;
    default: return -1;
    }
}

static int parse(request *r, int argc, char **argv)
{
    static char   name[] = "ted4enc";   /* what getopt's messages begin with, however we were called */
    struct option list[N_OPTIONS + 1];
    int           c;

    argv[0] = name;
    memset(list, 0, sizeof list);
    for (int i = 0; i < N_OPTIONS; i++)
        list[i] = table[i].o;
    *r = (request){ .preset = "medium", .downscale = 1 };
    while ((c = getopt_long(argc, argv, "o:j:fqvhV", list, NULL)) != -1) {
        const int what = take_option(r, c, optarg);

        for (int i = 0; what < 0 && i < N_OPTIONS; i++)
            if (list[i].val == c)
                fprintf(stderr, "ted4enc: --%s: bad value %s\n", list[i].name, optarg != NULL ? optarg : "");
        if (what != 0)
            return what;
    }
    if (optind + 1 != argc) {
        complain("one scene folder expected; --help lists the options");
        return -1;
    }
    r->scene = argv[optind];
    if (r->out == NULL && !r->check) {
        complain("-o out.ted4 expected");
        return -1;
    }
    if (r->resume && r->checkpoint == NULL) {
        complain("--resume needs --checkpoint FILE");
        return -1;
    }
    return 0;
}

static int set_options(const request *r, ted4_train_options *o)
{
    char why[256], text[256];
    int  a, b;
    char rest;

    if (ted4_options_preset(o, r->preset) != 0) {
        snprintf(why, sizeof why, "--preset %s: expected draft, fast, medium, slow or paper",
                 r->preset);
        return complain(why);
    }
    o->seed = r->seed;
    if (r->iterations != NULL) {
        if (sscanf(r->iterations, "%d,%d%c", &a, &b, &rest) != 2 || a < 1 || b < 0)
            return complain("--iterations: expected A,B");
        o->stage1 = a;
        o->stage2 = b;
    }
    if (r->lambda != NULL) {
        snprintf(text, sizeof text, "lambda=%s", r->lambda);
        if (ted4_options_set(o, text, why, sizeof why) != 0)
            return complain(why);
    }
    for (int i = 0; i < r->n_sets; i++)
        if (ted4_options_set(o, r->set[i], why, sizeof why) != 0)
            return complain(why);
    return EXIT_FINE;
}

/* Steps to the end, reporting and saving on the way. */
static int train(const request *r, ted4_trainer *t)
{
    const uint64_t total = ted4_trainer_total(t);
    ted4_run_log   log;
    char           why[1024];
    double         saved = ted4_seconds();
    int            bad = 0;

    if (ted4_run_log_open(&log, r->log, r->resume, r->quiet, r->verbose, why, sizeof why) != 0)
        return complain(why);
    log.start_step = log.last_step = t->iteration;
    while (!bad && t->iteration < total) {
        bad = ted4_trainer_step(t) != 0;
        if (!bad && (t->iteration % 1000 == 0 || t->iteration == total)) {
            log.psnr = ted4_trainer_preview(t, 4);
            bad = log.psnr < 0;
            ted4_run_log_step(&log, t);
        }
        if (!bad && r->checkpoint != NULL && ted4_seconds() - saved > 60) {
            bad = ted4_checkpoint_save(t, r->checkpoint) != 0;
            saved = ted4_seconds();
        }
    }
    if (!bad && r->checkpoint != NULL)
        bad = ted4_checkpoint_save(t, r->checkpoint) != 0;
    ted4_run_log_close(&log);
    return bad ? complain(t->message.text) : EXIT_FINE;
}

static void report(const request *r, const ted4_trainer *t, const ted4_verified *v, size_t size,
                   double seconds)
{
    if (r->json)
        printf("{\"bytes\":%zu,\"train_s\":%.2f,\"steps\":%llu,\"ms_per_step\":%.3f,\"anchors\":%u,\"gaussians\":%zu,"
               "\"dynamic\":%u,\"estimated_bits\":%.0f,\"coded_bits\":%.0f,\"hash\":\"%s\"}\n",
               size, seconds, (unsigned long long)t->iteration,
               1e3 * seconds / (double)(t->iteration > 0 ? t->iteration : 1), v->anchors,
               v->gaussians, v->dynamic, v->estimated_bits, v->coded_bits, v->hash);
    else if (!r->quiet)
        fprintf(stderr, "%s: %zu bytes, %u anchors (%u move), %zu Gaussians, trained in %.1f s, hash %s\n",
                r->out, size, v->anchors, v->dynamic, v->gaussians, seconds, v->hash);
}

static int write_scene(const request *r, ted4_trainer *t, double seconds)
{
    ted4_scene   *scene;
    uint8_t      *bytes = NULL;
    size_t        size = 0;
    char          why[1024];
    double        bits[TED4_TYPES];
    ted4_verified v = { 0 };
    ted4_error    e = { TED4_OK, 0 };
    int           status = EXIT_FINE;

    if (ted4_make_scene(t, &scene) != 0 || ted4_integer_rate(t, bits) != 0) {
        ted4_scene_free(scene);
        return complain(t->message.text);
    }
    for (int y = 0; y < TED4_TYPES; y++)
        v.estimated_bits += bits[y];
    if (ted4_encode(scene, 0, t->parallel, &bytes, &size, &e) != TED4_OK) {
        snprintf(why, sizeof why, "encoder refused its own scene: %s", ted4_status_id(e.code));
        status = complain(why);
    } else if (ted4_verify(scene, bytes, size, t->parallel, &v, why, sizeof why) != 0 ||
               ted4_file_write(r->out, bytes, size, why, sizeof why) != 0) {
        status = complain(why);
    } else {
        report(r, t, &v, size, seconds);
    }
    free(bytes);
    ted4_scene_free(scene);
    return status;
}

static int encode(const request *r, const ted4_train_options *o, ted4_dataset *d)
{
    ted4_parallel p;
    ted4_trainer  t;
    int           status;
    const double  start = ted4_seconds();

    ted4_threads_init(&p, r->threads);
    if (ted4_trainer_init(&t, o, d, &p) != 0 ||
        (r->resume && access(r->checkpoint, F_OK) == 0 &&
         ted4_checkpoint_load(&t, r->checkpoint) != 0)) {
        status = complain(t.message.text);
    } else {
        status = train(r, &t);
        if (status == EXIT_FINE)
            status = write_scene(r, &t, ted4_seconds() - start);
    }
    ted4_trainer_finish(&t);
    ted4_threads_finish(&p);
    return status;
}

int main(int argc, char **argv)
{
    request            r;
    ted4_train_options o;
    ted4_dataset       d;
    ted4_message       m;
    char               why[1024];
    const int          parsed = parse(&r, argc, argv);

    if (parsed != 0)
        return parsed > 0 ? EXIT_FINE : EXIT_TOOL;
    if (set_options(&r, &o) != EXIT_FINE)
        return EXIT_TOOL;
    if (!r.check && (ted4_file_writable(r.out, r.force, why, sizeof why) != 0 ||
                     (r.checkpoint != NULL &&
                      ted4_file_writable(r.checkpoint, 1, why, sizeof why) != 0)))
        return complain(why);

    const ted4_dataset_options wanted = { r.downscale, !r.black, r.seed, (size_t)2 << 30 };

    if (ted4_dataset_load(&d, r.scene, &wanted, &m) != 0)
        return complain(m.text);

    int status = EXIT_FINE;

    if (r.check)
        ted4_dataset_print(&d, stdout);
    if (ted4_dataset_verify(&d, &m) != 0)
        status = complain(m.text);
    else if (!r.check)
        status = encode(&r, &o, &d);
    ted4_dataset_free(&d);
    return status;
}
