/* trainer_init.c - initialises a trainer: see trainer_init.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "trainer_init.h"

#include <stdlib.h>
#include <string.h>

#include "norm/half.h"
#include "train/densify/camera_colour_init.h"
#include "train/densify/camera_exposure_init.h"
#include "train/densify/photo_votes.h"
#include "train/densify/short_lived.h"
#include "train/densify/viewpoints.h"
#include "train/math/random.h"
#include "train/model/header_from_options.h"
#include "train/model/init.h"

static int make_order(ted4_trainer *t)
{
    uint8_t *seen = calloc((size_t)t->data->n_frames + 1, 1); /* times that have pictures */
    uint32_t times = 0;

    t->order.item = malloc((t->data->n_pictures + 1) * sizeof *t->order.item);
    for (uint32_t i = 0; seen != NULL && t->order.item != NULL && i < t->data->n_pictures; i++) {
        const ted4_picture *pic = &t->data->pictures[i];

        if (pic->is_test)
            continue;
        t->order.item[t->order.n++] = i;
        times += !seen[pic->frame];
        seen[pic->frame] = 1;
    }
    free(seen);
    if (seen == NULL || t->order.item == NULL)
        return ted4_trainer_fail(t, "no memory for the order of pictures");
    if (t->order.n == 0)
        return ted4_trainer_fail(t, "no training pictures");
    t->order.cameras = (double)t->order.n / (double)times;
    t->order.key = ted4_mix(t->opt.seed ^ 0x6f72646572u);
    t->order.next = t->order.n;
    return 0;
}

static int make_images(ted4_trainer *t)
{
    size_t pixels = 0;

    for (size_t i = 0; i < t->data->n_pictures; i++) {
        const ted4_camera *c = &t->data->pictures[i].camera;
        const size_t n = (size_t)c->width * (size_t)c->height;

        pixels = n > pixels ? n : pixels;
    }
    t->work.image = malloc(3 * pixels * sizeof *t->work.image + 64);
    t->work.d_image = malloc(3 * pixels * sizeof *t->work.d_image + 64);
    t->work.raster = ted4_raster_new();
    t->work.adjoint = ted4_adjoint_new();
    t->work.loss = ted4_loss_workspace_new();
    if (t->work.image == NULL || t->work.d_image == NULL || t->work.raster == NULL ||
        t->work.adjoint == NULL || t->work.loss == NULL)
        return ted4_trainer_fail(t, "no memory for images of %zu pixels", pixels);
    if (t->opt.colour && ted4_colour_init(&t->colour, t->data) != 0)
        return ted4_trainer_fail(t, "no memory for colour correction");
    if (t->opt.poses && ted4_poses_init(&t->poses, t->data, &t->layout.head) != 0)
        return ted4_trainer_fail(t, "no memory for poses");
    return 0;
}

/* Half of max_anchors leaves room for growth and seeding. Where too few places are seen from, these
 * can only guess at depths, which points know: there, points get all the room. */
static size_t most_initial_anchors(const ted4_trainer *t)
{
    const size_t all = (size_t)t->opt.max_anchors;

    if (t->opt.init_anchors > 0)
        return (size_t)t->opt.init_anchors;
    return ted4_has_viewpoints(t) ? (all + 1) / 2 : all;
}

/* Initialises everything, in the layout of h. */
static int begin(ted4_trainer *t, const ted4_header *h)
{
    const char *wrong = ted4_header_wrong(h);

    if (wrong != NULL)
        return ted4_trainer_fail(
            t, "no file can hold this scene with these options: %s is beyond its range in a header",
            wrong);
    if (t->opt.batch > 1 && h->view == TED4_VIEW_FULL)
        return ted4_trainer_fail(t,
                                 "batch needs heads of opacity and covariance that do not depend "
                                 "on the view (view 0 or 1)");
    if (t->opt.grid != 0 && !ted4_grid_exists((unsigned)t->opt.grid))
        return ted4_trainer_fail(t, "grid: no file has positions of %d bits; 0, or 6 to 12",
                                 t->opt.grid);
    ted4_layout_make(&t->layout, h);
    t->phase.rate_norm_header = t->layout.head;
    ted4_weight_grid_full(t->net.bits);
    t->monitor.state.factor = 1;
    if (ted4_trainer_rebuild(t) != 0 || make_order(t) != 0 || make_images(t) != 0)
        return -1;
    if (ted4_anchors_init(&t->anchors, &t->layout) != 0 ||
        ted4_init_anchors(&t->anchors, &t->layout, t->data, most_initial_anchors(t), t->opt.cell,
                          &t->voxel) != 0)
        return ted4_trainer_fail(t, "no memory for the anchors");
    if (t->anchors.n == 0)
        return ted4_trainer_fail(t, "no initial point lies inside the scene's bounds");
    ted4_init_networks(t->net.value, &t->layout, t->opt.seed);
    if (ted4_camera_colour_init(t) != 0 || ted4_camera_exposure_init(t) != 0)
        return -1;
    return t->opt.transients
               ? ted4_init_short_lived(t, ted4_photo_votes_capacity(t->data->n_frames))
               : 0;
}

int ted4_trainer_init(ted4_trainer *t, const ted4_train_options *o, ted4_dataset *d,
                      const ted4_parallel *p)
{
    ted4_header h;

    memset(t, 0, sizeof *t);
    t->opt = *o;
    t->data = d;
    t->parallel = p;
    ted4_header_make(&h, o, d);
    return begin(t, &h);
}

int ted4_trainer_restart(ted4_trainer *t, const ted4_header *h)
{
    const ted4_train_options opt = t->opt;
    ted4_dataset *data = t->data;
    const ted4_parallel *parallel = t->parallel;
    ted4_exchange *exchange = t->exchange;
    const double seconds = t->seconds;
    const ted4_onlooker onlooker = t->onlooker;

    ted4_trainer_finish(t);
    t->opt = opt;
    t->data = data;
    t->parallel = parallel;
    t->exchange = exchange;
    t->seconds = seconds;
    t->onlooker = onlooker;
    t->search.probed = 1;
    return begin(t, h);
}
