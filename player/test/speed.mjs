// speed.mjs FILE.ted4 - how fast the player is in headless Chromium: one JSON object. Drawing is
// left aside as far as it goes, because it is done in software here: pictures have few pixels, and
// what is measured by the second stays off the screen.
// SPDX-License-Identifier: BSD-2-Clause
import { basename, dirname } from "node:path";
import { Browser } from "./browser.mjs";
import { serve } from "./server.mjs";

const [FILE, PLAYER] = [process.argv[2], process.env.TED4_PLAYER];
const WIDTH = 64, HEIGHT = 36, TIMES = 100, SCRUBS = 20, OPENINGS = 5;

// Of milliseconds.
const SUMMARY = `(times) => {
  times.sort((a, b) => a - b);
  return { least: times[0], median: times[times.length >> 1], most: times.at(-1) };
}`;

// From the slider to the Gaussians of that time, and until they are sorted and drawn.
const SCRUB = `(async () => {
  const time = document.getElementById("time"), evaluated = [], shown = [];
  const until = async (condition) => {
    while (!condition()) await new Promise((resolve) => { setTimeout(resolve, 1); });
    return performance.now();
  };
  for (let i = 0; i < ${SCRUBS}; i++) {
    const before = ted4Player.statistics.evaluated, start = performance.now();
    time.value = (i * 7.3 + 1.1) % time.max;
    time.dispatchEvent(new Event("input"));
    evaluated.push(await until(() => ted4Player.statistics.evaluated > before) - start);
    shown.push(await until(() => ted4Player.isSettled) - start);
  }
  const summary = ${SUMMARY};
  return { evaluated: summary(evaluated), shown: summary(shown) };
})()`;

// New times and new cameras, as many at once as the page's workers take. atOnce: 0: all of them.
const EVALUATE = `(async (atOnce) => {
  const inWorker = [], inAll = [];
  const start = performance.now();
  let next = 0;
  const one = async () => {
    while (next < ${TIMES}) {
      const asked = performance.now(), i = next++;
      const g = await ted4Player.gaussians(i * 137 % 1000, 1000, [0.001 * i, 0.1, 0.2]);
      inWorker.push(g.milliseconds);
      inAll.push(performance.now() - asked);
    }
  };
  await Promise.all(Array.from({ length: atOnce || ted4Player.evaluators }, one));
  const perSecond = 1000 * ${TIMES} / (performance.now() - start);
  const summary = ${SUMMARY};
  return { perSecond, inWorker: summary(inWorker), inAll: summary(inAll) };
})`;

async function opened(browser, url) {
  const page = await browser.page(WIDTH, HEIGHT);
  await page.open(url);
  await page.until("globalThis.ted4Player?.statistics.firstPicture > 0");
  await page.until("ted4Player.isSettled");
  return { page, ...await page.evaluate(`({ firstPicture: ted4Player.statistics.firstPicture,
    decode: ted4Player.file.milliseconds, sort: ted4Player.sorting,
    gaussians: ted4Player.file.info.gaussians, anchors: ted4Player.file.info.anchors })`) };
}

const server = await serve(PLAYER, dirname(FILE)), browser = new Browser();
const url = `${server.origin}/?file=${basename(FILE)}`, openings = [];
for (let i = 0; i < OPENINGS; i++) {
  await openings.at(-1)?.page.close();
  openings.push(await opened(browser, url));
}
const { page, anchors, gaussians } = openings.at(-1);
await page.until("ted4Player.evaluators === Math.min(navigator.hardwareConcurrency, 2)");
const values = (key) => openings.map((o) => o[key]).sort((a, b) => a - b);
const median = (key) => values(key)[OPENINGS >> 1];
console.log(JSON.stringify({
  anchors, gaussians, decode: median("decode"), sort: median("sort"),
  firstPicture: { least: values("firstPicture")[0], median: median("firstPicture") },
  evaluators: await page.evaluate("ted4Player.evaluators"),
  evaluateOne: await page.evaluate(`${EVALUATE}(1)`),
  evaluate: await page.evaluate(`${EVALUATE}(0)`), scrub: await page.evaluate(SCRUB),
}, (key, v) => (typeof v === "number" ? Math.round(10 * v) / 10 : v), 2));
await browser.close();
server.close();
