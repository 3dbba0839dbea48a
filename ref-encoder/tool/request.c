/* request.c - see request.h. Training options come from their own table (train/model/options.def).
 * SPDX-License-Identifier: BSD-2-Clause */
#include "request.h"

#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "data/frame_rate.h"
#include "edit.h"
#include "norm/syntax.h"
#include "ted4.h"
#include "tool/arguments.h"
#include "tool/json_string.h"
#include "tool/output.h"
#include "tool/similar.h"
#include "tool/threads.h"

enum {
    OPT_OUTPUT,
    OPT_PRESET,
    OPT_LAMBDA,
    OPT_ITERATIONS,
    OPT_CAPACITY,
    OPT_WHY,
    OPT_SET,
    OPT_DOWNSCALE,
    OPT_MAX_FRAMES,
    OPT_FPS,
    OPT_BOUNDS,
    OPT_BLACK,
    OPT_ALPHA,
    OPT_HOLD_OUT,
    OPT_SEED,
    OPT_THREADS,
    OPT_CACHE,
    OPT_TARGET,
    OPT_CHECKPOINT,
    OPT_EVERY,
    OPT_RESUME,
    OPT_STAGE1,
    OPT_LOG,
    OPT_PROFILE,
    OPT_TRANSCODE,
    OPT_TITLE,
    OPT_AUTHOR,
    OPT_LICENCE,
    OPT_CAMERAS,
    OPT_THUMBNAIL,
    OPT_CHECK,
    OPT_JSON,
    OPT_CONTRACT,
    OPT_FORCE,
    OPT_QUIET,
    OPT_VERBOSE,
    OPT_HELP,
    OPT_VERSION,
    N_OPTIONS
};

enum {
    MAX_SETS = 64,
    MAX_DOWNSCALE = 64,
    MAX_MAX_FRAMES = 36000,
    DEFAULT_CACHE = 2048,
    MAX_CACHE = 1 << 24,
    DEFAULT_EVERY = 60,
    MAX_EVERY = 86400,
    MAX_TARGET = 0x7fffffff
};

static const ted4_argument OPTIONS[N_OPTIONS] = {
    [OPT_OUTPUT] = { 'o', "output", "FILE", "the .ted4 file to write" },
    [OPT_PRESET] = { 0, "preset", "NAME", "draft, fast, medium (default), slow, paper" },
    [OPT_LAMBDA] = { 0, "lambda", "X", "weight of the rate, as --set lambda=X" },
    [OPT_TARGET] = { 0, "target-size", "BYTES",
                     "repeat stage 2 in search of the lambda for this size" },
    [OPT_ITERATIONS] = { 0, "iterations", "A,B",
                         "steps of both stages, as --set stage1=A stage2=B" },
    [OPT_CAPACITY] = { 0, "capacity", "HOW",
                       "auto (default): the smallest model that pays; fixed: as options say" },
    [OPT_WHY] = { 0, "why", NULL, "the file says what was decided and why: ted4info --why" },
    [OPT_SET] = { 0, "set", "NAME=VALUE",
                  "any training option of the table below; the last value holds" },
    [OPT_DOWNSCALE] = { 0, "downscale", "N", "integer area averaging of the pictures" },
    [OPT_MAX_FRAMES] = { 0, "max-frames", "N",
                         "only so many times, the first ones (default: all, 300 of Neu3D)" },
    [OPT_FPS] = { 0, "fps", "N",
                  "frames per second, if the scene does not state them: 6, 23.976, 30000/1001. "
                  "Default 30" },
    [OPT_BOUNDS] = { 0, "bounds", "X,Y,Z,X,Y,Z",
                     "two corners of a box of the scene; initial points lie in it" },
    [OPT_BLACK] = { 0, "black", NULL, "put pictures with alpha on black, not on white" },
    [OPT_ALPHA] = { 0, "alpha", "HOW",
                    "colours of pictures with alpha: straight (default) or premultiplied" },
    [OPT_HOLD_OUT] = { 0, "hold-out", "NAME",
                       "train without this camera, in place of the layout's split; repeatable" },
    [OPT_SEED] = { 0, "seed", "S", "same scene, options and seed: same bytes" },
    [OPT_THREADS] = { 'j', "threads", "N", "threads; 0: all cores that it may use. Default 0" },
    [OPT_CACHE] = { 0, "cache", "MIB",
                    "memory for decoded pictures; more of them are read again. Default 2048" },
    [OPT_CHECKPOINT] = { 0, "checkpoint", "FILE",
                         "save the training here now and then, when stopped, and at the end" },
    [OPT_EVERY] = { 0, "checkpoint-every", "S",
                    "seconds between checkpoints; 0: every step. Default 60" },
    [OPT_RESUME] = { 0, "resume", NULL, "go on from the checkpoint if it is there" },
    [OPT_STAGE1] = { 0, "stage1", "FILE", "begin with this end of stage 1, or make the file" },
    [OPT_LOG] = { 0, "log", "FILE", "JSON lines of progress; with --resume it goes on" },
    [OPT_PROFILE] = { 0, "profile", "NAME",
                      "compact (default), or main: larger files, which decoders of version 1.0 "
                      "read, too" },
    [OPT_TRANSCODE] = { 0, "transcode", "FILE",
                        "no training: write this file again, in the profile, without loss" },
    [OPT_TITLE] = { 0, "title", "TEXT", "title of the scene, for players and ted4info" },
    [OPT_AUTHOR] = { 0, "author", "TEXT", "who made it" },
    [OPT_LICENCE] = { 0, "licence", "TEXT", "an SPDX expression, such as CC-BY-4.0, or a text" },
    [OPT_CAMERAS] = { 0, "cameras", NULL,
                      "write the training cameras, and which way is up, into the file" },
    [OPT_THUMBNAIL] = { 0, "thumbnail", NULL, "write a small picture of the scene into the file" },
    [OPT_CHECK] = { 0, "check", NULL,
                    "say what the scene holds, or the one thing that is wrong, and stop" },
    [OPT_JSON] = { 0, "json", NULL, "result as one JSON object" },
    [OPT_CONTRACT] = { 0, "ted4-encode", NULL,
                       "the contract of conformance/README.md: --json --quiet" },
    [OPT_FORCE] = { 'f', "force", NULL, "overwrite files, also a checkpoint or a log" },
    [OPT_QUIET] = { 'q', "quiet", NULL, "print errors only, no progress" },
    [OPT_VERBOSE] = { 'v', "verbose", NULL, "a line of progress every 250 steps" },
    [OPT_HELP] = TED4_ARGUMENT_HELP,
    [OPT_VERSION] = TED4_ARGUMENT_VERSION,
};

