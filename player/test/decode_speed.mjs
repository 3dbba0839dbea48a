// decode_speed.mjs FILE.ted4 - how long the module takes to decode a file, against the native
// decoder with its plain kernels, each on one core: the least of several turns, in milliseconds.
// SPDX-License-Identifier: BSD-2-Clause
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { Decoder } from "../src/decoder.js";

const [FILE, PROGRAM] = [process.argv[2], process.env.TED4_DEC];
const TURNS = 12;
const ENVIRONMENT = { ...process.env, TED4_KERNEL: "plain" };

function native() {
  const said = execFileSync(PROGRAM, ["--test", "-j", "1", "--json", "-q", FILE],
    { encoding: "utf8", env: ENVIRONMENT });
  return JSON.parse(said).decode_ms;
}

const bytes = readFileSync(FILE);
const decoder = await Decoder.load(readFileSync(process.env.TED4_WASM));
const least = { wasm: Infinity, plain: Infinity };
for (let i = 0; i < TURNS; i++) {
  const start = performance.now();
  decoder.open(bytes);
  least.wasm = Math.min(least.wasm, performance.now() - start);
  least.plain = Math.min(least.plain, native());
}
console.log(JSON.stringify({ ...least, ratio: least.wasm / least.plain },
  (key, v) => (typeof v === "number" ? Math.round(100 * v) / 100 : v)));
