// path.js - a camera along the path of a file (spec 16.4), as ted4dec --path moves it: centres
// follow a Catmull-Rom spline, rotations go the shortest way (slerp), lenses change linearly.
// SPDX-License-Identifier: BSD-2-Clause
import { centreOf, placed } from "./camera.js";

// The unit quaternion w x y z of a rotation, from the largest of its four squares.
function quaternionOf([a, b, c, d, e, f, g, h, i]) {
  const rows = [
    [1 + a + e + i, h - f, c - g, d - b], [h - f, 1 + a - e - i, b + d, c + g],
    [c - g, b + d, 1 - a + e - i, f + h], [d - b, c + g, f + h, 1 - a - e + i],
  ];
  const largest = rows.reduce((best, row, k) => (row[k] > rows[best][best] ? k : best), 0);
  return rows[largest].map((v) => v / Math.hypot(...rows[largest]));
}

function rotationOf([w, x, y, z]) {
  return [
    1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),
    2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
    2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y),
  ];
}

function slerp(a, b, u) {
  const cosine = a.reduce((sum, v, k) => sum + v * b[k], 0), sign = cosine < 0 ? -1 : 1;
  const angle = Math.acos(Math.min(Math.abs(cosine), 1));
  const weight = (part) => (angle > 1e-6 ? Math.sin(part * angle) / Math.sin(angle) : part);
  const sum = a.map((v, k) => weight(1 - u) * v + sign * weight(u) * b[k]);
  return sum.map((v) => v / Math.hypot(...sum));
}

// Catmull-Rom between the middle two of four numbers.
function spline([a, b, c, d], u) {
  return b + 0.5 * u * (c - a + u * (2 * a - 5 * b + 4 * c - d + u * (3 * (b - c) + d - a)));
}

// The lens of a key in pixels of the path's first key.
function lensOf(key, { width, height }) {
  const x = width / key.width, y = height / key.height;
  return [key.fx * x, key.fy * y, key.cx * x, key.cy * y];
}

// Where on the path a time is: from 0 at the first key to path.length - 1. time: from 0 at the
// first frame to 1 at the last. Keys belong to the times that they have, if all have one and these
// do not decrease; otherwise they share out the whole time evenly.
export function placeOnPath(path, time) {
  const times = path.map(({ num, den }) => num / den);
  const isTimed = path.every(({ den }, i) => den > 0 && (i === 0 || times[i] >= times[i - 1]));
  if (!isTimed) return time * (path.length - 1);
  const next = times.findIndex((t) => t > time);
  if (next === 0) return 0;
  if (next < 0) return path.length - 1;
  return next - 1 + (time - times[next - 1]) / (times[next] - times[next - 1]);
}

// The camera at a place on the path (placeOnPath).
export function cameraOnPath(path, place) {
  const last = path.length - 1;
  const from = Math.min(Math.floor(place), Math.max(last - 1, 0)), u = place - from;
  const key = (i) => path[Math.min(Math.max(i, 0), last)];
  const centres = [-1, 0, 1, 2].map((i) => centreOf(key(from + i)));
  const centre = [0, 1, 2].map((k) => spline(centres.map((c) => c[k]), u));
  const [a, b] = [key(from), key(from + 1)], { width, height } = path[0];
  const wide = lensOf(b, path[0]);
  const [fx, fy, cx, cy] = lensOf(a, path[0]).map((v, k) => v + u * (wide[k] - v));
  const R = rotationOf(slerp(quaternionOf(a.R), quaternionOf(b.R), u));
  return placed({ width, height, fx, fy, cx, cy }, R, centre);
}
