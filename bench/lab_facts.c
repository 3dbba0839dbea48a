/* lab_facts.c - prints what the stability lab measures on one decoded file, as one JSON line:
 * quality of held-out pictures and of the worst of them, anchors that motion throws out of every
 * picture, how far anchors move, values that are not finite or at the end of their range, escapes,
 * and facts from the training's log. lab_facts.h defines them all.
 *     lab_facts FILE.ted4 SCENE [LOG.jsonl [STRIP.png]]
 * STRIP.png: truth, our picture and the error of the worst held-out picture.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <jansson.h>
#include "lab_facts.h"
#include "open_decoded.h"
#include "tool/cli.h"

static int open_file(lab_session *s, const char *path)
{
    decoded d = { NULL, NULL, { 0 }, 0 };
    const int code = open_decoded("lab_facts", path, &d);

    s->scene = d.scene;
    s->recon = d.recon;
    s->info = d.info;
    s->bytes = d.bytes;
    return code;
}

static int open_scene(lab_session *s, const char *folder)
{
    /* Pictures with transparency are compared over the background colour that the file carries. */
    const ted4_dataset_options options = { .downscale = 1,
                                           .white = s->info.background[0] > 127,
                                           .cache_bytes = 16 << 20 };
    ted4_message m;

    return ted4_dataset_load(&s->data, folder, &options, &m) == 0 ? TED4_EXIT_FINE
                                                                  : lab_failed(folder, m.text);
}

/* Returns a share, which is 0 if the total is 0. */
static double share(uint64_t part, uint64_t whole)
{
    return whole > 0 ? (double)part / (double)whole : 0;
}

static void put_real(json_t *o, const char *name, double v)
{
    json_object_set_new(o, name, isfinite(v) ? json_real(v) : json_null());
}

static void put_count(json_t *o, const char *name, uint64_t v)
{
    json_object_set_new(o, name, json_integer((json_int_t)v));
}

static void put_views(json_t *o, const lab_views *v)
{
    const int any = v->views > v->refused;

    put_count(o, "views", v->views);
    put_count(o, "exact", v->exact);
    put_count(o, "refused_views", v->refused);
    put_real(o, "psnr", any ? v->mean : NAN);
    put_real(o, "worst", any ? v->worst : NAN);
    if (any) {
        put_count(o, "worst_frame", v->worst_frame);
        put_count(o, "worst_camera", v->worst_camera);
    }
}

static void put_anchors(json_t *o, const lab_session *s, const lab_anchors *a,
                        const lab_gaussians *g)
{
    put_count(o, "anchors", s->info.n_anchors);
    put_count(o, "gaussians", s->info.n_gaussians);
    put_count(o, "dynamic", s->info.n_dynamic);
    put_count(o, "drawn", a->drawn);
    put_count(o, "out", a->out);
    put_real(o, "out_share", share(a->out, a->drawn));
    put_real(o, "displacement", a->displacement);
    put_real(o, "displacement_99", a->displacement_99);
    put_count(o, "refused_times", g->refused);
    put_real(o, "dead", share(g->dead, g->gaussians));
    put_real(o, "full", share(g->full, g->gaussians));
    put_real(o, "thin", share(g->thin, g->gaussians));
    put_real(o, "huge", share(g->huge, g->gaussians));
}

static void put_symbols(json_t *o, const lab_symbols *y)
{
    put_count(o, "symbols", y->symbols);
    put_count(o, "escapes", y->escapes);
    put_real(o, "escape_share", share(y->escapes, y->symbols));
    put_real(o, "symbol_ends", share(y->symbol_ends, y->symbols));
    put_real(o, "sigma_ends", share(y->sigma_ends, y->symbols));
    put_real(o, "step_ends", share(y->step_ends, y->steps));
    put_real(o, "context_ends", share(y->context_ends, y->contexts));
    put_real(o, "width_ends", share(y->width_ends, y->widths));
}

static void put_log(json_t *o, const lab_log *l)
{
    put_count(o, "log_lines", l->lines);
    put_count(o, "log_bad", l->bad);
    put_real(o, "loss_first", l->lines > 0 ? l->loss_first : NAN);
    put_real(o, "loss_last", l->lines > 0 ? l->loss_last : NAN);
    json_object_set_new(o, "diverged", json_integer(l->lines > 0 && l->loss_last > l->loss_first));
    put_real(o, "gradient", l->gradient >= 0 ? l->gradient : NAN);
    json_object_set_new(o, "gradient_term", json_string(l->gradient_term));
    put_real(o, "peak", l->peak >= 0 ? l->peak : NAN);
    json_object_set_new(o, "peak_term", json_string(l->peak_term));
    put_count(o, "rollbacks", l->rollbacks);
    put_count(o, "skipped", l->skipped);
    put_count(o, "clamped", l->saturated);
}

static int measure(lab_session *s, const char *log, const char *strip, json_t *o)
{
    lab_views views;
    lab_tracks tracks;
    lab_gaussians gaussians;
    lab_anchors anchors;
    lab_symbols symbols;
    lab_log said;
    int code = lab_measure_views(s, strip, &views);

    if (code == TED4_EXIT_FINE) {
        code = lab_make_tracks(s, &tracks, &gaussians);
        if (code == TED4_EXIT_FINE && lab_judge_anchors(&tracks, &anchors) != 0)
            code = lab_failed("anchors", "out of memory");
        lab_free_tracks(&tracks);
    }
    if (code == TED4_EXIT_FINE)
        code = lab_count_symbols(s, &symbols);
    if (code == TED4_EXIT_FINE && log != NULL)
        code = lab_read_log(log, &said);
    if (code != TED4_EXIT_FINE)
        return code;
    put_count(o, "bytes", s->bytes);
    put_views(o, &views);
    put_anchors(o, s, &anchors, &gaussians);
    put_symbols(o, &symbols);
    if (log != NULL)
        put_log(o, &said);
    return TED4_EXIT_FINE;
}

/* A mistake on the command line must not overwrite a log. */
static int is_picture(const char *path)
{
    const size_t n = strlen(path);

    return n > 4 && strcmp(path + n - 4, ".png") == 0;
}

int main(int argc, char **argv)
{
    lab_session s = { 0 };
    json_t *const o = json_object();
    int code;

    if (argc < 3 || argc > 5 || (argc == 5 && !is_picture(argv[4])) || o == NULL)
        return lab_failed("usage", "lab_facts FILE.ted4 SCENE [LOG.jsonl [STRIP.png]]");
    code = open_file(&s, argv[1]);
    if (code == TED4_EXIT_FINE)
        code = open_scene(&s, argv[2]);
    if (code == TED4_EXIT_FINE)
        code = measure(&s, argc > 3 ? argv[3] : NULL, argc > 4 ? argv[4] : NULL, o);
    if (code == TED4_EXIT_FINE) {
        json_dumpf(o, stdout, JSON_COMPACT | JSON_REAL_PRECISION(6));
        putchar('\n');
    }
    json_decref(o);
    ted4_dataset_free(&s.data);
    ted4_recon_free(s.recon);
    ted4_scene_free(s.scene);
    return code;
}
