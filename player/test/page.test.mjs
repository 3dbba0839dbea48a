// page.test.mjs - what the page knows without a browser: chunks, cameras, time.
// SPDX-License-Identifier: BSD-2-Clause
import assert from "node:assert/strict";
import { test } from "node:test";
import { centreOf, fitted, forward, lookingAt, orbited } from "../page/camera.js";
import { bytesByType, camerasOf, chunksOf, metaOf } from "../page/chunks.js";
import { Clock } from "../page/clock.js";
import { Evaluators } from "../page/evaluators.js";
import { cameraOnPath, placeOnPath } from "../page/path.js";
import { depthAhead, startCamera } from "../page/start.js";

const IDENTITY = [1, 0, 0, 0, 1, 0, 0, 0, 1];

function chunk(type, payload) {
  const bytes = new Uint8Array(12 + payload.length + 8); // the hash is the decoder's to check
  bytes.set(new TextEncoder().encode(type));
  new DataView(bytes.buffer).setUint32(8, payload.length, true);
  bytes.set(payload, 12);
  return bytes;
}

function file(...chunks) {
  return new Uint8Array([...new Uint8Array(12), ...chunks.flatMap((bytes) => [...bytes])]);
}

// With n cameras, 0 or 1.
function cams({
  up = [0, 0, 1], kind = 0, n = 1, R = IDENTITY, width = 640, num = 1, den = 4,
} = {}) {
  const view = new DataView(new ArrayBuffer(100));
  up.forEach((v, i) => view.setFloat32(4 * i, v, true));
  view.setUint32(12, kind, true);
  view.setUint32(16, n, true);
  view.setUint32(20, width, true);
  view.setUint32(24, 480, true);
  [500, 500, 320, 240, ...R, 1, 2, 3].forEach((v, i) => view.setFloat32(28 + 4 * i, v, true));
  view.setUint32(92, num, true);
  view.setUint32(96, den, true);
  return chunk("CAMS", new Uint8Array(view.buffer, 0, 20 + 80 * n));
}

test("chunks of a type are counted together, frames included", () => {
  const rows = bytesByType(chunksOf(file(chunk("TILE", [1, 2]), chunk("TILE", [3]))));
  assert.deepEqual(rows, [{ type: "TILE", count: 2, bytes: 43 }]);
});

test("META is lines of key and value", () => {
  const meta = metaOf(chunksOf(file(chunk("META", new TextEncoder().encode("title=a=b\n")))));
  assert.deepEqual([...meta], [["title", "a=b"]]);
});

test("CAMS gives up and cameras", () => {
  const { up, cameras, path } = camerasOf(chunksOf(file(cams())));
  assert.deepEqual(up, [0, 0, 1]);
  assert.deepEqual(path, []);
  assert.deepEqual(cameras, [{
    width: 640, height: 480, fx: 500, fy: 500, cx: 320, cy: 240, R: IDENTITY, t: [1, 2, 3],
    num: 1, den: 4,
  }]);
});

test("of each kind the last CAMS counts", () => {
  const { cameras, path } = camerasOf(chunksOf(
    file(cams({ width: 1 }), cams({ width: 2 }), cams({ kind: 1, width: 3 }))));
  assert.deepEqual([...cameras, ...path].map(({ width }) => width), [2, 3]);
});

test("a CAMS without cameras leaves those before it", () => {
  const { up, cameras } = camerasOf(chunksOf(file(cams(), cams({ up: [1, 0, 0], n: 0 }))));
  assert.deepEqual([up, cameras.length], [[1, 0, 0], 1]);
});

for (const [what, change] of [
  ["an up that is too long", { up: [0, 0, 2] }], ["an unknown kind", { kind: 2 }],
  ["no rotation", { R: [1, 0, 0, 0, 1, 0, 0, 0, 2] }],
  ["a mirror image", { R: [1, 0, 0, 0, 1, 0, 0, 0, -1] }], ["no width", { width: 0 }],
  ["a time after the end", { num: 5 }], ["a time of no time", { den: 0 }],
  ["a time that is no query", { den: 2 ** 24 }], ["an up that is no number", { up: [NaN, 0, 0] }],
]) {
  test(`CAMS with ${what} is ignored as a whole`, () => {
    const { up, cameras } = camerasOf(chunksOf(file(cams(change))));
    assert.deepEqual([up, cameras], [null, []]);
  });
}

