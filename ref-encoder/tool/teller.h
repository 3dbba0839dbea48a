/* teller.h - what a program says on standard error while it works: lines at once, and a line about
 * what goes on, from time to time. A thread of its own tells it, so that something is said, too,
 * while one call lasts for minutes. A terminal has one line that is written again every second,
 * anything else a whole line now and then. Nothing depends on what is told, and quiet says none of
 * it.
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

/* What goes on. Numbers that are negative are not known. */
typedef struct {
    ted4_teller_kind kind;
    char name[200];       /* of what is loaded, unpacked, drawn */
    uint64_t step, total; /* steps done of all; frames; pictures done of all */
    const char *stage;    /* "1", "2", "2i", or what a probe or trial is for */
    double share;         /* done of a probe or of trials; negative: plain training */
    double loss, psnr, bytes, ms;
    int train_psnr; /* psnr is of training pictures */
    size_t anchors;
    double left; /* seconds, at the clock when */
    double when;
} ted4_facts;

typedef struct {
    const char *program;
    int quiet, terminal, running, ending;
    double pause[2]; /* seconds between lines: before training, and from there on */
    pthread_t thread;
    pthread_mutex_t lock;
    pthread_cond_t wake;
    ted4_facts now;
    double since; /* when now.kind or now.name became what they are */
    double last;  /* when something was said last */
    int open;     /* the terminal's line has text */
} ted4_teller;

double ted4_seconds(void);

/* quiet: nothing is ever said. */
void ted4_teller_begin(ted4_teller *t, const char *program, int quiet);
void ted4_teller_end(ted4_teller *t);
/* A whole line, at once: "program: text". */
void ted4_teller_say(ted4_teller *t, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* The same, also where quiet: errors. */
void ted4_teller_error(ted4_teller *t, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
/* What somebody else says next on standard error begins on a line of its own. Fine before
 * ted4_teller_begin, too. */
void ted4_teller_clear(ted4_teller *t);
/* What goes on from here on. */
void ted4_teller_now(ted4_teller *t, const ted4_facts *f);
/* The line about it, at once, as a whole one where the terminal keeps none. */
void ted4_teller_show(ted4_teller *t);

/* ---- for tests ---- */

/* The line as text, without a line end; since: seconds that it has gone on. */
void ted4_teller_line(const ted4_facts *f, double clock, double since, char *text, size_t size);
/* "45 s", "12 min", "3 h 20 min" */
void ted4_teller_time(double seconds, char *text, size_t size);

#endif
