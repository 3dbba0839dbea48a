/* ted4eval.c - compares a .ted4 file with the pictures of its scene: quality, size and speed,
 * measured on the decoded file.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <getopt.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "align.h"
#include "belongs.h"
#include "camera_view.h"
#include "data/dataset.h"
#include "eval/metrics.h"
#include "eval_images.h"
#include "eval_result.h"
#include "file_out.h"
#include "fit_colours.h"
#include "moving_pixels.h"
#include "render/view.h"
#include "sheet.h"
#include "ted4.h"
#include "tool/arguments.h"
#include "tool/cli.h"
#include "tool/clock.h"
#include "tool/file_cameras.h"
#include "tool/leftovers.h"
#include "tool/output.h"
#include "tool/plural.h"
#include "teller.h"
#include "tool/threads.h"

enum {
    OPT_SPLIT,
    OPT_DOWNSCALE,
    OPT_TRAINED,
    OPT_MAX_FRAMES,
    OPT_ALPHA,
    OPT_HOLD_OUT,
    OPT_IMAGES,
    OPT_SHEET,
    OPT_THREADS,
    OPT_ALIGN,
    OPT_COLOURS,
    OPT_MOVING,
    OPT_ANYWAY,
    OPT_FORCE,
    OPT_JSON,
    OPT_QUIET,
    OPT_VERBOSE,
    OPT_HELP,
    OPT_VERSION,
    N_OPTIONS
};

enum { MAX_DOWNSCALE = 64, MAX_MAX_FRAMES = 36000, MAX_HOLD_OUT = 256, SHEET_ROWS = 4 };

static const ted4_argument OPTIONS[N_OPTIONS] = {
    [OPT_SPLIT] = { 0, "split", "NAME", "test (default) or train pictures" },
    [OPT_DOWNSCALE] = { 0, "downscale", "N",
                        "compare pictures shrunk N times, as ted4enc --downscale" },
    [OPT_TRAINED] = { 0, "trained-downscale", "N",
                      "the file was trained with ted4enc --downscale N: draw for coarser or finer "
                      "pixels" },
    [OPT_MAX_FRAMES] = { 0, "max-frames", "N",
                         "only the first N times of SCENE, as ted4enc --max-frames" },
    [OPT_ALPHA] = { 0, "alpha", "HOW", "straight or premultiplied, as ted4enc --alpha" },
    [OPT_HOLD_OUT] = { 0, "hold-out", "NAME",
                       "this camera's pictures are test, as ted4enc --hold-out" },
    [OPT_IMAGES] = { 0, "images", "DIR",
                     "write DIR/truth, DIR/ours, DIR/error (5 times the difference) as NNNNN.png" },
    [OPT_SHEET] = { 0, "sheet", "FILE.png",
                    "one picture: truth, ours, error of up to four cameras, at other times" },
    [OPT_THREADS] = { 'j', "threads", "N", "threads; 0: all cores that it may use. Default 0" },
    [OPT_ALIGN] = { 0, "align", NULL,
                    "also fit each picture's pose on half of its pixels, judge the other half" },
    [OPT_COLOURS] = { 0, "colours", NULL,
                      "also fit each camera's colours on its training pictures" },
    [OPT_MOVING] = { 0, "moving", NULL,
                     "also judge the pixels that move, where cameras stand still" },
    [OPT_ANYWAY] = { 0, "anyway", NULL,
                     "compare even if the file does not seem to belong to this scene" },
    [OPT_FORCE] = { 'f', "force", NULL, "overwrite pictures" },
    [OPT_JSON] = { 0, "json", NULL, "result as one JSON object" },
    [OPT_QUIET] = { 'q', "quiet", NULL, "errors only" },
    [OPT_VERBOSE] = { 'v', "verbose", NULL, "metrics of every picture on standard error" },
    [OPT_HELP] = TED4_ARGUMENT_HELP,
    [OPT_VERSION] = TED4_ARGUMENT_VERSION,
};

static const ted4_command COMMAND = {
    "ted4eval",
    "FILE.ted4 SCENE [options]",
    "Decodes FILE, draws every picture of a split of SCENE, and prints PSNR, SSIM (11 x 11 "
    "Gaussian), SSIM_2 (scikit-image,\n"
    "range 2), MS-SSIM, bytes of the file, milliseconds to decode it, pictures drawn per second.",
    OPTIONS,
    N_OPTIONS,
    "Exit codes: 0 fine, 1 file refused, 3 usage, input, output or resources, or the\n"
    "file cannot, or may not, be of this scene.\n\n"
    "Examples:\n"
    "  ted4eval a.ted4 scene --downscale 2 --sheet sheet.png\n",
    NULL,
};

typedef struct {
    const char *input, *scene, *images, *sheet;
    const char *hold_out[MAX_HOLD_OUT];
    size_t n_hold_out;
    int premultiplied;
    int want_test, downscale, trained, max_frames, threads;
    int align, colours, moving, anyway, force, json, quiet, verbose;
} settings;

typedef struct {
    const settings *set;
    ted4_parallel parallel;
    ted4_info info;
    ted4_recon *recon; /* owned, like all members below */
    ted4_camera_list taken;
    ted4_viewer *viewer;
    ted4_dataset data;
    size_t row[SHEET_ROWS]; /* index of the picture in each row of the sheet */
    ted4_sheet sheet;
    ted4_fitted_colours *colours; /* [data.n_cameras], or NULL without --colours */
    uint8_t **median;             /* [data.n_cameras], moving_pixels.h; NULL without --moving */
    ted4_eval_sums sum;
    ted4_belongs_sum squares;
} session;

