/* ted4dec.c - decodes a .ted4 file: checks it, exports its Gaussians for viewers, renders views.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <getopt.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "actions.h"
#include "arguments.h"
#include "cli.h"
#include "contract.h"
#include "graver.h"
#include "json_string.h"
#include "leftovers.h"
#include "threads.h"
#include "output.h"
#include "settings.h"
#include "sh.h"
#include "turn.h"
#include "views.h"

enum {
    OPT_OUTPUT,
    OPT_FORMAT,
    OPT_FRAMES,
    OPT_TIME,
    OPT_CENTRE,
    OPT_SH_DEGREE,
    OPT_UP,
    OPT_WIDEN,
    OPT_KEEP_ALL,
    OPT_DROP_FAINT,
    OPT_RENDER,
    OPT_CAMERA,
    OPT_ORBIT,
    OPT_PATH,
    OPT_VIEWS,
    OPT_HASH,
    OPT_TEST,
    OPT_LENIENT,
    OPT_TRACE,
    OPT_MEMORY,
    OPT_WORK,
    OPT_THREADS,
    OPT_FORCE,
    OPT_JSON,
    OPT_QUIET,
    OPT_VERBOSE,
    OPT_HELP,
    OPT_VERSION,
    N_OPTIONS
};

static const ted4_argument OPTIONS[N_OPTIONS] = {
    [OPT_OUTPUT] = { 'o', "output", "FILE",
                     "write Gaussians, one file per frame; the name ends in a format below and may "
                     "hold one %d; - is standard output" },
    [OPT_FORMAT] = { 0, "format", "NAME", "format of -o -: ply (default), splat, glb or raw" },
    [OPT_FRAMES] = { 0, "frames", "A:B:STEP",
                     "frames A to B - 1 by STEP; parts may be missing; A alone: that frame. "
                     "Default: all" },
    [OPT_TIME] = { 0, "time", "T",
                   "one time instead: in seconds, as 1.5s, or from 0 to 1, as 0.25 or 7/30; also "
                   "for --render" },
    [OPT_CENTRE] = { 0, "camera-centre", "X,Y,Z",
                     "where --hash and -o look from, in world coordinates, if spherical harmonics "
                     "do not "
                     "stand for all views. Default 0,0,0" },
    [OPT_SH_DEGREE] = { 0, "sh-degree", "N",
                        "spherical harmonics that stand for view-dependent colours, 0 to 3. "
                        "Default 1, if colours depend on the view" },
    [OPT_UP] = { 0, "up", "AXIS",
                 "turn what -o writes so that this axis of the scene is up in viewers, and --orbit "
                 "around it: x, y, z, -x, -y, -z, or auto: as the file says (ted4info shows it)" },
    [OPT_WIDEN] = { 0, "widen", NULL,
                    "widen the Gaussians of -o by the blur of a training pixel, for viewers that "
                    "draw larger pictures than those of training; the file has to hold its "
                    "cameras" },
    [OPT_KEEP_ALL] = { 0, "keep-all", NULL,
                       "also write Gaussians whose opacity is below 1/255. Default where the name "
                       "holds a %d, so that all files of a sequence have the same Gaussians" },
    [OPT_DROP_FAINT] = { 0, "drop-faint", NULL, "leave them out. Default for a single file" },
    [OPT_RENDER] = { 0, "render", "FILE",
                     "draw what --camera, --orbit or --path sees as FILE.png, whose name may hold "
                     "one "
                     "%d, or as a video FILE.mp4 at the scene's frame rate, with the program "
                     "ffmpeg" },
    [OPT_CAMERA] = { 0, "camera", "FILE.json",
                     "list of {width, height, fx, fy, cx, cy, R[9], t[3], frame or time}, a "
                     "transforms_*.json, whose times are fractions of the scene, or the word file: "
                     "the cameras of FILE.ted4. Default time: 0" },
    [OPT_ORBIT] = { 0, "orbit", "N",
                    "N cameras around the scene, or to and fro where the cameras of FILE.ted4 "
                    "stand, while it plays once" },
    [OPT_PATH] = { 0, "path", "FILE.json",
                   "a camera that moves along these ones while the scene plays: all of it or, if "
                   "every "
                   "camera has a time and none is earlier than the one before, from the first time "
                   "to the last; file: the path of FILE.ted4" },
    [OPT_VIEWS] = { 0, "views", "N",
                    "pictures of --path. Default: as many as the scene has frames; of a scene of "
                    "one time, 30 from camera to camera" },
    [OPT_HASH] = { 0, "hash", NULL,
                   "print the hash of the decoded integers and, for --frames or --time, of these "
                   "queries" },
    [OPT_TEST] = { 0, "test", NULL,
                   "only decode, checking everything, and tell time and the program's peak memory "
                   "so far (also what happens when nothing else is asked for); of any number of "
                   "files" },
    [OPT_LENIENT] = { 0, "lenient", NULL,
                      "of a damaged or truncated file take the first whole tiles, and say so" },
    [OPT_TRACE] = { 0, "trace", NULL,
                    "print every syntax element: byte offset, name, index, value" },
    [OPT_MEMORY] = { 0, "max-memory", "BYTES",
                     "refuse a file that takes more, as a scene or for queries. Default 4 GiB "
                     "each" },
    [OPT_WORK] = { 0, "max-work", "STEPS",
                   "refuse a file that asks for more steps, also for one query (specification "
                   "13.4). Default: any number" },
    [OPT_THREADS] = { 'j', "threads", "N", "threads; 0: all cores that it may use. Default 0" },
    [OPT_FORCE] = { 'f', "force", NULL, "overwrite files" },
    [OPT_JSON] = { 0, "json", NULL, "results as one JSON object" },
    [OPT_QUIET] = { 'q', "quiet", NULL, "errors and warnings only" },
    [OPT_VERBOSE] = { 'v', "verbose", NULL, "say more" },
    [OPT_HELP] = TED4_ARGUMENT_HELP,
    [OPT_VERSION] = TED4_ARGUMENT_VERSION,
};

static void print_formats(FILE *f)
{
    fputs("\nFormats of -o:\n", f);
    for (size_t i = 0; ted4_formats[i] != NULL; i++) {
        fprintf(f, "  %-8s ", ted4_formats[i]->suffix);
        ted4_arguments_wrap(f, ted4_formats[i]->text, 11);
    }
}

static const ted4_command COMMAND = {
    "ted4dec",
    "FILE.ted4... [options]     (- reads standard input)",
    "Decodes a TED4 file: Gaussians of any time as files for viewers, pictures, hashes.",
    OPTIONS,
    N_OPTIONS,
    "Exit codes: 0 fine, 1 file refused, 2 fine with warnings, 3 usage, input,\n"
    "output or resources.\n\n"
    "Examples:\n"
    "  ted4dec a.ted4 -o frame_%05d.ply --up auto\n"
    "  ted4dec a.ted4 --render view_%04d.png --orbit 120\n",
    print_formats,
};

static int bad_value(const char *name, const char *value, const char *expected)
{
    return ted4_arguments_bad("ted4dec", name, value, expected);
}

static int bad_format(const char *value)
{
    char expected[200] = "a name that ends in";
    size_t n = strlen(expected);

    for (size_t i = 0; ted4_formats[i] != NULL && n < sizeof expected; i++) {
        const char *const before = i == 0 ? " " : ted4_formats[i + 1] != NULL ? ", " : " or ";

        n += (size_t)snprintf(expected + n, sizeof expected - n, "%s%s", before,
                              ted4_formats[i]->suffix);
    }
    return bad_value("output", value, expected);
}

static int check_pattern(const char *name, const char *value)
{
    return ted4_pattern_count(value) >= 0
               ? 0
               : bad_value(name, value, "at most one %d, %5d or %05d, and no other %");
}

/* Several files can be checked; an output is not one of them. */
static int may_be_many(const ted4_settings *s, int n, char **operand)
{
    for (int i = 0; i < n; i++)
        if (ted4_format_find(operand[i]) != NULL)
            return 0;
    return ted4_settings_only_check(s);
}

