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

#include "json_line.h"
#include "tool/clock.h"
#include "tool/plural.h"
#include "train/search/candidates.h"
#include "train/state/anchor_masks.h"
#include "train/monitor/monitor.h"
#include "train/monitor/saturation.h"
#include "train/monitor/scale.h"

/* This member is written, and read back by find_end. */
#define CPU_SECONDS "cpu_seconds"

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

/* Returns whether n bytes without a line end may be all that a crash has left of a log: they begin
 * as its first line does. */
static int is_cut_short(const char *line, size_t n)
{
    static const char begin[] = "{\"step\":";

    return strncmp(line, begin, n < sizeof begin - 1 ? n : sizeof begin - 1) == 0;
}

/* Returns where the lines from byte end on reach a later step or number of rollbacks, or -1 if one
 * is not of ted4enc. A last line without a line end does not count. Sets *cpu to the cpu_seconds of
 * the last counted line that has them. */
static off_t find_end(FILE *f, off_t end, uint64_t step, uint64_t rollbacks, double *cpu)
{
    char *line = NULL;
    size_t capacity = 0;
    ssize_t n;
    unsigned long long at, count;

    while (end >= 0 && (n = getline(&line, &capacity, f)) > 0) {
        if (line[n - 1] != '\n') {
            end = end > 0 || is_cut_short(line, (size_t)n) ? end : -1;
            break;
        }
        if (sscanf(line, "{\"step\":%llu,", &at) != 1)
            end = -1;
        else if (at > step ||
                 (sscanf(line, "{\"step\":%*u,\"event\":\"%*[a-z]\",\"rollbacks\":%llu,", &count) ==
                      1 &&
                  count > rollbacks))
            break;
        else {
            const char *said = strstr(line, "\"" CPU_SECONDS "\":");

            end += n;
            if (said != NULL)
                *cpu = strtod(said + sizeof CPU_SECONDS + 2, NULL);
        }
    }
    free(line);
    return end;
}

/* Cuts off all lines of this trial beyond the trainer's step and number of rollbacks. Sets *cpu to
 * the cpu_seconds of the last remaining line that has them. Returns 0, or -1 with why filled. */