/* main calls ted4_teller_begin once the command line is parsed. */
static ted4_teller teller = { .lock = PTHREAD_MUTEX_INITIALIZER };

static int failed(const char *what, const char *why)
{
    ted4_teller_clear(&teller);
    fprintf(stderr, "ted4eval: %s: %s\n", what, why);
    return TED4_EXIT_TOOL;
}

static int complain(const char *text)
{
    ted4_teller_clear(&teller);
    fprintf(stderr, "ted4eval: %s\n", text);
    return TED4_EXIT_TOOL;
}

/* ---- command line ---- */

static int set_number(const char *name, const char *value, int low, int high, int *out)
{
    int64_t n;

    if (ted4_arguments_number(value, low, high, &n) != 0)
        return ted4_arguments_bad_number("ted4eval", name, value, low, high);
    *out = (int)n;
    return 0;
}

static int set_option(settings *s, int option, const char *value)
{
    switch (option) {
    case OPT_SPLIT:
        s->want_test = strcmp(value, "test") == 0;
        return s->want_test || strcmp(value, "train") == 0
                   ? 0
                   : ted4_arguments_bad("ted4eval", "split", value, "test or train");
    case OPT_DOWNSCALE: return set_number("downscale", value, 1, MAX_DOWNSCALE, &s->downscale);
    case OPT_TRAINED: return set_number("trained-downscale", value, 1, MAX_DOWNSCALE, &s->trained);
    case OPT_MAX_FRAMES: return set_number("max-frames", value, 1, MAX_MAX_FRAMES, &s->max_frames);
    case OPT_ALPHA:
        s->premultiplied = strcmp(value, "premultiplied") == 0;
        return s->premultiplied || strcmp(value, "straight") == 0
                   ? 0
                   : ted4_arguments_bad("ted4eval", "alpha", value, "straight or premultiplied");
    case OPT_HOLD_OUT:
        if (s->n_hold_out == MAX_HOLD_OUT)
            return failed("--hold-out", "too many");
        s->hold_out[s->n_hold_out++] = value;
        return 0;
    case OPT_IMAGES:
        s->images = value;
        return ted4_arguments_bad_dash("ted4eval", "images", value, "folder");
    case OPT_SHEET: s->sheet = value; return 0;
    case OPT_THREADS: return set_number("threads", value, 0, TED4_MAX_THREADS, &s->threads);
    default: break;
    }
    int *const flag[N_OPTIONS] = {
        [OPT_ALIGN] = &s->align,   [OPT_COLOURS] = &s->colours, [OPT_MOVING] = &s->moving,
        [OPT_ANYWAY] = &s->anyway, [OPT_FORCE] = &s->force,     [OPT_JSON] = &s->json,
        [OPT_QUIET] = &s->quiet,   [OPT_VERBOSE] = &s->verbose
    };

    *flag[option] = 1;
    return 0;
}