/* Prints the table of training options with meanings that fit the line or stand below their
 * values. */
static void print_training_options(FILE *f)
{
    enum { MEANING = 66, BELOW = 6 }; /* columns */
    char *table = NULL;
    size_t size = 0;
    FILE *const all = open_memstream(&table, &size);

    if (all == NULL)
        return;
    ted4_options_help(all);
    if (fclose(all) == 0) {
        for (char *line = table, *end; (end = strchr(line, '\n')) != NULL; line = end + 1) {
            *end = '\0';
            if (end - line <= TED4_HELP_COLUMNS) {
                fprintf(f, "%s\n", line);
                continue;
            }
            fprintf(f, "%.*s\n%*s", MEANING - 2, line, BELOW, "");
            ted4_arguments_wrap(f, line + MEANING, BELOW);
        }
    }
    free(table);
}

static const ted4_command COMMAND = {
    "ted4enc",
    "SCENE -o FILE.ted4 [options]",
    "Trains a scene from posed pictures and writes it as a TED4 file. SCENE is a folder: COLMAP,\n"
    "D-NeRF/Blender, nerfstudio, HyperNeRF, Neu3D, LLFF, or cams.json with one video per camera.\n"
    "Videos need the program ffmpeg; their frames are kept in $XDG_CACHE_HOME/ted4, or in\n"
    "ted4-UID in $TMPDIR or /tmp.",
    OPTIONS,
    N_OPTIONS,
    "Exit codes: 0 fine, 1 the file of --transcode was refused, 2 fine but larger\n"
    "than --target-size, 3 usage, input, output or resources, 130 stopped by Ctrl-C,\n"
    "143 by a request to end, 129 because the terminal was closed: after the step,\n"
    "and after a last checkpoint if --checkpoint is given.\n\n"
    "Examples:\n"
    "  ted4enc --check scene\n"
    "  ted4enc scene -o a.ted4 --preset draft --downscale 2 --cameras\n\n"
    "Presets: what each is for, and how long the scene of doc/training.md takes on 8\n"
    "cores (520 pictures of 240x135; twice the pixels or the times take less than\n"
    "twice as long):\n"
    "  draft    a look at whether poses and pictures are right; 25 seconds\n"
    "  fast     most of the quality, for trying options; 1.5 minutes\n"
    "  medium   a file to keep; 5 minutes\n"
    "  slow     more anchors and longer stages; 10 minutes\n"
    "  paper    as many steps and anchors as the paper; 25 minutes\n\n"
    "Training options (--set) and their values in each preset:\n",
    print_training_options,
};

