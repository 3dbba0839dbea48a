/* settings.h - what the command line of ted4dec asks for, and which options go together.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SETTINGS_H
#define TED4_SETTINGS_H

#include "export.h"
#include "times.h"

/* The end of a name of --render that asks for one video in place of pictures. */
#define TED4_VIDEO_SUFFIX ".mp4"

enum { TED4_MAX_VIEWS = 1000000 }; /* cameras of --orbit, pictures of --path */

typedef struct {
    const char *input;
    const char *output, *render;      /* patterns; NULL: not requested */
    const char *cameras, *path;       /* file names, or "file"; NULL: not requested */
    int orbit, views;                 /* numbers of pictures; 0: not given */
    const ted4_format *format;        /* of output */
    const ted4_format *stdout_format; /* --format; NULL: not given */
    ted4_range range;
    ted4_time time;
    int has_range, has_time;
    ted4_seconds seconds; /* the time, if den > 0 */
    float centre[3];
    int has_centre;
    float up[3];   /* direction of the scene that exports turn up; all 0: do not turn */
    int auto_up;   /* 1: the file says which direction */
    int sh_degree; /* -1: not given */
    int threads;
    int64_t max_memory, max_work; /* limits for decoding and for a query; 0: not given */
    int keep_all, drop_faint, widen, hash, test, lenient, trace, force, json, quiet, verbose;
} ted4_settings;

/* Returns 1 if nothing is to be printed or written: the files are only to be checked. */
int ted4_settings_only_check(const ted4_settings *s);

/* Checks that no option would be without effect beside the others, before the file is read, and
 * settles the format of standard output. Returns 0, or an exit code (cli.h) after one line on
 * stderr. */
int ted4_settings_check(ted4_settings *s);

#endif
