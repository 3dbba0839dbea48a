/* widen.h - makes exported Gaussians as wide as training saw them, for viewers that draw larger
 * pictures than those of training: the 3D smoothing filter. Annex I.4 is the same in the image.
 * Depends on camera_list.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_WIDEN_H
#define TED4_WIDEN_H

#include <stddef.h>

#include "camera_list.h"

/* Adds to the variances of each Gaussian what training added to them in the image (I.2, step 6),
 * as wide as it is at the Gaussian for the camera that resolves it best: for a camera that sees it
 * at depth Z, 0.3 (Z / fx)^2. Where no camera sees it, Z is its distance from the camera. What
 * binary32 cannot hold is left as it is.
 * taken: one camera or more; near_z: depth at which they begin to see. mean, scale: [n] each, in
 * the axes of the cameras; scales are linear. Returns 0, or -1 if out of memory. */
int ted4_widen(const ted4_camera_list *taken, float near_z, size_t n, const float *const mean[3],
               float *const scale[3]);

#endif
