/* open_scene.c - the first step of ted4dec: decodes a file to a recon, strictly or leniently, and
 * reports the time and memory used.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "actions.h"
#include "cli.h"
#include "clock.h"
#include "file_cameras.h"
#include "plural.h"

static void print_element(void *user, size_t offset, const char *element, int64_t index,
                          int64_t value)
{
    (void)user;
    printf("%zu %s[%" PRId64 "] = %" PRId64 "\n", offset, element, index, value);
}

/* Reports the contents of the file, and the time and memory used to decode it to attributes.
 * ru_maxrss is the peak of this process in KiB (Linux), including its copy of the file: it is that
 * of the largest file until then. */
static void tell_cost(const ted4_session *s, size_t size, double ms)
{
    const ted4_settings *const set = s->set;
    struct rusage usage;
    const double mib = getrusage(RUSAGE_SELF, &usage) == 0 ? (double)usage.ru_maxrss / 1024 : 0.0;

    if (set->verbose || (ted4_settings_only_check(set) && !set->quiet))
        fprintf(stderr,
                "ted4dec: %s: %s, %zu bytes, %" PRIu32 " anchor%s, %zu Gaussian%s, %" PRIu32
                " frame%s; decoded to attributes in %.1f ms, peak memory so far %.1f MiB\n",
                set->input, s->warned ? "incomplete" : "valid", size, s->info.n_anchors,
                ted4_s(s->info.n_anchors), s->info.n_gaussians, ted4_s(s->info.n_gaussians),
                s->info.frames, ted4_s(s->info.frames), ms, mib);
    if (ted4_settings_only_check(set)) {
        json_object_set_new(s->report, "decode_ms", json_real(ms));
        json_object_set_new(s->report, "peak_mib", json_real(mib));
    }
}

/* spec 3.3: reports the strict verdict, and what the lenient decoder recovered. */
static void tell_salvage(ted4_session *s, const ted4_salvage *what)
{
    const ted4_error *const v = &what->verdict, *const stop = &what->stop;

    s->warned = 1;
    fprintf(stderr,
            "ted4dec: %s: byte %zu: %s [%s] (specification %s)\n"
            "ted4dec: %s: incomplete: tiles 0 to %" PRIu32 " of %" PRIu32 ", %" PRIu32
            " anchor%s of %" PRIu32 "; nothing from byte %zu on: %s [%s]\n",
            s->set->input, v->offset, ted4_status_text(v->code), ted4_status_id(v->code),
            ted4_status_section(v->code), s->set->input, what->n_tiles - 1, what->tiles_declared,
            s->info.n_anchors, ted4_s(s->info.n_anchors), what->anchors_declared, stop->offset,
            ted4_status_text(stop->code), ted4_status_id(stop->code));
    json_object_set_new(s->report, "verdict", json_string("invalid"));
    json_object_set_new(s->report, "error", json_string(ted4_status_id(v->code)));
    json_object_set_new(s->report, "offset", json_integer((json_int_t)v->offset));
    json_object_set_new(
        s->report, "salvage",
        json_pack("{s:I, s:I, s:I, s:I, s:s, s:I}", "tiles", (json_int_t)what->n_tiles,
                  "tiles_declared", (json_int_t)what->tiles_declared, "anchors",
                  (json_int_t)s->info.n_anchors, "anchors_declared",
                  (json_int_t)what->anchors_declared, "stop", ted4_status_id(stop->code),
                  "stop_offset", (json_int_t)stop->offset));
}

/* Decodes as the settings say and fills what->verdict. Returns the scene, or NULL. With --lenient,
 * there may be a scene although the verdict is an error. */
static ted4_scene *decode(ted4_session *s, const uint8_t *data, size_t size, const ted4_options *o,
                          ted4_salvage *what)
{
    ted4_scene *scene;

    memset(what, 0, sizeof *what);
    if (s->set->lenient)
        (void)ted4_decode_lenient(data, size, o, &scene, what);
    else
        (void)ted4_decode(data, size, o, &scene, &what->verdict);
    return scene;
}

/* Returns the time of --time. */
static ted4_time requested_time(const ted4_session *s)
{
    const ted4_info *const info = &s->info;
    const ted4_seconds t = s->set->seconds;
    const double end = (double)(info->frames - 1) * info->rate_den / info->rate_num;

    if (t.den == 0)
        return s->set->time;
    if ((double)t.num / t.den > end && !s->set->quiet)
        fprintf(stderr, "ted4dec: note: the last frame is at %.7g s\n", end);
    return ted4_time_of_seconds(t, info->frames, info->rate_num, info->rate_den);
}

int ted4_action_open(ted4_session *s)
{
    const ted4_settings *const set = s->set;
    const ted4_options options = { .parallel = &s->parallel,
                                   .max_bytes = (uint64_t)set->max_memory,
                                   .max_work = (uint64_t)set->max_work,
                                   .trace = set->trace ? print_element : NULL };
    ted4_salvage what;
    size_t size;
    uint8_t *const data = ted4_read_ted4(set->input, &size);
    const double start = ted4_clock();
    int code = TED4_EXIT_FINE;

    s->data = data;
    s->size = size;
    if (data == NULL)
        return ted4_report_unread("ted4dec", set->input, set->json);
    ted4_scene *const scene = decode(s, data, size, &options, &what);
    ted4_error e = what.verdict;

    if (scene != NULL) { /* the scene is freed once there is a recon */
        ted4_scene_info(scene, &s->info);
        ted4_file_up(data, size, s->up);
        s->time = requested_time(s);
        if (e.code != TED4_OK)
            tell_salvage(s, &what);
        e = (ted4_error) { ted4_recon_new(&s->recon, scene, &options), 0 };
        ted4_scene_free(scene);
    } else if (ted4_status_verdict(what.stop.code) == TED4_LIMIT) {
        e = what.stop; /* what made --lenient recover nothing */
    }
    if (e.code == TED4_OK)
        tell_cost(s, size, 1e3 * (ted4_clock() - start));
    else
        code = ted4_report("ted4dec", set->input, &e, set->json);
    return code;
}
