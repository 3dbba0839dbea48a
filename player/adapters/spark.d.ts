// Types of adapters/spark.js. SPDX-License-Identifier: BSD-2-Clause
import type { PackedSplats } from "@sparkjsdev/spark";
import type { Gaussians } from "../src/index.js";

/** Options of a SparkRenderer that draws as annex I does. pixel: the width of a pixel, in pixels of
 *  the pictures of which the scene was learnt (trainedFocal of pixel.js); 1 if it is left out. */
export function annexI(pixel?: number):
  { preBlurAmount: number; blurAmount: number; sortRadial: boolean; minAlpha: number;
    maxStdDev: number; maxPixelRadius: number };

/** For n Gaussians, 1 or more: the splats of a SplatMesh, { packedSplats }. */
export function createPackedSplats(n: number): PackedSplats;

/** Puts Gaussians into splats that were made for as many of them. Lengths are divided by unit (1 if
 *  it is left out), which is to be the unit of the viewer's world as well: Spark keeps centres up to
 *  65504 and standard deviations from 6e-6 to 8103, in the splats and once more as they are in the
 *  world. 2 ** info.exponent suits scenes of any size. The mesh then needs updateVersion(). */
export function updatePackedSplats(packed: PackedSplats, gaussians: Gaussians, unit?: number): void;