/* Returns -1 if the program should go on, or else an exit code. */
static int parse(settings *s, int argc, char **argv)
{
    const char *value;

    *s = (settings) { .want_test = 1, .downscale = 1 };
    for (int i; (i = ted4_arguments_next(&COMMAND, argc, argv, &value)) != TED4_ARGUMENTS_END;) {
        if (i == TED4_ARGUMENTS_BAD)
            return TED4_EXIT_TOOL;
        if (i == TED4_ARGUMENTS_DONE)
            return TED4_EXIT_FINE;
        const int code = set_option(s, i, value);

        if (code != 0)
            return code;
    }
    if (optind + 2 != argc)
        return failed("arguments", "a file and a scene folder expected (see --help)");
    s->input = argv[optind];
    s->scene = argv[optind + 1];
    if (s->sheet != NULL && !ted4_has_suffix(s->sheet, ".png"))
        return failed(s->sheet, "--sheet writes .png only");
    return -1;
}

/* ---- opening ---- */

static int open_file(session *s)
{
    const ted4_options options = { .parallel = &s->parallel };
    ted4_error e = { TED4_OK, 0 };
    ted4_scene *scene;
    uint8_t *const bytes = ted4_read_ted4(s->set->input, &s->sum.bytes);
    const double start = ted4_clock();

    if (bytes == NULL) {
        ted4_teller_clear(&teller);
        return ted4_report_unread("ted4eval", s->set->input, s->set->json);
    }
    if (ted4_decode(bytes, s->sum.bytes, &options, &scene, &e) == TED4_OK) {
        ted4_scene_info(scene, &s->info);
        e.code = ted4_recon_new(&s->recon, scene, &options);
        ted4_scene_free(scene);
    }
    s->sum.decode_ms = 1e3 * (ted4_clock() - start);
    if (e.code == TED4_OK &&
        ted4_file_cameras(bytes, s->sum.bytes, TED4_CAMS_TAKEN, &s->taken) != 0)
        e.code = TED4_E_LIMIT_MEMORY;
    free(bytes);
    ted4_teller_clear(&teller);
    return e.code == TED4_OK ? TED4_EXIT_FINE
                             : ted4_report("ted4eval", s->set->input, &e, s->set->json);
}

static int open_scene(session *s)
{
    /* Pictures with alpha are compared on the background colour that the file carries. */
    const ted4_dataset_options options = { .downscale = s->set->downscale,
                                           .white = s->info.background[0] > 127,
                                           .cache_bytes = 64 << 20,
                                           .max_frames = (uint32_t)s->set->max_frames,
                                           .premultiplied = s->set->premultiplied,
                                           .hold_out = s->set->hold_out,
                                           .n_hold_out = s->set->n_hold_out };
    ted4_message m;

    if (ted4_dataset_load(&s->data, s->set->scene, &options, &m) != 0)
        return complain(m.text);
    ted4_teller_clear(&teller);
    for (size_t i = 0; i < s->data.n_warnings; i++)
        fprintf(stderr, "ted4eval: warning: %s\n", s->data.warnings[i]);
    s->viewer = ted4_viewer_new();
    return s->viewer == NULL ? failed(s->set->scene, "out of memory") : TED4_EXIT_FINE;
}

/* Refuses a file that does not seem to belong to the scene, unless --anyway is given. why: the
 * reason if belongs is 0. sure: no training can be the cause of it. Returns an exit code. */
static int refuse_pair(const session *s, int belongs, int sure, const char *why)
{
    if (belongs || s->set->anyway)
        return TED4_EXIT_FINE;
    ted4_teller_clear(&teller);
    fprintf(stderr, "ted4eval: %s: %s be of %s%s: %s; --anyway compares them all the same\n",
            s->set->input, sure ? "cannot" : "may not", s->set->scene,
            sure ? "" : ", or is hardly trained", why);
    return TED4_EXIT_TOOL;
}

static int in_split(const session *s, size_t i)
{
    return s->data.pictures[i].is_test == s->set->want_test;
}

static int begin_sheet(session *s)
{
    const size_t rows = ted4_sheet_choose(&s->data, s->set->want_test, SHEET_ROWS, s->row);
    const ted4_camera *const c = &s->data.pictures[s->row[0]].camera;
    char why[256];

    if (ted4_file_writable(s->set->sheet, s->set->force, "", why, sizeof why) != 0)
        return complain(why);
    return ted4_sheet_init(&s->sheet, c->width, c->height, (int)rows) == 0
               ? TED4_EXIT_FINE
               : failed(s->set->sheet, "out of memory");
}

