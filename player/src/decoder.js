// decoder.js - TED4 files in JavaScript: the reference decoder as a WebAssembly module
// (wasm/api.c), one instance per file. Works in browsers, in workers and in Node; depends on
// nothing.
// SPDX-License-Identifier: BSD-2-Clause
import { timeOfFrame } from "./times.js";

// Members of ted4_info in units of 4 bytes (ted4.h, wasm32).
const INFO = {
  anchors: 0, offsets: 1, frames: 2, rateNum: 3, rateDen: 4, gaussians: 5, moving: 6, level: 7,
  view: 8, motion: 9, activation: 10, origin: 11, exponent: 14, background: 15,
};
const INFO_HASH = 4 * INFO.background + 3; // bytes
const MOTION = ["none", "bank", "concat", "inr"];
const VIEW = ["none", "colour", "full"];
// Members of ted4_gaussians: the count, then addresses.
const ARRAYS = ["mean", "mean", "mean", "scale", "scale", "scale", "rotation", "rotation",
  "rotation", "rotation", "opacity", "colour", "colour", "colour"];
// Members of ted4_budget_row in bytes: chunk, element, bytes, symbols.
const ROW = { chunk: 0, element: 8, bytes: 40, symbols: 48 };
const STATUS = { id: 0, section: 1, text: 2, verdict: 3 };
const DEFAULT_MAX_BYTES = 2 ** 31;

// Why a file, or a query, is refused. id: of the specification's chapter 14, as "con.magic";
// offset: byte offset in the file; undefined for verdicts without one.
export class Ted4Error extends Error {
  constructor(verdict, id, offset, section, text) {
    super(offset === undefined ? `${id}: ${text}` : `${id} at byte ${offset}: ${text}`);
    this.name = "Ted4Error";
    Object.assign(this, { verdict, id, offset, section, text });
  }
}

// Can the module take it as a term of a query? What it takes, it judges (R-REC-002).
function isTerm(n) {
  return Number.isInteger(n) && n >= 0 && n < 2 ** 32;
}

// The bytes of a file: an ArrayBuffer, or any view of one.
export function bytesOf(file) {
  if (file instanceof ArrayBuffer) return new Uint8Array(file);
  if (ArrayBuffer.isView(file))
    return new Uint8Array(file.buffer, file.byteOffset, file.byteLength);
  throw new TypeError(`${typeof file === "string" ? file : typeof file}, expected bytes`);
}

function hex(bytes) {
  return Array.from(bytes, (b) => b.toString(16).padStart(2, "0")).join("");
}

// The compiled module, from which every file gets an instance.
export class Decoder {
  #module;

  constructor(module) {
    this.#module = module;
  }

  // source: a WebAssembly.Module, its bytes, a Response or a promise of one, or a URL.
  static async load(source) {
    if (source instanceof WebAssembly.Module) return new Decoder(source);
    if (source instanceof ArrayBuffer || ArrayBuffer.isView(source))
      return new Decoder(await WebAssembly.compile(source));
    const response = await (typeof source === "string" || source instanceof URL
      ? fetch(source) : source);
    if (!response.ok) throw new Error(`${response.url}: ${response.status}`);
    return new Decoder(await WebAssembly.compile(await response.arrayBuffer()));
  }

  // The module, which may be posted to a worker.
  get module() {
    return this.#module;
  }

