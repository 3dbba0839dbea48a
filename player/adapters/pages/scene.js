// scene.js - what the pages of adapters share: the file of ?file=, and a camera of annex I as the
// matrices of WebGL.
// SPDX-License-Identifier: BSD-2-Clause
import { centreOf } from "../../page/camera.js";
import { Decoder } from "../../src/decoder.js";

const NEAR = 0.02, FAR = 1000; // in units of the scene; near as in I.2

export const canvas = document.getElementById("picture");

export async function openScene() {
  const decoder = await Decoder.load("ted4.wasm");
  const response = await fetch(new URLSearchParams(location.search).get("file"));
  return decoder.open(await response.arrayBuffer());
}

// A camera in the units of a scene.
export function inUnits(camera, { exponent }) {
  return { ...camera, t: camera.t.map((v) => v * 2 ** -exponent) };
}

// { toWorld, projection }, column by column; axes of the camera point right, up, back.
export function matrices(camera, exponent) {
  const { width, height, fx, fy, cx, cy, R } = camera, [x, y, z] = centreOf(camera);
  const near = NEAR * 2 ** exponent, far = FAR * 2 ** exponent;
  return {
    toWorld: [R[0], R[1], R[2], 0, -R[3], -R[4], -R[5], 0, -R[6], -R[7], -R[8], 0, x, y, z, 1],
    projection: [
      2 * fx / width, 0, 0, 0, 0, 2 * fy / height, 0, 0, 1 - 2 * cx / width, 2 * cy / height - 1,
      (far + near) / (near - far), -1, 0, 0, 2 * far * near / (near - far), 0,
    ],
  };
}
