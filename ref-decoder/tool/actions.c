/* actions.c - see actions.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "actions.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/bytes.h"
#include "cli.h"
#include "output.h"
#include "render/png_file.h"
#include "render/view.h"
#include "sample.h"

static const char PROGRAM[] = "ted4dec";

/* ---- times ---- */

static size_t count_times(const ted4_session *s)
{
    const ted4_range *const r = &s->set->range;
    const uint32_t end = r->end < s->info.frames ? r->end : s->info.frames;

    if (s->set->has_time)
        return 1;
    return r->first < end ? (end - r->first - 1) / r->step + 1 : 0;
}

/* Returns time i of the count_times(s) requested ones. *number: the number for its file name. */
static ted4_time time_at(const ted4_session *s, size_t i, uint32_t *number)
{
    *number = s->set->has_time ? 0 : s->set->range.first + (uint32_t)i * s->set->range.step;
    return s->set->has_time ? s->set->time : ted4_time_of_frame(*number, s->info.frames);
}

/* ---- messages ---- */

static int failed_status(ted4_status status, const ted4_session *s)
{
    return ted4_report(PROGRAM, s->set->input, &(ted4_error) { status, 0 }, s->set->json);
}

static int failed_file(const char *path, const char *why)
{
    fprintf(stderr, "%s: %s: %s\n", PROGRAM, path, why);
    return TED4_EXIT_TOOL;
}

static void progress(const ted4_session *s, const char *what, size_t done, size_t n)
{
    if (!s->set->quiet && n > 1 && isatty(STDERR_FILENO))
        fprintf(stderr, "\r%s %zu/%zu%s", what, done, n, done == n ? "\n" : "");
}

static void append(json_t *report, const char *key, json_t *value)
{
    json_t *list = json_object_get(report, key);

    if (list == NULL) {
        list = json_array();
        json_object_set_new(report, key, list);
    }
    json_array_append_new(list, value);
}

/* ---- checks before anything is written ---- */

static int check_free(const char *pattern, uint32_t number)
{
    char path[TED4_PATH_SIZE];

    if (ted4_pattern_make(path, pattern, number) != 0)
        return failed_file(pattern, "name too long");
    if (access(path, F_OK) == 0)
        return failed_file(path, "exists; -f overwrites");
    return TED4_EXIT_FINE;
}

static int check_frames(const ted4_session *s)
{
    const ted4_settings *const set = s->set;

    if (set->range.first >= s->info.frames ||
        (set->range.end != UINT32_MAX && set->range.end > s->info.frames)) {
        fprintf(stderr, "%s: --frames: the file has frames 0 to %" PRIu32 "\n", PROGRAM,
                s->info.frames - 1);
        return TED4_EXIT_TOOL;
    }
    for (size_t i = 0; i < s->cameras.n; i++) {
        if (s->cameras.camera[i].has_frame && s->cameras.camera[i].frame >= s->info.frames) {
            fprintf(stderr, "%s: %s: camera %zu: the file has frames 0 to %" PRIu32 "\n", PROGRAM,
                    set->cameras, i, s->info.frames - 1);
            return TED4_EXIT_TOOL;
        }
    }
    return TED4_EXIT_FINE;
}

static int has_direction(const float v[3])
{
    return v[0] != 0 || v[1] != 0 || v[2] != 0;
}

/* The direction of the scene that exports turn up; all 0: they are not turned. */
static const float *up_of_export(const ted4_session *s)
{
    return s->set->auto_up ? s->up : s->set->up;
}

static int check_up(const ted4_session *s)
{
    if (!s->set->auto_up || has_direction(s->up))
        return TED4_EXIT_FINE;
    fprintf(stderr, "%s: --up auto: the file does not say which way is up; name an axis, as z\n",
            PROGRAM);
    return TED4_EXIT_TOOL;
}

/* A camera centre changes nothing in formats whose harmonics hold the colours of all views, unless
 * the shapes depend on the view as well. */
static int check_centre(const ted4_session *s)
{
    const ted4_settings *const set = s->set;

    if (!set->has_centre || set->hash || s->info.view != TED4_VIEW_COLOUR ||
        set->format->max_sh_degree < 0)
        return TED4_EXIT_FINE;
    fprintf(stderr,
            "%s: --camera-centre: has no effect: spherical harmonics hold the colours of all views;"
            " .raw holds those of one\n",
            PROGRAM);
    return TED4_EXIT_TOOL;
}

