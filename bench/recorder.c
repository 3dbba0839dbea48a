/* recorder.c - see recorder.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "recorder.h"

#include "measure.h"

const int recorder_cores[RECORDER_CORES] = { 8, 16, 32 };

enum { CLOCK_READINGS = 10000 };

void recorder_init(recorder *r)
{
    const double begin = now_ms();

    memset(r, 0, sizeof *r);
    for (int i = 0; i < CLOCK_READINGS; i++)
        (void)now_ms();
    r->clock = (now_ms() - begin) / CLOCK_READINGS;
}

void recorder_finish(recorder *r)
{
    free(r->duration);
    free(r->kept);
    memset(r, 0, sizeof *r);
}

double recorder_schedule(const double *duration, size_t n, int cores)
{
    double free_at[RECORDER_MOST_CORES] = { 0 }, last = 0;

    for (size_t i = 0; i < n; i++) {
        int first = 0;

        for (int k = 1; k < cores; k++)
            if (free_at[k] < free_at[first])
                first = k;
        free_at[first] += duration[i];
        last = free_at[first] > last ? free_at[first] : last;
    }
    return last;
}

static void reserve(recorder *r, size_t n)
{
    if (n <= r->capacity)
        return;
    r->capacity = 2 * n;
    r->duration = must(realloc(r->duration, r->capacity * sizeof *r->duration));
}

static void keep(recorder *r)
{
    r->kept = must(realloc(r->kept, (r->n + 1) * sizeof *r->kept));
    memcpy(r->kept, r->duration, r->n * sizeof *r->kept);
    r->n_kept = r->n;
}

static double sum_of(const double *x, size_t n)
{
    double sum = 0;

    for (size_t i = 0; i < n; i++)
        sum += x[i];
    return sum;
}

/* Computes the time of a region whose indices take jobs from a common list; on one thread, the
 * first index does all of them. */
static double schedule_list(const recorder *r, double work, size_t n, int cores)
{
    const double all = sum_of(r->kept, r->n_kept);

    const int takers = (size_t)cores < n ? cores : (int)n;

    return all > 0 ? recorder_schedule(r->kept, r->n_kept, takers) * work / all : work;
}

double recorder_thread_ms(void)
{
    struct timespec t;

    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}

/* Subtracts from the longest durations the time that other programs had on this core. */
static void take_off(recorder *r, double excess)
{
    while (excess > 0) {
        size_t longest = 0;

        for (size_t i = 1; i < r->n; i++)
            longest = r->duration[i] > r->duration[longest] ? i : longest;

        const double cut = excess < r->duration[longest] ? excess : r->duration[longest];

        r->duration[longest] -= cut;
        excess -= cut;
        if (!(cut > 0))
            return;
    }
}

/* Times every index. Returns the time of the region, and sets *excess to the part of it that other
 * programs took. */
static double time_indices(recorder *r, size_t n, void (*body)(void *arg, size_t i), void *arg,
                           double *excess)
{
    const double spent = recorder_thread_ms(), begin = now_ms();
    double at = begin;

    for (size_t i = 0; i < n; i++) {
        body(arg, i);

        const double now = now_ms(), took = now - at - r->clock;

        r->duration[i] = took > 0 ? took : 0;
        at = now;
    }
    *excess = (at - begin) - (recorder_thread_ms() - spent);
    *excess = *excess > 0 ? *excess : 0;
    return at - begin;
}

static void run(void *user, size_t n, void (*body)(void *arg, size_t i), void *arg)
{
    recorder *r = user;
    const double begin = now_ms(), spent = recorder_thread_ms();
    const int kind = r->kind != NULL ? r->kind(n) : 0;
    double excess;

    reserve(r, n);
    r->n = n;

    const double took = time_indices(r, n, body, arg, &excess);

    take_off(r, excess);
    if (kind == 1)
        keep(r);

    const double work = sum_of(r->duration, n);

    r->regions.work += took - excess;
    r->regions.n++;
    for (int k = 0; k < RECORDER_CORES; k++) {
        const int cores = recorder_cores[k];

        r->regions.on[k] += RECORDER_ROUND(cores);
        r->regions.on[k] += kind == 2 ? schedule_list(r, work, n, cores)
                                      : recorder_schedule(r->duration, n, cores);
    }
    r->regions.spent += recorder_thread_ms() - spent - (took - excess);
    r->regions.own += now_ms() - begin - (took - excess);
}

ted4_parallel recorder_team(recorder *r)
{
    return (ted4_parallel) { run, r };
}
