// conversions.mjs - splat-transform of PlayCanvas takes what ted4dec exports: it turns a sequence
// of .ply into .spz and .sog and reads these and our .splat back, and its .glb holds what ours
// does. What comes back differs by no more than the quantisation of the format.
// SPDX-License-Identifier: BSD-2-Clause
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { before, test } from "node:test";
import { decode, needed, OUT, SCENE } from "./fixture.mjs";

const TRANSFORM = join(needed("TED4_MODULES"), ".bin/splat-transform");
const FRAMES = [0, 8];
const POSITION = ["x", "y", "z"], COLOUR = ["f_dc_0", "f_dc_1", "f_dc_2"];
const SCALE = ["scale_0", "scale_1", "scale_2"];
const ROUNDING = 1.01; // of binary32, in front of bounds
const at = (name) => join(OUT, name);
const visibility = (logit) => 1 / (1 + Math.exp(-logit));
const isVisible = (logit) => visibility(logit) > 1 / 255;

function transform(from, to, ...options) {
  execFileSync(TRANSFORM, ["-q", "-w", "-g", "cpu", "--max-workers", "0", at(from), ...options,
    at(to)], { stdio: ["ignore", "ignore", "inherit"] });
}

// The columns of a PLY file of floats by name.
function readPly(name) {
  const bytes = readFileSync(at(name)), end = bytes.indexOf("end_header\n") + 11;
  const header = bytes.subarray(0, end).toString("latin1");
  const n = Number(/element vertex (\d+)/.exec(header)[1]);
  const names = [...header.matchAll(/property float (\S+)/g)].map(([, column]) => column);
  const floats = new Float32Array(bytes.buffer.slice(bytes.byteOffset + end));
  assert.equal(floats.length, n * names.length);
  return Object.fromEntries(names.map((column, k) =>
    [column, Array.from({ length: n }, (_, i) => floats[i * names.length + k])]));
}

// The accessors of a GLB file's only primitive that hold floats, by the end of their names.
function readGlb(name) {
  const bytes = readFileSync(at(name)), size = bytes.readUInt32LE(12);
  const json = JSON.parse(bytes.subarray(20, 20 + size).toString());
  const start = bytes.byteOffset + 20 + size + 8, wide = { SCALAR: 1, VEC3: 3, VEC4: 4 };
  const found = Object.entries(json.meshes[0].primitives[0].attributes).map(([key, index]) => {
    const { bufferView, byteOffset = 0, count, type, componentType } = json.accessors[index];
    if (componentType !== 5126) return [key, null];
    const from = start + (json.bufferViews[bufferView].byteOffset ?? 0) + byteOffset;
    const floats = bytes.buffer.slice(from, from + 4 * count * wide[type]);
    return [key.split(":").at(-1), [...new Float32Array(floats)]];
  });
  return Object.fromEntries(found);
}

// The largest of |a[i] - b[i]| where where(i).
function farthest(a, b, where = () => true) {
  assert.equal(a.length, b.length);
  return a.reduce((most, v, i) => (where(i) ? Math.max(most, Math.abs(v - b[i])) : most), 0);
}

function within(a, b, bound, what, where) {
  const error = farthest(a, b, where);
  assert.ok(error <= ROUNDING * bound, `${what}: ${error}, bound ${bound}`);
}

const range = (a) => a.reduce((most, v) => Math.max(most, v), -Infinity) -
  a.reduce((least, v) => Math.min(least, v), Infinity);

before(() => {
  for (const format of ["ply", "splat", "glb"])
    decode(SCENE, "-o", at(`frame_%d.${format}`), "--frames", "0:9:8", "--sh-degree", "0", "-f",
      "-q");
});

// Positions have 12 bits after the point, colours steps of 1 / (0.15 255), opacities 8 bits,
// logarithms of scales steps of 1/16 from -10 to 5.9.
function checkSpz(ours, back) {
  const inside = (a) => a.map((v) => Math.min(Math.max(v, -10), 255 / 16 - 10));
  for (const key of POSITION) within(back[key], ours[key], 2 ** -13, key);
  for (const key of COLOUR) within(back[key], ours[key], 0.5 / (0.15 * 255), key);
  for (const key of SCALE) within(inside(back[key]), inside(ours[key]), 1 / 32, key);
  within(back.opacity.map(visibility), ours.opacity.map(visibility), 0.5 / 255, "opacity");
}

