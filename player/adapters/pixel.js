// pixel.js - by how much a renderer widens Gaussians whose pixels are not those of training (annex
// I.4). The width of a pixel is counted in pixels of the pictures of which the scene was learnt.
// SPDX-License-Identifier: BSD-2-Clause

const LEARNT = 0.3; // what training adds to both variances, square pixels (I.2)
const SQUARE = 1 / 12; // variance of a pixel

// The focal length of the pictures of which the scene was learnt, in their pixels: the median of
// the cameras that took them; null if there are none. A pixel that is drawn with the focal length
// fx has the width trainedFocal(cameras) / fx.
export function trainedFocal(cameras) {
  const focal = cameras.map(({ fx }) => fx).sort((a, b) => a - b);
  return focal.length > 0 ? focal[focal.length >> 1] : null;
}

// For pixels of this width, in square pixels as they are drawn: what to add to both variances at
// the same opacity, and what to add after that while opacity falls, so that a Gaussian covers as
// much as before.
export function widening(pixel) {
  return { learnt: LEARNT / pixel ** 2, square: Math.max(0, 1 - pixel ** -2) * SQUARE };
}
