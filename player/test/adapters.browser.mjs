// adapters.browser.mjs - each adapter shows a file in headless Chromium with its pinned package.
// SPDX-License-Identifier: BSD-2-Clause
import assert from "node:assert/strict";
import { basename, dirname, join } from "node:path";
import { after, before, test } from "node:test";
import { lookingAt } from "../page/camera.js";
import { Browser } from "./browser.mjs";
import { CAMERA, PLAYER, rendered, SCENE, SMALL, SMALL_CAMERA, withPixel } from "./fixture.mjs";
import { psnr } from "./pictures.mjs";
import { serve } from "./server.mjs";

const FRAMES = [3, 12], LAST = 15;
let browser, server;

before(async () => {
  server = await serve(join(PLAYER, "adapters"), PLAYER, dirname(SCENE));
  browser = new Browser();
});

after(async () => {
  await browser?.close();
  server?.close();
});

// Decibels of the adapter's pictures at two times.
async function shown(t, adapter, { option = "", camera = CAMERA, scene = SCENE } = {}) {
  const page = await browser.page(camera.width, camera.height);
  await page.open(`${server.origin}/?adapter=${adapter}&file=${basename(scene)}${option}`);
  const decibels = [];
  for (const frame of FRAMES) {
    await page.evaluate(`show(${JSON.stringify(camera)}, ${frame})`);
    decibels.push(await psnr(page, await page.screenshot(), rendered(frame / LAST, camera, scene)));
  }
  t.diagnostic(`${adapter}${option}, pixels ${camera.pixel} times as wide: ` +
    `${decibels.map((v) => v.toFixed(1)).join(", ")} dB`);
  assert.deepEqual(page.errors, []);
  return { page, least: Math.min(...decibels) };
}

test("PlayCanvas: a GSplatContainer", async (t) => {
  assert.ok((await shown(t, "playcanvas")).least >= 40);
});

test("PlayCanvas: a GSplatContainer, drawn by its own shaders", async (t) => {
  const camera = { ...CAMERA, pixel: 1 }; // they know nothing of annex I.4
  assert.ok((await shown(t, "playcanvas", { option: "&plain", camera })).least >= 20);
});

test("PlayCanvas and Spark: wide pixels", async (t) => {
  const camera = withPixel(2);
  assert.ok((await shown(t, "playcanvas", { camera })).least >= 40);
  assert.ok((await shown(t, "spark", { camera })).least >= 30);
});

// Some Gaussians are behind the camera, beside it, or larger than the picture.
test("PlayCanvas and Spark: amid the Gaussians, in a small window and a large one", async (t) => {
  const amid = (lens) => lookingAt(lens, [-0.1, -0.4, 0.4], [0, 0, 0.3], [0, 0, 1]);
  assert.ok((await shown(t, "playcanvas", { camera: amid(CAMERA) })).least >= 40);
  assert.ok((await shown(t, "spark", { camera: amid(withPixel(1 / 8)) })).least >= 30);
});

test("PlayCanvas and Spark: a scene of a millionth of the size", async (t) => {
  const small = { camera: SMALL_CAMERA, scene: SMALL };
  assert.ok((await shown(t, "playcanvas", small)).least >= 40);
  assert.ok((await shown(t, "spark", small)).least >= 30);
});

test("SuperSplat: a FrameSource", async (t) => {
  const { page, least } = await shown(t, "supersplat");
  assert.ok(least >= 40);
  assert.equal(await page.evaluate("frameCount"), LAST + 1);
  assert.deepEqual(await page.evaluate("rotation"), [0, 0, 1, 0]);
});

test("Spark: PackedSplats", async (t) => {
  assert.ok((await shown(t, "spark")).least >= 30);
});
