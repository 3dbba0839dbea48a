/* actions.c - see actions.h: the checks before anything is written, and --hash.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "actions.h"

#include <inttypes.h>
#include <stdio.h>

#include "base/bytes.h"
#include "cli.h"
#include "output.h"
#include "turn.h"

/* ---- checks before anything is written ---- */

static int check_free(const char *pattern, uint32_t number)
{
    char path[TED4_PATH_SIZE];

    if (ted4_output_is_stdout(pattern))
        return TED4_EXIT_FINE;
    if (ted4_pattern_make(path, pattern, number) != 0)
        return ted4_session_refused(pattern, "name too long");
    if (ted4_output_exists(path))
        return ted4_session_refused(path, "exists; -f overwrites");
    return TED4_EXIT_FINE;
}

static int check_frames(const ted4_session *s)
{
    const ted4_settings *const set = s->set;

    if (set->range.first >= s->info.frames ||
        (set->range.end != UINT32_MAX && set->range.end > s->info.frames)) {
        fprintf(stderr, "ted4dec: --frames: the file has frames 0 to %" PRIu32 "\n",
                s->info.frames - 1);
        return TED4_EXIT_TOOL;
    }
    for (size_t i = 0; i < s->cameras.n; i++) {
        if (s->cameras.camera[i].has_frame && s->cameras.camera[i].frame >= s->info.frames) {
            fprintf(stderr, "ted4dec: %s: camera %zu: the file has frames 0 to %" PRIu32 "\n",
                    set->cameras, i, s->info.frames - 1);
            return TED4_EXIT_TOOL;
        }
    }
    return TED4_EXIT_FINE;
}

static int check_up(const ted4_session *s)
{
    if (!s->set->auto_up || ted4_has_direction(s->up))
        return TED4_EXIT_FINE;
    fprintf(stderr,
            "ted4dec: --up auto: the file does not say which way is up; name an axis, as z\n");
    return TED4_EXIT_TOOL;
}

/* A camera centre changes nothing if nothing depends on the view, nor in formats whose harmonics
 * hold the colours of all views, unless the shapes depend on the view as well. What --hash prints
 * names the centre. */
static int check_centre(const ted4_session *s)
{
    const ted4_settings *const set = s->set;
    const char *why = NULL;

    if (!set->has_centre || set->hash)
        return TED4_EXIT_FINE;
    if (s->info.view == TED4_VIEW_NONE)
        why = "nothing in this file depends on the view";
    else if (s->info.view == TED4_VIEW_COLOUR && set->format->max_sh_degree >= 0)
        why = "spherical harmonics hold the colours of all views; .raw holds those of one";
    if (why == NULL)
        return TED4_EXIT_FINE;
    fprintf(stderr, "ted4dec: --camera-centre: has no effect: %s\n", why);
    return TED4_EXIT_TOOL;
}

int ted4_action_check(const ted4_session *s)
{
    const ted4_settings *const set = s->set;
    const size_t n_files = set->output != NULL ? ted4_session_times(s) : 0;
    const int is_video = set->render != NULL && ted4_has_suffix(set->render, TED4_VIDEO_SUFFIX);
    const size_t n_pictures = is_video ? 1 : s->cameras.n;
    int code = check_frames(s);

    if (code == TED4_EXIT_FINE)
        code = check_centre(s);
    if (code == TED4_EXIT_FINE)
        code = check_up(s);
    if (code == TED4_EXIT_FINE && n_files > 1 && ted4_output_is_stdout(set->output))
        code = ted4_session_refused(
            "-o -", "standard output takes one frame; --time or --frames says which");
    if (code == TED4_EXIT_FINE && n_files > 1 && ted4_pattern_count(set->output) == 0)
        code = ted4_session_refused(set->output, "several frames need a %d in the name");
    if (code == TED4_EXIT_FINE && n_pictures > 1 && ted4_pattern_count(set->render) == 0)
        code = ted4_session_refused(set->render, "several cameras need a %d in the name");
    for (size_t i = 0; i < n_files && code == TED4_EXIT_FINE && !set->force; i++) {
        uint32_t number;

        ted4_session_time(s, i, &number);
        code = check_free(set->output, number);
    }
    for (size_t i = 0; i < n_pictures && code == TED4_EXIT_FINE && !set->force; i++)
        code = check_free(set->render, (uint32_t)i);
    return code;
}

/* ---- --hash ---- */

static int hash_query(ted4_session *s, ted4_time t)
{
    const float *const c = s->set->centre;
    const ted4_query q = { t.num, t.den, { c[0], c[1], c[2] } };
    ted4_gaussians g;
    uint8_t hash[16];
    char text[33];
    const ted4_status status = ted4_recon_query(s->recon, &q, &s->parallel, &g);

    if (status != TED4_OK)
        return ted4_session_failed(status, s);
    ted4_gaussians_hash(&g, hash);
    ted4_hex(text, hash, sizeof hash);
    if (s->set->json)
        ted4_session_append(s->report, "queries",
                            json_pack("{s:I, s:I, s:[f,f,f], s:s}", "num", (json_int_t)t.num, "den",
                                      (json_int_t)t.den, "camera", (double)c[0], (double)c[1],
                                      (double)c[2], "hash", text));
    else
        printf("query %" PRIu32 "/%" PRIu32 " %.9g,%.9g,%.9g %s\n", t.num, t.den, (double)c[0],
               (double)c[1], (double)c[2], text);
    return TED4_EXIT_FINE;
}

int ted4_action_hash(ted4_session *s)
{
    const size_t n = s->set->has_time || s->set->has_range ? ted4_session_times(s) : 0;
    int code = TED4_EXIT_FINE;
    char text[33];

    ted4_hex(text, s->info.hash, sizeof s->info.hash);
    if (s->set->json)
        json_object_set_new(s->report, "ends", json_string(text));
    else
        printf("ends %s\n", text);
    if (n > 0 && !ted4_recon_class_x()) {
        fprintf(stderr,
                "ted4dec: warning: this build is not strict: hashes of queries may differ\n");
        s->warned = 1;
    }
    for (size_t i = 0; i < n && code == TED4_EXIT_FINE; i++) {
        uint32_t number;
        const ted4_time t = ted4_session_time(s, i, &number);

        code = hash_query(s, t);
    }
    return code;
}