/* The operands are not one file. What looks like an output is one whose -o is missing. */
static int bad_operands(int n, char **operand)
{
    const char *output = NULL;

    for (int i = 0; i < n; i++)
        if (ted4_format_find(operand[i]) != NULL)
            output = operand[i];
    if (n == 2 && output != NULL)
        fprintf(stderr, "ted4dec: expected one file; -o %s writes Gaussians to a file\n", output);
    else
        fprintf(stderr, "ted4dec: expected one file, found %d (see --help)\n", n);
    return TED4_EXIT_TOOL;
}

/* Parses the value of an option. Returns 0, or an exit code. */
static int set_number(const char *name, const char *value, int high, int *out)
{
    int64_t n;

    if (ted4_arguments_number(value, 0, high, &n) != 0)
        return ted4_arguments_bad_number("ted4dec", name, value, 0, high);
    *out = (int)n;
    return 0;
}

static int set_count(const char *name, const char *value, int *out)
{
    int64_t n;

    if (ted4_arguments_number(value, 1, TED4_MAX_VIEWS, &n) != 0)
        return ted4_arguments_bad_number("ted4dec", name, value, 1, TED4_MAX_VIEWS);
    *out = (int)n;
    return 0;
}

/* Does the same for a limit, which is at least 1. */
static int set_bound(const char *name, const char *value, int64_t *out)
{
    return ted4_arguments_number(value, 1, INT64_MAX, out) != 0
               ? ted4_arguments_bad_number("ted4dec", name, value, 1, INT64_MAX)
               : 0;
}

