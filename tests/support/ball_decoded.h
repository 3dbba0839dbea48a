/* ball_decoded.h - quality of a file of the scene of balls after decoding, for test_trainer.c and
 * test_variants.c.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_BALL_DECODED_H
#define TED4_BALL_DECODED_H

#include "ball_trainer.h"
#include "eval/metrics.h"
#include "render/view.h"
#include "ted4.h"
#include "test.h"

/* Decodes the file and returns the mean PSNR over the training pictures. */
static inline double ball_decoded_psnr(const ball_file *f, ted4_dataset *d, ted4_info *info)
{
    ted4_scene *s;
    ted4_recon *r;
    ted4_viewer *viewer = ted4_viewer_new();
    double sum = 0, n = 0;

    assert_non_null(viewer);
    assert_int_equal(ted4_decode(f->bytes, f->size, NULL, &s, NULL), TED4_OK);
    ted4_scene_info(s, info);
    assert_int_equal(ted4_recon_new(&r, s, NULL), TED4_OK);
    ted4_scene_free(s);
    for (size_t i = 0; i < d->n_pictures; i++) {
        const ted4_picture *pic = &d->pictures[i];
        const ted4_camera *c = &pic->camera;
        ted4_view v = { .width = c->width,
                        .height = c->height,
                        .fx = (float)c->fx,
                        .fy = (float)c->fy,
                        .cx = (float)c->cx,
                        .cy = (float)c->cy };
        uint8_t rgb[3 * BALL_W * BALL_H];
        ted4_metrics m;

        for (int k = 0; k < 9; k++)
            v.R[k] = (float)c->R[k];
        for (int k = 0; k < 3; k++)
            v.t[k] = (float)c->t[k];
        if (pic->is_test)
            continue;
        assert_int_equal(ted4_render_query(viewer, r, info, pic->frame,
                                           d->n_frames > 1 ? d->n_frames - 1 : 1, &v, NULL, rgb),
                         TED4_OK);
        assert_int_equal(ted4_metrics_compare(ted4_dataset_pixels(d, i, NULL), rgb, BALL_W, BALL_H,
                                              NULL, &m),
                         0);
        ted4_dataset_release(d, i);
        sum += m.psnr;
        n += 1;
    }
    ted4_recon_free(r);
    ted4_viewer_free(viewer);
    return sum / n;
}

#endif
