// Types of adapters/playcanvas-kernel.js. SPDX-License-Identifier: BSD-2-Clause
import type { GraphicsDevice } from "playcanvas";

/** To be called once for a device of an application with a GSplatComponentSystem, before anything
 *  is drawn. Only for WebGL. scene.gsplat.antiAlias has to be true where pixels are wider than those
 *  of training. Gaussians show from the camera's nearClip on, which is 0.02 2^info.exponent in annex
 *  I. Throws Error if the device is one of WebGPU, or if this PlayCanvas has other shaders. */
export function drawAsAnnexI(device: GraphicsDevice): void;

/** The width of a pixel from the next frame on, in pixels of the pictures of which the scene was
 *  learnt (annex I.4; trainedFocal of pixel.js): above 0, and 1 before the first call. */
export function setPixel(device: GraphicsDevice, pixel: number): void;
