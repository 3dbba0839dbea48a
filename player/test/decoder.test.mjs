// decoder.test.mjs - the WebAssembly decoder by its JavaScript interface, on vectors of the
// conformance suite. Run by `make player-test`. SPDX-License-Identifier: BSD-2-Clause
import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { test } from "node:test";
import { Decoder, Ted4Error } from "../src/index.js";

const root = new URL("../../", import.meta.url);
const vectors = new URL("conformance/vectors/", root);
const wasm = readFileSync(process.env.TED4_WASM ?? new URL("build/player/ted4.wasm", root));
const decoder = await Decoder.load(wasm);

function* inFolder(name) {
  const folder = new URL(name, vectors);
  for (const file of readdirSync(folder).filter((f) => f.endsWith(".ted4")))
    yield {
      bytes: readFileSync(new URL(file, folder)),
      wanted: JSON.parse(readFileSync(new URL(file.replace(/ted4$/, "json"), folder))),
    };
}

const contents = [...inFolder("content/")];

test("the module is small", () => {
  assert.ok(wasm.length <= 150e3, `${wasm.length} bytes`);
});

test("trained files have the hashes of their descriptors in T1 to T4", () => {
  assert.ok(contents.length > 0);
  for (const { bytes, wanted } of contents) {
    const scene = decoder.open(bytes);
    for (const t of [1, 2, 3, 4])
      assert.equal(scene.tier(t).xxh3, wanted.tiers[`T${t}`].xxh3, `${wanted.id} T${t}`);
  }
});

test("arithmetic is strict: class X", () => {
  assert.equal(decoder.open(contents[0].bytes).isClassX, true);
});

test("the bytes of all elements sum up to the file's", () => {
  for (const { bytes } of contents) {
    const rows = decoder.open(bytes, { budget: true }).bytesByElement();
    assert.equal(rows.reduce((sum, row) => sum + row.bytes, 0), bytes.length);
  }
});

test("Gaussians of a frame have as many values as records, finite, with opacity in [0, 1]", () => {
  const scene = decoder.open(contents[0].bytes);
  const g = scene.frame(scene.info.frames - 1, [0, 0, 0]);
  assert.equal(g.n, scene.info.gaussians);
  for (const a of [...g.mean, ...g.scale, ...g.rotation, ...g.colour, g.opacity]) {
    assert.equal(a.length, g.n);
    assert.ok(a.every(Number.isFinite));
  }
  assert.ok(g.opacity.every((x) => x >= 0 && x <= 1));
});

test("a query that is none is refused, and never taken for another one", () => {
  const scene = decoder.open(contents[0].bytes);
  const last = 2 ** 24 - 1;
  assert.ok(scene.gaussians(last, last, [0, 0, 0]).n > 0);
  for (const [num, den] of [[0.5, 1], [2 ** 32, 5], [3, 2 ** 32 + 5], [-1, 5], [6, 5], [0, 0],
    [1, 2 ** 24], [NaN, 1], ["0", 1]])
    assert.throws(() => scene.gaussians(num, den), { name: "Ted4Error", id: "query.range" });
  for (const camera of [[1, 2], [1, 2, 3, 4], ["1", 2, 3]])
    assert.throws(() => scene.frame(0, camera), TypeError);
  for (const options of [{ maxBytes: -1 }, { maxBytes: NaN }, { maxWork: -1 },
    { maxQueryWork: -1 }])
    assert.throws(() => decoder.open(contents[0].bytes, options), RangeError);
});

test("a file is bytes; a path, an address or a number is refused as the caller's mistake", () => {
  for (const file of ["scene.ted4", new URL("file:///scene.ted4"), 5, null, undefined, [1, 2]])
    for (const call of ["open", "salvage"])
      assert.throws(() => decoder[call](file), { name: "TypeError", message: /, expected bytes$/ });
  const { buffer, byteOffset, byteLength } = Uint8Array.from(contents[0].bytes);
  const { hash } = decoder.open(contents[0].bytes).info;
  assert.equal(decoder.open(new DataView(buffer, byteOffset, byteLength)).info.hash, hash);
});

test("a broken file is refused with identifier and offset", () => {
  const bytes = Uint8Array.from(contents[0].bytes);
  bytes[100] ^= 1;
  assert.throws(() => decoder.open(bytes), (e) => e instanceof Ted4Error &&
    e.verdict === "invalid" && e.id === "con.chunk-hash" && Number.isInteger(e.offset));
  assert.throws(() => decoder.open(new Uint8Array(0)), { id: "con.truncated", offset: 0 });
});

test("a bound on memory is kept", () => {
  assert.throws(() => decoder.open(contents[0].bytes, { maxBytes: 1000 }), { id: "limit.memory" });
});

test("a bound on the work of queries is kept, and does not bound decoding", () => {
  const least = decoder.open(contents[0].bytes, { maxQueryWork: 1 });
  assert.throws(() => least.frame(0), { verdict: "limit", id: "limit.work" });
  assert.ok(decoder.open(contents[0].bytes, { maxQueryWork: 1e9 }).frame(0).n > 0);
  assert.throws(() => decoder.open(contents[0].bytes, { maxWork: 1 }), { id: "limit.work" });
});

test("a time beyond the last is refused", () => {
  assert.throws(() => decoder.open(contents[0].bytes).gaussians(2, 1), Ted4Error);
});

test("a scene that does not keep its file has all that was decoded of it", () => {
  const { bytes, wanted } = contents[0], scene = decoder.open(bytes, { keepsFile: false });
  assert.throws(() => scene.tier(0), { message: /keepsFile/ });
  assert.equal(scene.tier(1).xxh3, wanted.tiers.T1.xxh3);
  assert.equal(scene.frame(0).n, scene.info.gaussians);
  assert.equal(decoder.open(bytes).tier(0).bytes > 0, true);
  assert.throws(() => decoder.salvage(bytes, { keepsFile: false }).scene.tier(0),
    { message: /keepsFile/ });
});

test("every scene has memory of its own", () => {
  const [a, b] = [decoder.open(contents[0].bytes), decoder.open(contents.at(-1).bytes)];
  const before = a.frame(0).mean[0].slice();
  b.frame(0);
  assert.deepEqual(a.frame(0).mean[0].slice(), before);
});
