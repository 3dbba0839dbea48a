// client.js - decodes in a worker (worker.js). Every call gives a promise; calls of one client are
// answered in order.
// SPDX-License-Identifier: BSD-2-Clause
import { Ted4Error } from "./decoder.js";
import { timeOfFrame } from "./times.js";

function restored(e) {
  if (e.id === undefined) return new Error(e.message);
  return new Ted4Error(e.verdict, e.id, e.offset, e.section, e.text);
}

export class Ted4Client {
  #worker;
  #waiting = new Map();
  #calls = 0;
  #scenes = 0;

  // worker: one that runs worker.js; made from the file beside this one if it is missing.
  constructor(worker = new Worker(new URL("./worker.js", import.meta.url), { type: "module" })) {
    this.#worker = worker;
    worker.onmessage = ({ data: { call, value, error } }) => {
      const { resolve, reject } = this.#waiting.get(call);
      this.#waiting.delete(call);
      if (error) reject(restored(error));
      else resolve(value);
    };
    worker.onerror = (e) => {
      for (const { reject } of this.#waiting.values()) reject(new Error(e.message));
      this.#waiting.clear();
    };
  }

  #ask(message, transfer = []) {
    const call = ++this.#calls;
    return new Promise((resolve, reject) => {
      this.#waiting.set(call, { resolve, reject });
      this.#worker.postMessage({ call, ...message }, transfer);
    });
  }

  // source: of the module, as Decoder.load takes it, but for a Response.
  load(source) {
    return this.#ask({ type: "load", source });
  }

  // The file's scene: { info, bytesByElement, milliseconds, gaussians(num, den, camera), frame(j,
  // camera), close() }. Rejects with Ted4Error. bytes go to the worker and are gone here.
  async open(bytes, options = {}) {
    const scene = ++this.#scenes;
    const buffer = bytes instanceof ArrayBuffer ? bytes : bytes.slice().buffer;
    const opened = await this.#ask({ type: "open", scene, bytes: buffer, options }, [buffer]);
    const gaussians = (num, den, camera = [0, 0, 0]) =>
      this.#ask({ type: "gaussians", scene, num, den, camera });
    return {
      ...opened,
      gaussians,
      frame: (j, camera) => {
        const { num, den } = timeOfFrame(j, opened.info);
        return gaussians(num, den, camera);
      },
      close: () => this.#ask({ type: "close", scene }),
    };
  }

  terminate() {
    this.#worker.terminate();
  }
}
