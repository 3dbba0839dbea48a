// page.browser.mjs - the page in headless Chromium: pictures against those of the decoder, time,
// camera, refusals, and the page that holds everything.
// SPDX-License-Identifier: BSD-2-Clause
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { basename, dirname, join } from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath, pathToFileURL } from "node:url";
import { Browser } from "./browser.mjs";
import {
  CAMERA, decode, edit, keep, OUT, PLAYER, rendered, SCENE, SMALL, SMALL_CAMERA, withPixel,
} from "./fixture.mjs";
import { lookingAt } from "../page/camera.js";
import { psnr, sideBySide } from "./pictures.mjs";
import { serve } from "./server.mjs";

const LEAST_PSNR = 35, MOST_OVERHEAD = 2.5e6;
const POSITION = "ted4Player.clock.position";
let browser, server, page;

before(async () => {
  server = await serve(PLAYER, dirname(SCENE), OUT);
  browser = new Browser();
  page = await browser.page(CAMERA.width, CAMERA.height);
  await page.open(`${server.origin}/?file=${basename(SCENE)}`);
  await page.until("ted4Player.isSettled");
});

after(async () => {
  await browser?.close();
  server?.close();
});

// Only the scene, through a camera.
function showBare(of = page, camera = CAMERA) {
  return of.evaluate(`document.body.classList.add("bare");
    ted4Player.navigation.camera = ${JSON.stringify(camera)}; 0`);
}

test("a file is opened, and its hash is the one that the decoder prints", async () => {
  const hash = await page.evaluate("ted4Player.file.info.hash");
  assert.ok(decode(SCENE, "--hash").includes(hash));
  assert.match(await page.evaluate(`document.getElementById("verdict").textContent`), /^Valid/);
  assert.equal(await page.evaluate(`document.getElementById("message").hidden`), true);
});

test("the page begins at the file's first camera, with its up, and offers the others", async () => {
  const { up, cameras } = await page.evaluate("ted4Player.file.cameras");
  assert.deepEqual(up, [0, 0, 1]);
  assert.deepEqual(await page.evaluate("ted4Player.navigation.camera"), cameras[0]);
  assert.equal(await page.evaluate(`document.getElementById("cameras").textContent`),
    `of ${cameras.length}`);
  await page.evaluate(`(() => {
    const camera = document.getElementById("camera");
    camera.value = 2;
    camera.dispatchEvent(new Event("change"));
  })()`);
  assert.deepEqual(await page.evaluate("ted4Player.navigation.camera"), cameras[1]);
});

test("pictures at three times agree with those of ted4dec --render", async (t) => {
  await showBare();
  const frames = await page.evaluate("ted4Player.clock.frames");
  for (const part of [0, 0.5, 1]) {
    const frame = Math.round(part * (frames - 1));
    await page.evaluate(`ted4Player.clock.seek(${frame}); 0`);
    await page.until("ted4Player.isSettled");
    const shot = await page.screenshot(), reference = rendered(frame / (frames - 1));
    const decibels = await psnr(page, shot, reference);
    t.diagnostic(`frame ${frame}: ${decibels.toFixed(1)} dB`);
    keep(`frame-${frame}.jpg`, await sideBySide(page, [shot, reference]));
    assert.ok(decibels >= LEAST_PSNR, `frame ${frame}: ${decibels} dB`);
  }
});

test("pixels of other widths than those of training agree with ted4dec, too", async (t) => {
  await showBare();
  await page.evaluate("ted4Player.clock.seek(0); 0");
  for (const r of [0.25, 1, 2]) {
    const camera = withPixel(r);
    await page.resize(camera.width, camera.height);
    await page.until(`document.getElementById("picture").width === ${camera.width}`);
    await page.until("ted4Player.isSettled");
    const decibels = await psnr(page, await page.screenshot(), rendered(0, camera));
    t.diagnostic(`${r} times as wide: ${decibels.toFixed(1)} dB`);
    assert.ok(decibels >= LEAST_PSNR, `${r} times as wide: ${decibels} dB`);
  }
  await page.resize(CAMERA.width, CAMERA.height);
});

