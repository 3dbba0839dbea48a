/* teller.c - see teller.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "teller.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "tool/clock.h"
#include "tool/plural.h"
#include "tool/thread_start.h"

/* All in seconds: how often the thread wakes up, and the time between status lines, elsewhere
 * before training, elsewhere from then on, and on a terminal. */
#define LOOK_EVERY   0.5
#define PAUSE_BEFORE 3.0
#define PAUSE        30.0
#define PAUSE_SCREEN 1.0

enum { MOST_TEXT = 600 };

void ted4_teller_time(double seconds, char *text, size_t size)
{
    const double minutes = ceil(seconds / 60.0);

    if (seconds < 100.0)
        snprintf(text, size, "%.0f s", fmax(ceil(seconds), 1.0));
    else if (minutes < 100.0)
        snprintf(text, size, "%.0f min", minutes);
    else
        snprintf(text, size, "%.0f h %.0f min", floor(minutes / 60.0), fmod(minutes, 60.0));
}

static void training_line(const ted4_facts *f, double clock, char *text, size_t size)
{
    char left[40] = "";
    size_t n = (size_t)snprintf(text, size, "%llu/%llu ", (unsigned long long)f->step,
                                (unsigned long long)f->total);

    if (f->share >= 0)
        n += (size_t)snprintf(text + n, size - n, "%s: %.0f %%", f->stage,
                              fmin(100.0 * f->share, 100.0));
    else
        n += (size_t)snprintf(text + n, size - n, "stage %s", f->stage);
    n += (size_t)snprintf(text + n, size - n, "  loss %.5f", f->loss);
    if (f->psnr >= 0)
        n += (size_t)snprintf(text + n, size - n, "  %spsnr %.2f", f->train_psnr ? "train " : "",
                              f->psnr);
    n += (size_t)snprintf(text + n, size - n, "  anchors %zu", f->anchors);
    if (f->bytes >= 0)
        n += (size_t)snprintf(text + n, size - n, "  bytes %.0f", f->bytes);
    if (f->ms >= 0)
        n += (size_t)snprintf(text + n, size - n, "  %.1f ms/step", f->ms);
    if (f->left >= 0) {
        ted4_teller_time(fmax(f->left - (clock - f->when), 0.0), left, sizeof left);
        snprintf(text + n, size - n, "  %s left", left);
    }
}

void ted4_teller_line(const ted4_facts *f, double clock, double since, char *text, size_t size)
{
    char past[40];
    const int n = (int)f->step, all = (int)f->total;

    ted4_teller_time(since, past, sizeof past);
    text[0] = 0;
    switch (f->kind) {
    case TED4_TELL_LOADING: snprintf(text, size, "loading %s, %s so far", f->name, past); break;
    case TED4_TELL_UNPACKING:
        snprintf(text, size, "unpacking %s: %d frame%s", f->name, n, ted4_s(f->step));
        break;
    case TED4_TELL_STARTING: snprintf(text, size, "%s, %s so far", f->name, past); break;
    case TED4_TELL_TRAINING: training_line(f, clock, text, size); break;
    case TED4_TELL_CODING:
        snprintf(text, size, "coding and checking the file, %s so far", past);
        break;
    case TED4_TELL_DRAWING:
        snprintf(text, size, "%d of %d picture%s compared", n, all, ted4_s(f->total));
        break;
    default: break;
    }
}

/* Prints the status line; the caller holds the lock. On a terminal the line is left open. */
static void show(ted4_teller *t, double clock)
{
    char text[MOST_TEXT];

    ted4_teller_line(&t->now, clock, clock - t->since, text, sizeof text);
    if (text[0] == 0)
        return;
    fprintf(stderr, t->terminal ? "\r\033[K%s: %s" : "%s: %s\n", t->program, text);
    fflush(stderr);
    t->open = t->terminal;
    t->last = clock;
}

static double pause_of(const ted4_teller *t)
{
    return t->pause[t->now.kind >= TED4_TELL_TRAINING];
}

/* The thread of the status line. */
static void *tell(void *arg)
{
    ted4_teller *t = arg;

    pthread_mutex_lock(&t->lock);
    while (!t->ending) {
        struct timespec until;

        clock_gettime(CLOCK_REALTIME, &until);
        until.tv_nsec += (long)(LOOK_EVERY * 1e9);
        until.tv_sec += until.tv_nsec / 1000000000L;
        until.tv_nsec %= 1000000000L;
        pthread_cond_timedwait(&t->wake, &t->lock, &until);

        const double clock = ted4_clock();

        if (!t->ending && t->now.kind != TED4_TELL_NOTHING && clock - t->last >= pause_of(t))
            show(t, clock);
    }
    pthread_mutex_unlock(&t->lock);
    return NULL;
}

void ted4_teller_begin(ted4_teller *t, const char *program, int quiet)
{
    memset(t, 0, sizeof *t);
    t->program = program;
    t->quiet = quiet;
    t->terminal = isatty(STDERR_FILENO);
    t->pause[0] = t->terminal ? PAUSE_SCREEN : PAUSE_BEFORE;
    t->pause[1] = t->terminal ? PAUSE_SCREEN : PAUSE;
    t->last = t->since = ted4_clock();
    pthread_mutex_init(&t->lock, NULL);
    pthread_cond_init(&t->wake, NULL);
    /* If there is no thread, only the messages are printed. */
    t->running = !quiet && ted4_thread_start(&t->thread, tell, t) == 0;
}

/* Clears an open status line; the caller holds the lock. */
static void close_line(ted4_teller *t)
{
    if (t->open)
        fputs("\r\033[K", stderr);
    t->open = 0;
}

void ted4_teller_clear(ted4_teller *t)
{
    pthread_mutex_lock(&t->lock);
    close_line(t);
    fflush(stderr);
    pthread_mutex_unlock(&t->lock);
}

void ted4_teller_end(ted4_teller *t)
{
    pthread_mutex_lock(&t->lock);
    t->ending = 1;
    close_line(t);
    fflush(stderr);
    pthread_cond_signal(&t->wake);
    pthread_mutex_unlock(&t->lock);
    if (t->running)
        pthread_join(t->thread, NULL);
    pthread_cond_destroy(&t->wake);
    pthread_mutex_destroy(&t->lock);
}

static void say(ted4_teller *t, const char *format, va_list arguments)
{
    pthread_mutex_lock(&t->lock);
    close_line(t);
    fprintf(stderr, "%s: ", t->program);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    fflush(stderr);
    t->last = ted4_clock();
    pthread_mutex_unlock(&t->lock);
}

void ted4_teller_say(ted4_teller *t, const char *format, ...)
{
    va_list arguments;

    va_start(arguments, format);
    if (!t->quiet)
        say(t, format, arguments);
    va_end(arguments);
}

void ted4_teller_error(ted4_teller *t, const char *format, ...)
{
    va_list arguments;

    va_start(arguments, format);
    say(t, format, arguments);
    va_end(arguments);
}

void ted4_teller_now(ted4_teller *t, const ted4_facts *f)
{
    if (t->quiet)
        return;
    pthread_mutex_lock(&t->lock);
    if (f->kind != t->now.kind || strcmp(f->name, t->now.name) != 0)
        t->since = ted4_clock();
    t->now = *f;
    pthread_mutex_unlock(&t->lock);
}

void ted4_teller_show(ted4_teller *t)
{
    if (t->quiet)
        return;
    pthread_mutex_lock(&t->lock);
    show(t, ted4_clock());
    pthread_mutex_unlock(&t->lock);
}