/* Options that can be applied only after the preset. */
typedef struct {
    const char *preset;
    struct {
        int option;
        const char *value;
    } set[MAX_SETS]; /* in their order */
    int n_sets;
    const char *of_scene; /* name of the first option given that --transcode does not know */
} pending;

static int complain(const char *text)
{
    fprintf(stderr, "ted4enc: %s\n", text);
    return TED4_REQUEST_BAD;
}

static int bad_value(int option, const char *value, const char *expected)
{
    (void)ted4_arguments_bad("ted4enc", OPTIONS[option].name, value, expected);
    return TED4_REQUEST_BAD;
}

static int bad_number(int option, const char *value, int low, int high)
{
    (void)ted4_arguments_bad_number("ted4enc", OPTIONS[option].name, value, low, high);
    return TED4_REQUEST_BAD;
}

/* A .ted4 file is written to its end and then renamed, so that standard output cannot take it. */
static int bad_output(const char *path)
{
    fprintf(stderr, "ted4enc: -o %s: expected a file name that ends in .ted4\n", path);
    return TED4_REQUEST_BAD;
}

static int take_number(int option, const char *value, int low, int high, int *to)
{
    int64_t n;

    if (ted4_arguments_number(value, low, high, &n) != 0)
        return bad_number(option, value, low, high);
    *to = (int)n;
    return TED4_REQUEST_GO;
}

/* --fps: a number, or a fraction of two. */
static int take_rate(const char *value, double *rate)
{
    char *end;
    uint32_t num, den;

    *rate = strtod(value, &end);
    if (*end == '/')
        *rate /= strtod(end + 1, &end);
    return strspn(value, "0123456789./") == strlen(value) && *end == '\0' &&
                   ted4_frame_rate(*rate, &num, &den) == 0
               ? TED4_REQUEST_GO
               : bad_value(OPT_FPS, value, "a number above 0, as 6, 23.976 or 30000/1001");
}

static const char BOX[] = "X,Y,Z,X,Y,Z: two corners that differ in every coordinate";

/* --bounds: two opposite corners of a box. */
static int take_bounds(ted4_request *r, const char *value)
{
    float corner[6];

    if (ted4_arguments_floats(value, 6, corner) != 0)
        return bad_value(OPT_BOUNDS, value, BOX);
    for (int k = 0; k < 3; k++) {
        const float a = corner[k], b = corner[3 + k];

        if (a == b)
            return bad_value(OPT_BOUNDS, value, BOX);
        r->bounds.low[k] = a < b ? a : b;
        r->bounds.high[k] = a < b ? b : a;
    }
    r->bounds.bounded = 1;
    return TED4_REQUEST_GO;
}

static int take_profile(const char *value, ted4_train_options *o)
{
    if (strcmp(value, "compact") != 0 && strcmp(value, "main") != 0)
        return bad_value(OPT_PROFILE, value, "main or compact");
    o->profile = strcmp(value, "compact") == 0 ? TED4_PROFILE_COMPACT : TED4_PROFILE_MAIN;
    return TED4_REQUEST_GO;
}

static int take_capacity(const char *value, ted4_train_options *o)
{
    if (strcmp(value, "auto") != 0 && strcmp(value, "fixed") != 0)
        return bad_value(OPT_CAPACITY, value, "auto or fixed");
    o->capacity = strcmp(value, "auto") == 0;
    return TED4_REQUEST_GO;
}

/* A text that becomes one line of META. */
static int take_text(int option, const char *value, const char **to)
{
    if (value[0] == '\0' || strlen(value) > TED4_REQUEST_TEXT || !ted4_edit_is_text(value))
        return bad_value(option, value, "a text of one line, at most 1000 bytes of UTF-8");
    *to = value;
    return TED4_REQUEST_GO;
}

/* Options without a value. Returns the member that the option sets to 1, or NULL. */
static int *flag(ted4_request *r, int option)
{
    int *const flags[N_OPTIONS] = {
        [OPT_WHY] = &r->search_report, [OPT_CAMERAS] = &r->cameras, [OPT_THUMBNAIL] = &r->thumbnail,
        [OPT_BLACK] = &r->black,       [OPT_RESUME] = &r->resume,   [OPT_CHECK] = &r->check,
        [OPT_JSON] = &r->json,         [OPT_FORCE] = &r->force,     [OPT_QUIET] = &r->quiet,
        [OPT_VERBOSE] = &r->verbose,
    };

    return flags[option];
}