/* ---- one picture ---- */

static int write_images(const session *s, size_t i, const uint8_t *truth, const uint8_t *ours)
{
    const ted4_picture *const p = &s->data.pictures[i];
    const uint8_t *const median = s->median == NULL ? NULL : s->median[p->camera_id];
    const ted4_eval_images to = { s->set->images, s->sum.views };
    ted4_message m;

    return ted4_eval_images_write(&to, &p->camera, truth, ours, median, &m) == 0 ? TED4_EXIT_FINE
                                                                                 : complain(m.text);
}

/* Adds the metrics of a rendered picture to the sums, and writes it to --images and --sheet. */
static int take_picture(session *s, size_t i, const uint8_t *truth, const uint8_t *ours)
{
    const ted4_picture *const p = &s->data.pictures[i];
    ted4_metrics m;
    int code = TED4_EXIT_FINE;

    if (ted4_metrics_compare(truth, ours, p->camera.width, p->camera.height, &s->parallel, &m) != 0)
        return failed(p->path, "out of memory");
    if (s->set->verbose) {
        ted4_teller_clear(&teller);
        fprintf(stderr, "%s frame %" PRIu32 ": psnr %.4f ssim %.5f ssim2 %.5f ms_ssim %.5f\n",
                p->path, p->frame, m.psnr, m.ssim, m.ssim2, m.ms_ssim);
    }
    if (s->set->images != NULL)
        code = write_images(s, i, truth, ours);
    for (int r = 0; s->set->sheet != NULL && r < s->sheet.rows; r++)
        if (s->row[r] == i)
            ted4_sheet_put(&s->sheet, r, truth, ours);
    s->sum.psnr += m.psnr;
    s->sum.ssim += m.ssim;
    s->sum.ssim2 += m.ssim2;
    s->sum.ms_ssim += m.ms_ssim;
    s->sum.l1 += m.l1;
    s->sum.views++;
    ted4_belongs_add(&s->squares, truth, ours, (size_t)p->camera.width * (size_t)p->camera.height);
    return code;
}

/* The view of a camera of the scene, with pixels as large as annex I.4 wants them. */
static ted4_view view_of(const session *s, const ted4_camera *camera)
{
    ted4_view view = ted4_view_of_camera(camera);

    if (s->set->trained > 0)
        view.pixel = (float)s->set->downscale / (float)s->set->trained;
    return view;
}

/* A picture whose pose is fitted. */
typedef struct {
    session *s;
    uint32_t frame;
    ted4_status status;
} aligning;

static int draw(void *user, const ted4_camera *camera, uint8_t *rgb)
{
    aligning *const a = user;
    const ted4_view view = view_of(a->s, camera);
    const uint32_t last = a->s->data.n_frames > 1 ? a->s->data.n_frames - 1 : 1;

    a->status = ted4_render_query(a->s->viewer, a->s->recon, &a->s->info, a->frame, last, &view,
                                  &a->s->parallel, rgb);
    return a->status != TED4_OK;
}

/* Fits the pose of a picture (align.h), which changes neither the file nor any other picture, and
 * judges the other half of it. ours: room for a picture; holds the one from the given pose. */
static int align_picture(session *s, const ted4_picture *p, const uint8_t *truth, uint8_t *ours)
{
    const ted4_camera *const c = &p->camera;
    aligning a = { s, p->frame, TED4_E_LIMIT_MEMORY };
    const double given = ted4_align_psnr(truth, ours, c->width, c->height);
    ted4_camera fitted;

    if (ted4_align(c, ted4_distance_to(&s->info, c), truth, draw, &a, &fitted) != 0 ||
        draw(&a, &fitted, ours) != 0) {
        ted4_teller_clear(&teller);
        return ted4_report("ted4eval", s->set->input, &(ted4_error) { a.status, 0 }, s->set->json);
    }

    const double aligned = ted4_align_psnr(truth, ours, c->width, c->height);

    s->sum.given += given;
    s->sum.aligned += aligned;
    if (s->set->verbose)
        fprintf(stderr, "%s frame %" PRIu32 ": half %.4f aligned %.4f\n", p->path, p->frame, given,
                aligned);
    return TED4_EXIT_FINE;
}

