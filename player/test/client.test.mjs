// client.test.mjs - the decoder in a worker: what a call gives when all is well, when it comes at
// the wrong time, and when the worker is gone. SPDX-License-Identifier: BSD-2-Clause
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { Worker as Thread } from "node:worker_threads";
import { Ted4Client } from "../src/index.js";

const root = new URL("../../", import.meta.url);
const wasm = readFileSync(process.env.TED4_WASM ?? new URL("build/player/ted4.wasm", root));
const bytes = readFileSync(new URL("conformance/vectors/content/CNT-pop-0.002.ted4", root));
const copy = () => Uint8Array.from(bytes);

// A thread of Node that runs worker.js, with the interface of a browser's worker.
class BrowserWorker {
  #thread = new Thread(`
    const { parentPort } = require("node:worker_threads");
    globalThis.self = { postMessage: (m, o) => parentPort.postMessage(m, o?.transfer) };
    import(${JSON.stringify(new URL("../src/worker.js", import.meta.url).href)}).then(() =>
      parentPort.on("message", (data) => self.onmessage({ data })));
  `, { eval: true });

  constructor() {
    this.#thread.on("message", (data) => this.onmessage({ data }));
  }

  postMessage(message, transfer) {
    this.#thread.postMessage(message, transfer);
  }

  terminate() {
    this.#thread.terminate();
  }
}

// Keeps what it is sent, and never answers.
class SilentWorker {
  sent = [];
  postMessage(message) {
    this.sent.push(message);
  }

  terminate() {}
}

// With a client that has loaded the module.
async function withClient(body) {
  const client = new Ted4Client(new BrowserWorker());
  try {
    await client.load(wasm);
    await body(client);
  } finally {
    client.terminate();
  }
}

test("a scene in a worker gives the Gaussians of its frames", () => withClient(async (client) => {
  const scene = await client.open(copy());
  const g = await scene.frame(scene.info.frames - 1, [0, 0, -4]);
  assert.equal(g.n, scene.info.gaussians);
  assert.ok(g.mean[0].every(Number.isFinite));
}));

test("every call gives a promise, which a call that is none rejects", () =>
  withClient(async (client) => {
    const scene = await client.open(copy());
    await assert.rejects(scene.frame(1.5), RangeError);
    await assert.rejects(scene.gaussians(2, 1), { name: "Ted4Error", id: "query.range" });
    await assert.rejects(client.load("ted4.wasm"), { code: "ERR_INVALID_URL" });
    await assert.rejects(client.load(() => {}), { name: "DataCloneError" });
  }));

test("calls are answered in order, also those that come while the module is loaded", async () => {
  const client = new Ted4Client(new BrowserWorker()), answered = [];
  const noted = (name) => () => answered.push(name);
  const calls = [client.load(wasm).then(noted("load")), client.open(copy()).then(noted("open")),
    client.load(wasm).then(noted("again"))];
  await Promise.all(calls).finally(() => client.terminate());
  assert.deepEqual(answered, ["load", "open", "again"]);
});

test("bytes of a Buffer are copied, and those of an ArrayBuffer are gone afterwards", () =>
  withClient(async (client) => {
    const pool = Buffer.concat([Buffer.alloc(8), bytes]), part = pool.subarray(8);
    const { info } = await client.open(part);
    assert.ok(part.equals(bytes));
    const { buffer } = copy();
    assert.equal((await client.open(buffer)).info.hash, info.hash);
    assert.equal(buffer.byteLength, 0);
  }));

test("an address in place of the bytes of a file is refused", () => withClient(async (client) => {
  await assert.rejects(client.open("scene.ted4"), { name: "TypeError" });
}));

test("before load, and after close, the error says so", async () => {
  const early = new Ted4Client(new BrowserWorker());
  await assert.rejects(early.open(copy()), { message: "no decoder: call load() before open()" });
  early.terminate();
  await withClient(async (client) => {
    const scene = await client.open(copy());
    await scene.close();
    await assert.rejects(scene.frame(0), { message: "the scene is closed" });
  });
});

test("calls under way when the worker is terminated, and later ones, are rejected", async () => {
  const client = new Ted4Client(new SilentWorker()), loading = client.load(wasm);
  client.terminate();
  await assert.rejects(loading, { message: "the worker is terminated" });
  await assert.rejects(client.open(copy()), { message: "the worker is terminated" });
});

test("a worker that fails rejects all calls, with a reason", async () => {
  for (const [event, message] of [[{}, "the worker failed to start"],
    [{ message: "SyntaxError" }, "SyntaxError"]]) {
    const worker = new SilentWorker(), client = new Ted4Client(worker), loading = client.load(wasm);
    worker.onerror(event);
    await assert.rejects(loading, { message });
    await assert.rejects(client.load(wasm), { message });
    worker.onmessage({ data: { call: 1 } }); // too late
  }
});

test("an address is that of the page, as text", async () => {
  const worker = new SilentWorker(), client = new Ted4Client(worker);
  globalThis.document = { baseURI: "https://example.org/a/b.html" };
  client.load("ted4.wasm");
  client.load(new URL("https://example.org/c.wasm"));
  delete globalThis.document;
  await null;
  assert.deepEqual(worker.sent.map(({ source }) => source),
    ["https://example.org/a/ted4.wasm", "https://example.org/c.wasm"]);
});
