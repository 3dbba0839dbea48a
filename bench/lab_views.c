/* lab_views.c - compares held-out pictures of a decoded file with the truth, and draws the worst of
 * them as a strip: see lab_facts.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "eval/metrics.h"
#include "lab_facts.h"
#include "render/png_file.h"
#include "tool/cli.h"
#include "tool/sheet.h"
#include "train/model/normalise.h"

typedef struct {
    ted4_viewer *viewer;   /* owned, as all below */
    uint8_t *ours, *worst; /* [height][width][3] for the largest picture: the last one drawn, and
                              the worst one */
    size_t worst_item;
    double sum;
} view_work;

/* For a picture equal to the truth, one value is assumed to be wrong by one. */
static double finite_psnr(double psnr, const ted4_camera *c)
{
    return isfinite(psnr) ? psnr : 20.0 * log10(255.0) + 10.0 * log10(3.0 * c->width * c->height);
}

/* Draws picture i into w->ours. The caller counts TED4_E_REC_NONFINITE. */
static ted4_status draw_picture(lab_session *s, size_t i, view_work *w)
{
    const ted4_picture *const p = &s->data.pictures[i];
    const uint32_t last = s->data.n_frames > 1 ? s->data.n_frames - 1 : 1;
    const ted4_header world = { 0 }; /* origin 0, unit 1: the view is in world coordinates */
    ted4_view view;
    float centre[3];

    ted4_normalise_view(&world, &p->camera, &view, centre);
    return ted4_render_query(w->viewer, s->recon, &s->info, p->frame, last, &view, NULL, w->ours);
}

static int add_picture(lab_session *s, size_t i, view_work *w, lab_views *v)
{
    const ted4_picture *const p = &s->data.pictures[i];
    const ted4_status status = draw_picture(s, i, w);
    ted4_message message;
    ted4_metrics m;

    v->views++;
    if (status == TED4_E_REC_NONFINITE) {
        v->refused++;
        return TED4_EXIT_FINE;
    }
    if (status != TED4_OK)
        return lab_failed(p->path, ted4_status_id(status));

    const uint8_t *const truth = ted4_dataset_pixels(&s->data, i, &message);

    if (truth == NULL)
        return lab_failed(p->path, message.text);

    const int bad =
        ted4_metrics_compare(truth, w->ours, p->camera.width, p->camera.height, NULL, &m);

    ted4_dataset_release(&s->data, i);
    if (bad)
        return lab_failed(p->path, "out of memory");

    const double psnr = finite_psnr(m.psnr, &p->camera);

    v->exact += !isfinite(m.psnr);
    w->sum += psnr;
    if (v->views - v->refused == 1 || psnr < v->worst) {
        v->worst = psnr;
        v->worst_frame = p->frame;
        v->worst_camera = p->camera_id;
        w->worst_item = i;
        memcpy(w->worst, w->ours, 3 * (size_t)p->camera.width * (size_t)p->camera.height);
    }
    return TED4_EXIT_FINE;
}

static int write_strip(lab_session *s, const view_work *w, const char *path)
{
    const ted4_camera *const c = &s->data.pictures[w->worst_item].camera;
    ted4_message message;
    ted4_sheet sheet;
    char why[256];
    const uint8_t *const truth = ted4_dataset_pixels(&s->data, w->worst_item, &message);

    if (truth == NULL)
        return lab_failed(path, message.text);
    if (ted4_sheet_init(&sheet, c->width, c->height, 1) != 0) {
        ted4_dataset_release(&s->data, w->worst_item);
        return lab_failed(path, "out of memory");
    }
    ted4_sheet_put(&sheet, 0, truth, w->worst);
    ted4_dataset_release(&s->data, w->worst_item);

    const int bad =
        ted4_png_write(path, c->width * TED4_SHEET_COLUMNS, c->height, sheet.rgb, why, sizeof why);

    ted4_sheet_finish(&sheet);
    return bad ? lab_failed(path, why) : TED4_EXIT_FINE;
}

int lab_measure_views(lab_session *s, const char *strip, lab_views *v)
{
    view_work w = { .viewer = ted4_viewer_new() };
    size_t largest = 1;
    int code = TED4_EXIT_FINE;

    memset(v, 0, sizeof *v);
    for (size_t i = 0; i < s->data.n_pictures; i++) {
        const ted4_camera *const c = &s->data.pictures[i].camera;
        const size_t size = 3 * (size_t)c->width * (size_t)c->height;

        largest = size > largest ? size : largest;
    }
    w.ours = malloc(largest);
    w.worst = malloc(largest);
    if (w.viewer == NULL || w.ours == NULL || w.worst == NULL)
        code = lab_failed("pictures", "out of memory");
    for (size_t i = 0; i < s->data.n_pictures && code == TED4_EXIT_FINE; i++)
        if (s->data.pictures[i].is_test)
            code = add_picture(s, i, &w, v);

    const size_t counted = v->views - v->refused;

    v->mean = counted > 0 ? w.sum / (double)counted : 0;
    if (code == TED4_EXIT_FINE && strip != NULL && counted > 0)
        code = write_strip(s, &w, strip);
    ted4_viewer_free(w.viewer);
    free(w.ours);
    free(w.worst);
    return code;
}