  // Strict decoding of a whole file. options: maxBytes of memory and maxWork (spec 13.4) that the
  // file may ask for, and maxQueryWork that each query may; budget: true also attributes its bytes
  // to elements; keepsFile: false lets go of the bytes once they are decoded, and then there is no
  // tier 0. Throws Ted4Error, or TypeError for a path or an address in place of bytes.
  open(bytes, options = {}) {
    const scene = new Scene(new WebAssembly.Instance(this.#module, {}).exports, bytes, options);
    scene.decode();
    return scene;
  }

  // Lenient decoding (spec 3.3): { error, salvage, scene }. error: the strict verdict as a
  // Ted4Error, or null; scene: what could be read, or null.
  salvage(bytes, options = {}) {
    const scene = new Scene(new WebAssembly.Instance(this.#module, {}).exports, bytes, options);
    return scene.decodeLenient();
  }
}

// A decoded file. Made by Decoder.
export class Scene {
  #wasm;
  #bytes;
  #options;
  #file = 0;
  info = null;

  constructor(wasm, bytes, options) {
    this.#wasm = wasm;
    this.#bytes = bytesOf(bytes);
    this.#options = {
      maxBytes: DEFAULT_MAX_BYTES, maxWork: 0, maxQueryWork: 0, budget: false, keepsFile: true,
      ...options,
    };
    for (const name of ["maxBytes", "maxWork", "maxQueryWork"])
      if (!(this.#options[name] >= 0))
        throw new RangeError(`${name}: ${this.#options[name]}, expected a number from 0`);
  }

  #view() {
    return new DataView(this.#wasm.memory.buffer);
  }

  #text(address) {
    const memory = new Uint8Array(this.#wasm.memory.buffer);
    return new TextDecoder().decode(memory.subarray(address, memory.indexOf(0, address)));
  }

  #status(code, what) {
    return this.#text(this.#wasm.ted4_wasm_status(code, what));
  }

  #error(code, offset) {
    const verdict = this.#status(code, STATUS.verdict);
    const placed = verdict === "invalid" || verdict === "unsupported";
    return new Ted4Error(verdict, this.#status(code, STATUS.id), placed ? offset : undefined,
      this.#status(code, STATUS.section), this.#status(code, STATUS.text));
  }

  // Runs body over a copy of the file in the instance's memory, which is given back.
  #withFile(body) {
    if (this.#bytes === null) throw new Error("the file is gone: it was opened without keepsFile");
    const size = this.#bytes.length;
    const address = this.#wasm.ted4_wasm_alloc(size) >>> 0;
    if (address === 0) throw this.#error(this.#codeOf("limit.memory"), 0);
    new Uint8Array(this.#wasm.memory.buffer).set(this.#bytes, address);
    try {
      return body(address, size);
    } finally {
      this.#wasm.ted4_wasm_free(address);
    }
  }

  #codeOf(id) {
    let code = 1;
    while (this.#status(code, STATUS.id) !== id) code++;
    return code;
  }

  decode() {
    const { maxBytes, maxWork, budget } = this.#options;
    const code = this.#withFile((address, size) =>
      this.#wasm.ted4_wasm_open(address, size, maxBytes, maxWork, budget ? 1 : 0));
    if (code !== 0)
      throw this.#error(code, this.#view().getUint32(this.#wasm.ted4_wasm_error() + 4, true));
    this.#endDecoding();
  }

  decodeLenient() {
    const { maxBytes, maxWork } = this.#options;
    const code = this.#withFile((address, size) =>
      this.#wasm.ted4_wasm_open_lenient(address, size, maxBytes, maxWork));
    const offset = this.#view().getUint32(this.#wasm.ted4_wasm_error() + 4, true);
    const at = this.#wasm.ted4_wasm_salvage();
    const [tiles, tilesDeclared, anchorsDeclared, stop, stopOffset] =
      Array.from({ length: 5 }, (_, i) => this.#view().getUint32(at + 4 * i, true));
    this.#endDecoding();
    return {
      error: code === 0 ? null : this.#error(code, offset),
      salvage: { tiles, tilesDeclared, anchorsDeclared, stop: this.#error(stop, stopOffset) },
      scene: this.info === null ? null : this,
    };
  }

  #endDecoding() {
    this.info = this.#readInfo();
    if (!this.#options.keepsFile) this.#bytes = null;
  }

  #readInfo() {
    const at = this.#wasm.ted4_wasm_info();
    if (at === 0) return null;
    const view = this.#view();
    const word = (i) => view.getUint32(at + 4 * i, true);
    const byte = (i) => view.getUint8(at + i);
    return {
      anchors: word(INFO.anchors), offsets: word(INFO.offsets), gaussians: word(INFO.gaussians),
      moving: word(INFO.moving), frames: word(INFO.frames),
      rate: word(INFO.rateNum) / word(INFO.rateDen), rateNum: word(INFO.rateNum),
      rateDen: word(INFO.rateDen), level: word(INFO.level),
      view: VIEW[word(INFO.view)], motion: MOTION[word(INFO.motion)],
      activation: word(INFO.activation) !== 0,
      origin: [0, 1, 2].map((i) => view.getFloat32(at + 4 * (INFO.origin + i), true)),
      exponent: view.getInt32(at + 4 * INFO.exponent, true),
      background: [0, 1, 2].map((i) => byte(4 * INFO.background + i)),
      hash: hex(new Uint8Array(this.#wasm.memory.buffer, at + INFO_HASH, 16)),
    };
  }

  // The Gaussians of time num / den from a camera centre in world coordinates: { n, id, mean:
  // [x, y, z], scale: [3], rotation: [w, x, y, z], opacity, colour: [r, g, b] }, arrays of n values
  // in the module's memory, which stay as they are until the next call. Throws Ted4Error.
  gaussians(num, den, camera = [0, 0, 0]) {
    if (!isTerm(num) || !isTerm(den))
      throw this.#error(this.#codeOf("query.range"));
    const [x, y, z] = camera;
    if (camera.length !== 3 || ![x, y, z].every((v) => typeof v === "number"))
      throw new TypeError(`camera: ${camera}, expected three numbers`);
    const { maxBytes, maxQueryWork } = this.#options;
    const code = this.#wasm.ted4_wasm_query(num, den, x, y, z, maxBytes, maxQueryWork);
    if (code !== 0) throw this.#error(code);
    const view = this.#view();
    const at = this.#wasm.ted4_wasm_gaussians();
    const n = view.getUint32(at, true);
    const address = (i) => view.getUint32(at + 4 + 4 * i, true);
    const buffer = this.#wasm.memory.buffer;
    const result = { n, mean: [], scale: [], rotation: [], opacity: null, colour: [] };
    ARRAYS.forEach((name, i) => {
      const array = new Float32Array(buffer, address(i), n);
      if (name === "opacity") result.opacity = array;
      else result[name].push(array);
    });
    result.id = new Uint32Array(buffer, address(ARRAYS.length), n);
    return result;
  }

  // The Gaussians of frame j.
  frame(j, camera) {
    const { num, den } = timeOfFrame(j, this.info);
    return this.gaussians(num, den, camera);
  }

  // 1: arithmetic is strict here (class X).
  get isClassX() {
    return this.#wasm.ted4_wasm_class_x() !== 0;
  }

  // Size and XXH3-128 of a tier of annex J, 0 to 4; null: no memory.
  tier(number) {
    const { maxBytes } = this.#options;
    const at = number === 0
      ? this.#withFile((a, size) => this.#wasm.ted4_wasm_tier(0, a, size, maxBytes))
      : this.#wasm.ted4_wasm_tier(number, 0, 0, maxBytes);
    return at === 0 ? null : this.#tierAt(at);
  }

  // The same of T5: the records of the last query.
  records() {
    return this.#tierAt(this.#wasm.ted4_wasm_records());
  }

  #tierAt(at) {
    return {
      bytes: this.#view().getFloat64(at, true),
      xxh3: hex(new Uint8Array(this.#wasm.memory.buffer, at + 8, 16)),
    };
  }

  // Of a file opened with budget: [{ chunk, element, bytes, symbols }], whose bytes sum up to the
  // file's.
  bytesByElement() {
    const rows = [];
    for (let at; (at = this.#wasm.ted4_wasm_budget(rows.length)) !== 0;) {
      const view = this.#view();
      rows.push({
        chunk: this.#text(at + ROW.chunk), element: this.#text(at + ROW.element),
        bytes: Number(view.getBigUint64(at + ROW.bytes, true)),
        symbols: Number(view.getBigUint64(at + ROW.symbols, true)),
      });
    }
    return rows;
  }
}
