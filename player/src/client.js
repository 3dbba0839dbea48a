// client.js - decodes in a worker (worker.js). Every call gives a promise; calls of one client are
// answered in order. When the worker fails or is terminated, all calls are rejected.
// SPDX-License-Identifier: BSD-2-Clause
import { Ted4Error, bytesOf } from "./decoder.js";
import { timeOfFrame } from "./times.js";

function restored(e) {
  if (e.id === undefined) return new Error(e.message);
  return new Ted4Error(e.verdict, e.id, e.offset, e.section, e.text);
}

// An address as text, in full: the worker has no page that it could be relative to.
function absolute(address) {
  const { document, location } = globalThis;
  return new URL(address, document?.baseURI ?? location?.href).href;
}

// A buffer to be transferred: of an ArrayBuffer itself, of a view a copy of its bytes.
function owned(bytes) {
  return bytes instanceof ArrayBuffer ? bytes : bytesOf(bytes).slice().buffer;
}

export class Ted4Client {
  #worker;
  #waiting = new Map();
  #calls = 0;
  #scenes = 0;
  #end = null; // why the worker answers no more

  // worker: one that runs worker.js; made from the file beside this one if it is missing.
  constructor(worker = new Worker(new URL("./worker.js", import.meta.url), { type: "module" })) {
    this.#worker = worker;
    worker.onmessage = ({ data: { call, value, error } }) => {
      const waiting = this.#waiting.get(call);
      this.#waiting.delete(call);
      if (error) waiting?.reject(restored(error));
      else waiting?.resolve(value);
    };
    // A worker whose script cannot be fetched says nothing of it.
    worker.onerror = (e) => this.#finish(e.message || "the worker failed to start");
  }

  #finish(reason) {
    this.#end ??= new Error(reason);
    for (const { reject } of this.#waiting.values()) reject(this.#end);
    this.#waiting.clear();
  }

  async #ask(message, transfer = []) {
    if (this.#end !== null) throw this.#end;
    const call = ++this.#calls;
    this.#worker.postMessage({ call, ...message }, transfer);
    return new Promise((resolve, reject) => { this.#waiting.set(call, { resolve, reject }); });
  }

  // source: of the module, as Decoder.load takes it, but for a Response.
  async load(source) {
    const isAddress = typeof source === "string" || source instanceof URL;
    return this.#ask({ type: "load", source: isAddress ? absolute(source) : source });
  }

  // The file's scene: { info, bytesByElement, milliseconds, gaussians(num, den, camera), frame(j,
  // camera), close() }. Rejects with Ted4Error. An ArrayBuffer goes to the worker and is gone here;
  // of a Uint8Array the worker gets a copy.
  async open(bytes, options = {}) {
    const scene = ++this.#scenes, buffer = owned(bytes);
    const opened = await this.#ask({ type: "open", scene, bytes: buffer, options }, [buffer]);
    const gaussians = (num, den, camera = [0, 0, 0]) =>
      this.#ask({ type: "gaussians", scene, num, den, camera });
    return {
      ...opened,
      gaussians,
      frame: async (j, camera) => {
        const { num, den } = timeOfFrame(j, opened.info);
        return gaussians(num, den, camera);
      },
      close: () => this.#ask({ type: "close", scene }),
    };
  }

  terminate() {
    this.#worker.terminate();
    this.#finish("the worker is terminated");
  }
}