for (const version of [3, 4]) {
  test(`.spz, version ${version}, of every frame comes back`, () => {
    for (const frame of FRAMES) {
      transform(`frame_${frame}.ply`, `frame_${frame}.spz`, "--spz-version", String(version));
      transform(`frame_${frame}.spz`, "back.ply");
      checkSpz(readPly(`frame_${frame}.ply`), readPly("back.ply"));
    }
  });
}

// Positions have 16 bits of sign(x) log(1 + |x|) between the ends of their axis, and opacities 8,
// both cut off; colours are entries of a codebook of 256, no worse than as many even steps.
// Gaussians that nobody sees lose their colours.
function checkSog(ours, back) {
  const logarithm = (a) => a.map((v) => Math.sign(v) * Math.log1p(Math.abs(v)));
  const sees = (i) => isVisible(ours.opacity[i]);
  for (const key of POSITION) {
    const logs = logarithm(ours[key]);
    within(logarithm(back[key]), logs, range(logs) / 65535, key);
  }
  for (const key of COLOUR) {
    const errors = ours[key].map((v, i) => v - back[key][i]).filter((_, i) => sees(i));
    const mean = Math.sqrt(errors.reduce((sum, e) => sum + e * e, 0) / errors.length);
    const bound = range(ours[key].filter((_, i) => sees(i))) / 256 / Math.sqrt(12);
    assert.ok(mean <= bound, `${key}: ${mean}, bound ${bound}`);
  }
  within(back.opacity.map(visibility), ours.opacity.map(visibility), 1 / 255, "opacity", sees);
}

test(".sog of every frame comes back", () => {
  for (const frame of FRAMES) {
    // .sog sorts by Morton codes; sorted before, its order is ours.
    transform(`frame_${frame}.ply`, "sorted.ply", "-M");
    transform("sorted.ply", `frame_${frame}.sog`);
    transform(`frame_${frame}.sog`, "back.ply");
    const ours = readPly(`frame_${frame}.ply`), sorted = readPly("sorted.ply");
    for (const key of [...POSITION, ...COLOUR])
      assert.deepEqual([...sorted[key]].sort(), [...ours[key]].sort());
    checkSog(sorted, readPly("back.ply"));
  }
});

test("our .splat is read as it was written", () => {
  for (const frame of FRAMES) {
    const bytes = readFileSync(at(`frame_${frame}.splat`)), n = bytes.length / 32;
    transform(`frame_${frame}.splat`, "back.ply");
    const back = readPly("back.ply");
    const column = (read) => Array.from({ length: n }, (_, i) => read(32 * i));
    POSITION.forEach((key, k) =>
      assert.deepEqual(back[key], column((from) => bytes.readFloatLE(from + 4 * k))));
    COLOUR.forEach((key, k) => within(back[key].map((v) => 0.5 + 0.28209479177387814 * v),
      column((from) => bytes[from + 24 + k] / 255), 1e-5, key));
    within(back.opacity.map(visibility), column((from) => bytes[from + 27] / 255), 1e-5, "opacity");
  }
});

// Both turn the file's axes, right, down, forward, so that y is up: ours about x, theirs about z.
test("our .glb holds what splat-transform's does", () => {
  for (const frame of FRAMES) {
    transform(`frame_${frame}.ply`, "theirs.glb");
    const ours = readGlb(`frame_${frame}.glb`), theirs = readGlb("theirs.glb");
    assert.deepEqual(Object.keys(ours).sort(), Object.keys(theirs).sort());
    const turned = theirs.POSITION.map((v, i) => (i % 3 === 1 ? v : -v));
    assert.deepEqual(ours.POSITION.map((v) => v + 0), turned.map((v) => v + 0));
    within(ours.OPACITY, theirs.OPACITY, 1e-6, "opacity");
    within(ours.SCALE, theirs.SCALE, 1e-6 * Math.max(1, range(ours.SCALE)), "scale");
    within(ours.SH_DEGREE_0_COEF_0, theirs.SH_DEGREE_0_COEF_0, 1e-6, "colour");
  }
});