int ted4_action_check(const ted4_session *s)
{
    const ted4_settings *const set = s->set;
    const size_t n_files = set->output != NULL ? count_times(s) : 0;
    int code = check_frames(s);

    if (code == TED4_EXIT_FINE)
        code = check_centre(s);
    if (code == TED4_EXIT_FINE)
        code = check_up(s);
    if (code == TED4_EXIT_FINE && n_files > 1 && ted4_pattern_count(set->output) == 0)
        code = failed_file(set->output, "several frames need a %d in the name");
    if (code == TED4_EXIT_FINE && s->cameras.n > 1 && ted4_pattern_count(set->render) == 0)
        code = failed_file(set->render, "several cameras need a %d in the name");
    for (size_t i = 0; i < n_files && code == TED4_EXIT_FINE && !set->force; i++) {
        uint32_t number;

        time_at(s, i, &number);
        code = check_free(set->output, number);
    }
    for (size_t i = 0; i < s->cameras.n && code == TED4_EXIT_FINE && !set->force; i++)
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
        return failed_status(status, s);
    ted4_gaussians_hash(&g, hash);
    ted4_hex(text, hash, sizeof hash);
    if (s->set->json)
        append(s->report, "queries",
               json_pack("{s:I, s:I, s:[f,f,f], s:s}", "num", (json_int_t)t.num, "den",
                         (json_int_t)t.den, "camera", (double)c[0], (double)c[1], (double)c[2],
                         "hash", text));
    else
        printf("query %" PRIu32 "/%" PRIu32 " %.9g,%.9g,%.9g %s\n", t.num, t.den, (double)c[0],
               (double)c[1], (double)c[2], text);
    return TED4_EXIT_FINE;
}

int ted4_action_hash(ted4_session *s)
{
    const size_t n = s->set->has_time || s->set->has_range ? count_times(s) : 0;
    int code = TED4_EXIT_FINE;
    char text[33];

    ted4_hex(text, s->info.hash, sizeof s->info.hash);
    if (s->set->json)
        json_object_set_new(s->report, "ends", json_string(text));
    else
        printf("ends %s\n", text);
    if (n > 0 && !ted4_recon_class_x()) {
        fprintf(stderr, "%s: warning: this build is not strict: hashes of queries may differ\n",
                PROGRAM);
        s->warned = 1;
    }
    for (size_t i = 0; i < n && code == TED4_EXIT_FINE; i++) {
        uint32_t number;
        const ted4_time t = time_at(s, i, &number);

        code = hash_query(s, t);
    }
    return code;
}

/* ---- -o ---- */

/* Prints how view-dependent values are written, because the format cannot hold them as they are. */
static void announce_export(ted4_session *s, const ted4_sampler *how)
{
    const float *const c = s->set->centre;

    if (!has_direction(up_of_export(s)) && has_direction(s->up) && s->up[1] > -0.9f &&
        s->set->format != &ted4_format_raw && !s->set->quiet)
        fprintf(
            stderr,
            "%s: note: up is %g %g %g in this scene, and viewers expect 0 -1 0; --up auto turns "
            "it\n",
            PROGRAM, (double)s->up[0], (double)s->up[1], (double)s->up[2]);
    if (s->info.view == TED4_VIEW_FULL) {
        fprintf(stderr,
                "%s: warning: opacity and shape depend on the view in this file; written as seen "
                "from %g,%g,%g\n",
                PROGRAM, (double)c[0], (double)c[1], (double)c[2]);
        s->warned = 1;
    } else if (s->info.view == TED4_VIEW_COLOUR && how->sh_degree < 0 && !s->set->quiet) {
        fprintf(stderr, "%s: note: colours as seen from %g,%g,%g\n", PROGRAM, (double)c[0],
                (double)c[1], (double)c[2]);
    }
}

/* Says at the end of text, of n bytes of size, what the axes of an export are. */
static void say_axes(const ted4_session *s, char *text, size_t n, size_t size)
{
    const float *const turned = up_of_export(s), *const up = s->up;

    if (has_direction(turned))
        snprintf(text + n, size - n,
                 "world axes: right-handed, y down: turned so that %g %g %g of the scene is up\n",
                 (double)turned[0], (double)turned[1], (double)turned[2]);
    else if (has_direction(up))
        snprintf(text + n, size - n, "world axes: right-handed, of the scene: up is %g %g %g\n",
                 (double)up[0], (double)up[1], (double)up[2]);
    else
        snprintf(text + n, size - n,
                 "world axes: right-handed, of the scene: which way is up is not known\n");
}