/* Returns whether an option means something without a scene and a training. */
static int goes_with_transcode(int option)
{
    switch (option) {
    case OPT_OUTPUT:
    case OPT_THREADS:
    case OPT_PROFILE:
    case OPT_TRANSCODE:
    case OPT_JSON:
    case OPT_CONTRACT:
    case OPT_FORCE:
    case OPT_QUIET:
    case OPT_VERBOSE: return 1;
    default: return 0;
    }
}

/* The name of a file to write. */
static int take_file(int option, const char *value, const char **to)
{
    *to = value;
    return ted4_arguments_bad_dash("ted4enc", OPTIONS[option].name, value, "file") == 0
               ? TED4_REQUEST_GO
               : TED4_REQUEST_BAD;
}

/* What changes the preset. */
static int take_later(pending *p, int option, const char *value)
{
    if (p->n_sets == MAX_SETS)
        return complain("too many training options");
    p->set[p->n_sets].option = option;
    p->set[p->n_sets++].value = value;
    return TED4_REQUEST_GO;
}

static int take(ted4_request *r, pending *p, int option, const char *value)
{
    int *const on = flag(r, option);

    if (on != NULL)
        *on = 1;
    if (p->of_scene == NULL && !goes_with_transcode(option))
        p->of_scene = OPTIONS[option].name;
    switch (option) {
    case OPT_OUTPUT: r->out = value; break;
    case OPT_PRESET: p->preset = value; break;
    case OPT_CHECKPOINT: return take_file(option, value, &r->checkpoint);
    case OPT_STAGE1: return take_file(option, value, &r->stage1);
    case OPT_LOG: return take_file(option, value, &r->log);
    case OPT_TRANSCODE: r->transcode = value; break;
    case OPT_TITLE: return take_text(option, value, &r->title);
    case OPT_AUTHOR: return take_text(option, value, &r->author);
    case OPT_LICENCE: return take_text(option, value, &r->licence);
    case OPT_BOUNDS: return take_bounds(r, value);
    case OPT_ALPHA:
        r->premultiplied = strcmp(value, "premultiplied") == 0;
        return r->premultiplied || strcmp(value, "straight") == 0
                   ? TED4_REQUEST_GO
                   : bad_value(option, value, "straight or premultiplied");
    case OPT_HOLD_OUT:
        if (r->n_hold_out == TED4_REQUEST_HOLD_OUT)
            return complain("too many --hold-out");
        r->hold_out[r->n_hold_out++] = value;
        break;
    case OPT_CONTRACT: r->json = r->quiet = 1; break;
    case OPT_DOWNSCALE: return take_number(option, value, 1, MAX_DOWNSCALE, &r->downscale);
    case OPT_MAX_FRAMES: return take_number(option, value, 1, MAX_MAX_FRAMES, &r->max_frames);
    case OPT_FPS: return take_rate(value, &r->rate);
    case OPT_CACHE: return take_number(option, value, 0, MAX_CACHE, &r->cache_mib);
    case OPT_EVERY: return take_number(option, value, 0, MAX_EVERY, &r->checkpoint_every);
    case OPT_THREADS: return take_number(option, value, 0, TED4_MAX_THREADS, &r->threads);
    case OPT_SEED: {
        int seed = 0;
        const int status = take_number(option, value, 0, 0x7fffffff, &seed);

        r->options.seed = (uint32_t)seed;
        return status;
    }
    case OPT_TARGET: {
        int64_t bytes = 0;

        if (ted4_arguments_number(value, 1, MAX_TARGET, &bytes) != 0)
            return bad_number(option, value, 1, MAX_TARGET);
        r->target_size = (size_t)bytes;
        break;
    }
    case OPT_LAMBDA:
    case OPT_ITERATIONS:
    case OPT_CAPACITY:
    case OPT_PROFILE:
    case OPT_SET: return take_later(p, option, value);
    }
    return TED4_REQUEST_GO;
}

/* Formats a hint with the option or preset that is most similar to an unknown word. Returns text,
 * or
 * "" if none is similar. name(i): the i-th known name; NULL: there is none. */
static const char *suggestion(const char *word, const char *(*name)(int i), char *text, size_t size)
{
    ted4_similar s = ted4_similar_to(word, strcspn(word, "="));

    for (int i = 0; name(i) != NULL; i++)
        ted4_similar_try(&s, name(i));
    if (s.best == NULL || s.distance == 0)
        return "";
    snprintf(text, size, "; did you mean %s?", s.best);
    return text;
}

