/* teller.h - progress messages on standard error. Messages are printed at once; in addition, a
 * status line says from time to time what the program is doing. A separate thread prints the status
 * line, so that it also appears while a single call lasts for minutes. On a terminal the status
 * line is overwritten every second; elsewhere a new line is printed at longer intervals. No result
 * depends on these messages, and with quiet none of them is printed.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_TELLER_H
#define TED4_TELLER_H

#include <pthread.h>
#include <stddef.h>
#include <stdint.h>

typedef enum {
    TED4_TELL_NOTHING,
    TED4_TELL_LOADING,
    TED4_TELL_UNPACKING,
    TED4_TELL_STARTING,
    TED4_TELL_TRAINING,
    TED4_TELL_CODING,
    TED4_TELL_DRAWING
} ted4_teller_kind;

/* What the program is doing. A negative number is one that is not known. */
typedef struct {
    ted4_teller_kind kind;
    char name[200];       /* what is loaded or unpacked; STARTING: the activity */
    uint64_t step, total; /* training steps or drawn pictures, done and in total; step: frames */
    const char *stage;    /* "1", "2", "2i", or the purpose of a probe or of trials */
    double share;         /* done share of a probe or of trials; negative: plain training */
    double loss, psnr, bytes, ms; /* psnr in dB; size of the file; milliseconds per step */
    int train_psnr;               /* 1: psnr is that of training pictures */
    size_t anchors;
    double left; /* remaining seconds as estimated at time when */
    double when; /* of ted4_clock */
} ted4_facts;

typedef struct {
    const char *program;
    int quiet, terminal, running, ending;
    double pause[2]; /* seconds between status lines: [0] before training, [1] from then on */
    pthread_t thread;
    pthread_mutex_t lock;
    pthread_cond_t wake;
    ted4_facts now;
    double since; /* time of the last change of now.kind or now.name */
    double last;  /* time of the last output */
    int open;     /* 1: the terminal shows a status line that has not been ended */
} ted4_teller;

/* Starts the thread of the status line. program: borrowed. quiet: only errors will be printed. */
void ted4_teller_begin(ted4_teller *t, const char *program, int quiet);
/* Clears the status line and ends the thread. */
void ted4_teller_end(ted4_teller *t);
/* Prints the line "program: text" at once. */
void ted4_teller_say(ted4_teller *t, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* Prints an error: like ted4_teller_say, but also with quiet. */
void ted4_teller_error(ted4_teller *t, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
/* Clears the status line, so that other output to standard error begins on a line of its own. May
 * be called before ted4_teller_begin if t->lock is initialised. */
void ted4_teller_clear(ted4_teller *t);
/* Sets the facts that the status line shows from now on. */
void ted4_teller_now(ted4_teller *t, const ted4_facts *f);
/* Prints the status line at once; unless standard error is a terminal, as a line of its own. */
void ted4_teller_show(ted4_teller *t);

/* ---- for tests ---- */

/* Formats the status line, without a line end. since: seconds for which this kind and name have
 * been current. */
void ted4_teller_line(const ted4_facts *f, double clock, double since, char *text, size_t size);
/* Formats a duration as "45 s", "12 min" or "3 h 20 min", rounded up. */
void ted4_teller_time(double seconds, char *text, size_t size);

#endif