static int set_up(ted4_settings *s, const char *value)
{
    s->auto_up = strcmp(value, "auto") == 0;
    memset(s->up, 0, sizeof s->up);
    return s->auto_up || ted4_axis_parse(value, s->up) == 0
               ? 0
               : bad_value("up", value, "x, y, z, -x, -y, -z or auto");
}

static int set_time(ted4_settings *s, const char *value)
{
    s->has_time = 1;
    s->seconds.den = 0;
    if (ted4_time_parse(value, &s->time) == 0 || ted4_seconds_parse(value, &s->seconds) == 0)
        return 0;
    return bad_value(
        "time", value,
        "seconds, as 1.5s, or 0 to 1, as 0.25 or 7/30; at most 7 digits after a point");
}

/* Sets the value of an option that may be given once: of two files, one would be lost. */
static int set_once(const char *option, const char *value, const char **out)
{
    if (*out != NULL) {
        fprintf(stderr, "ted4dec: %s: only once (see --help)\n", option);
        return TED4_EXIT_TOOL;
    }
    *out = value;
    return 0;
}

static int set_render(ted4_settings *s, const char *value)
{
    const int code = set_once("--render", value, &s->render);

    if (code != 0)
        return code;
    if (ted4_has_suffix(value, TED4_VIDEO_SUFFIX))
        return ted4_pattern_count(value) == 0
                   ? 0
                   : bad_value("render", value, "a name without % for a video");
    return ted4_has_suffix(value, ".png")
               ? check_pattern("render", value)
               : bad_value("render", value, "a name that ends in .png or .mp4");
}

static int set_output(ted4_settings *s, const char *value)
{
    const int code = set_once("-o", value, &s->output);

    if (code != 0)
        return code;
    s->format = ted4_output_is_stdout(value) ? &ted4_format_ply : ted4_format_find(value);
    return s->format == NULL ? bad_format(value) : check_pattern("output", value);
}

static int set_format(ted4_settings *s, const char *value)
{
    char name[16];

    snprintf(name, sizeof name, "x.%s", value);
    s->stdout_format = ted4_format_find(name);
    return s->stdout_format != NULL ? 0 : bad_value("format", value, "ply, splat, glb or raw");
}

