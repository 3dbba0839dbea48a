// camera.js - cameras of annex I as plain objects, { width, height, fx, fy, cx, cy, R, t }, and the
// motions of a viewer. A point x of the world lies at R x + t, with axes right, down, forward; R is
// row by row.
// SPDX-License-Identifier: BSD-2-Clause

const STEEPEST = 0.999; // cosine of the angle between the view and up, at most

export const add = (a, b) => a.map((v, i) => v + b[i]);
export const scaled = (a, s) => a.map((v) => v * s);
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) =>
  [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const unit = (a) => scaled(a, 1 / Math.hypot(...a));

export const right = ({ R }) => R.slice(0, 3);
export const down = ({ R }) => R.slice(3, 6);
export const forward = ({ R }) => R.slice(6, 9);

// -R^T t
export function centreOf({ R, t }) {
  return [0, 1, 2].map((j) => -(R[j] * t[0] + R[3 + j] * t[1] + R[6 + j] * t[2]));
}

// The camera with these axes at this place.
export function placed(camera, R, centre) {
  const t = [0, 3, 6].map((row) => -dot(R.slice(row, row + 3), centre));
  return { ...camera, R, t };
}

// The camera at a place, looking at another one.
export function lookingAt(camera, centre, target, up) {
  const ahead = unit(add(target, scaled(centre, -1)));
  const side = unit(cross(ahead, up));
  return placed(camera, [...side, ...cross(ahead, side), ...ahead], centre);
}

export function moved(camera, offset) {
  return placed(camera, camera.R, add(centreOf(camera), offset));
}

// v turned about a unit axis (Rodrigues).
function turned(v, axis, angle) {
  const c = Math.cos(angle), s = Math.sin(angle);
  return add(add(scaled(v, c), scaled(cross(axis, v), s)), scaled(axis, dot(axis, v) * (1 - c)));
}

// The camera turned about a pivot: by yaw about up, and by pitch about its own right axis, but not
// over the pole.
export function orbited(camera, pivot, up, yaw, pitch) {
  const tilted = turned(forward(camera), right(camera), pitch);
  const steep = Math.abs(dot(tilted, up)) > STEEPEST &&
    Math.abs(dot(tilted, up)) > Math.abs(dot(forward(camera), up));
  const axis = right(camera);
  const turn = (v) => turned(steep ? v : turned(v, axis, pitch), up, yaw);
  const R = [...turn(right(camera)), ...turn(down(camera)), ...turn(forward(camera))];
  const arm = add(centreOf(camera), scaled(pivot, -1));
  return placed(camera, R, add(pivot, turn(arm)));
}

// The same view in a picture of other sides, with all of the old one in it.
export function fitted(camera, width, height) {
  const s = Math.min(width / camera.width, height / camera.height);
  return {
    ...camera, width, height, fx: camera.fx * s, fy: camera.fy * s,
    cx: width / 2 + (camera.cx - camera.width / 2) * s,
    cy: height / 2 + (camera.cy - camera.height / 2) * s,
  };
}