test("CAMS of another size than it says is ignored", () => {
  assert.deepEqual(camerasOf(chunksOf(file(chunk("CAMS", new Uint8Array(21))))).cameras, []);
  assert.deepEqual(camerasOf(chunksOf(file(chunk("CAMS", new Uint8Array(0))))).cameras, []);
});

function played(clock, milliseconds) {
  clock.play(0);
  clock.advance(milliseconds);
  return clock.position;
}

test("time goes on by rate and speed, and loops after the last frame has been shown", () => {
  const clock = new Clock();
  clock.reset(10, 5);
  assert.equal(played(clock, 1000), 5);
  clock.reset(10, 5);
  assert.equal(played(clock, 1900), 9);
  clock.reset(10, 5);
  assert.equal(played(clock, 2200), 1);
  clock.reset(10, 5);
  clock.speed = 0.5;
  assert.equal(played(clock, 1000), 2.5);
});

test("without a loop time stops at the last frame, and starts again from the first", () => {
  const clock = new Clock();
  clock.reset(10, 5);
  clock.isLooping = false;
  assert.equal(played(clock, 5000), 9);
  assert.equal(clock.isPlaying, false);
  assert.equal(played(clock, 200), 1);
});

test("steps go to whole frames and stay within the scene", () => {
  const clock = new Clock();
  clock.reset(10, 5);
  clock.seek(2.5);
  clock.step(1);
  assert.equal(clock.position, 3);
  clock.seek(2.5);
  clock.step(-1);
  assert.equal(clock.position, 2);
  clock.step(-5);
  assert.equal(clock.position, 0);
});

test("queries of whole frames are exact, and a single frame has time 0", () => {
  const clock = new Clock();
  clock.reset(10, 5);
  clock.seek(3);
  const { num, den } = clock.query;
  assert.equal(num * 9, 3 * den);
  clock.reset(1, 5);
  assert.deepEqual(clock.query, { num: 0, den: 1 });
});

test("the time of a query is exact until another one is sought", () => {
  const clock = new Clock();
  clock.reset(10, 5);
  clock.seekTo({ num: 1, den: 7 });
  assert.deepEqual([clock.query, clock.position], [{ num: 1, den: 7 }, 9 / 7]);
  clock.seekTo({ num: 0, den: 0 });
  assert.deepEqual(clock.query, { num: 1, den: 7 });
  assert.equal(played(clock, 0), 9 / 7);
  assert.deepEqual(clock.query, { num: 5, den: 36 });
  clock.seekTo({ num: 1, den: 7 });
  clock.seek(9);
  assert.deepEqual(clock.query, { num: 1, den: 1 });
  clock.seekTo({ num: 1, den: 7 });
  clock.reset(10, 5);
  assert.deepEqual(clock.query, { num: 0, den: 1 });
});

function near(actual, expected) {
  actual.forEach((v, i) => assert.ok(Math.abs(v - expected[i]) < 1e-9, `${actual}`));
}

const camera = lookingAt({ width: 4, height: 2, fx: 3, fy: 3, cx: 2, cy: 1 }, [0, -5, 1],
  [0, 0, 1], [0, 0, 1]);

test("a camera looks at its target, with up upwards", () => {
  near(centreOf(camera), [0, -5, 1]);
  near(forward(camera), [0, 1, 0]);
  near(camera.R.slice(3, 6), [0, 0, -1]);
});

test("orbiting keeps the pivot before the camera, and stops below the pole", () => {
  let turned = orbited(camera, [0, 0, 1], [0, 0, 1], 0.5, 0);
  near(forward(turned), centreOf(turned).map((v, i) => ([0, 0, 1][i] - v) / 5));
  for (let i = 0; i < 100; i++) turned = orbited(turned, [0, 0, 1], [0, 0, 1], 0, -0.1);
  assert.ok(Math.abs(forward(turned)[2]) < 1);
  assert.ok(Math.abs(forward(turned)[2]) > 0.9);
});

test("a picture of other sides shows all of the old one", () => {
  const { fx, cx, cy, width, height } = fitted(camera, 8, 8);
  assert.deepEqual([fx, cx, cy, width, height], [6, 4, 4, 8, 8]);
});

const timed = (...times) => times.map(([num, den]) => ({ num, den }));

test("keys of a path belong to their times", () => {
  const path = timed([1, 4], [2, 4], [2, 4], [4, 4]);
  assert.deepEqual([0, 0.25, 0.375, 0.5, 0.75, 1].map((t) => placeOnPath(path, t)),
    [0, 0, 0.5, 2, 2.5, 3]);
  assert.equal(placeOnPath(timed([1, 4]), 0.7), 0);
});