test("a scene of a millionth of the size agrees with ted4dec, too", async (t) => {
  const small = await browser.page(CAMERA.width, CAMERA.height);
  await small.open(`${server.origin}/?file=${basename(SMALL)}`);
  await small.until("ted4Player.isSettled");
  await showBare(small, SMALL_CAMERA);
  await small.until("ted4Player.isSettled");
  const decibels = await psnr(small, await small.screenshot(), rendered(0, SMALL_CAMERA, SMALL));
  t.diagnostic(`${decibels.toFixed(1)} dB`);
  assert.ok(decibels >= LEAST_PSNR, `${decibels} dB`);
  await small.close();
});

test("of times that follow each other closely the last one stays on the screen", async () => {
  await showBare();
  await page.evaluate("ted4Player.clock.seek(8); 0");
  await page.until("ted4Player.isSettled");
  const wanted = await page.screenshot();
  for (let milliseconds = 0; milliseconds < 80; milliseconds += 5) {
    await page.evaluate(`(async () => {
      const { clock } = ted4Player;
      for (const frame of [0, 4, 8]) {
        clock.seek(frame);
        await new Promise((resolve) => { setTimeout(resolve, ${milliseconds}); });
      }
    })()`);
    await page.until("ted4Player.isSettled");
    const shot = await page.screenshot();
    assert.ok(shot === wanted || await psnr(page, shot, wanted) >= 60, `${milliseconds} ms`);
  }
});

test("space plays and pauses, and pictures follow", async () => {
  await page.evaluate("ted4Player.clock.seek(0); 0");
  await page.until("ted4Player.isSettled");
  const drawn = await page.evaluate("ted4Player.statistics.drawn");
  await page.press(" ");
  await page.until(`${POSITION} > 2`);
  await page.press(" ");
  const stopped = await page.evaluate(POSITION);
  await page.until("ted4Player.isSettled");
  assert.equal(await page.evaluate(POSITION), stopped);
  assert.ok(await page.evaluate("ted4Player.statistics.drawn") > drawn);
});

test("several workers evaluate, and give the same Gaussians", async () => {
  await page.until("ted4Player.evaluators === Math.min(navigator.hardwareConcurrency, 2)");
  const differing = await page.evaluate(`(async () => {
    const ask = () => ted4Player.gaussians(3, 8, [0.1, -2, 1]);
    const [a, b] = await Promise.all([ask(), ask()]);
    const arrays = (g) => [...g.mean, ...g.scale, ...g.rotation, g.opacity, ...g.colour];
    return arrays(a).filter((array, k) => array.some((v, i) => v !== arrays(b)[k][i])).length;
  })()`);
  assert.equal(differing, 0);
});

test("keys step and jump", async () => {
  const last = await page.evaluate("ted4Player.clock.frames - 1");
  await page.press("End");
  assert.equal(await page.evaluate(POSITION), last);
  await page.press(",");
  assert.equal(await page.evaluate(POSITION), last - 1);
  await page.press("Home");
  assert.equal(await page.evaluate(POSITION), 0);
  await page.press(".");
  assert.equal(await page.evaluate(POSITION), 1);
  await page.press("ArrowLeft");
  assert.equal(await page.evaluate(POSITION), 0);
});

test("the slider scrubs, to times between frames too", async () => {
  await page.evaluate(`(() => {
    const time = document.getElementById("time");
    time.value = 2.5;
    time.dispatchEvent(new Event("input"));
  })()`);
  await page.until("ted4Player.isSettled");
  assert.equal(await page.evaluate(POSITION), 2.5);
  assert.match(await page.evaluate(`document.getElementById("frame").textContent`), /^2 /);
});

const CENTRE = `(({ R, t }) => [0, 1, 2].map((j) =>
  -(R[j] * t[0] + R[3 + j] * t[1] + R[6 + j] * t[2])))(ted4Player.navigation.camera)`;
const DISTANCE = "ted4Player.navigation.distance";

async function way(move) {
  const [x, y, z] = await page.evaluate(CENTRE);
  await move();
  const [newX, newY, newZ] = await page.evaluate(CENTRE);
  return Math.hypot(newX - x, newY - y, newZ - z);
}

test("dragging orbits about the scene, and the distance stays", async () => {
  const distance = await page.evaluate(DISTANCE);
  assert.ok(await way(() => page.drag(100, 100, 180, 110)) > 0.1);
  assert.equal(await page.evaluate(DISTANCE), distance);
  await page.until("ted4Player.isSettled");
});

