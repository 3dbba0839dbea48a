/* session.c - see session.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "session.h"

#include <inttypes.h>
#include <stdio.h>
#include <unistd.h>

#include "cli.h"

size_t ted4_session_times(const ted4_session *s)
{
    const ted4_range *const r = &s->set->range;
    const uint32_t end = r->end < s->info.frames ? r->end : s->info.frames;

    if (s->set->has_time)
        return 1;
    return r->first < end ? (end - r->first - 1) / r->step + 1 : 0;
}

ted4_time ted4_session_time(const ted4_session *s, size_t i, uint32_t *number)
{
    *number = s->set->has_time ? 0 : s->set->range.first + (uint32_t)i * s->set->range.step;
    return s->set->has_time ? s->time : ted4_time_of_frame(*number, s->info.frames);
}

int ted4_session_failed(ted4_status status, const ted4_session *s)
{
    return ted4_report("ted4dec", s->set->input, &(ted4_error) { status, 0 }, s->set->json);
}

int ted4_session_refused(const char *path, const char *why)
{
    fprintf(stderr, "ted4dec: %s: %s\n", path, why);
    return TED4_EXIT_TOOL;
}

void ted4_session_progress(const ted4_session *s, const char *what, size_t done, size_t n)
{
    if (!s->set->quiet && n > 1 && isatty(STDERR_FILENO))
        fprintf(stderr, "\r%s %zu/%zu%s", what, done, n, done == n ? "\n" : "");
}

void ted4_session_append(json_t *report, const char *key, json_t *value)
{
    json_t *list = json_object_get(report, key);

    if (list == NULL) {
        list = json_array();
        json_object_set_new(report, key, list);
    }
    json_array_append_new(list, value);
}

const float *ted4_session_up(const ted4_session *s)
{
    return s->set->auto_up ? s->up : s->set->up;
}
