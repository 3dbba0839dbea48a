#!/usr/bin/env node
// driver.mjs - the WebAssembly decoder behind the driver contract of the conformance suite
// (conformance/README.md). Environment: TED4_WASM, the module (build/player/ted4.wasm).
// SPDX-License-Identifier: BSD-2-Clause
import { readFileSync } from "node:fs";
import { Decoder, Ted4Error } from "../src/decoder.js";

const CAPABILITIES = {
  protocol: 1, name: "ted4.wasm", version: "0.2.0-dev", spec: "1.0 and draft 1.1",
  profiles: ["Main", "Compact"], max_level: 31, tiers: ["T0", "T1", "T2", "T3", "T4", "T5"],
  class: "X", strict: true, lenient: true, declines: [], knobs: ["max_alloc_total", "max_work"],
};

function parse(words) {
  const request = { tiers: [], queries: null, lenient: false, options: {} };
  const [file, ...rest] = words;
  request.file = file;
  for (let i = 0; i + 1 < rest.length; i += 2) {
    const value = rest[i + 1];
    if (rest[i] === "--tiers") request.tiers = value.split(",").map((t) => Number(t.slice(1)));
    else if (rest[i] === "--queries") request.queries = JSON.parse(readFileSync(value, "utf8"));
    else if (rest[i] === "--mode") request.lenient = value === "lenient";
    else if (rest[i] === "--knob") {
      const [name, number] = value.split("=");
      request.options[name === "max_work" ? "maxWork" : "maxBytes"] = Number(number);
    } else throw new Error(`${rest[i]}: not an option`);
  }
  return request;
}

function query(scene, q) {
  try {
    scene.gaussians(q.t[0], q.t[1], q.cam);
    return scene.records();
  } catch (e) {
    if (e instanceof Ted4Error && e.verdict !== "limit") return { error: e.id };
    throw e;
  }
}

function tiers(scene, request, first) {
  const answer = {};
  for (const t of request.tiers.filter((t) => t >= first)) {
    answer[`T${t}`] = t === 5 ? (request.queries ?? []).map((q) => query(scene, q)) : scene.tier(t);
    if (answer[`T${t}`] === null) throw new Ted4Error("limit", "limit.memory");
  }
  return answer;
}

function refusal(e) {
  const answer = { result: e.verdict, error: e.id };
  if (e.offset !== undefined) answer.offset = e.offset;
  return answer;
}

function lenient(decoder, bytes, request) {
  const { error, salvage, scene } = decoder.salvage(bytes, request.options);
  if (error === null) return { result: "valid", tiers: tiers(scene, request, 0) };
  const answer = refusal(error);
  if (scene !== null)
    answer.salvage = {
      tiles: salvage.tiles, tiles_declared: salvage.tilesDeclared, anchors: scene.info.anchors,
      anchors_declared: salvage.anchorsDeclared, error: salvage.stop.id,
      offset: salvage.stop.offset ?? 0, hash: scene.info.hash, tiers: tiers(scene, request, 1),
    };
  return answer;
}

function run(decoder, request) {
  let bytes;
  try {
    bytes = readFileSync(request.file);
  } catch {
    return { result: "io", error: "io.read" };
  }
  try {
    if (request.lenient) return lenient(decoder, bytes, request);
    return { result: "valid", tiers: tiers(decoder.open(bytes, request.options), request, 0) };
  } catch (e) {
    if (e instanceof Ted4Error) return refusal(e);
    throw e;
  }
}

const [, , command, ...words] = process.argv;
if (command === "--ted4-capabilities") {
  console.log(JSON.stringify(CAPABILITIES));
} else if (command === "--ted4-run") {
  const wasm = process.env.TED4_WASM ??
    new URL("../../build/player/ted4.wasm", import.meta.url);
  console.log(JSON.stringify(run(await Decoder.load(readFileSync(wasm)), parse(words))));
} else {
  console.error("driver.mjs: see conformance/README.md");
  process.exit(3);
}
