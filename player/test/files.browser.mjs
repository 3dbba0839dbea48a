// files.browser.mjs - how files come to the page: which one of several stays, choosing, messages,
// the time in an address. In headless Chromium.
// SPDX-License-Identifier: BSD-2-Clause
import assert from "node:assert/strict";
import { copyFileSync, writeFileSync } from "node:fs";
import { basename, dirname, join } from "node:path";
import { after, before, test } from "node:test";
import { Browser } from "./browser.mjs";
import { CAMERA, OUT, PLAYER, SCENE } from "./fixture.mjs";
import { serve } from "./server.mjs";

const NAME = basename(SCENE), NEXT = join(OUT, "next.ted4"), BAD = join(OUT, "bad.ted4");
const LATE = encodeURIComponent(`${NAME}?wait=1500`);
const MESSAGE = `document.getElementById("message")`;
const WELCOME = `document.getElementById("welcome")`;
let browser, server;

before(async () => {
  copyFileSync(SCENE, NEXT);
  writeFileSync(BAD, "no scene");
  server = await serve(PLAYER, dirname(SCENE), OUT);
  browser = new Browser();
});

after(async () => {
  await browser?.close();
  server?.close();
});

// A new tab with the player, and drop(name, address) in it.
async function opened(query = "") {
  const page = await browser.page(CAMERA.width, CAMERA.height);
  await page.open(`${server.origin}/${query}`);
  await page.evaluate(`globalThis.drop = (name, address) => {
    const arrayBuffer = () => fetch(address).then((response) => response.arrayBuffer());
    const file = { name, arrayBuffer, slice: () => file }, dataTransfer = { files: [file] };
    dispatchEvent(Object.assign(new Event("drop"), { dataTransfer }));
  }; 0`);
  return page;
}

// On the middle of an element, whatever lies there.
async function click(page, id) {
  const [x, y] = await page.evaluate(`(({ left, top, width, height }) =>
    [left + width / 2, top + height / 2]
  )(document.getElementById("${id}").getBoundingClientRect())`);
  await page.drag(x, y, x, y);
}

const isShown = (name) => `ted4Player.file?.name === "${name}" && ted4Player.isSettled`;
const after2Seconds = () => new Promise((resolve) => { setTimeout(resolve, 2000); });

test("the file that was asked for last stays, when one from before comes after it", async () => {
  const page = await opened(`?file=${LATE}`);
  await page.evaluate(`drop("dropped", "${NAME}"); 0`);
  await page.until(isShown("dropped"));
  await after2Seconds();
  assert.equal(await page.evaluate(isShown("dropped")), true);
  await page.close();
});

test("a refusal that comes late says nothing over the file that was asked for last", async () => {
  const page = await opened(`?file=${encodeURIComponent("bad.ted4?wait=1500")}`);
  await page.evaluate(`drop("first", "${NAME}"); drop("last", "${NAME}"); 0`);
  await page.until(isShown("last"));
  await after2Seconds();
  assert.equal(await page.evaluate(isShown("last")), true);
  assert.equal(await page.evaluate(`${MESSAGE}.hidden`), true);
  await page.close();
});

test("a file is chosen by keys, also the same one again, and while another one is open",
  async () => {
    const page = await opened();
    const press = (id) => async () => {
      await page.evaluate(`document.getElementById("${id}").focus(); 0`);
      await page.press("Enter");
    };
    await page.until("globalThis.ted4Player");
    assert.equal(await page.evaluate(`${WELCOME}.checkVisibility()`), true);
    await page.choose(BAD, press("file"));
    await page.until(`!${MESSAGE}.hidden`);
    await page.evaluate(`${MESSAGE}.hidden = true; 0`);
    await page.choose(BAD, press("file"));
    await page.until(`!${MESSAGE}.hidden`);
    await page.choose(SCENE, press("file"));
    await page.until(isShown(NAME));
    await page.choose(NEXT, press("open"));
    await page.until(isShown("next.ted4"));
    await page.close();
  });

