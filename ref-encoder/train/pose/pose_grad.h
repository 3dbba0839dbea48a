/* pose_grad.h - the gradient of a picture's loss with respect to the motion of its pose. Depends on
 * train/pose/pose.h, train/model/splat_grads.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_POSE_GRAD_H
#define TED4_POSE_GRAD_H

#include "base/parallel.h"
#include "pose.h"
#include "train/model/splat_grads.h"

/* Computes dL/d(motion) of the pose of picture item, which has one, after the picture was drawn as
 * v from the Gaussians s. g: the rasteriser's gradients of the Gaussians;
 * d_centre [3]: the gradient with respect to the camera's centre by way of what depends on the
 * viewing direction. All in normalised space. Sums have a fixed order, so results are bit-identical
 * for any number of threads. */
void ted4_pose_backward(const ted4_poses *p, size_t item, const ted4_view *v, const ted4_splats *s,
                        const ted4_splat_grads *g, const float *d_centre,
                        const ted4_parallel *parallel, ted4_pose_motion gradient);

#endif
