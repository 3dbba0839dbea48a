// controls.browser.mjs - the controls of the page in headless Chromium: moving, keys, what
// a screen reader hears, small windows, a lost drawing context.
// SPDX-License-Identifier: BSD-2-Clause
import assert from "node:assert/strict";
import { basename, dirname } from "node:path";
import { after, before, test } from "node:test";
import { Browser } from "./browser.mjs";
import { add, centreOf, dot, fitted, forward, scaled } from "../page/camera.js";
import { PLAYER, SCENE } from "./fixture.mjs";
import { psnr } from "./pictures.mjs";
import { serve } from "./server.mjs";

const WIDTH = 700, HEIGHT = 400; // with room for the panel on the right
let browser, server, page;

before(async () => {
  server = await serve(PLAYER, dirname(SCENE));
  browser = new Browser();
  page = await browser.page(WIDTH, HEIGHT);
  await page.open(`${server.origin}/?file=${basename(SCENE)}`);
  await page.until("globalThis.ted4Player?.isSettled");
});

after(async () => {
  await browser?.close();
  server?.close();
});

const frames = () => page.evaluate(`new Promise((resolve) =>
  requestAnimationFrame(() => requestAnimationFrame(resolve)))`);

async function navigation() {
  return page.evaluate(`(({ camera, distance }) => ({ camera, distance }))(ted4Player.navigation)`);
}

// Where a point of the world is in a window.
function seenAt(point, camera, width, height) {
  const { R, t, fx, fy, cx, cy } = fitted(camera, width, height);
  const [x, y, z] = [0, 3, 6].map((row, i) => dot(R.slice(row, row + 3), point) + t[i]);
  return [cx + fx * x / z, cy + fy * y / z];
}

test("the pivot stays under the pointer that moves the camera sideways", async () => {
  for (const [width, height, ratio] of
    [[320, 240, 1], [640, 300, 1], [200, 400, 1], [400, 300, 2]]) {
    await page.resize(width, height, ratio);
    await page.evaluate(`document.body.classList.add("bare"); 0`);
    await frames();
    assert.equal(await page.evaluate("devicePixelRatio"), ratio);
    const { camera, distance } = await navigation();
    const pivot = add(centreOf(camera), scaled(forward(camera), distance));
    const [x, y] = seenAt(pivot, camera, width, height);
    await page.drag(100, 100, 140, 130, "right");
    const [newX, newY] = seenAt(pivot, (await navigation()).camera, width, height);
    assert.ok(Math.hypot(newX - x - 40, newY - y - 30) < 0.1,
      `${width}x${height} at ${ratio}: ${newX - x}, ${newY - y}`);
  }
  await page.resize(WIDTH, HEIGHT);
  await page.evaluate(`document.body.classList.remove("bare"); 0`);
});

test("with Caps Lock the letters do the same, and a held key switches once", async () => {
  const isBare = () => page.evaluate(`document.body.classList.contains("bare")`);
  await page.press("H", "KeyH");
  assert.equal(await isBare(), true);
  await page.press("h", "KeyH", 4);
  assert.equal(await isBare(), false);
  await page.press(" ", "Space", 2);
  assert.equal(await page.evaluate("ted4Player.clock.isPlaying"), true);
  await page.press(" ", "Space", 4);
  assert.equal(await page.evaluate("ted4Player.clock.isPlaying"), false);
  await page.evaluate("ted4Player.clock.seek(0); 0");
  await page.press(".", "Period", 3);
  assert.equal(await page.evaluate("ted4Player.clock.position"), 3);
});

test("a screen reader is not told of every frame", async () => {
  assert.equal(await page.evaluate(`document.getElementById("frame")
    .closest("output, [aria-live], [role=status], [role=log], [role=timer]")`), null);
});

test("the timeline leaves the panel free in windows of all sizes", async () => {
  for (const [width, height] of [[641, 360], [667, 375], [736, 414], [360, 640], [300, 300],
    [1024, 600]]) {
    await page.resize(width, height);
    await page.evaluate(`document.body.classList.remove("bare");
      document.getElementById("panel").hidden = false; 0`);
    await frames();
    const [panel, timeline] = await page.evaluate(`["panel", "timeline"].map((id) => {
      const { top, bottom } = document.getElementById(id).getBoundingClientRect();
      return { top, bottom };
    })`);
    assert.ok(panel.bottom <= timeline.top && panel.bottom > panel.top + 20,
      `${width}x${height}: ${panel.bottom}, ${timeline.top}`);
  }
  await page.resize(WIDTH, HEIGHT);
});

test("a drawing context that is lost and restored shows the same picture", async () => {
  await page.evaluate(`document.body.classList.add("bare"); 0`);
  await page.until("ted4Player.isSettled");
  const wanted = await page.screenshot();
  await page.evaluate(`globalThis.loss = document.getElementById("picture").getContext("webgl2")
    .getExtension("WEBGL_lose_context"); loss.loseContext(); 0`);
  await frames();
  const drawn = await page.evaluate("ted4Player.statistics.drawn");
  await page.evaluate("loss.restoreContext(); 0");
  await page.until(`ted4Player.statistics.drawn > ${drawn} + 1 && ted4Player.isSettled`, 10);
  assert.ok(await psnr(page, await page.screenshot(), wanted) >= 60);
  await page.evaluate(`document.body.classList.remove("bare"); 0`);
});

test("nothing fails on the way", () => assert.deepEqual(page.errors, []));
