// evaluators.js - the workers that evaluate a file's Gaussians. The first one decodes the file and
// is enough; the others decode it too, later, so that two times can be evaluated at once.
// SPDX-License-Identifier: BSD-2-Clause
import { Ted4Client } from "../src/client.js";

// Whether a scene can be evaluated: its first query takes the rest of the memory.
const answers = (scene) => scene.gaussians(0, 1).then(() => true, () => false);

export class Evaluators {
  #clients;
  #loaded = []; // what worker i says of the module
  #wasm;
  #scenes = []; // of the open file, one per worker that has it: { scene, waiting }
  #bytes = null;

  // workers: one or more that run src/worker.js; wasm: the module's bytes, or its address.
  constructor(workers, wasm) {
    this.#clients = workers.map((worker) => new Ted4Client(worker));
    this.#wasm = wasm;
    this.#load(0).catch(() => {}); // the first file that is opened tries again
  }

  // Gives worker i the module, once. What failed is tried again the next time.
  #load(i) {
    this.#loaded[i] ??= this.#clients[i].load(this.#wasm).catch((error) => {
      this.#loaded[i] = undefined;
      throw error;
    });
    return this.#loaded[i];
  }

  // Opens a file in the first worker: { scene, use }. use() lets go of the file before and takes
  // this one. Rejects with Ted4Error.
  async open(bytes) {
    await this.#load(0);
    const scene = await this.#clients[0].open(bytes);
    const use = () => {
      // A worker that has failed has no scene to let go of.
      for (const { scene: before } of this.#scenes) before.close().catch(() => {});
      this.#scenes = [{ scene, waiting: 0 }];
      this.#bytes = bytes;
    };
    return { scene, use };
  }

  // The other workers get the file as well. One that cannot, for want of memory, stays idle.
  async share() {
    const bytes = this.#bytes;
    await Promise.all(this.#clients.slice(1).map(async (client, i) => {
      try {
        await this.#load(i + 1);
        const scene = await client.open(bytes);
        if (await answers(scene) && bytes === this.#bytes) this.#scenes.push({ scene, waiting: 0 });
        else await scene.close();
      } catch {
        // The first worker has decoded the same bytes, so that the file is not at fault.
      }
    }));
  }

  // How many times can be evaluated at once.
  get count() {
    return this.#scenes.length;
  }

  get isFree() {
    return this.#scenes.some(({ waiting }) => waiting === 0);
  }

  // As of ClientScene, by the worker that has the least to do.
  async gaussians(num, den, centre) {
    const worker = this.#scenes.reduce((a, b) => (b.waiting < a.waiting ? b : a));
    worker.waiting++;
    try {
      return await worker.scene.gaussians(num, den, centre);
    } finally {
      worker.waiting--;
    }
  }

  // Elements of the file and their bytes. Slow: the file is decoded again.
  async bytesByElement() {
    const scene = await this.#clients[0].open(this.#bytes, { budget: true });
    scene.close().catch(() => {});
    return scene.bytesByElement;
  }
}
