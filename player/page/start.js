// start.js - where a viewer begins, for files that list no cameras.
// SPDX-License-Identifier: BSD-2-Clause
import { lookingAt } from "./camera.js";

const WIDTH = 960, HEIGHT = 540, FOCAL = 800; // pixels
const SAMPLES = 4096; // Gaussians that are looked at, at most
const VISIBLE = 0.1; // opacity of those that count
const DISTANCE = 2.2; // from the middle, in spreads
const LEAST = 1e-6; // part of the scene that is a spread
const SLANT = [0.35, -0.9]; // how far aside and back

// Median, and the distance within which the middle 80 percent lie.
function middle(values) {
  const sorted = values.sort((a, b) => a - b);
  const at = (part) => sorted[Math.min(sorted.length - 1, Math.floor(part * sorted.length))];
  return { centre: at(0.5), spread: (at(0.9) - at(0.1)) / 2 };
}

// Numbers of Gaussians that show; none, perhaps.
function samples(g) {
  const step = Math.max(1, Math.ceil(g.n / SAMPLES));
  const indices = [];
  for (let i = 0; i < g.n; i += step) if (g.opacity[i] > VISIBLE) indices.push(i);
  return indices;
}

// Where the Gaussians that show are, and how far apart. Where that says nothing, as in a scene that
// fades in, the bounds of the scene do.
function extent(g, { origin, exponent }) {
  const indices = samples(g), reach = 2 ** exponent;
  if (indices.length === 0) return { target: origin, spread: reach };
  const parts = g.mean.map((array) => middle(indices.map((i) => array[i])));
  const spread = Math.max(...parts.map((part) => part.spread));
  return {
    target: parts.map(({ centre }) => centre), spread: spread > LEAST * reach ? spread : reach,
  };
}

// Some direction at a right angle to up.
function aside(up) {
  const least = up.map(Math.abs).indexOf(Math.min(...up.map(Math.abs)));
  const v = up.map((u, i) => (i === least ? 1 : 0) - u * up[least]);
  return v.map((x) => x / Math.hypot(...v));
}

// { camera, distance } that shows most of the Gaussians. info: of the file.
export function startCamera(g, up, info) {
  const { target, spread } = extent(g, info);
  const distance = DISTANCE * spread;
  const a = aside(up);
  const b = [up[1] * a[2] - up[2] * a[1], up[2] * a[0] - up[0] * a[2], up[0] * a[1] - up[1] * a[0]];
  const way = up.map((u, i) => 0.3 * u + SLANT[0] * a[i] + SLANT[1] * b[i]);
  const centre = target.map((v, i) => v + distance * way[i] / Math.hypot(...way));
  const lens = { width: WIDTH, height: HEIGHT, fx: FOCAL, fy: FOCAL, cx: WIDTH / 2,
    cy: HEIGHT / 2 };
  return { camera: lookingAt(lens, centre, target, up), distance };
}

// How far ahead of a camera the scene is: the median depth of what shows before it; undefined where
// nothing does.
export function depthAhead({ R, t }, g) {
  const depths = samples(g)
    .map((i) => R[6] * g.mean[0][i] + R[7] * g.mean[1][i] + R[8] * g.mean[2][i] + t[2])
    .filter((z) => z > 0);
  return depths.length > 0 ? middle(depths).centre : undefined;
}