test("two fingers that part come nearer", async () => {
  const distance = await page.evaluate(DISTANCE);
  await page.pinch([[140, 120], [180, 120]], [[100, 120], [220, 120]]);
  const ratio = await page.evaluate(DISTANCE) / distance;
  assert.ok(Math.abs(ratio - 1 / 3) < 0.05, `${ratio}`);
  await page.until("ted4Player.isSettled");
});

test("W flies as long as it is held", async () => {
  const from = await page.evaluate(`${CENTRE}.join()`);
  await page.hold("w", `${CENTRE}.join() !== "${from}"`);
  assert.equal(await way(() => page.until("ted4Player.isSettled")), 0);
});

const FORWARD = "ted4Player.navigation.camera.R.slice(6)";

// For some frames, a key that says that and is at the place of that code.
const held = (key, code) => page.evaluate(`(async () => {
  const send = (type) => document.body.dispatchEvent(
    new KeyboardEvent(type, { key: "${key}", code: "${code}", bubbles: true }));
  send("keydown");
  for (let i = 0; i < 4; i++) await new Promise(requestAnimationFrame);
  send("keyup");
})()`);

test("keys turn the camera about the pivot as long as they are held", async () => {
  const distance = await page.evaluate(DISTANCE);
  const pivot = async () => {
    const [centre, ahead] = await page.evaluate(`[${CENTRE}, ${FORWARD}]`);
    return centre.map((v, i) => v + distance * ahead[i]);
  };
  const about = await pivot();
  for (const key of ["j", "l", "i", "k"]) {
    const before = await page.evaluate(FORWARD);
    await held(key, `Key${key.toUpperCase()}`);
    assert.notDeepEqual(await page.evaluate(FORWARD), before, key);
    (await pivot()).forEach((v, i) => assert.ok(Math.abs(v - about[i]) < 1e-4, key));
    assert.equal(await page.evaluate(DISTANCE), distance);
  }
  await page.until("ted4Player.isSettled");
});

test("a key that steps does not fly, too, where keyboards have it at the place of E", async () => {
  await page.evaluate("ted4Player.clock.seek(0); 0");
  assert.equal(await way(() => held(".", "KeyE")), 0);
  assert.equal(await page.evaluate(POSITION), 1);
});

test("the question mark opens the help, which Escape closes", async () => {
  await page.press("?");
  assert.equal(await page.evaluate(`document.getElementById("help").open`), true);
  await page.press("Escape");
  assert.equal(await page.evaluate(`document.getElementById("help").open`), false);
});

test("bytes by element sum up to the file", async () => {
  const rows = await page.evaluate("ted4Player.bytesByElement()");
  assert.equal(rows.reduce((sum, { bytes }) => sum + bytes, 0), readFileSync(SCENE).length);
});

test("nothing is asked for elsewhere, and nothing fails on the way", () => {
  const elsewhere = page.requests.filter((url) =>
    !url.startsWith(server.origin) && !url.startsWith("blob:") && !url.startsWith("data:"));
  assert.deepEqual(elsewhere, []);
  assert.deepEqual(page.errors, []);
});

const KEYS = [[-1.3, -3.2, 1.9], [1.6, -3.1, 1.2], [3.2, -1, 2.2]].map((eye, i) =>
  ({ ...lookingAt(CAMERA, eye, [0, 0, 0.3], [0, 0, 1]), time: i / 2 }));