static int cut(const ted4_run_log *l, const ted4_trainer *t, double *cpu, char *why,
               size_t why_size)
{
    FILE *f = fopen(l->path, "r");

    if (f == NULL || fseeko(f, l->trial, SEEK_SET) != 0) {
        say(l->path, strerror(errno), why, why_size);
        if (f != NULL)
            fclose(f);
        return -1;
    }

    const off_t end = find_end(f, l->trial, t->iteration, t->monitor.state.rollbacks, cpu);

    fclose(f);
    if (end < 0)
        return say(l->path, "there, but not a log of ted4enc to go on with", why, why_size);
    return ftruncate(l->file, end) == 0 ? 0 : say(l->path, strerror(errno), why, why_size);
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
    if (keep && is_regular(l->file) && cut(l, t, &l->cpu_seconds, why, why_size) != 0) {
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
    return is_regular(l->file) ? cut(l, t, &said, why, why_size) : 0;
}

void ted4_run_log_skip(ted4_run_log *l)
{
    l->wall = ted4_clock();
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

void ted4_run_log_begin_trial(ted4_run_log *l, const ted4_trainer *t)
{
    ted4_run_log_rewind(l, t);
    if (is_regular(l->file))
        l->trial = lseek(l->file, 0, SEEK_END);
}

/* Numbers of a line that are not members of the trainer. */
typedef struct {
    const char *stage;
    double ms, cpu_ms, rate; /* milliseconds per step; Gaussian-pixels per second */
} line_facts;

/* Begins a line with the members that all have. event: NULL for the line of a step. */
static void begin(ted4_json_line *l, const ted4_trainer *t, const char *event)
{
    ted4_json_line_begin(l);
    ted4_json_line_put(l, "step", "%llu", (unsigned long long)t->iteration);
    if (event == NULL)
        return;
    ted4_json_line_put(l, "event", "\"%s\"", event);
    ted4_json_line_put(l, "rollbacks", "%llu", (unsigned long long)t->monitor.state.rollbacks);
}

static void put_count(ted4_json_line *l, const char *name, uint64_t x)
{
    ted4_json_line_put(l, name, "%llu", (unsigned long long)x);
}

/* A number before and after something. */
static void put_pair(ted4_json_line *l, const char *name, int decimals, double before, double after)
{
    ted4_json_line_open(l, name, "[");
    ted4_json_line_fixed(l, NULL, decimals, before);
    ted4_json_line_fixed(l, NULL, decimals, after);
    ted4_json_line_close(l, "]");
}

static void put_bytes(ted4_json_line *l, const ted4_preview *v)
{
    static const char *const names[TED4_TYPES] = { [TED4_FEATURE] = "feature",
                                                   [TED4_SCALING] = "scaling",
                                                   [TED4_OFFSET] = "offset",
                                                   [TED4_PHI] = "phi",
                                                   [TED4_TAU] = "tau" };

    ted4_json_line_fixed(l, "bytes", 0, v->bytes);
    ted4_json_line_open(l, "bytes_by_type", "{");
    ted4_json_line_fixed(l, "positions", 0, v->positions);
    ted4_json_line_fixed(l, "masks", 0, v->masks);
    for (int y = 0; y < TED4_TYPES; y++)
        ted4_json_line_fixed(l, names[y], 0, v->type[y]);
    ted4_json_line_fixed(l, "networks", 0, v->networks);
    ted4_json_line_fixed(l, "frame", 0, v->frame);
    ted4_json_line_close(l, "}");
}

static void put_gradients(ted4_json_line *l, const ted4_monitor_state *s)
{
    ted4_json_line_open(l, "gradients", "{");
    for (int k = 0; k < TED4_TERMS; k++)
        ted4_json_line_digits(l, ted4_term_name(k), 4, ted4_scale_usual(&s->gradient[k]));
    ted4_json_line_close(l, "}");
    ted4_json_line_open(l, "peaks", "{");
    for (int k = 0; k < TED4_TERMS; k++)
        ted4_json_line_digits(l, ted4_term_name(k), 4, s->gradient[k].peak);
    ted4_json_line_close(l, "}");
}

static void put_step(ted4_json_line *j, const ted4_run_log *l, const ted4_trainer *t,
                     const line_facts *f)
{
    const ted4_progress *p = &t->progress;
    const ted4_preview *v = &l->preview;

    begin(j, t, NULL);
    ted4_json_line_put(j, "stage", "\"%s\"", f->stage);
    ted4_json_line_digits(j, "lambda", 7, t->opt.lambda);
    ted4_json_line_fixed(j, "loss", 6, p->loss);
    ted4_json_line_fixed(j, "l1", 6, p->l1);
    ted4_json_line_fixed(j, "ssim", 6, p->ssim);
    ted4_json_line_fixed(j, "psnr", 4, v->psnr);
    put_count(j, "anchors", t->anchors.n);
    put_count(j, "moving", ted4_count_dynamic(t));
    ted4_json_line_fixed(j, "splats", 0, p->splats);
    put_bytes(j, v);
    ted4_json_line_open(j, "bits", "[");
    for (int y = 0; y < TED4_TYPES; y++)
        ted4_json_line_fixed(j, NULL, 2, p->bits[y]);
    ted4_json_line_close(j, "]");
    put_count(j, "skipped", ted4_raster_skipped(t->work.raster));
    put_count(j, "clamped", ted4_saturated_values(t));
    put_gradients(j, &t->monitor.state);
    put_count(j, "rollbacks", t->monitor.state.rollbacks);
    ted4_json_line_put(j, "split", "\"%s\"", v->train ? "train" : "test");
    ted4_json_line_fixed(j, "ms", 3, f->ms);
    ted4_json_line_fixed(j, "cpu_ms", 3, f->cpu_ms);
    ted4_json_line_digits(j, "gaussian_pixels_per_s", 4, f->rate);
    ted4_json_line_fixed(j, "seconds", 2, t->seconds);
    ted4_json_line_fixed(j, CPU_SECONDS, 2, l->cpu_seconds);
    ted4_json_line_fixed(j, "left", 1, l->left);
}

/* Writes the whole text or, if the disk is full, nothing of it. Returns 0, or -1 with why filled.
 */
static int write_text(const ted4_run_log *l, const char *text, size_t size, char *why,
                      size_t why_size)
{
    const off_t before = lseek(l->file, 0, SEEK_END);
    const ssize_t done = write(l->file, text, size);

    if (done == (ssize_t)size)
        return 0;
    say(l->path, done < 0 ? strerror(errno) : "cannot write all of a line (disk full?)", why,
        why_size);
    if (done > 0 && is_regular(l->file) && ftruncate(l->file, before) != 0)
        say(l->path, "ends with half a line, which cannot be taken off", why, why_size);
    return -1;
}

/* Ends a line, and writes and frees it. Returns the same as write_text. */
static int put_line(const ted4_run_log *l, ted4_json_line *line, char *why, size_t why_size)
{
    const int bad = ted4_json_line_end(line) != 0
                        ? say(l->path, "no memory for a line", why, why_size)
                        : write_text(l, line->text, line->size, why, why_size);

    ted4_json_line_free(line);
    return bad;
}

const char *ted4_run_log_stage(const ted4_trainer *t)
{
    return !t->phase.stage2 ? "1" : t->phase.integer ? "2i" : "2";
}

int ted4_run_log_step(ted4_run_log *l, const ted4_trainer *t, char *why, size_t why_size)
{
    const double steps = (double)(t->iteration - l->last_step);
    ted4_json_line line;
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
    put_step(&line, l, t, &f);
    return put_line(l, &line, why, why_size);
}

int ted4_run_log_event(ted4_run_log *l, const ted4_trainer *t, char *why, size_t why_size)
{
    const ted4_anomaly *f = &t->monitor.anomaly;
    ted4_json_line line;

    if (l->file < 0)
        return 0;
    begin(&line, t, t->monitor.found ? "failure" : "rollback");
    put_count(&line, "failed", f->step);
    ted4_json_line_put(&line, "cause", "\"%s\"", f->cause);
    ted4_json_line_put(&line, "term", "\"%s\"", f->term);
    if (f->anchor >= 0)
        put_count(&line, "anchor", (uint64_t)f->anchor);
    else
        ted4_json_line_put(&line, "anchor", "null");
    ted4_json_line_digits(&line, "factor", 7, t->monitor.state.factor);
    return put_line(l, &line, why, why_size);
}

int ted4_run_log_closing(ted4_run_log *l, const ted4_trainer *t, char *why, size_t why_size)
{
    const ted4_closing *c = &t->closing;
    ted4_json_line line;

    if (l->teller != NULL)
        ted4_teller_say(l->teller,
                        "closing: %llu of %llu anchor%s moved, and the motion of %llu explained "
                        "nothing",
                        (unsigned long long)c->moving, (unsigned long long)c->anchors,
                        ted4_s(c->anchors), (unsigned long long)c->closed);
    if (l->file < 0)
        return 0;
    begin(&line, t, "closing");
    put_count(&line, "anchors", c->anchors);
    put_count(&line, "moving", c->moving);
    put_count(&line, "closed", c->closed);
    return put_line(l, &line, why, why_size);
}

int ted4_run_log_trials(ted4_run_log *l, const ted4_trainer *t, size_t first, char *why,
                        size_t why_size)
{
    for (size_t i = first; i < t->search.n_trials; i++) {
        const struct ted4_trial *x = &t->search.trial[i];

        if (l->teller != NULL)
            ted4_teller_say(l->teller,
                            "capacity: %s %lld to %lld %s: cost %.6f to %.6f (distortion %.6f to "
                            "%.6f, bytes %.0f to %.0f), after %lld step%s each",
                            ted4_candidate_name((ted4_candidate)x->candidate), (long long)x->from,
                            (long long)x->to, x->taken ? "taken" : "left", x->before.cost,
                            x->after.cost, x->before.distortion, x->after.distortion,
                            x->before.bytes, x->after.bytes, (long long)x->steps,
                            ted4_s((uint64_t)x->steps));
        if (l->file < 0)
            continue;

        ted4_json_line line;

        begin(&line, t, "capacity");
        ted4_json_line_put(&line, "what", "\"%s\"",
                           ted4_candidate_name((ted4_candidate)x->candidate));
        ted4_json_line_put(&line, "from", "%lld", (long long)x->from);
        ted4_json_line_put(&line, "to", "%lld", (long long)x->to);
        ted4_json_line_put(&line, "trained", "%lld", (long long)x->steps);
        ted4_json_line_put(&line, "taken", x->taken ? "true" : "false");
        put_pair(&line, "cost", 8, x->before.cost, x->after.cost);
        put_pair(&line, "distortion", 8, x->before.distortion, x->after.distortion);
        put_pair(&line, "bytes", 0, x->before.bytes, x->after.bytes);
        if (put_line(l, &line, why, why_size) != 0)
            return -1;
    }
    return 0;
}

int ted4_run_log_poses(ted4_run_log *l, const ted4_trainer *t, char *why, size_t why_size)
{
    const int refined = t->poses.decision == TED4_POSES_REFINED;
    ted4_json_line line;

    if (l->file < 0)
        return 0;
    begin(&line, t, "poses");
    ted4_json_line_fixed(&line, "moved", 4, t->poses.moved);
    ted4_json_line_put(&line, "refined", refined ? "true" : "false");
    return put_line(l, &line, why, why_size);
}

int ted4_run_log_close(ted4_run_log *l, char *why, size_t why_size)
{
    const int file = l->file;

    l->file = -1;
    return file < 0 || close(file) == 0 ? 0 : say(l->path, strerror(errno), why, why_size);
}
