/* picture.h - renders the current model and compares it with the pictures: true pictures in the
 * scene's colours, the distortion of a picture and its gradient on Gaussians, previews. Nothing
 * here changes the model. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_PICTURE_H
#define TED4_PICTURE_H

#include "trainer.h"

/* What a forward pass is for. */
typedef enum {
    TED4_PASS_IMAGE, /* the image only */
    TED4_PASS_STEP,  /* a training step: with the dropout of stage 1, the noise of stage 2, and
                        everything that the rasteriser's backward pass needs */
    TED4_PASS_JUDGE  /* the gradients of all anchors: the same without dropout */
} ted4_pass;

/* Generates the Gaussians of t->visible_blocks at the time of pic, as seen from in->camera.
 * in->camera and in->by_view are given; the rest of *in and *s
 * is filled and borrows from t. Returns 0, or -1 with t->message filled. */
int ted4_trainer_generate(ted4_trainer *t, const ted4_picture *pic, ted4_pass pass,
                          ted4_generate_input *in, ted4_splats *s);
/* Does the forward pass of one picture. Fills t->visible_blocks for its view, and t->work.image,
 * planar. *in and *s borrow from t, and are valid until the next pass. Returns 0, or -1 with
 * t->message filled. */
int ted4_trainer_render(ted4_trainer *t, const ted4_picture *pic, ted4_pass pass, ted4_view *v,
                        ted4_generate_input *in, ted4_splats *s);
/* Makes room for n gradients in t->work.splat_gradient, whose values are unknown afterwards.
 * Returns 0, or -1 with t->message filled. */
int ted4_trainer_reserve_splats(ted4_trainer *t, size_t n);
/* Backpropagates t->work.d_image to t->work.splat_gradient, after a forward pass that was not for
 * the image only. Returns 0, or -1 with t->message filled. */
int ted4_trainer_render_backward(ted4_trainer *t, const ted4_view *v, const ted4_splats *s);

/* Renders the current model into t->work.image, planar. *v and centre receive view and camera
 * centre in normalised space. Returns 0, or -1 with t->message filled. */
int ted4_trainer_draw(ted4_trainer *t, const ted4_picture *pic, ted4_view *v, float centre[3]);

/* Returns whether colours of this picture's camera are corrected yet. If nothing is known about
 * them, the scene first learns what most cameras agree about. */
int ted4_trainer_corrected(const ted4_trainer *t, const ted4_picture *pic);
/* Computes the loss of t->work.image, in the colours of the picture's camera, against truth, and
 * its gradient, in t->work.d_image. If the camera is corrected and map is not NULL, map receives
 * the gradient of its colour map, and t->work.d_image is with respect to the scene's colours; with
 * map NULL, it is with respect to the camera's colours. l1, ssim: as in ted4_loss. Returns the
 * loss, or a negative number if memory ran out. */
double ted4_trainer_loss(ted4_trainer *t, const ted4_picture *pic, const uint8_t *truth,
                         ted4_colour_map map, double *l1, double *ssim);
/* Returns the true picture number item, interleaved bytes, in the scene's colours. It is valid
 * until ted4_dataset_release of it, or the next call. Returns NULL with t->message filled on
 * failure. */
const uint8_t *ted4_trainer_seen(ted4_trainer *t, size_t item);

/* Returns the distortion of training picture item, as rendered from the current model, or a
 * negative number with t->message filled. */
double ted4_trainer_distortion(ted4_trainer *t, size_t item);
/* Computes the gradients of that distortion on Gaussians, in t->work.splat_gradient. *s and
 * t->visible_blocks describe these Gaussians. Returns 0, or -1 with t->message filled. */
int ted4_distortion_gradient(ted4_trainer *t, size_t item, ted4_splats *s);

/* Returns the mean PSNR of the current model on up to n held-out pictures (or training pictures if
 * there are none), evenly spread. It renders from the trainer's floats, not from a decoded file, so
 * it is for the progress line only. Returns a negative number with t->message filled on failure. */
double ted4_trainer_preview(ted4_trainer *t, int n);

#endif
