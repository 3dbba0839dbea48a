// spark.js - the Gaussians of a time as PackedSplats of Spark: 16 bytes each, with centres in
// binary16 and the rest in 8 bits. The axes of the world stay those of the scene; turn the mesh
// so that its up direction is that of the viewer.
// SPDX-License-Identifier: BSD-2-Clause
import { PackedSplats, setPackedSplat } from "@sparkjsdev/spark";
import { widening } from "./pixel.js";

const LEAST_ALPHA = 1 / 255; // I.3
// Standard deviations at which an opacity of 1 falls to it.
const REACH = Math.sqrt(-2 * Math.log(LEAST_ALPHA));
const BOUNDLESS = 1e6; // pixels

// Options of a SparkRenderer that draws as annex I does; pixel: the width of a pixel (pixel.js). By
// itself, Spark cuts Gaussians off at 2.8 standard deviations, and shrinks what is larger than 512
// pixels.
export function annexI(pixel = 1) {
  const { learnt, square } = widening(pixel);
  return {
    preBlurAmount: learnt, blurAmount: square, sortRadial: false, minAlpha: LEAST_ALPHA,
    maxStdDev: REACH, maxPixelRadius: BOUNDLESS,
  };
}

// For n Gaussians: the splats of a SplatMesh, { packedSplats }.
export function createPackedSplats(n) {
  const packed = new PackedSplats();
  packed.ensureSplats(n);
  packed.numSplats = n;
  return packed;
}

// Puts Gaussians (Scene.gaussians, ClientScene.gaussians) into packed, with lengths in a unit that
// is to be the unit of the viewer's world as well: Spark packs splats once more, as they are in the
// world. It keeps standard deviations from 6e-6 to 8103. The mesh then needs updateVersion().
export function updatePackedSplats(packed, { n, mean, scale, rotation, opacity, colour },
  unit = 1) {
  const [x, y, z] = mean, [sx, sy, sz] = scale, [qw, qx, qy, qz] = rotation, [r, g, b] = colour;
  for (let i = 0; i < n; i++)
    setPackedSplat(packed.packedArray, i, x[i] / unit, y[i] / unit, z[i] / unit,
      sx[i] / unit, sy[i] / unit, sz[i] / unit, qx[i], qy[i], qz[i], qw[i],
      opacity[i], r[i], g[i], b[i]);
  packed.needsUpdate = true;
}
