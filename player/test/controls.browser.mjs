// controls.browser.mjs - the controls of the page in headless Chromium: moving, the pivot, the
// camera box, keys, what a screen reader hears, small windows, a lost drawing context.
// SPDX-License-Identifier: BSD-2-Clause
import assert from "node:assert/strict";
import { basename, dirname } from "node:path";
import { after, before, test } from "node:test";
import { Browser } from "./browser.mjs";
import { add, centreOf, dot, fitted, forward, scaled } from "../page/camera.js";
import { keep, PLAYER, SCENE } from "./fixture.mjs";
import { psnr } from "./pictures.mjs";
import { serve } from "./server.mjs";

const WIDTH = 700, HEIGHT = 400; // with room for the panel on the right
const BOX = `document.getElementById("camera")`;
const INDEX = "ted4Player.cameras.indexOf(ted4Player.navigation.camera)";
const DISTANCE = "ted4Player.navigation.distance";
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

test("the canvas has the pixels of the screen, also on a page that is shown smaller", async () => {
  const small = await browser.page(WIDTH, HEIGHT);
  await small.resize(400, 300, 0.5);
  await small.open(`${server.origin}/?file=${basename(SCENE)}`);
  await small.until("globalThis.ted4Player?.isSettled");
  for (const ratio of [0.5, 0.8, 1, 2, 0.5]) {
    await small.resize(400, 300, ratio);
    await small.until(`Math.abs(devicePixelRatio - ${ratio}) < 1e-6 && (({ width, clientWidth }) =>
      width === Math.round(clientWidth * ${ratio}))(document.getElementById("picture"))`, 10);
    await small.until("ted4Player.isSettled");
    keep(`ratio-${ratio}.png`, await small.screenshot());
  }
  assert.deepEqual(small.errors, []);
  await small.close();
});

test("the pivot is measured anew at every camera of the file", async () => {
  const at = async (i) => {
    await page.evaluate(`ted4Player.useCamera(${i}); 0`);
    await page.until("ted4Player.isSettled");
    return page.evaluate(DISTANCE);
  };
  const first = await at(0), second = await at(1);
  await page.wheel(150, 60, -1200);
  await page.until(`${DISTANCE} < ${0.5 * second}`);
  await page.press("0");
  await page.until("ted4Player.isSettled");
  assert.equal(await page.evaluate(DISTANCE), first);
  await page.wheel(150, 60, 1200);
  await page.until(`${DISTANCE} > ${2 * first}`);
  assert.equal(await at(1), second);
  assert.notEqual(first, second);
});

async function type(text) {
  await page.evaluate(`${BOX}.focus(); ${BOX}.select(); 0`);
  for (const key of text) await page.press(key);
  await page.press("Enter");
}

test("the camera box says which camera of the file is looked through, and leads to it",
  async () => {
    const said = async () => {
      await frames();
      return page.evaluate(`[${BOX}.value, ${INDEX} + 1]`);
    };
    const leave = () => page.evaluate(`document.getElementById("picture").focus(); 0`);
    await type("5");
    assert.deepEqual(await said(), ["5", 5]);
    await page.wheel(150, 60, -120);
    await page.until(`${INDEX} < 0`);
    await page.press("Enter");
    assert.deepEqual(await said(), ["5", 5]);
    await leave();
    await page.press("0");
    assert.deepEqual(await said(), ["1", 1]);
    await page.evaluate(`${BOX}.value = 5; ${BOX}.dispatchEvent(new Event("change"));
      ted4Player.useCamera(0); 0`);
    assert.deepEqual(await said(), ["1", 1]);
    await type("7");
    await leave();
    await page.drag(150, 60, 170, 70);
    assert.deepEqual(await said(), ["", 0]);
    await type("7");
    assert.deepEqual(await said(), ["7", 7]);
    for (const bad of ["99", "0", "1.5", ""]) {
      await page.evaluate(`${BOX}.value = "${bad}"; ${BOX}.dispatchEvent(new Event("change")); 0`);
      assert.deepEqual(await page.evaluate(`[${BOX}.value, ${INDEX} + 1]`), ["7", 7], bad);
    }
    await leave();
  });

test("with Caps Lock the letters do the same, and a held key switches once", async () => {
  const isBare = () => page.evaluate(`document.body.classList.contains("bare")`);
  await page.press("H");
  assert.equal(await isBare(), true);
  await page.press("h", 4);
  assert.equal(await isBare(), false);
  await page.press(" ", 2);
  assert.equal(await page.evaluate("ted4Player.clock.isPlaying"), true);
  await page.press(" ", 4);
  assert.equal(await page.evaluate("ted4Player.clock.isPlaying"), false);
  await page.evaluate("ted4Player.clock.seek(0); 0");
  await page.press(".", 3);
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

test("a drawing context that is lost is told of, and restored shows the same picture", async () => {
  await page.evaluate(`document.body.classList.add("bare"); 0`);
  await page.until("ted4Player.isSettled");
  const wanted = await page.screenshot();
  await page.evaluate(`globalThis.loss = document.getElementById("picture").getContext("webgl2")
    .getExtension("WEBGL_lose_context"); loss.loseContext(); 0`);
  await frames();
  const message = `document.getElementById("message")`;
  assert.equal(await page.evaluate(`${message}.hidden`), false);
  assert.match(await page.evaluate(`${message}.textContent`), /drawing context/);
  const drawn = await page.evaluate("ted4Player.statistics.drawn");
  await page.evaluate("loss.restoreContext(); 0");
  await page.until(`ted4Player.statistics.drawn > ${drawn} + 1 && ted4Player.isSettled`, 10);
  assert.equal(await page.evaluate(`${message}.hidden`), true);
  assert.ok(await psnr(page, await page.screenshot(), wanted) >= 60);
  await page.evaluate(`document.body.classList.remove("bare"); 0`);
});

test("what plays before the first picture has one, and all workers", async () => {
  const early = await browser.page(WIDTH, HEIGHT);
  await early.open(`${server.origin}/?file=${basename(SCENE)}`);
  await early.evaluate(`new Promise((resolve) => {
    const waiting = setInterval(() => {
      if (ted4Player.file === null) return;
      clearInterval(waiting);
      ted4Player.clock.play(performance.now());
      resolve();
    });
  })`);
  await early.until(`ted4Player.statistics.firstPicture > 0 &&
    ted4Player.evaluators === Math.min(navigator.hardwareConcurrency, 2)`, 30);
  assert.equal(await early.evaluate("ted4Player.clock.isPlaying"), true);
  assert.deepEqual(early.errors, []);
});

test("nothing fails on the way", () => assert.deepEqual(page.errors, []));