/* Draws picture i as the file shows it. user: the session. Returns an exit code. */
static int draw_picture(void *user, size_t i, uint8_t *rgb)
{
    const session *const s = user;
    const ted4_view view = view_of(s, &s->data.pictures[i].camera);
    const uint32_t last = s->data.n_frames > 1 ? s->data.n_frames - 1 : 1;
    const ted4_error e = { ted4_render_query(s->viewer, s->recon, &s->info,
                                             s->data.pictures[i].frame, last, &view, &s->parallel,
                                             rgb),
                           0 };

    if (e.code == TED4_OK)
        return TED4_EXIT_FINE;
    ted4_teller_clear(&teller);
    return ted4_report("ted4eval", s->set->input, &e, s->set->json);
}

/* Judges a picture through the map of its camera. */
static void judge_colours(session *s, const ted4_picture *p, const uint8_t *truth,
                          const uint8_t *ours)
{
    static const ted4_colour_map identity = { 0 };
    const ted4_fitted_colours *const f = &s->colours[p->camera_id];
    const size_t pixels = (size_t)p->camera.width * (size_t)p->camera.height;

    if (f->pictures == 0)
        return;

    const double raw = ted4_fitted_psnr(identity, truth, ours, pixels),
                 fitted = ted4_fitted_psnr(f->map, truth, ours, pixels);

    s->sum.raw += raw;
    s->sum.fitted += fitted;
    s->sum.fitted_views++;
    if (s->set->verbose)
        fprintf(stderr, "%s frame %" PRIu32 ": raw %.4f fitted %.4f\n", p->path, p->frame, raw,
                fitted);
}

/* Judges the pixels of a picture that show what moves, if its camera stands still. */
static void judge_moving(session *s, const ted4_picture *p, const uint8_t *truth,
                         const uint8_t *ours)
{
    ted4_moving_sum of = { 0 };

    if (s->median[p->camera_id] == NULL)
        return;
    ted4_moving_add(&of, s->median[p->camera_id], truth, ours,
                    (size_t)p->camera.width * (size_t)p->camera.height, NULL);
    s->sum.moving.square += of.square;
    s->sum.moving.pixels += of.pixels;
    s->sum.moving.views++;
    if (s->set->verbose)
        fprintf(stderr, "%s frame %" PRIu32 ": moving %.4f of %zu pixel%s\n", p->path, p->frame,
                ted4_moving_psnr(&of), of.pixels, ted4_s(of.pixels));
}

static int evaluate_picture(session *s, size_t i)
{
    const ted4_picture *const p = &s->data.pictures[i];
    uint8_t *const ours = malloc((size_t)p->camera.width * (size_t)p->camera.height * 3);
    ted4_message m;
    const uint8_t *truth;
    double start;
    int code;

    if (ours == NULL)
        return failed(p->path, "out of memory");
    start = ted4_clock();
    code = draw_picture(s, i, ours);
    s->sum.render_s += ted4_clock() - start;
    if (code == TED4_EXIT_FINE) {
        if ((truth = ted4_dataset_pixels(&s->data, i, &m)) == NULL) {
            code = failed(p->path, m.text);
        } else {
            code = take_picture(s, i, truth, ours);
            if (code == TED4_EXIT_FINE && s->set->colours)
                judge_colours(s, p, truth, ours);
            if (code == TED4_EXIT_FINE && s->set->moving)
                judge_moving(s, p, truth, ours);
            if (code == TED4_EXIT_FINE && s->set->align)
                code = align_picture(s, p, truth, ours);
            ted4_dataset_release(&s->data, i);
        }
    }
    free(ours);
    return code;
}

/* ---- the whole ---- */

