// playcanvas.js - the Gaussians of a time as a GSplatContainer of PlayCanvas: every array of a
// query is a texture of its own, in binary32 as the decoder gives it. The axes of the world stay
// those of the scene; turn the entity so that its up direction is that of the viewer.
// SPDX-License-Identifier: BSD-2-Clause
import { BoundingBox, GSplatContainer, GSplatFormat, PIXELFORMAT_R32F, Vec3 } from "playcanvas";

const STREAMS = ["meanX", "meanY", "meanZ", "scaleX", "scaleY", "scaleZ", "turnW", "turnX", "turnY",
  "turnZ", "opacity", "red", "green", "blue"];
const READ_GLSL = `
vec3 getCenter() { return vec3(loadMeanX().r, loadMeanY().r, loadMeanZ().r); }
vec4 getColor() { return vec4(loadRed().r, loadGreen().r, loadBlue().r, loadOpacity().r); }
vec3 getScale() { return vec3(loadScaleX().r, loadScaleY().r, loadScaleZ().r); }
vec4 getRotation() { return vec4(loadTurnW().r, loadTurnX().r, loadTurnY().r, loadTurnZ().r); }
`;
const READ_WGSL = `
fn getCenter() -> vec3f { return vec3f(loadMeanX().r, loadMeanY().r, loadMeanZ().r); }
fn getColor() -> vec4f {
    return vec4f(loadRed().r, loadGreen().r, loadBlue().r, loadOpacity().r);
}
fn getScale() -> vec3f { return vec3f(loadScaleX().r, loadScaleY().r, loadScaleZ().r); }
fn getRotation() -> vec4f {
    return vec4f(loadTurnW().r, loadTurnX().r, loadTurnY().r, loadTurnZ().r);
}
`;

// A container for n Gaussians. PlayCanvas rounds scales to binary16 in world coordinates: scaling
// the entity by 2 ** -info.exponent, and the camera's position with it, suits scenes of any size.
export function createContainer(device, n) {
  const streams = STREAMS.map((name) => ({ name, format: PIXELFORMAT_R32F }));
  const format = new GSplatFormat(device, streams, { readGLSL: READ_GLSL, readWGSL: READ_WGSL });
  return new GSplatContainer(device, n, format);
}

// PlayCanvas sorts by these.
function setCenters(container, [x, y, z], n) {
  const { centers } = container;
  for (let i = 0, at = 0; i < n; i++, at += 3) {
    centers[at] = x[i];
    centers[at + 1] = y[i];
    centers[at + 2] = z[i];
  }
}

function range(array, n) {
  let low = Infinity, high = -Infinity;
  for (let i = 0; i < n; i++) {
    if (array[i] < low) low = array[i];
    if (array[i] > high) high = array[i];
  }
  return [low, high];
}

// Its sort loses what lies out of these bounds.
function bounds(mean, n) {
  const ranges = mean.map((array) => range(array, n));
  const box = new BoundingBox();
  box.setMinMax(new Vec3(ranges.map(([low]) => low)), new Vec3(ranges.map(([, high]) => high)));
  return box;
}

// Puts Gaussians (Scene.gaussians, ClientScene.gaussians) into the container. The component then
// needs workBufferUpdate = WORKBUFFER_UPDATE_ONCE.
export function updateContainer(container, { n, mean, scale, rotation, opacity, colour }) {
  [...mean, ...scale, ...rotation, opacity, ...colour].forEach((array, i) => {
    const texture = container.getTexture(STREAMS[i]);
    texture.lock().set(array);
    texture.unlock();
  });
  setCenters(container, mean, n);
  container.aabb.copy(bounds(mean, n));
  container.update(n);
}