static int set_option(ted4_settings *s, int option, const char *value)
{
    switch (option) {
    case OPT_OUTPUT: return set_output(s, value);
    case OPT_FORMAT: return set_format(s, value);
    case OPT_FRAMES:
        s->has_range = 1;
        return ted4_range_parse(value, &s->range) == 0
                   ? 0
                   : bad_value("frames", value,
                               "one frame, or A:B:STEP with A < B, as 0:10 or ::5");
    case OPT_TIME: return set_time(s, value);
    case OPT_CENTRE:
        s->has_centre = 1;
        return ted4_arguments_floats(value, 3, s->centre) == 0
                   ? 0
                   : bad_value("camera-centre", value, "three numbers X,Y,Z");
    case OPT_SH_DEGREE: return set_number("sh-degree", value, TED4_SH_MAX_DEGREE, &s->sh_degree);
    case OPT_UP: return set_up(s, value);
    case OPT_RENDER: return set_render(s, value);
    case OPT_CAMERA: return set_once("--camera", value, &s->cameras);
    case OPT_ORBIT: return set_count("orbit", value, &s->orbit);
    case OPT_PATH: return set_once("--path", value, &s->path);
    case OPT_VIEWS: return set_count("views", value, &s->views);
    case OPT_MEMORY: return set_bound("max-memory", value, &s->max_memory);
    case OPT_WORK: return set_bound("max-work", value, &s->max_work);
    case OPT_THREADS: return set_number("threads", value, TED4_MAX_THREADS, &s->threads);
    default: break;
    }
    int *const flag[N_OPTIONS] = { [OPT_KEEP_ALL] = &s->keep_all, [OPT_DROP_FAINT] = &s->drop_faint,
                                   [OPT_WIDEN] = &s->widen,       [OPT_HASH] = &s->hash,
                                   [OPT_TEST] = &s->test,         [OPT_LENIENT] = &s->lenient,
                                   [OPT_TRACE] = &s->trace,       [OPT_FORCE] = &s->force,
                                   [OPT_JSON] = &s->json,         [OPT_QUIET] = &s->quiet,
                                   [OPT_VERBOSE] = &s->verbose };

    *flag[option] = 1;
    return 0;
}

/* Returns -1 if the program should continue, else its exit code. */
static int parse(ted4_settings *s, int argc, char **argv)
{
    const char *value;

    *s = (ted4_settings) { .range = { 0, UINT32_MAX, 1 }, .sh_degree = -1 };
    for (int i; (i = ted4_arguments_next(&COMMAND, argc, argv, &value)) != TED4_ARGUMENTS_END;) {
        if (i == TED4_ARGUMENTS_BAD)
            return TED4_EXIT_TOOL;
        if (i == TED4_ARGUMENTS_DONE)
            return TED4_EXIT_FINE;
        const int code = set_option(s, i, value);

        if (code != 0)
            return code;
    }
    if (optind == argc || (optind + 1 < argc && !may_be_many(s, argc - optind, argv + optind)))
        return bad_operands(argc - optind, argv + optind);
    const int code = ted4_settings_check(s);

    return code != 0 ? code : -1;
}

static int run(ted4_session *s)
{
    const ted4_settings *const set = s->set;
    int code = ted4_action_open(s);

    if (code == TED4_EXIT_FINE)
        code = ted4_views_make(s);
    if (code == TED4_EXIT_FINE)
        code = ted4_action_check(s);
    if (code == TED4_EXIT_FINE && set->hash)
        code = ted4_action_hash(s);
    if (code == TED4_EXIT_FINE && set->output != NULL)
        code = ted4_action_export(s);
    if (code == TED4_EXIT_FINE && set->render != NULL)
        code = ted4_action_render(s);
    if (code != TED4_EXIT_FINE || !set->json)
        return code;

    json_object_set_new(s->report, "file", ted4_json_string(set->input));
    if (json_object_get(s->report, "verdict") == NULL)
        json_object_set_new(s->report, "verdict", json_string("valid"));
    json_object_set_new(s->report, "frames", json_integer(s->info.frames));
    json_object_set_new(s->report, "gaussians", json_integer((json_int_t)s->info.n_gaussians));
    json_dumpf(s->report, stdout, JSON_COMPACT | JSON_REAL_PRECISION(9));
    putchar('\n');
    return code;
}

/* Does for one file what the settings say. Returns the exit code. */
static int work(const ted4_settings *set)
{
    ted4_session s = { .set = set, .report = json_object() };
    int code;

    ted4_threads_init(&s.parallel, set->threads);
    code = run(&s);
    free(s.data);
    ted4_camera_list_free(&s.cameras);
    ted4_recon_free(s.recon);
    json_decref(s.report);
    ted4_threads_finish(&s.parallel);
    return code == TED4_EXIT_FINE && s.warned ? TED4_EXIT_WARNED : code;
}

int main(int argc, char **argv)
{
    ted4_settings set;
    int worst = TED4_EXIT_FINE;

    if (ted4_contract_asked(argc, argv))
        return ted4_contract(argc, argv);

    const int parsed = parse(&set, argc, argv);

    if (parsed >= 0)
        return parsed;
    ted4_leftovers_watch();
    for (int i = optind; i < argc; i++) {
        set.input = argv[i];
        worst = ted4_graver(worst, work(&set));
    }
    return ted4_cli_end("ted4dec", worst);
}
