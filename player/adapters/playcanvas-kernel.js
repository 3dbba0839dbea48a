// playcanvas-kernel.js - lets PlayCanvas 2.23 draw Gaussians as annex I does. Its own shaders add
// only a quarter of the 0.3 square pixels to covariances, whatever the width of a pixel, and fade
// Gaussians out before their alpha falls to 1/255. They also draw what is nearer than the near
// plane, stretch what lies beside the picture, and shrink what is as large as the picture.
// SPDX-License-Identifier: BSD-2-Clause
import { SHADERLANGUAGE_GLSL, ShaderChunks } from "playcanvas";
import { widening } from "./pixel.js";

const LEAST_ALPHA = 1 / 255, MOST_ALPHA = 0.99; // I.3
// A quad reaches as far as an opacity of 1 shows; u, from its middle to its side, goes from 0 to 1,
// and alpha falls by exp(-STEEPNESS u^2).
const STEEPNESS = -Math.log(LEAST_ALPHA), REACH = Math.sqrt(STEEPNESS);
// PlayCanvas projects with twice the focal length: its units are half pixels.
const UNITS = 4; // per square pixel
// What is added to variances: x at the same opacity, y altogether.
const BLUR = "ted4_blur";
const BOUNDLESS = "1e9"; // half pixels
const BESIDE = 1.3; // how far projections change with place, in half pictures (I.2, step 4)
const determinant = (blur) => `(cov[0][0] + ${blur}) * (cov[1][1] + ${blur})`;

const EDITS = {
  gsplatCornerVS: [
    ["uniform float minPixelSize;", `uniform float minPixelSize; uniform vec2 ${BLUR};`],
    ["cov[0][0] * cov[1][1]", determinant(`${BLUR}.x`)],
    [determinant("0.3"), determinant(`${BLUR}.y`)],
    ["cov[0][0] + 0.3;", `cov[0][0] + ${BLUR}.y;`],
    ["cov[1][1] + 0.3;", `cov[1][1] + ${BLUR}.y;`],
    ["vec2 J1 = focal / vp.z;", `
      if (camera_params.w != 1.0 && -v.z <= camera_params.z) return false;
      vec2 J1 = focal / vp.z;
      vec2 ted4_ndc = center.proj.xy / center.proj.w;
      vec2 ted4_beside = clamp(ted4_ndc, -${BESIDE}, ${BESIDE}) - ted4_ndc;`],
    ["-J1 / vp.z * vp.xy;", `camera_params.w == 1.0 ? vec2(0.0) :
      -J1 * (vp.xy / vp.z - ted4_beside / vec2(center.projMat00, center.projMat11));`],
    ["float l1 = 2.0", `
      #ifndef GSPLAT_FISHEYE
        vmin = ${BOUNDLESS};
      #endif
      float l1 = ${REACH}`], ["float l2 = 2.0", `float l2 = ${REACH}`],
  ],
  gsplatCommonVS: [["* 0.5)", `* ${1 / REACH})`]],
  gsplatPS: [["normExp(A) * gaussianColor.a",
    `min(${MOST_ALPHA}, exp(-${STEEPNESS} * A) * gaussianColor.a)`]],
};

function edited(name, code, [from, to]) {
  if (!code.includes(from)) throw new Error(`${name} of this PlayCanvas has no "${from}"`);
  return code.replace(from, to);
}

// To be called once for a device of an application with a GSplatComponentSystem, before anything is
// drawn. Only for WebGL. Opacity falls (I.4) where scene.gsplat.antiAlias is true. Gaussians show
// from the camera's nearClip on; in I.2 that is 0.02 2^e.
export function drawAsAnnexI(device) {
  if (device.isWebGPU) throw new Error("drawAsAnnexI cannot edit the shaders of WebGPU");
  const chunks = ShaderChunks.get(device, SHADERLANGUAGE_GLSL);
  for (const [name, edits] of Object.entries(EDITS))
    chunks.set(name, edits.reduce((code, edit) => edited(name, code, edit), chunks.get(name)));
  setPixel(device, 1);
}

// The width of a pixel from the next frame on (pixel.js); 1 before the first call.
export function setPixel(device, pixel) {
  const { learnt, square } = widening(pixel);
  device.scope.resolve(BLUR).setValue([UNITS * learnt, UNITS * (learnt + square)]);
}
