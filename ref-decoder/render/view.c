/* view.c - renders views of a decoded scene, through ted4_recon_query and the rasteriser.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "render/view.h"

#include <math.h>
#include <stdlib.h>

struct ted4_viewer {
    ted4_raster *raster; /* owned */
    float *image;        /* owned: planar, capacity floats */
    size_t capacity;
};

ted4_viewer *ted4_viewer_new(void)
{
    ted4_viewer *const v = calloc(1, sizeof *v);

    if (v == NULL)
        return NULL;
    v->raster = ted4_raster_new();
    if (v->raster != NULL)
        return v;
    free(v);
    return NULL;
}

void ted4_viewer_free(ted4_viewer *v)
{
    if (v == NULL)
        return;
    ted4_raster_free(v->raster);
    free(v->image);
    free(v);
}

static int reserve_image(ted4_viewer *v, size_t n)
{
    if (n > v->capacity) {
        free(v->image);
        v->image = malloc(n * sizeof *v->image);
        v->capacity = v->image == NULL ? 0 : n;
    }
    return v->capacity >= n ? 0 : -1;
}

/* Computes the centre of the camera, c = -R^T t, where x_cam = 0. */
static void camera_centre(const ted4_view *camera, float c[3])
{
    for (int i = 0; i < 3; i++) {
        double sum = 0.0;

        for (int k = 0; k < 3; k++)
            sum -= (double)camera->R[3 * k + i] * (double)camera->t[k];
        c[i] = (float)sum;
    }
}

typedef struct {
    const float *image;
    uint8_t *rgb;
    size_t width, plane;
} round_job;

static void round_row(void *arg, size_t row)
{
    const round_job *const j = arg;

    for (size_t c = 0; c < 3; c++) {
        const float *const from = j->image + c * j->plane + row * j->width;
        uint8_t *const to = j->rgb + row * j->width * 3 + c;

        for (size_t x = 0; x < j->width; x++) {
            const float v = from[x] > 0.0f ? from[x] : 0.0f;

            to[3 * x] = (uint8_t)((v < 1.0f ? v : 1.0f) * 255.0f + 0.5f);
        }
    }
}

ted4_status ted4_render_gaussians(ted4_viewer *v, const ted4_gaussians *g, const ted4_info *info,
                                  const ted4_view *camera, const ted4_parallel *p, uint8_t *rgb)
{
    const size_t plane = (size_t)camera->width * (size_t)camera->height;
    ted4_view view = *camera;

    if (reserve_image(v, plane * 3) != 0)
        return TED4_E_LIMIT_MEMORY;
    view.near_z = (float)ldexp(TED4_VIEW_NEAR, info->exponent);
    for (int c = 0; c < 3; c++)
        view.background[c] = (float)info->background[c] / 255.0f;

    const ted4_splats s = { g->n,
                            { g->mean[0], g->mean[1], g->mean[2] },
                            { g->scale[0], g->scale[1], g->scale[2] },
                            { g->rot[0], g->rot[1], g->rot[2], g->rot[3] },
                            g->opacity,
                            { g->colour[0], g->colour[1], g->colour[2] } };

    if (ted4_raster_forward(v->raster, &s, &view, p, 0, v->image) != 0)
        return TED4_E_LIMIT_MEMORY;
    round_job j = { v->image, rgb, (size_t)camera->width, plane };

    ted4_parallel_for(p, (size_t)camera->height, round_row, &j);
    return TED4_OK;
}

ted4_status ted4_query_for_view(ted4_recon *r, uint32_t num, uint32_t den, const ted4_view *camera,
                                const ted4_parallel *p, ted4_gaussians *g)
{
    ted4_query q = { num, den, { 0.0f, 0.0f, 0.0f } };

    camera_centre(camera, q.camera);
    return ted4_recon_query(r, &q, p, g);
}

ted4_status ted4_render_query(ted4_viewer *v, ted4_recon *r, const ted4_info *info, uint32_t num,
                              uint32_t den, const ted4_view *camera, const ted4_parallel *p,
                              uint8_t *rgb)
{
    ted4_gaussians g;
    const ted4_status status = ted4_query_for_view(r, num, den, camera, p, &g);

    return status != TED4_OK ? status : ted4_render_gaussians(v, &g, info, camera, p, rgb);
}
