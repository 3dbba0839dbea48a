/* picture.h - the model against the pictures: drawing it as it is, true pictures in the scene's
 * colours, the distortion of a picture and its gradient on Gaussians, previews. Nothing is learnt
 * here. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_PICTURE_H
#define TED4_PICTURE_H

#include "trainer.h"

/* Forward pass of one picture over t->visible blocks, which are filled for its view; the image is
 * in t->work.image, planar. training: with the noise of stage 2, and what the rasteriser's way back
 * needs. *in, *s: borrow from t, valid until the next pass. 0, or -1 with t->message. */
int ted4_trainer_render(ted4_trainer *t, const ted4_picture *pic, int training, ted4_view *v,
                        ted4_generate_input *in, ted4_splats *s);
/* From t->work.d_image to t->work.splat_gradient, after a pass with training. 0, or -1 with
 * t->message. */
int ted4_trainer_render_backward(ted4_trainer *t, const ted4_view *v, const ted4_splats *s);

/* Draws the model as it is now into t->work.image, planar, and tells view and camera centre in
 * normalised space. 0, or -1 with t->message. */
int ted4_trainer_draw(ted4_trainer *t, const ted4_picture *pic, ted4_view *v, float centre[3]);

/* Are colours of this picture's camera corrected by now? Where nothing is known about them, the
 * scene first learns what most cameras agree about. */
int ted4_trainer_corrected(const ted4_trainer *t, const ted4_picture *pic);
/* Loss of t->work.image, in the colours of the picture's camera, against truth; its gradient is in
 * t->work.d_image. map: where the camera is corrected, gradient of its colour map, and that of the
 * scene's colours in t->work.d_image; NULL: that of the camera's colours there. l1, ssim: as
 * ted4_loss. Negative: no memory. */
double ted4_trainer_loss(ted4_trainer *t, const ted4_picture *pic, const uint8_t *truth,
                         ted4_colour_map map, double *l1, double *ssim);
/* The true picture number item, interleaved bytes, in the scene's colours; valid until
 * ted4_dataset_release of it, or the next call. NULL, with t->message. */
const uint8_t *ted4_trainer_seen(ted4_trainer *t, size_t item);

/* Distortion of training picture item, drawn from the model as it is now; nothing is learnt from
 * it. Negative: failed, with t->message. */
double ted4_trainer_distortion(ted4_trainer *t, size_t item);
/* The same picture's gradients of the distortion on Gaussians, in t->work.splat_gradient; *s and
 * t->visible blocks: which Gaussians. 0, or -1 with t->message. */
int ted4_distortion_gradient(ted4_trainer *t, size_t item, ted4_splats *s);

/* Mean PSNR of the current model on up to n held-out pictures (training pictures when there are
 * none), spread evenly over them, from its own floats: for the progress line only. Negative:
 * failure, with t->message. */
double ted4_trainer_preview(ted4_trainer *t, int n);

#endif
