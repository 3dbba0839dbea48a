// player.test.mjs - the Player without a browser: its workers and its view are stubs.
// SPDX-License-Identifier: BSD-2-Clause
import assert from "node:assert/strict";
import { register } from "node:module";
import { test } from "node:test";

// Counts what it is told to draw; what globalThis.drawing does may fail.
const VIEW = `export class View {
  static create() { return Promise.resolve(globalThis.view = new View()); }
  sets = 0; hasPicture = false; isSettled = true;
  onFrame(changed) { this.changed = changed; }
  onLoss() {} clear() {} setBackground() {} resize() {} setCamera() {}
  setGaussians() {
    globalThis.drawing();
    this.sets++;
    this.hasPicture = true;
  }
}`;
register("data:text/javascript," + encodeURIComponent(`
  export async function resolve(name, context, next) {
    return !name.endsWith("/view.js") ? next(name, context)
      : { url: "data:text/javascript," + encodeURIComponent(${JSON.stringify(VIEW)}),
        shortCircuit: true };
  }`));
const { Evaluators } = await import("../page/evaluators.js");
const { Player } = await import("../page/player.js");

const INFO = {
  frames: 30, rate: 30, rateNum: 30, rateDen: 1, view: "none", origin: [0, 0, 0], exponent: 3,
  background: [0, 0, 0], gaussians: 2,
};
const NO_MEMORY = { error: { verdict: "limit", id: "limit.memory", section: "", text: "" } };

const after = (milliseconds) => new Promise((resolve) => { setTimeout(resolve, milliseconds); });

// Two Gaussians that far along z.
function atDepth(z, opacity = 1) {
  const all = (v) => new Float32Array(2).fill(v);
  return {
    n: 2, id: new Uint32Array(2), mean: [all(0), all(0), all(z)], opacity: all(opacity),
    milliseconds: 1,
  };
}

// Answers queries by gaussians(), that many milliseconds later each.
class StubWorker {
  sent = [];
  #answered = Promise.resolve();

  constructor(milliseconds, gaussians) {
    Object.assign(this, { milliseconds, gaussians });
  }

  postMessage({ call, type }) {
    this.sent.push(type);
    this.#answered = this.#answered.then(async () => {
      await after(type === "gaussians" ? this.milliseconds : 1);
      const answer = type === "gaussians" ? this.gaussians() : { value: { info: INFO } };
      this.onmessage({ data: { call, ...answer } });
    });
  }
}

const good = () => ({ value: atDepth(5) });

// A file with a camera at the origin that looks along z, of nothing else.
function fileWithCamera() {
  const bytes = new Uint8Array(12 + 20 + 100), view = new DataView(bytes.buffer);
  bytes.set(new TextEncoder().encode("CAMS"), 12);
  view.setUint32(20, 100, true);
  view.setFloat32(24 + 4, -1, true); // up
  view.setUint32(24 + 16, 1, true);
  [640, 480].forEach((v, i) => view.setUint32(24 + 20 + 4 * i, v, true));
  [500, 500, 320, 240, 1, 0, 0, 0, 1, 0, 0, 0, 1].forEach((v, i) =>
    view.setFloat32(24 + 28 + 4 * i, v, true));
  view.setUint32(24 + 96, 1, true);
  return bytes.buffer;
}

// A player that shows a file, for as long as body takes; errors: those that it has told of.
async function withPlayer(workers, body, file = new ArrayBuffer(12)) {
  globalThis.drawing = () => {};
  const errors = [];
  const player = new Player({ addEventListener() {}, clientWidth: 100, clientHeight: 100 }, workers,
    "http://localhost/ted4.wasm", (error) => { if (error !== null) errors.push(error.message); });
  await player.open(file, "file");
  const { view } = globalThis;
  const frames = setInterval(() => view.changed(performance.now()), 10);
  try {
    await body({ player, view, errors });
  } finally {
    clearInterval(frames);
  }
}

test("a worker that has no memory for a query lets go of the file, and the first one goes on",
  async () => {
    const workers = [new StubWorker(1, good), new StubWorker(1, () => NO_MEMORY)];
    const evaluators = new Evaluators(workers, "http://localhost/ted4.wasm");
    (await evaluators.open(new Uint8Array(1))).use();
    await evaluators.share();
    assert.equal(evaluators.count, 1);
    assert.deepEqual(workers[1].sent, ["load", "open", "gaussians", "close"]);
  });

test("what one worker refuses does not stop the picture of another one", async () => {
  let isFull = false;
  const workers = [new StubWorker(40, good),
    new StubWorker(1, () => (isFull ? NO_MEMORY : good()))];
  await withPlayer(workers, async ({ player, view }) => {
    await after(200);
    assert.equal(player.evaluators, 2);
    isFull = true;
    const before = view.sets;
    player.clock.play(performance.now());
    await after(400);
    player.clock.pause();
    assert.ok(view.sets > before + 3, `${view.sets - before} pictures`);
  });
});

test("Gaussians that cannot be drawn are told of, once", () =>
  withPlayer([new StubWorker(1, good)], async ({ errors }) => {
    globalThis.drawing = () => { throw new RangeError("Array buffer allocation failed"); };
    await after(100);
    assert.deepEqual(errors, ["Array buffer allocation failed"]);
  }));

test("a pivot is measured once something shows, and is as far as the scene is large until then",
  () => {
    let answer = atDepth(-7, 0);
    return withPlayer([new StubWorker(1, () => ({ value: answer }))], async ({ player }) => {
      await after(100);
      assert.equal(player.navigation.distance, 8);
      answer = atDepth(100);
      player.clock.seek(3);
      await after(100);
      assert.equal(player.navigation.distance, 100);
    }, fileWithCamera());
  });

test("a flight that is interrupted, as by a lost drawing context, goes on from where it was", () =>
  withPlayer([new StubWorker(1, good)], async ({ player, view }) => {
    const { navigation } = player, z = () => navigation.camera.t[2];
    const now = performance.now() + 1000, before = z();
    view.changed(now);
    navigation.press({ code: "KeyW", shiftKey: false });
    view.changed(now + 60e3);
    navigation.releaseAll();
    assert.ok(z() < before && z() > before - 0.1 * navigation.distance, `${before}, ${z()}`);
  }, fileWithCamera()));

test("a worker that fails as it lets go of a file that another one has replaced harms nothing",
  async () => {
    class Failing extends StubWorker {
      postMessage(message) {
        if (message.type === "close") setTimeout(() => this.onerror({ message: "failed" }));
        else super.postMessage(message);
      }
    }
    let unhandled = null;
    const hear = (error) => { unhandled = error; };
    process.on("unhandledRejection", hear);
    await withPlayer([new Failing(1, good)], async ({ player }) => {
      await Promise.allSettled([player.open(new ArrayBuffer(12), "replaced"),
        player.open(new ArrayBuffer(12), "last")]);
      await after(50);
    });
    process.off("unhandledRejection", hear);
    assert.equal(unhandled, null);
  });