static int set(ted4_request *r, const char *text)
{
    char why[256], hint[80], all[400];

    if (ted4_options_set(&r->options, text, why, sizeof why) == 0)
        return TED4_REQUEST_GO;
    snprintf(all, sizeof all, "%s%s", why, suggestion(text, ted4_options_name, hint, sizeof hint));
    return complain(all);
}

/* --iterations: text is "A,B", the steps of stages 1 and 2. */
static int set_iterations(ted4_request *r, const char *text)
{
    const char *comma = strchr(text, ',');
    char one[256];

    if (comma == NULL || comma - text > 100)
        return complain("--iterations: expected A,B");
    snprintf(one, sizeof one, "stage1=%.*s", (int)(comma - text), text);

    const int status = set(r, one);

    snprintf(one, sizeof one, "stage2=%s", comma + 1);
    return status != TED4_REQUEST_GO ? status : set(r, one);
}

/* --lambda, --iterations, --capacity, --profile or --set. */
static int apply_one(ted4_request *r, int option, const char *value)
{
    char text[256];

    switch (option) {
    case OPT_LAMBDA: snprintf(text, sizeof text, "lambda=%s", value); return set(r, text);
    case OPT_ITERATIONS: return set_iterations(r, value);
    case OPT_CAPACITY: return take_capacity(value, &r->options);
    case OPT_PROFILE: return take_profile(value, &r->options);
    default: return set(r, value);
    }
}

/* Applies the preset first, then what changes it, in the order of the command line. */
static int apply(ted4_request *r, const pending *p)
{
    const uint32_t seed = r->options.seed;
    char text[256], hint[80];
    int status = TED4_REQUEST_GO;

    if (ted4_options_preset(&r->options, p->preset) != 0) {
        snprintf(text, sizeof text, "--preset %.*s: expected draft, fast, medium, slow or paper%s",
                 ted4_whole_letters(p->preset, 100), p->preset,
                 suggestion(p->preset, ted4_options_preset_name, hint, sizeof hint));
        return complain(text);
    }
    r->options.seed = seed;
    for (int i = 0; i < p->n_sets && status == TED4_REQUEST_GO; i++)
        status = apply_one(r, p->set[i].option, p->set[i].value);
    return status;
}

/* Checks that what was given goes together. */
static int check(const ted4_request *r, const pending *p)
{
    char text[100];

    if (r->transcode != NULL && p->of_scene != NULL) {
        snprintf(text, sizeof text, "--%s does not go with --transcode", p->of_scene);
        return complain(text);
    }
    if (r->out == NULL && !r->check)
        return complain("-o FILE.ted4 expected");
    if (r->out != NULL && !ted4_has_suffix(r->out, ".ted4"))
        return bad_output(r->out);
    if (r->resume && r->checkpoint == NULL)
        return complain("--resume: only with --checkpoint (see --help)");
    if (r->checkpoint_every >= 0 && r->checkpoint == NULL)
        return complain("--checkpoint-every: only with --checkpoint (see --help)");
    if (r->quiet && r->verbose)
        return complain("-q and -v: only one of them (see --help)");
    return TED4_REQUEST_GO;
}

int ted4_request_parse(ted4_request *r, int argc, char **argv)
{
    static char name[] = "ted4enc"; /* the beginning of getopt's messages, whatever argv[0] was */
    pending p = { .preset = "medium" };
    const char *value;
    int option;

    argv[0] = name;
    memset(r, 0, sizeof *r);
    r->downscale = 1;
    r->cache_mib = DEFAULT_CACHE;
    r->checkpoint_every = -1; /* not given */
    while ((option = ted4_arguments_next(&COMMAND, argc, argv, &value)) >= 0) {
        const int status = take(r, &p, option, value);

        if (status != TED4_REQUEST_GO)
            return status;
    }
    if (option != TED4_ARGUMENTS_END)
        return option == TED4_ARGUMENTS_DONE ? TED4_REQUEST_DONE : TED4_REQUEST_BAD;
    if (optind + (r->transcode == NULL) != argc)
        return complain(r->transcode == NULL ? "one scene folder expected; --help lists the options"
                                             : "no scene folder expected beside --transcode");
    r->scene = r->transcode == NULL ? argv[optind] : NULL;

    const int status = check(r, &p);

    if (r->checkpoint_every < 0)
        r->checkpoint_every = DEFAULT_EVERY;
    return status == TED4_REQUEST_GO ? apply(r, &p) : status;
}