test("a file that is no scene is refused by its first bytes; its rest is not read", async () => {
  const page = await opened();
  await page.until("globalThis.ted4Player");
  await page.evaluate(`globalThis.reads = 0; (() => {
    const file = new File([new Uint8Array(1e6)], "video");
    file.arrayBuffer = () => {
      reads++;
      return new Blob([file]).arrayBuffer();
    };
    dispatchEvent(Object.assign(new Event("drop"), { dataTransfer: { files: [file] } }));
  })()`);
  await page.until(`!${MESSAGE}.hidden`);
  assert.match(await page.evaluate(`${MESSAGE}.textContent`),
    /video is refused \(invalid\): con\.magic at byte 0/);
  assert.equal(await page.evaluate("reads"), 0);
  await page.close();
});

test("bytes by element that cannot be counted are told of", async () => {
  const page = await browser.page(CAMERA.width, CAMERA.height);
  await page.before(`globalThis.Worker = class extends Worker {
    postMessage(message, transfer) {
      const error = { verdict: "limit", id: "limit.memory", text: "too little" };
      if (!message.options?.budget) super.postMessage(message, transfer);
      else setTimeout(() => this.onmessage({ data: { call: message.call, error } }));
    }
  }`);
  await page.open(`${server.origin}/?file=${NAME}`);
  await page.until("globalThis.ted4Player?.isSettled");
  await page.evaluate(`document.getElementById("sizes").open = true; 0`);
  await page.until(`!${MESSAGE}.hidden`, 10);
  assert.match(await page.evaluate(`${MESSAGE}.textContent`),
    /^Bytes by element: limit\.memory/);
  assert.deepEqual(page.errors, []);
  await page.close();
});

test("a message goes when it is closed, hidden with the rest, or when the next file is good",
  async () => {
    const page = await opened(`?file=${NAME}`);
    await page.until("globalThis.ted4Player?.isSettled");
    const refuse = async () => {
      await page.evaluate(`drop("bad", "bad.ted4"); 0`);
      await page.until(`!${MESSAGE}.hidden`);
      assert.match(await page.evaluate(`${MESSAGE}.textContent`), /bad is refused \(invalid\)/);
    };
    const isVisible = () => page.evaluate(`${MESSAGE}.checkVisibility()`);
    await refuse();
    await page.evaluate(`document.getElementById("panel").hidden = false; 0`);
    await click(page, "close-message");
    assert.equal(await isVisible(), false);
    await refuse();
    await page.press("h");
    assert.equal(await isVisible(), false);
    await page.press("h");
    assert.equal(await isVisible(), true);
    await page.evaluate(`ted4Player.clock.seek(2); 0`);
    await page.until("ted4Player.isSettled");
    assert.equal(await isVisible(), true);
    await page.evaluate(`drop("good", "${NAME}"); 0`);
    await page.until(isShown("good"));
    assert.equal(await isVisible(), false);
    await page.close();
  });

test("a lost drawing context is told of until it is back, whatever files come", async () => {
  const page = await opened(`?file=${NAME}`);
  const says = (text) => `!${MESSAGE}.hidden && ${MESSAGE}.textContent.includes("${text}")`;
  await page.until("globalThis.ted4Player?.isSettled");
  await page.evaluate(`globalThis.loss = document.getElementById("picture").getContext("webgl2")
    .getExtension("WEBGL_lose_context"); loss.loseContext(); 0`);
  await page.until(says("drawing context"));
  await page.evaluate(`drop("bad", "bad.ted4"); 0`);
  await page.until(says("bad is refused"));
  await click(page, "close-message");
  assert.equal(await page.evaluate(says("drawing context")), true);
  await page.evaluate(`drop("good", "${NAME}"); 0`);
  await page.until(`ted4Player.file.name === "good"`);
  assert.equal(await page.evaluate(says("drawing context")), true);
  await page.evaluate("loss.restoreContext(); 0");
  await page.until(isShown("good"));
  assert.equal(await page.evaluate(`${MESSAGE}.hidden`), true);
  await page.close();
});

