// worker.js - a decoder in a worker: opens files and answers queries, so that a page stays smooth.
// client.js speaks to it. Messages are { call, type, ... }, answers { call, value } or
// { call, error }.
// SPDX-License-Identifier: BSD-2-Clause
import { Decoder } from "./decoder.js";

let decoder = null;
const scenes = new Map();

// Copies that may be transferred: the arrays of a query change with the next one.
function copied(g) {
  const copy = (array) => array.slice();
  return {
    n: g.n, id: copy(g.id), opacity: copy(g.opacity), mean: g.mean.map(copy),
    scale: g.scale.map(copy), rotation: g.rotation.map(copy), colour: g.colour.map(copy),
  };
}

function buffers(g) {
  return [g.id, g.opacity, ...g.mean, ...g.scale, ...g.rotation, ...g.colour].map((a) => a.buffer);
}

const actions = {
  load({ source }) {
    return Decoder.load(source).then((d) => { decoder = d; });
  },
  open({ scene, bytes, options }) {
    if (decoder === null) throw new Error("no decoder: call load() before open()");
    const start = performance.now();
    const opened = decoder.open(bytes, { ...options, keepsFile: false });
    scenes.set(scene, opened);
    return {
      info: opened.info, bytesByElement: options?.budget ? opened.bytesByElement() : null,
      milliseconds: performance.now() - start,
    };
  },
  gaussians({ scene, num, den, camera }) {
    if (!scenes.has(scene)) throw new Error("the scene is closed");
    const start = performance.now();
    const result = copied(scenes.get(scene).gaussians(num, den, camera));
    result.milliseconds = performance.now() - start;
    return result;
  },
  close({ scene }) {
    scenes.delete(scene);
  },
};

function described(e) {
  const { message, verdict, id, offset, section, text } = e;
  return { message, verdict, id, offset, section, text };
}

async function answer(data) {
  try {
    const value = await actions[data.type](data);
    self.postMessage({ call: data.call, value },
      { transfer: data.type === "gaussians" ? buffers(value) : [] });
  } catch (e) {
    self.postMessage({ call: data.call, error: described(e) });
  }
}

// Loading takes several turns of the worker; calls that come in the meantime wait for it.
let answered = Promise.resolve();
self.onmessage = ({ data }) => {
  answered = answered.then(() => answer(data));
};
