/* cell_view.c - see cell_view.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "cell_view.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "train/state/picture.h"
#include "view_geometry.h"

/* Where the model renders less opacity than this, nothing is known about the depth. */
#define OPAQUE 0.5f

/* Renders the view again with the depth of each Gaussian as its first channel and 1 as its second,
 * into t->work.image. Returns 0, or -1 with t->message filled. */
static int render_depth(ted4_trainer *t, const ted4_picture *pic)
{
    ted4_generate_input in;
    ted4_splats s;
    ted4_view v;

    if (ted4_trainer_render(t, pic, 0, &v, &in, &s) != 0)
        return -1;

    float *depth = malloc((2 * s.n + 1) * sizeof *depth), *one = depth + s.n;

    if (depth == NULL)
        return ted4_trainer_fail(t, "no memory to look for what is missing");
    for (size_t i = 0; i < s.n; i++) {
        depth[i] = v.R[6] * s.mean[0][i] + v.R[7] * s.mean[1][i] + v.R[8] * s.mean[2][i] + v.t[2];
        one[i] = 1.0f;
    }
    s.colour[0] = depth;
    s.colour[1] = s.colour[2] = one;
    memset(v.background, 0, sizeof v.background);

    const int bad = ted4_raster_forward(t->work.raster, &s, &v, t->parallel, 0, t->work.image) != 0;

    free(depth);
    return bad ? ted4_trainer_fail(t, "no memory to render") : 0;
}

/* The pixel in the middle of a cell, at most at the edge of the picture. */
static int middle(int cell, int step, int size)
{
    const int at = cell * step + step / 2;

    return at < size ? at : size - 1;
}

/* Fills colours and errors of the cells from those of the pixels. */
static void fill_cells(ted4_cell_view *v, const ted4_error_view *e)
{
    const int width = e->view.width, height = e->view.height;

    for (int row = 0; row < v->rows; row++)
        for (int column = 0; column < v->columns; column++) {
            const size_t at = (size_t)row * (size_t)v->columns + (size_t)column;
            const size_t pixel = (size_t)middle(row, v->step, height) * (size_t)width +
                                 (size_t)middle(column, v->step, width);
            int sum = 0, n = 0;

            for (int y = row * v->step; y < (row + 1) * v->step && y < height; y++)
                for (int x = column * v->step; x < (column + 1) * v->step && x < width; x++, n++)
                    sum += e->error[(size_t)y * (size_t)width + (size_t)x];
            v->error[at] = (uint8_t)(sum / n);
            memcpy(v->rgb + 3 * at, e->rgb + 3 * pixel, 3);
        }
}

/* Fills the depths from t->work.image as render_depth leaves it. unknown: where nothing is
 * rendered. */
static void fill_depths(ted4_cell_view *v, const float *image, float unknown)
{
    const int width = v->view.width, height = v->view.height;
    const size_t pixels = (size_t)width * (size_t)height;

    for (int row = 0; row < v->rows; row++)
        for (int column = 0; column < v->columns; column++) {
            const size_t pixel = (size_t)middle(row, v->step, height) * (size_t)width +
                                 (size_t)middle(column, v->step, width);
            const float opacity = image[pixels + pixel];

            v->depth[(size_t)row * (size_t)v->columns + (size_t)column] =
                opacity >= OPAQUE ? image[pixel] / opacity : unknown;
        }
}

/* Allocates and fills everything but the depths. Returns 0, or -1 if memory ran out. */
static int make_cells(ted4_cell_view *v, const ted4_error_view *e)
{
    v->view = e->view;
    v->nearest = e->nearest;
    v->step = ted4_view_spacing(e->view.width);
    v->columns = (e->view.width + v->step - 1) / v->step;
    v->rows = (e->view.height + v->step - 1) / v->step;

    const size_t n = (size_t)v->columns * (size_t)v->rows;

    v->rgb = malloc(3 * n);
    v->error = malloc(n);
    if (v->rgb == NULL || v->error == NULL)
        return -1;
    fill_cells(v, e);
    return 0;
}

/* Renders the depths. farthest: where nothing is rendered. Returns 0, or -1 with t->message
 * filled. */
static int add_depths(ted4_trainer *t, size_t item, float farthest, ted4_cell_view *v)
{
    v->depth = malloc((size_t)v->columns * (size_t)v->rows * sizeof *v->depth);
    if (v->depth == NULL)
        return ted4_trainer_fail(t, "no memory to look for what is missing");
    if (render_depth(t, &t->data->pictures[item]) != 0)
        return -1;
    fill_depths(v, t->work.image, farthest);
    return 0;
}

int ted4_cell_view_open(ted4_trainer *t, size_t item, int with_depth, ted4_cell_view *v)
{
    ted4_error_view e = { 0 };
    int bad = ted4_error_view_open(t, item, &e) != 0;

    if (!bad && make_cells(v, &e) != 0)
        bad = ted4_trainer_fail(t, "no memory to look for what is missing");
    bad = bad || (with_depth && add_depths(t, item, e.farthest, v) != 0);
    ted4_error_view_close(&e);
    return bad ? -1 : 0;
}

void ted4_cell_view_close(ted4_cell_view *v)
{
    free(v->rgb);
    free(v->error);
    free(v->depth);
    memset(v, 0, sizeof *v);
}

int ted4_cell_of(const ted4_cell_view *v, const float p[3], int *column, int *row)
{
    size_t pixel;
    float depth;

    if (!ted4_view_pixel(&v->view, p, &pixel, &depth))
        return 0;
    *column = (int)(pixel % (size_t)v->view.width) / v->step;
    *row = (int)(pixel / (size_t)v->view.width) / v->step;
    return 1;
}

void ted4_cell_point(const ted4_cell_view *v, int column, int row, float z, float p[3])
{
    float ray[2];

    ted4_view_ray(&v->view, middle(column, v->step, v->view.width),
                  middle(row, v->step, v->view.height), ray);
    ted4_ray_point(&v->view, ray, z, p);
}
