// fixture.mjs - what tests in a browser share: the trained file that `make test-player` names, a
// camera for it, and the decoder's own pictures of that.
// SPDX-License-Identifier: BSD-2-Clause
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { lookingAt } from "../page/camera.js";

export function needed(name) {
  const value = process.env[name];
  if (value === undefined) throw new Error(`${name} is not set: run make test-player`);
  return value;
}

export const SCENE = needed("TED4_SCENE"); // a .ted4 file of the scene "occluder", z up
export const SMALL = needed("TED4_SMALL"); // of the same scene at a millionth of the size
export const PLAYER = needed("TED4_PLAYER"); // folder of the built player
const PROGRAMS = needed("TED4_PROGRAMS"); // folder of ted4dec and ted4edit
export const OUT = process.env.TED4_OUT ?? mkdtempSync(join(tmpdir(), "ted4-player-"));

// Twice as many pixels each way as the pictures of which the scene was learnt.
const LENS = { width: 320, height: 240, fx: 320, fy: 320, cx: 160, cy: 120, pixel: 0.5 };
export const CAMERA = lookingAt(LENS, [-1.3, -3.2, 1.9], [0, 0, 0.3], [0, 0, 1]);

// The same view of SMALL.
export const SMALL_CAMERA = { ...CAMERA, t: CAMERA.t.map((v) => 1e-6 * v) };

// The same view in pixels r times as wide as those of training (annex I.4).
export function withPixel(r) {
  const s = CAMERA.pixel / r, { width, height, fx, fy, cx, cy } = CAMERA;
  return { ...CAMERA, width: width * s, height: height * s, fx: fx * s, fy: fy * s, cx: cx * s,
    cy: cy * s, pixel: r };
}

export function decode(...args) {
  return execFileSync(join(PROGRAMS, "ted4dec"), args, { encoding: "utf8" });
}

export function edit(...args) {
  execFileSync(join(PROGRAMS, "ted4edit"), args);
}

// The PNG, base64, of the camera at a time, by the decoder.
export function rendered(time, camera = CAMERA, scene = SCENE) {
  const list = join(OUT, "camera.json"), picture = join(OUT, "rendered.png");
  writeFileSync(list, JSON.stringify([{ ...camera, time }]));
  decode(scene, "--render", picture, "--camera", list, "-f", "-q");
  return readFileSync(picture).toString("base64");
}

export function keep(name, base64) {
  writeFileSync(join(OUT, name), Buffer.from(base64, "base64"));
}
