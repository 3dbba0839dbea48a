// Types of adapters/pixel.js. SPDX-License-Identifier: BSD-2-Clause

/** The focal length of the pictures of which the scene was learnt, in their pixels (annex I.4): the
 *  median of the cameras that took them; null if there are none. A pixel drawn with the focal
 *  length fx has the width trainedFocal(cameras) / fx. */
export function trainedFocal(cameras: { fx: number }[]): number | null;

/** What a renderer adds to both variances of a Gaussian in the image, in square pixels: learnt at
 *  the same opacity, then square, while opacity falls. pixel: the width, above 0. */
export function widening(pixel: number): { learnt: number; square: number };
