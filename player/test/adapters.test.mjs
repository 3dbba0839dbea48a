// adapters.test.mjs - adapters without a browser, with a PlayCanvas that only has the names. Run by
// `make player-test`. SPDX-License-Identifier: BSD-2-Clause
import assert from "node:assert/strict";
import { register } from "node:module";
import { test } from "node:test";

const STUB = "export class GSplatData { constructor(elements) { this.elements = elements; } } " +
  "export class Quat {} export class Vec3 {} " +
  "export const SHADERLANGUAGE_GLSL = 'glsl', ShaderChunks = null;";
register("data:text/javascript," + encodeURIComponent(`
  export async function resolve(name, context, next) {
    return name !== "playcanvas" ? next(name, context)
      : { url: "data:text/javascript," + encodeURIComponent(${JSON.stringify(STUB)}),
        shortCircuit: true };
  }`));
const { drawAsAnnexI } = await import("../adapters/playcanvas-kernel.js");
const { FrameSource, gsplatData } = await import("../adapters/supersplat.js");

// A promise that is rejected, and that nobody looks at, fails the test that runs.
test("a source may be destroyed after its client, whose scenes are gone by then", async () => {
  const close = async () => { throw new Error("the worker is terminated"); };
  new FrameSource({ info: { frames: 1 }, close }, () => null).destroy();
  await new Promise((resolve) => { setTimeout(resolve, 10); });
});

test("a source of a scene without close() may be destroyed", () => {
  new FrameSource({ info: { frames: 1 } }, () => null).destroy();
});

test("logarithms of opacities 0 and 1, and of a scale of 0, are finite", () => {
  const all = (n, ...v) => Array.from({ length: n }, () => Float32Array.from(v));
  const [{ properties }] = gsplatData({
    n: 2, mean: all(3, 0, 0), scale: all(3, 0, 2), rotation: all(4, 1, 1), opacity: all(1, 0, 1)[0],
    colour: all(3, 0, 1),
  }).elements;
  for (const { name, storage } of properties) assert.ok(storage.every(Number.isFinite), name);
});

test("shaders of WebGPU, which stay as they are, are refused", () => {
  assert.throws(() => drawAsAnnexI({ isWebGPU: true }), /WebGPU/);
});
