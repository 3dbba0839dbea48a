/* eval_result.c - see eval_result.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "eval_result.h"

#include <math.h>
#include <stdio.h>

#include <jansson.h>

#include "tool/plural.h"

static void print_text(const ted4_eval_sums *t, const ted4_eval_style *style)
{
    const double n = (double)t->views, fitted = (double)t->fitted_views;

    printf("psnr       %.4f dB\nssim       %.5f\nssim2      %.5f\nms_ssim    %.5f\nbytes      "
           "%zu\ndecode     %.2f ms\nrender     %.2f fps\nviews      %zu\n",
           t->psnr / n, t->ssim / n, t->ssim2 / n, t->ms_ssim / n, t->bytes, t->decode_ms,
           n / t->render_s, t->views);
    if (style->align)
        printf("half       %.4f dB\naligned    %.4f dB\n", t->given / n, t->aligned / n);
    if (style->colours && t->fitted_views > 0)
        printf("raw        %.4f dB\nfitted     %.4f dB\n", t->raw / fitted, t->fitted / fitted);
    if (style->colours)
        printf("of         %zu view%s\n", t->fitted_views, ted4_s(t->fitted_views));
    if (style->moving && t->moving.pixels > 0)
        printf("moving     %.4f dB\n", ted4_moving_psnr(&t->moving));
    if (style->moving)
        printf("of         %zu pixel%s in %zu view%s\n", t->moving.pixels, ted4_s(t->moving.pixels),
               t->moving.views, ted4_s(t->moving.views));
}

/* Returns null for a metric that is infinite or undefined (its window exceeds the picture, or it is
 * the mean of no pictures). */
static json_t *number(double v)
{
    return isfinite(v) ? json_real(v) : json_null();
}

static void print_json(const ted4_eval_sums *t, const ted4_info *info, const ted4_eval_style *style)
{
    const double n = (double)t->views, fitted = (double)t->fitted_views;
    json_t *const o = json_pack("{s:o, s:o, s:o, s:o, s:o, s:I, s:o, s:o, s:I, s:s, s:I, s:I, s:I}",
                                "psnr", number(t->psnr / n), "ssim", number(t->ssim / n), "ssim2",
                                number(t->ssim2 / n), "ms_ssim", number(t->ms_ssim / n), "l1",
                                number(t->l1 / n), "bytes", (json_int_t)t->bytes, "decode_ms",
                                number(t->decode_ms), "render_fps", number(n / t->render_s),
                                "views", (json_int_t)t->views, "split", style->split, "frames",
                                (json_int_t)info->frames, "anchors", (json_int_t)info->n_anchors,
                                "gaussians", (json_int_t)info->n_gaussians);

    if (style->align) {
        json_object_set_new(o, "psnr_half", number(t->given / n));
        json_object_set_new(o, "psnr_aligned", number(t->aligned / n));
    }
    if (style->colours) {
        json_object_set_new(o, "psnr_raw", number(t->raw / fitted));
        json_object_set_new(o, "psnr_fitted", number(t->fitted / fitted));
        json_object_set_new(o, "views_fitted", json_integer((json_int_t)t->fitted_views));
    }
    if (style->moving) {
        json_object_set_new(o, "psnr_moving", number(ted4_moving_psnr(&t->moving)));
        json_object_set_new(o, "pixels_moving", json_integer((json_int_t)t->moving.pixels));
        json_object_set_new(o, "views_moving", json_integer((json_int_t)t->moving.views));
    }
    json_dumpf(o, stdout, JSON_COMPACT | JSON_REAL_PRECISION(6));
    putchar('\n');
    json_decref(o);
}

void ted4_eval_print(const ted4_eval_sums *t, const ted4_info *info, const ted4_eval_style *style)
{
    if (style->json)
        print_json(t, info, style);
    else
        print_text(t, style);
}
