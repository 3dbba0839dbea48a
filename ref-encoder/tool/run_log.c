/* run_log.c - see run_log.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "run_log.h"

#include <errno.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

double ted4_seconds(void)
{
    struct timespec t;

    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

int ted4_run_log_open(ted4_run_log *l, const char *path, int append, int quiet, int verbose,
                      char *why, size_t why_size)
{
    memset(l, 0, sizeof *l);
    l->terminal = !quiet && isatty(STDERR_FILENO);
    l->verbose = verbose;
    l->start = l->last_time = ted4_seconds();
    if (path == NULL)
        return 0;
    l->json = fopen(path, append ? "a" : "w");
    if (l->json == NULL) {
        snprintf(why, why_size, "%s: %s", path, strerror(errno));
        return -1;
    }
    return 0;
}

double ted4_estimated_bytes(const ted4_trainer *t)
{
    const ted4_shape *s = &t->layout.shape;
    double            bits = 48.0 + t->layout.head.n_offsets;

    if (!t->stage2)
        return 0;
    for (int y = 0; y < TED4_TYPES; y++)
        bits += t->progress.bits[y];
    return (double)t->anchors.n * bits / 8.0 +
           4.0 * (double)(s->n_netr + s->n_bank) + 2.0 * (double)s->n_nete;
}

void ted4_run_log_step(ted4_run_log *l, const ted4_trainer *t)
{
    const double now = ted4_seconds();
    const double steps = (double)(t->iteration - l->last_step);
    const double ms = steps > 0 ? 1e3 * (now - l->last_time) / steps : 0;
    const double left = 1e-3 * ms * (double)(ted4_trainer_total(t) - t->iteration);
    const double rate = ms > 0 ? 1e3 * t->progress.splat_pixels / ms : 0;
    const char  *stage = !t->stage2 ? "1" : t->integer ? "2i" : "2";

    if (l->json != NULL) {
        fprintf(l->json,
                "{\"step\":%llu,\"stage\":\"%s\",\"loss\":%.6f,\"l1\":%.6f,\"ssim\":%.6f,"
                "\"psnr\":%.4f,\"anchors\":%zu,\"splats\":%.0f,\"bytes\":%.0f,\"bits\":[%.2f,%.2f,%.2f,%.2f,%.2f],"
                "\"ms\":%.3f,\"gaussian_pixels_per_s\":%.4g,\"seconds\":%.2f}\n",
                (unsigned long long)t->iteration, stage, t->progress.loss, t->progress.l1,
                t->progress.ssim, l->psnr, t->anchors.n, t->progress.splats,
                ted4_estimated_bytes(t), t->progress.bits[0], t->progress.bits[1],
                t->progress.bits[2], t->progress.bits[3], t->progress.bits[4], ms, rate,
                now - l->start);
        fflush(l->json);
    }
    if (l->terminal || l->verbose)
        fprintf(stderr,
                "%s%llu/%llu stage %s loss %.5f psnr %.2f anchors %zu bytes %.0f  %.1f ms/step (%.1f G Gaussian-pixels/s)  %.0f s left%s",
                l->terminal ? "\r\033[K" : "", (unsigned long long)t->iteration,
                (unsigned long long)ted4_trainer_total(t), stage, t->progress.loss, l->psnr,
                t->anchors.n, ted4_estimated_bytes(t), ms, 1e-9 * rate, left, l->terminal ? "" : "\n");
    l->last_time = now;
    l->last_step = t->iteration;
}

void ted4_run_log_close(ted4_run_log *l)
{
    if (l->terminal)
        fprintf(stderr, "\n");
    if (l->json != NULL)
        fclose(l->json);
    l->json = NULL;
}