test("bytes by element that come when another file is open are not shown", async () => {
  const page = await opened(`?file=${NAME}`);
  await page.until("globalThis.ted4Player?.isSettled");
  await page.evaluate(`globalThis.answers = [];
    ted4Player.bytesByElement = () => new Promise((resolve) => { answers.push(resolve); });
    document.getElementById("sizes").open = true; 0`);
  await page.until("answers.length === 1");
  await page.evaluate(`drop("good", "${NAME}"); 0`);
  await page.until("answers.length === 2");
  const rows = await page.evaluate(`(async () => {
    const row = (element) => [{ chunk: "TILE", element, bytes: 1, symbols: 1 }];
    answers[1](row("new"));
    answers[0](row("old"));
    await new Promise((resolve) => { setTimeout(resolve); });
    return document.getElementById("by-element").textContent;
  })()`);
  assert.equal(rows, "TILE new1");
  await page.close();
});

test("a message about a time goes when another one can be evaluated", async () => {
  const page = await opened(`?file=${NAME}`);
  await page.until("globalThis.ted4Player?.isSettled");
  await page.evaluate(`globalThis.kept = ted4Player.navigation.camera;
    ted4Player.navigation.camera = { ...kept, t: [1e45, 1e45, 1e45] }; 0`);
  await page.until(`!${MESSAGE}.hidden`);
  await page.evaluate(`ted4Player.navigation.camera = kept; ted4Player.clock.seek(3); 0`);
  await page.until(`${MESSAGE}.hidden`);
  await page.close();
});

test("the time that the address says when the file is there counts", async () => {
  const page = await opened(`?file=${LATE}#frame=3`);
  await page.evaluate(`location.hash = "frame=7"; 0`);
  await page.until("ted4Player.isSettled");
  assert.equal(await page.evaluate("ted4Player.clock.position"), 7);
  await page.close();
});

// In the page: a player of its own, opened twice with a file without cameras. The answers are those
// of its worker, and the canvas gives no context to the first try. Errors of both tries, and the
// types of all messages to the worker.
const opens = (answers) => `(async () => {
  const answers = ${JSON.stringify(answers)}, types = [], errors = [];
  const worker = { postMessage({ call, type }) {
    types.push(type);
    setTimeout(() => worker.onmessage({ data: { call, ...answers[type] } }));
  } };
  const canvas = document.createElement("canvas");
  const player = new ted4Player.constructor(canvas, [worker], "ted4.wasm", () => {});
  canvas.getContext = () => null;
  for (let i = 0; i < 2; i++) {
    await player.open(new ArrayBuffer(12), "file").catch((e) => errors.push(e.message));
    await new Promise((resolve) => { setTimeout(resolve, 100); });
    delete canvas.getContext;
  }
  return { errors, types };
})()`;

test("a decoded file that cannot be shown is closed, and the next one starts the drawing anew",
  async () => {
    const page = await opened();
    await page.until("globalThis.ted4Player");
    const { errors, types } = await page.evaluate(opens({
      load: {}, open: { value: { info: {} } }, gaussians: { error: { message: "no memory" } },
      close: {},
    }));
    assert.equal(errors.length, 2);
    assert.equal(errors[0], "the page draws with WebGL 2, which this browser does not offer");
    assert.equal(errors[1], "no memory");
    assert.deepEqual(types, ["load", "open", "close", "open", "gaussians", "close"]);
    await page.close();
  });

test("on a machine that does not say how many cores it has, one worker evaluates", async () => {
  const page = await browser.page(CAMERA.width, CAMERA.height);
  await page.before(
    `Object.defineProperty(navigator, "hardwareConcurrency", { value: undefined })`);
  await page.open(`${server.origin}/?file=${NAME}`);
  await page.until("globalThis.ted4Player?.isSettled");
  assert.equal(await page.evaluate("ted4Player.evaluators"), 1);
  await page.close();
});