test("keys without times, or with times that decrease, share out the whole time", () => {
  for (const path of [timed([0, 1], [1, 0], [1, 1]), timed([0, 1], [1, 1], [1, 2])])
    assert.deepEqual([0, 0.25, 1].map((t) => placeOnPath(path, t)), [0, 0.5, 2]);
});

test("a camera on a path is at its keys, and between them on a smooth way", () => {
  const lens = { width: 4, height: 2, fx: 3, fy: 3, cx: 2, cy: 1 };
  const eyes = [[0, -5, 1], [5, 0, 1], [0, 5, 1]];
  const path = eyes.map((eye) => lookingAt(lens, eye, [0, 0, 1], [0, 0, 1]));
  path[2] = { ...path[2], width: 8, height: 4, fx: 12, fy: 12, cx: 4, cy: 2 };
  eyes.forEach((eye, i) => {
    near(centreOf(cameraOnPath(path, i)), eye);
    near(cameraOnPath(path, i).R, path[i].R);
  });
  near(forward(cameraOnPath(path, 0.5)), [-Math.SQRT1_2, Math.SQRT1_2, 0]);
  near(centreOf(cameraOnPath(path, 0.5)), [2.8125, -2.8125, 1]);
  assert.deepEqual([0.5, 1.5, 2].map((place) => cameraOnPath(path, place).fx), [3, 4.5, 6]);
  near(cameraOnPath(path.slice(0, 1), 0).R, path[0].R);
});

test("of many Gaussians at most 4096 say where a viewer begins", () => {
  for (const n of [1, 4096, 6000, 8191, 8193]) {
    const looked = new Set(), values = new Float32Array(n).map((_, i) => i / n);
    const opacity = new Proxy(new Float32Array(n).fill(1), {
      get(array, i) {
        looked.add(i);
        return array[i];
      },
    });
    const g = { n, opacity, mean: [values, values, values] };
    const { distance } = startCamera(g, [0, -1, 0], { origin: [0, 0, 0], exponent: 0 });
    assert.ok(looked.size <= 4096 && looked.size > Math.min(n, 4096) / 2, `${looked.size}`);
    assert.ok(n === 1 || Math.abs(distance - 2.2 * 0.4) < 0.01, `${distance}`);
  }
});

test("where nothing shows at the first time, a viewer begins before the whole scene", () => {
  const info = { origin: [1, 2, 3], exponent: 4 };
  const faint = { n: 2, opacity: [0.05, 0.1], mean: [[5, 6], [5, 6], [5, 6]] };
  const none = { n: 0, opacity: [], mean: [[], [], []] };
  for (const g of [faint, none]) {
    const { camera, distance } = startCamera(g, [0, -1, 0], info);
    assert.equal(distance, 2.2 * 16);
    const centre = centreOf(camera);
    near([Math.hypot(...centre.map((v, i) => v - info.origin[i]))], [distance]);
    near(forward(camera), info.origin.map((v, i) => (v - centre[i]) / distance));
    assert.equal(depthAhead({ R: IDENTITY, t: [0, 0, 0] }, g), undefined);
  }
  // What shows is at one place, which does not say how far to go back.
  const alone = { n: 3, opacity: [0, 1, 0], mean: [[5, 6, 7], [5, 6, 7], [5, 6, 7]] };
  const { camera, distance } = startCamera(alone, [0, -1, 0], info);
  assert.equal(distance, 2.2 * 16);
  near([Math.hypot(...centreOf(camera).map((v) => v - 6))], [distance]);
});

test("a module that could not be loaded is loaded again for the next file", async () => {
  let loads = 0;
  const worker = {
    postMessage({ call, type }) {
      const answer = type === "load" && loads++ < 2 ? { error: { message: "503" } }
        : { value: { info: {} } };
      setTimeout(() => this.onmessage({ data: { call, ...answer } }));
    },
  };
  const evaluators = new Evaluators([worker], "http://localhost/ted4.wasm");
  // Nobody has asked for a file yet, so that nobody is to hear of it.
  await new Promise((resolve) => { setTimeout(resolve, 20); });
  await assert.rejects(evaluators.open(new Uint8Array(1)), { message: "503" });
  assert.ok((await evaluators.open(new Uint8Array(1))).scene);
  assert.ok((await evaluators.open(new Uint8Array(1))).scene);
  assert.equal(loads, 3);
});
