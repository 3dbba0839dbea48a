/* run_log.c - see run_log.h. Each line is written by one call of write, so that a log contains only
 * whole lines, except for a last one cut short by a crash, which resuming removes.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "run_log.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "train/search/candidates.h"
#include "train/state/anchor_masks.h"
#include "train/monitor/monitor.h"
#include "train/monitor/saturation.h"
#include "train/monitor/scale.h"

/* This member is written, and read back by find_end. */
#define CPU_SECONDS "\"cpu_seconds\":"

static double seconds_of(clockid_t clock)
{
    struct timespec t;

    clock_gettime(clock, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int say(const char *path, const char *what, char *why, size_t why_size)
{
    snprintf(why, why_size, "%s: %s", path, what);
    return -1;
}

static int is_regular(int file)
{
    struct stat s;

    return fstat(file, &s) == 0 && S_ISREG(s.st_mode);
}

/* Returns the number of bytes of the lines up to a step and a number of rollbacks, or -1 if a line
 * is not one of ted4enc. A last line without a line end does not count. Sets *cpu to the
 * cpu_seconds of the last counted line that has them. */
static off_t find_end(FILE *f, uint64_t step, uint64_t rollbacks, double *cpu)
{
    char *line = NULL;
    size_t capacity = 0;
    ssize_t n;
    off_t end = 0;
    unsigned long long at, count;

    while (end >= 0 && (n = getline(&line, &capacity, f)) > 0 && line[n - 1] == '\n') {
        if (sscanf(line, "{\"step\":%llu,", &at) != 1)
            end = -1;
        else if (at > step ||
                 (sscanf(line, "{\"step\":%*u,\"event\":\"%*[a-z]\",\"rollbacks\":%llu,", &count) ==
                      1 &&
                  count > rollbacks))
            break;
        else {
            const char *said = strstr(line, CPU_SECONDS);

            end += n;
            if (said != NULL)
                *cpu = strtod(said + sizeof CPU_SECONDS - 1, NULL);
        }
    }
    free(line);
    return end;
}

/* Cuts off all lines beyond the trainer's step and number of rollbacks. Sets *cpu to the
 * cpu_seconds of the last remaining line that has them. Returns 0, or -1 with why filled. */
static int cut(const char *path, int file, const ted4_trainer *t, double *cpu, char *why,
               size_t why_size)
{
    FILE *f = fopen(path, "r");

    if (f == NULL)
        return say(path, strerror(errno), why, why_size);

    const off_t end = find_end(f, t->iteration, t->monitor.state.rollbacks, cpu);

    fclose(f);
    if (end < 0)
        return say(path, "there, but not a log of ted4enc to go on with", why, why_size);
    return ftruncate(file, end) == 0 ? 0 : say(path, strerror(errno), why, why_size);
}

int ted4_run_log_open(ted4_run_log *l, const char *path, const ted4_trainer *t, int keep,
                      ted4_teller *teller, char *why, size_t why_size)
{
    memset(l, 0, sizeof *l);
    l->path = path;
    l->file = -1;
    l->teller = teller;
    l->left = l->ms = -1;
    ted4_run_log_skip(l);
    ted4_run_log_rewind(l, t);
    if (path == NULL)
        return 0;
    l->file = open(path, O_WRONLY | O_CREAT | O_APPEND | (keep ? 0 : O_TRUNC), 0666);
    if (l->file < 0)
        return say(path, strerror(errno), why, why_size);
    if (keep && is_regular(l->file) && cut(path, l->file, t, &l->cpu_seconds, why, why_size) != 0) {
        close(l->file);
        l->file = -1;
        return -1;
    }
    ted4_run_log_rewind(l, t);
    return 0;
}

int ted4_run_log_cut(ted4_run_log *l, const ted4_trainer *t, char *why, size_t why_size)
{
    double said; /* not used: the time of the removed lines was training, and stays counted */

    ted4_run_log_rewind(l, t);
    return is_regular(l->file) ? cut(l->path, l->file, t, &said, why, why_size) : 0;
}

void ted4_run_log_skip(ted4_run_log *l)
{
    l->wall = ted4_seconds();
    l->cpu = seconds_of(CLOCK_PROCESS_CPUTIME_ID);
}

void ted4_run_log_tick(ted4_run_log *l, ted4_trainer *t)
{
    const double wall = l->wall, cpu = l->cpu;

    ted4_run_log_skip(l);
    t->seconds += l->wall - wall;
    l->cpu_seconds += l->cpu - cpu;
}

void ted4_run_log_rewind(ted4_run_log *l, const ted4_trainer *t)
{
    l->last_step = t->iteration;
    l->last_seconds = t->seconds;
    l->last_cpu = l->cpu_seconds;
}

enum { TERMS_TEXT = TED4_TERMS * 26, MOST_LINE = 1200 + 2 * TERMS_TEXT };

/* Numbers of a line that are not members of the trainer. */
typedef struct {
    const char *stage;
    double ms, cpu_ms, rate; /* milliseconds per step; Gaussian-pixels per second */
} line_facts;

/* Formats "feature":x,... of all terms; each number has at most 12 characters. Returns text. */
static const char *print_terms(char *text, size_t size, const double *x)
{
    size_t at = 0;

    for (int k = 0; k < TED4_TERMS && at < size; k++)
        at += (size_t)snprintf(text + at, size - at, "%s\"%s\":%.4g", k == 0 ? "" : ",",
                               ted4_term_name(k), x[k]);
    return text;
}

static int print_line(char *line, size_t size, const ted4_run_log *l, const ted4_trainer *t,
                      const line_facts *f)
{
    const ted4_progress *p = &t->progress;
    const ted4_preview *v = &l->preview;
    const double *b = p->bits, *y = v->type;
    double usual[TED4_TERMS], peak[TED4_TERMS];
    char gradients[TERMS_TEXT], peaks[TERMS_TEXT];

    for (int k = 0; k < TED4_TERMS; k++) {
        usual[k] = ted4_scale_usual(&t->monitor.state.gradient[k]);
        peak[k] = t->monitor.state.gradient[k].peak;
    }
    return snprintf(
        line, size,
        "{\"step\":%llu,\"stage\":\"%s\",\"lambda\":%.7g,\"loss\":%.6f,\"l1\":%.6f,\"ssim\":%.6f,"
        "\"psnr\":%.4f,"
        "\"anchors\":%zu,\"moving\":%zu,\"splats\":%.0f,\"bytes\":%.0f,"
        "\"bytes_by_type\":{\"positions\":%.0f,\"masks\":%.0f,\"feature\":%.0f,\"scaling\":%.0f,"
        "\"offset\":%.0f,"
        "\"phi\":%.0f,\"tau\":%.0f,\"networks\":%.0f,\"frame\":%.0f},\"bits\":[%.2f,%.2f,%.2f,%.2f,"
        "%.2f],"
        "\"skipped\":%llu,\"clamped\":%zu,\"gradients\":{%s},\"peaks\":{%s},\"rollbacks\":%llu,"
        "\"split\":\"%s\",\"ms\":%.3f,\"cpu_ms\":%.3f,\"gaussian_pixels_per_s\":%.4g,\"seconds\":%."
        "2f," CPU_SECONDS "%.2f,\"left\":%.1f}\n",
        (unsigned long long)t->iteration, f->stage, t->opt.lambda, p->loss, p->l1, p->ssim, v->psnr,
        t->anchors.n, ted4_count_dynamic(t), p->splats, v->bytes, v->positions, v->masks,
        y[TED4_FEATURE], y[TED4_SCALING], y[TED4_OFFSET], y[TED4_PHI], y[TED4_TAU], v->networks,
        v->frame, b[TED4_FEATURE], b[TED4_SCALING], b[TED4_OFFSET], b[TED4_PHI], b[TED4_TAU],
        (unsigned long long)ted4_raster_skipped(t->work.raster), ted4_saturated_values(t),
        print_terms(gradients, sizeof gradients, usual), print_terms(peaks, sizeof peaks, peak),
        (unsigned long long)t->monitor.state.rollbacks, v->train ? "train" : "test", f->ms,
        f->cpu_ms, f->rate, t->seconds, l->cpu_seconds, l->left);
}

/* Writes the whole line or, if the disk is full, nothing of it. Returns 0, or -1 with why filled.
 */
static int put_line(const ted4_run_log *l, const char *line, size_t size, char *why,
                    size_t why_size)
{
    const off_t before = lseek(l->file, 0, SEEK_END);
    const ssize_t done = write(l->file, line, size);

    if (done == (ssize_t)size)
        return 0;
    say(l->path, done < 0 ? strerror(errno) : "cannot write all of a line (disk full?)", why,
        why_size);
    if (done > 0 && is_regular(l->file) && ftruncate(l->file, before) != 0)
        say(l->path, "ends with half a line, which cannot be taken off", why, why_size);
    return -1;
}

const char *ted4_run_log_stage(const ted4_trainer *t)
{
    return !t->phase.stage2 ? "1" : t->phase.integer ? "2i" : "2";
}

int ted4_run_log_step(ted4_run_log *l, const ted4_trainer *t, char *why, size_t why_size)
{
    const double steps = (double)(t->iteration - l->last_step);
    char line[MOST_LINE];
    line_facts f = { .stage = ted4_run_log_stage(t) };

    if (steps > 0) {
        f.ms = 1e3 * (t->seconds - l->last_seconds) / steps;
        f.cpu_ms = 1e3 * (l->cpu_seconds - l->last_cpu) / steps;
    }
    f.rate = f.ms > 0 ? 1e3 * t->progress.splat_pixels / f.ms : 0;
    l->ms = f.ms;
    ted4_run_log_rewind(l, t);
    if (l->file < 0)
        return 0;
    return put_line(l, line, (size_t)print_line(line, sizeof line, l, t, &f), why, why_size);
}

int ted4_run_log_event(ted4_run_log *l, const ted4_trainer *t, char *why, size_t why_size)
{
    const ted4_anomaly *f = &t->monitor.anomaly;
    char line[400], anchor[24] = "null";

    if (l->file < 0)
        return 0;
    if (f->anchor >= 0)
        snprintf(anchor, sizeof anchor, "%lld", (long long)f->anchor);

    const int n =
        snprintf(line, sizeof line,
                 "{\"step\":%llu,\"event\":\"%s\",\"rollbacks\":%llu,\"failed\":%llu,"
                 "\"cause\":\"%s\",\"term\":\"%s\",\"anchor\":%s,\"factor\":%.7g}\n",
                 (unsigned long long)t->iteration, t->monitor.found ? "failure" : "rollback",
                 (unsigned long long)t->monitor.state.rollbacks, (unsigned long long)f->step,
                 f->cause, f->term, anchor, t->monitor.state.factor);

    return put_line(l, line, (size_t)n, why, why_size);
}

int ted4_run_log_closing(ted4_run_log *l, const ted4_trainer *t, char *why, size_t why_size)
{
    const ted4_closing *c = &t->closing;
    char line[200];

    if (l->teller != NULL)
        ted4_teller_say(l->teller,
                        "closing: %llu of %llu anchors moved, and the motion of %llu explained "
                        "nothing",
                        (unsigned long long)c->moving, (unsigned long long)c->anchors,
                        (unsigned long long)c->closed);
    if (l->file < 0)
        return 0;

    const int n = snprintf(line, sizeof line,
                           "{\"step\":%llu,\"event\":\"closing\",\"rollbacks\":%llu,"
                           "\"anchors\":%llu,\"moving\":%llu,\"closed\":%llu}\n",
                           (unsigned long long)t->iteration,
                           (unsigned long long)t->monitor.state.rollbacks,
                           (unsigned long long)c->anchors, (unsigned long long)c->moving,
                           (unsigned long long)c->closed);

    return put_line(l, line, (size_t)n, why, why_size);
}

int ted4_run_log_trials(ted4_run_log *l, const ted4_trainer *t, size_t first, char *why,
                        size_t why_size)
{
    char line[600];

    for (size_t i = first; i < t->search.n_trials; i++) {
        const struct ted4_trial *x = &t->search.trial[i];

        if (l->teller != NULL)
            ted4_teller_say(l->teller,
                            "capacity: %s %lld to %lld %s: cost %.6f to %.6f (distortion %.6f to "
                            "%.6f, bytes %.0f to %.0f), after %lld steps each",
                            ted4_candidate_name((ted4_candidate)x->candidate), (long long)x->from,
                            (long long)x->to, x->taken ? "taken" : "left", x->before.cost,
                            x->after.cost, x->before.distortion, x->after.distortion,
                            x->before.bytes, x->after.bytes, (long long)x->steps);
        if (l->file < 0)
            continue;

        const int n = snprintf(
            line, sizeof line,
            "{\"step\":%llu,\"event\":\"capacity\",\"rollbacks\":%llu,\"what\":"
            "\"%s\",\"from\":%lld,\"to\":%lld,"
            "\"trained\":%lld,\"taken\":%s,\"cost\":[%.8f,%.8f],\"distortion\":["
            "%.8f,%.8f],\"bytes\":[%.0f,%.0f]}\n",
            (unsigned long long)t->iteration, (unsigned long long)t->monitor.state.rollbacks,
            ted4_candidate_name((ted4_candidate)x->candidate), (long long)x->from, (long long)x->to,
            (long long)x->steps, x->taken ? "true" : "false", x->before.cost, x->after.cost,
            x->before.distortion, x->after.distortion, x->before.bytes, x->after.bytes);

        if (put_line(l, line, (size_t)n, why, why_size) != 0)
            return -1;
    }
    return 0;
}

int ted4_run_log_poses(ted4_run_log *l, const ted4_trainer *t, char *why, size_t why_size)
{
    const int refined = t->poses.decision == TED4_POSES_REFINED;
    char line[200];

    if (l->file < 0)
        return 0;

    const int n = snprintf(line, sizeof line,
                           "{\"step\":%llu,\"event\":\"poses\",\"rollbacks\":%llu,"
                           "\"moved\":%.4f,\"refined\":%s}\n",
                           (unsigned long long)t->iteration,
                           (unsigned long long)t->monitor.state.rollbacks, t->poses.moved,
                           refined ? "true" : "false");

    return put_line(l, line, (size_t)n, why, why_size);
}

int ted4_run_log_close(ted4_run_log *l, char *why, size_t why_size)
{
    const int file = l->file;

    l->file = -1;
    return file < 0 || close(file) == 0 ? 0 : say(l->path, strerror(errno), why, why_size);
}