/* Fits the colours of the cameras of the split, and says whose cannot be fitted. */
static int fit_colours(session *s)
{
    size_t cameras = 0, views = 0;
    ted4_message m;
    int code;

    s->colours = calloc(s->data.n_cameras, sizeof *s->colours);
    if (s->colours == NULL)
        return failed(s->set->scene, "out of memory");
    code = ted4_fit_colours(&s->data, s->set->want_test, draw_picture, s, s->colours, &m);
    if (code != 0)
        return code < 0 ? complain(m.text) : code;
    for (uint32_t k = 0; k < s->data.n_cameras; k++) {
        size_t n = 0;

        for (size_t i = 0; i < s->data.n_pictures && s->colours[k].pictures == 0; i++)
            n += s->data.pictures[i].camera_id == k && in_split(s, i);
        cameras += n > 0;
        views += n;
    }
    ted4_teller_clear(&teller);
    if (cameras > 0)
        fprintf(stderr,
                "ted4eval: warning: %zu of these pictures %s by %zu camera%s without training "
                "pictures: their colours cannot be fitted\n",
                views, views == 1 ? "is" : "are", cameras, ted4_s(cameras));
    return TED4_EXIT_FINE;
}

static int evaluate(session *s)
{
    const settings *const set = s->set;
    size_t n = 0;
    char why[256];
    ted4_message m;
    int code = TED4_EXIT_FINE;

    for (size_t i = 0; i < s->data.n_pictures; i++)
        n += (size_t)in_split(s, i);
    code = refuse_pair(s, ted4_belongs_scene(&s->info, &s->data, why, sizeof why), 1, why);
    if (code != TED4_EXIT_FINE)
        return code;
    if (n == 0)
        return failed(set->scene, set->want_test
                                      ? "no test pictures; --split train compares training pictures"
                                      : "no training pictures");
    if (set->trained == 0 &&
        !ted4_belongs_size(&s->taken, &s->data, set->want_test, why, sizeof why))
        fprintf(stderr, "ted4eval: warning: %s\n", why);
    if (set->images != NULL &&
        ted4_eval_images_begin(set->images, n, set->moving, set->force, &m) != 0)
        return complain(m.text);
    if (set->sheet != NULL)
        code = begin_sheet(s);
    if (code == TED4_EXIT_FINE && set->colours)
        code = fit_colours(s);
    if (code == TED4_EXIT_FINE && set->moving)
        code = ted4_moving_medians(&s->data, set->want_test, &s->median, &m) == 0
                   ? TED4_EXIT_FINE
                   : complain(m.text);
    for (size_t i = 0; i < s->data.n_pictures && code == TED4_EXIT_FINE; i++) {
        if (!in_split(s, i))
            continue;
        code = evaluate_picture(s, i);
        ted4_teller_now(
            &teller, &(ted4_facts) { .kind = TED4_TELL_DRAWING, .step = s->sum.views, .total = n });
    }
    if (code == TED4_EXIT_FINE && set->sheet != NULL &&
        ted4_eval_sheet_write(&s->sheet, set->sheet, set->force, why, sizeof why) != 0)
        code = complain(why);
    if (code == TED4_EXIT_FINE)
        code = refuse_pair(s, ted4_belongs_pictures(&s->squares, why, sizeof why), 0, why);
    if (code == TED4_EXIT_FINE)
        ted4_eval_print(&s->sum, &s->info,
                        &(ted4_eval_style) { set->want_test ? "test" : "train", set->json,
                                             set->align, set->colours, set->moving });
    return code;
}

int main(int argc, char **argv)
{
    settings set;
    session s = { .set = &set };
    int code = parse(&set, argc, argv);

    if (code >= 0)
        return code;
    ted4_leftovers_watch();
    ted4_teller_begin(&teller, "ted4eval", set.quiet);
    ted4_teller_say(&teller, "comparing %s with %s", set.input, set.scene);
    ted4_teller_now(&teller, &(ted4_facts) { .kind = TED4_TELL_LOADING, .name = "the scene" });
    ted4_threads_init(&s.parallel, set.threads);
    code = open_file(&s);
    if (code == TED4_EXIT_FINE)
        code = open_scene(&s);
    if (code == TED4_EXIT_FINE)
        code = evaluate(&s);
    ted4_sheet_finish(&s.sheet);
    ted4_viewer_free(s.viewer);
    free(s.colours);
    ted4_moving_free(s.median, s.data.n_cameras);
    ted4_dataset_free(&s.data);
    ted4_camera_list_free(&s.taken);
    ted4_recon_free(s.recon);
    ted4_threads_finish(&s.parallel);
    ted4_teller_end(&teller);
    return ted4_cli_end("ted4eval", code);
}
