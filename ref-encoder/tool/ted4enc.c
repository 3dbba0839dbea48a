/* ted4enc.c - trains a scene and writes it as a .ted4 file (decisions 5).
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "data/dataset.h"
#include "file_out.h"
#include "tool/threads.h"
#include "request.h"
#include "run_log.h"
#include "ted4.h"
#include "tool/cli.h"
#include "train/checkpoint.h"
#include "train/make_scene.h"
#include "verify.h"
#include "write/encode.h"

/* Decoded pictures kept in memory. */
#define CACHE_BYTES ((size_t)2 << 30)
/* Steps between reports, pictures of the preview, seconds between checkpoints. */
enum { REPORT_EVERY = 1000, PREVIEW_PICTURES = 4, CHECKPOINT_EVERY = 60 };

static int complain(const char *text)
{
    fprintf(stderr, "ted4enc: %s\n", text);
    return TED4_EXIT_TOOL;
}

/* Steps to the end, reporting and saving on the way. */
static int train(const ted4_request *r, ted4_trainer *t)
{
    const uint64_t total = ted4_trainer_total(t);
    ted4_run_log   log;
    char           why[1024];
    double         saved = ted4_seconds();
    int            bad = 0;

    if (ted4_run_log_open(&log, r->log, r->resume, r->quiet, r->verbose, why, sizeof why) != 0)
        return complain(why);
    log.last_step = t->iteration;
    while (!bad && t->iteration < total) {
        bad = ted4_trainer_step(t) != 0;
        if (!bad && (t->iteration % REPORT_EVERY == 0 || t->iteration == total)) {
            log.psnr = ted4_trainer_preview(t, PREVIEW_PICTURES);
            bad = log.psnr < 0;
            ted4_run_log_step(&log, t);
        }
        if (!bad && r->checkpoint != NULL && ted4_seconds() - saved > CHECKPOINT_EVERY) {
            bad = ted4_checkpoint_save(t, r->checkpoint) != 0;
            saved = ted4_seconds();
        }
    }
    if (!bad && r->checkpoint != NULL)
        bad = ted4_checkpoint_save(t, r->checkpoint) != 0;
    ted4_run_log_close(&log);
    return bad ? complain(t->message.text) : TED4_EXIT_FINE;
}

static void report(const ted4_request *r, const ted4_trainer *t, const ted4_verified *v, size_t size,
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

static int write_scene(const ted4_request *r, ted4_trainer *t, double seconds)
{
    ted4_scene   *scene;
    uint8_t      *bytes = NULL;
    size_t        size = 0;
    char          why[1024];
    double        bits[TED4_TYPES];
    ted4_verified v = { 0 };
    ted4_error    e = { TED4_OK, 0 };
    int           status = TED4_EXIT_FINE;

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

static int encode(const ted4_request *r, ted4_dataset *d)
{
    ted4_parallel p;
    ted4_trainer  t;
    int           status;
    const double  start = ted4_seconds();

    ted4_threads_init(&p, r->threads);
    if (ted4_trainer_init(&t, &r->options, d, &p) != 0 ||
        (r->resume && access(r->checkpoint, F_OK) == 0 &&
         ted4_checkpoint_load(&t, r->checkpoint) != 0)) {
        status = complain(t.message.text);
    } else {
        status = train(r, &t);
        if (status == TED4_EXIT_FINE)
            status = write_scene(r, &t, ted4_seconds() - start);
    }
    ted4_trainer_finish(&t);
    ted4_threads_finish(&p);
    return status;
}

int main(int argc, char **argv)
{
    ted4_request r;
    ted4_dataset d;
    ted4_message m;
    char         why[1024];
    const int    parsed = ted4_request_parse(&r, argc, argv);

    if (parsed != TED4_REQUEST_GO)
        return parsed == TED4_REQUEST_DONE ? TED4_EXIT_FINE : TED4_EXIT_TOOL;
    if (!r.check && (ted4_file_writable(r.out, r.force, why, sizeof why) != 0 ||
                     (r.checkpoint != NULL &&
                      ted4_file_writable(r.checkpoint, 1, why, sizeof why) != 0)))
        return complain(why);

    const ted4_dataset_options wanted = { r.downscale, !r.black, r.options.seed, CACHE_BYTES, 0 };

    if (ted4_dataset_load(&d, r.scene, &wanted, &m) != 0)
        return complain(m.text);

    int status = TED4_EXIT_FINE;

    if (r.check)
        ted4_dataset_print(&d, stdout);
    if (ted4_dataset_verify(&d, &m) != 0)
        status = complain(m.text);
    else if (!r.check)
        status = encode(&r, &d);
    ted4_dataset_free(&d);
    return status;
}
