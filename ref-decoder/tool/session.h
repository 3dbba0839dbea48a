/* session.h - one run of ted4dec: what it has read and found, and what its actions (actions.h)
 * share.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SESSION_H
#define TED4_SESSION_H

#include <jansson.h>

#include "camera_list.h"
#include "settings.h"
#include "ted4.h"

/* One run of the program. */
typedef struct {
    const ted4_settings *set;
    ted4_parallel parallel;
    ted4_info info;
    ted4_recon *recon; /* owned */
    uint8_t *data;     /* owned: [size] the file */
    size_t size;
    ted4_camera_list cameras; /* owned: what --render draws */
    ted4_time time;           /* of --time */
    float up[3];              /* as the file says; all 0: unknown */
    json_t *report;           /* owned: what --json prints */
    int warned;
} ted4_session;

/* Returns the number of times that --frames or --time requests; all frames if neither does. */
size_t ted4_session_times(const ted4_session *s);
/* Returns time i of the ted4_session_times(s) requested ones. *number: the number for its file
 * name. */
ted4_time ted4_session_time(const ted4_session *s, size_t i, uint32_t *number);

/* Returns the direction of the scene that exports turn up; 0 0 0: they are not turned. */
const float *ted4_session_up(const ted4_session *s);

/* Report on stderr what failed, for all files or for one. Return the exit code (cli.h). */
int ted4_session_failed(ted4_status status, const ted4_session *s);
int ted4_session_refused(const char *path, const char *why);
/* Shows on a terminal that done of n are finished. */
void ted4_session_progress(const ted4_session *s, const char *what, size_t done, size_t n);
/* Adds value, which it takes over, to the list of that name in what --json prints. */
void ted4_session_append(json_t *report, const char *key, json_t *value);

#endif
