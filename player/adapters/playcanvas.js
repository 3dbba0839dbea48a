// playcanvas.js - the Gaussians of a time as a GSplatContainer of PlayCanvas, in binary32 as the
// decoder gives them. Axes of the world stay right, down, forward; turn the entity if y is up.
// SPDX-License-Identifier: BSD-2-Clause
import {
  BoundingBox, GSplatContainer, GSplatFormat, PIXELFORMAT_RGBA32F, Vec3,
} from "playcanvas";

const STREAMS = ["dataCenter", "dataScale", "dataRotation", "dataColor"];
// Opacity travels in the fourth value of the centre; rotations are w, x, y, z as PlayCanvas wants.
const READ_GLSL = `
vec3 getCenter() { return loadDataCenter().xyz; }
vec4 getColor() { return vec4(loadDataColor().rgb, loadDataCenter().w); }
vec3 getScale() { return loadDataScale().xyz; }
vec4 getRotation() { return loadDataRotation(); }
`;
const READ_WGSL = `
fn getCenter() -> vec3f { return loadDataCenter().xyz; }
fn getColor() -> vec4f { return vec4f(loadDataColor().rgb, loadDataCenter().w); }
fn getScale() -> vec3f { return loadDataScale().xyz; }
fn getRotation() -> vec4f { return loadDataRotation(); }
`;

// A container for n Gaussians.
export function createContainer(device, n) {
  const streams = STREAMS.map((name) => ({ name, format: PIXELFORMAT_RGBA32F }));
  const format = new GSplatFormat(device, streams,
    { readGLSL: READ_GLSL, readWGSL: READ_WGSL });
  return new GSplatContainer(device, n, format);
}

function interleave(target, stride, arrays, n) {
  arrays.forEach((array, c) => {
    for (let i = 0, at = c; i < n; i++, at += stride) target[at] = array[i];
  });
}

function upload(container, name, arrays, n) {
  const texture = container.getTexture(name);
  interleave(texture.lock(), 4, arrays, n);
  texture.unlock();
}

// PlayCanvas sorts between the bounds of all centres.
function bounds(mean, n) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  mean.forEach((array, c) => {
    for (let i = 0; i < n; i++) {
      if (array[i] < low[c]) low[c] = array[i];
      if (array[i] > high[c]) high[c] = array[i];
    }
  });
  const box = new BoundingBox();
  box.setMinMax(new Vec3(low), new Vec3(high));
  return box;
}

// Puts Gaussians (Scene.gaussians, ClientScene.gaussians) into the container. moved: false if only
// colours and opacities differ from those before.
export function updateContainer(container, g, moved = true) {
  upload(container, "dataColor", g.colour, g.n);
  upload(container, "dataCenter", [...g.mean, g.opacity], g.n);
  upload(container, "dataScale", g.scale, g.n);
  upload(container, "dataRotation", g.rotation, g.n);
  if (moved) {
    interleave(container.centers, 3, g.mean, g.n);
    container.aabb.copy(bounds(g.mean, g.n));
  }
  container.update(g.n, moved);
}
