/* pose_step.h - poses of training cameras during training: gradients, the step of the optimiser,
 * and the decision whether refinement goes on. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_POSE_STEP_H
#define TED4_POSE_STEP_H

#include "train/state/trainer.h"

/* Computes the gradient of one picture's loss with respect to its pose; 0 unless poses are learnt.
 * Call it after ted4_generate_backward or, of several views, after ted4_generate_view_backward; v
 * and s as drawn. */
void ted4_pose_gradient(ted4_trainer *t, const ted4_picture *pic, const ted4_view *v,
                        const ted4_splats *s, ted4_pose_motion gradient);
/* Adds it to the gradient of the pose, if poses are learnt. Call it once for each picture of a
 * step. */
void ted4_pose_add(ted4_trainer *t, const ted4_picture *pic, const ted4_pose_motion gradient);
/* Does one step of Adam for the poses that have gathered gradients, and keeps the world where it
 * is. Sets the norm of these gradients for the monitor. */
void ted4_update_poses(ted4_trainer *t);

/* Goes on with the trial of refinement, if its next part is due. Given poses that are right only
 * follow the noise of training, and cost quality if they do; so they are put back after a fifth of
 * stage 1 if what is seen has moved by less than 0.2 pixels, or by less than 0.5 if each picture
 * has a pose of its own and things may move. Where hardly two cameras see the same content, poses
 * drift farther while it is learnt, and the content with them. Pictures do not tell such a drift
 * from the given poses, but tell wrong poses from right ones. So from then on a prior pulls towards
 * the given poses, and they are put back after three tenths of stage 1 unless three quarters of
 * that motion remain, or half a pixel. Otherwise refinement goes on without the prior until the
 * end. t->poses.decision and t->poses.moved receive the result. */
void ted4_poses_decide(ted4_trainer *t);

#endif
