// Types of adapters/pixel.js. SPDX-License-Identifier: BSD-2-Clause

/** The width of a pixel, in pixels of the pictures of which the scene was learnt (annex I.4). fx:
 *  the focal length of the view, in pixels; cameras: those that took the pictures. 1 if there are
 *  none. */
export function pixelWidth(fx: number, cameras: { fx: number }[]): number;

/** What a renderer adds to both variances of a Gaussian in the image, in square pixels: learnt at
 *  the same opacity, then square, while opacity falls. pixel: the width, above 0. */
export function widening(pixel: number): { learnt: number; square: number };