test("the path of a file is followed in time, as ted4dec --path does, until the camera is moved",
  async (t) => {
    const keys = join(OUT, "path.json"), file = join(OUT, "path.ted4"), frame = 4;
    writeFileSync(keys, JSON.stringify(KEYS));
    edit(SCENE, "-o", file, "--path", keys, "-f");
    const along = await browser.page(CAMERA.width, CAMERA.height);
    await along.open(`${server.origin}/?file=path.ted4`);
    await along.until("globalThis.ted4Player?.isSettled");
    const box = `document.getElementById("follows-path")`;
    assert.deepEqual(await along.evaluate(`[${box}.disabled, ${box}.checked]`), [false, false]);
    await along.press("p");
    await along.evaluate(`document.body.classList.add("bare"); ted4Player.clock.seek(${frame}); 0`);
    await along.until(`ted4Player.isSettled && ${box}.checked`);
    decode(file, "--render", join(OUT, "along%d.png"), "--path", "file", "-f", "-q");
    const reference = readFileSync(join(OUT, `along${frame}.png`)).toString("base64");
    const shot = await along.screenshot(), decibels = await psnr(along, shot, reference);
    keep("along.jpg", await sideBySide(along, [shot, reference]));
    t.diagnostic(`frame ${frame}: ${decibels.toFixed(1)} dB`);
    assert.ok(decibels >= LEAST_PSNR, `${decibels} dB`);
    await along.press(" ");
    await along.until(`${POSITION} > ${frame} + 2`);
    await along.press(" ");
    await along.until("ted4Player.isSettled");
    assert.equal(await along.evaluate("ted4Player.followsPath"), true);
    await along.drag(100, 100, 180, 110);
    await along.until(`ted4Player.isSettled && !${box}.checked`);
    assert.equal(await along.evaluate("ted4Player.followsPath"), false);
    assert.deepEqual(along.errors, []);
  });

test("the page begins at the time in its address, and goes where that changes", async () => {
  const begun = await browser.page(CAMERA.width, CAMERA.height);
  await begun.open(`${server.origin}/?file=${basename(SCENE)}#frame=3`);
  await begun.until("globalThis.ted4Player?.isSettled");
  assert.equal(await begun.evaluate(POSITION), 3);
  const { rateNum, rateDen } = await begun.evaluate("ted4Player.file.info");
  await begun.evaluate(`location.hash = "t=0.123"; 0`);
  await begun.until(`Math.abs(${POSITION} - 0.123 * ${rateNum / rateDen}) < 1e-9`);
  await begun.until("ted4Player.isSettled");
  await begun.evaluate(`location.hash = "elsewhere"; 0`);
  await begun.evaluate("new Promise((resolve) => { setTimeout(resolve, 50); })");
  assert.ok(Math.abs(await begun.evaluate(POSITION) - 0.123 * rateNum / rateDen) < 1e-9);
  assert.deepEqual(begun.errors, []);
});

test("a broken file is refused with identifier and offset", async () => {
  const bytes = readFileSync(SCENE);
  bytes[bytes.length - 40] ^= 1;
  writeFileSync(join(OUT, "broken.ted4"), bytes);
  const broken = await browser.page(640, 360);
  await broken.open(`${server.origin}/?file=broken.ted4`);
  await broken.until(`!document.getElementById("message").hidden`);
  const said = await broken.evaluate(`document.getElementById("message").textContent`);
  assert.match(said, /broken\.ted4 is refused \(invalid\): con\.chunk-hash at byte \d+\n/);
});

test("the page that holds everything opens by file:// and plays", async (t) => {
  const file = join(OUT, "scene.html");
  const program = fileURLToPath(new URL("../export.mjs", import.meta.url));
  const said = execFileSync("node", [program, PLAYER, SCENE, file], { encoding: "utf8" });
  const { length } = readFileSync(file), overhead = length - readFileSync(SCENE).length;
  assert.ok(said.includes(`: ${length} bytes, ${overhead} more than the scene`), said);
  t.diagnostic(`${overhead} bytes more than the scene`);
  assert.ok(overhead <= MOST_OVERHEAD);
  const alone = await browser.page(CAMERA.width, CAMERA.height);
  await alone.open(pathToFileURL(file).href);
  await alone.until("globalThis.ted4Player?.isSettled");
  await alone.press(" ");
  await alone.until(`${POSITION} > 1`);
  assert.deepEqual(alone.errors, []);
  const old = await browser.page(CAMERA.width, CAMERA.height);
  await old.before("delete globalThis.DecompressionStream");
  await old.open(pathToFileURL(file).href);
  await old.until(`!document.getElementById("message").hidden`, 10);
  assert.match(await old.evaluate(`document.getElementById("message").textContent`),
    /cannot start in this browser: .*DecompressionStream/);
  assert.equal(await old.evaluate(`document.getElementById("welcome").hidden`), true);
  assert.deepEqual(old.errors, []);
});
