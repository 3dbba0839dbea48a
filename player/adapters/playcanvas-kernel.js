// playcanvas-kernel.js - lets PlayCanvas 2.23 draw Gaussians as annex I does. Its own shaders add
// only a quarter of the 0.3 square pixels to covariances, whatever the width of a pixel, and fade
// Gaussians out before their alpha falls to 1/255.
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
const determinant = (blur) => `(cov[0][0] + ${blur}) * (cov[1][1] + ${blur})`;

const EDITS = {
  gsplatCornerVS: [
    ["uniform float minPixelSize;", `uniform float minPixelSize; uniform vec2 ${BLUR};`],
    ["cov[0][0] * cov[1][1]", determinant(`${BLUR}.x`)],
    [determinant("0.3"), determinant(`${BLUR}.y`)],
    ["cov[0][0] + 0.3;", `cov[0][0] + ${BLUR}.y;`],
    ["cov[1][1] + 0.3;", `cov[1][1] + ${BLUR}.y;`],
    ["float l1 = 2.0", `float l1 = ${REACH}`], ["float l2 = 2.0", `float l2 = ${REACH}`],
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
// drawn. Only for WebGL. Opacity falls (I.4) where scene.gsplat.antiAlias is true.
export function drawAsAnnexI(device) {
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