/* Writes one time. *worst_rms becomes at least the error of this fit. */
static int export_time(ted4_session *s, const ted4_sampler *how, ted4_time t, uint32_t number,
                       double *worst_rms)
{
    char path[TED4_PATH_SIZE], comment[512];
    ted4_sample sample;
    int code = TED4_EXIT_FINE, n;
    const ted4_status status = ted4_sample_make(how, t.num, t.den, &sample);

    if (status != TED4_OK)
        return failed_status(status, s);
    n = snprintf(comment, sizeof comment, "generated by ted4dec %s\ntime %" PRIu32 "/%" PRIu32 "\n",
                 TED4_VERSION, t.num, t.den);
    say_axes(s, comment, (size_t)n, sizeof comment);
    n = (int)strlen(comment);
    if (s->info.view != TED4_VIEW_NONE && how->sh_degree >= 0)
        snprintf(comment + n, sizeof comment - (size_t)n,
                 "colours fitted to a view-dependent head, rms error %.4f\n", sample.sh_rms);
    sample.frame.comment = comment;
    sample.frame.in_order = ted4_pattern_count(s->set->output) > 0;
    if (ted4_pattern_make(path, s->set->output, number) != 0 ||
        ted4_export(s->set->format, &sample.frame, path) != 0)
        code = failed_file(s->set->output, strerror(errno));
    else if (s->set->json)
        append(s->report, "exports",
               json_pack("{s:s, s:I, s:I, s:I, s:f}", "path", path, "num", (json_int_t)t.num, "den",
                         (json_int_t)t.den, "gaussians", (json_int_t)sample.frame.n, "sh_rms",
                         sample.sh_rms));
    if (code == TED4_EXIT_FINE && s->set->verbose)
        fprintf(stderr, "%s: %s: %zu of %zu Gaussians, rms error of colours %.4f\n", PROGRAM, path,
                sample.frame.n, s->info.n_gaussians, sample.sh_rms);
    if (sample.sh_rms > *worst_rms)
        *worst_rms = sample.sh_rms;
    ted4_sample_finish(&sample);
    return code;
}

/* The degree of the export: if none was requested, 1 where colours depend on the view, otherwise
 * 0; and not more than the format holds (-1: no harmonics). Degree 1 gives most of what harmonics
 * can give. */
static int sh_degree(const ted4_settings *set, const ted4_info *info)
{
    const int useful = info->view != TED4_VIEW_NONE;
    const int wanted = set->sh_degree >= 0 ? set->sh_degree : useful;

    return wanted < set->format->max_sh_degree ? wanted : set->format->max_sh_degree;
}

int ted4_action_export(ted4_session *s)
{
    const ted4_settings *const set = s->set;
    const size_t n = count_times(s);
    const int is_sequence = ted4_pattern_count(set->output) > 0;
    ted4_turn turn;
    const ted4_sampler how = {
        .recon = s->recon,
        .info = &s->info,
        .parallel = &s->parallel,
        .camera = { set->centre[0], set->centre[1], set->centre[2] },
        .sh_degree = sh_degree(set, &s->info),
        .turn = has_direction(up_of_export(s)) ? &turn : NULL,
        .keep_all = set->keep_all || (is_sequence && !set->drop_faint),
    };
    double worst_rms = 0.0;
    int code = TED4_EXIT_FINE;

    if (how.turn != NULL)
        ted4_turn_up(up_of_export(s), &turn);
    announce_export(s, &how);
    for (size_t i = 0; i < n && code == TED4_EXIT_FINE; i++) {
        uint32_t number;
        const ted4_time t = time_at(s, i, &number);

        code = export_time(s, &how, t, number, &worst_rms);
        progress(s, "written", i + 1, n);
    }
    if (code == TED4_EXIT_FINE && !set->quiet && s->info.view != TED4_VIEW_NONE &&
        how.sh_degree >= 0)
        fprintf(stderr,
                "%s: note: spherical harmonics of degree %d stand for view-dependent colours; rms "
                "error at most %.4f\n",
                PROGRAM, how.sh_degree, worst_rms);
    return code;
}

/* ---- --render ---- */

static int render_camera(ted4_session *s, ted4_viewer *viewer, const ted4_listed_camera *c,
                         uint32_t number)
{
    const ted4_time t = c->has_frame ? ted4_time_of_frame(c->frame, s->info.frames) : c->time;
    uint8_t *const rgb = malloc((size_t)c->view.width * (size_t)c->view.height * 3);
    char path[TED4_PATH_SIZE], why[256];
    int code = TED4_EXIT_FINE;
    ted4_status status = TED4_E_LIMIT_MEMORY;

    if (rgb != NULL)
        status = ted4_render_query(viewer, s->recon, &s->info, t.num, t.den, &c->view, &s->parallel,
                                   rgb);
    if (status != TED4_OK)
        code = failed_status(status, s);
    else if (ted4_pattern_make(path, s->set->render, number) != 0)
        code = failed_file(s->set->render, "name too long");
    else if (ted4_png_write(path, c->view.width, c->view.height, rgb, why, sizeof why) != 0)
        code = failed_file(path, why);
    else if (s->set->json)
        append(s->report, "views",
               json_pack("{s:s, s:I, s:I}", "path", path, "num", (json_int_t)t.num, "den",
                         (json_int_t)t.den));
    free(rgb);
    return code;
}

int ted4_action_render(ted4_session *s)
{
    ted4_viewer *const viewer = ted4_viewer_new();
    int code = viewer == NULL ? failed_status(TED4_E_LIMIT_MEMORY, s) : TED4_EXIT_FINE;

    for (size_t i = 0; i < s->cameras.n && code == TED4_EXIT_FINE; i++) {
        code = render_camera(s, viewer, &s->cameras.camera[i], (uint32_t)i);
        progress(s, "drawn", i + 1, s->cameras.n);
    }
    ted4_viewer_free(viewer);
    return code;
}
