// supersplat.js - a scene as a FrameSource of SuperSplat's sequences (its src/sequence.ts):
// frameCount, getFrame, destroy. Frames look as they do from one place, because SuperSplat's frames
// know nothing of the camera.
// SPDX-License-Identifier: BSD-2-Clause
import { GSplatData, Quat, Vec3 } from "playcanvas";

const SH_C0 = 0.28209479177387814; // the constant of spherical harmonics of degree 0
const LEAST = 1e-6; // opacities are kept so far from 0 and 1, that their logarithms are finite
const LEAST_SCALE = 2 ** -126; // for the same reason, as in .ply files of ted4dec

const logit = (p) => {
  const inside = Math.min(Math.max(p, LEAST), 1 - LEAST);
  return Math.log(inside / (1 - inside));
};

const logarithm = (s) => Math.log(Math.max(s, LEAST_SCALE));

// The properties of a PLY file of 3D Gaussian splatting.
function propertiesOf({ mean, scale, rotation, opacity, colour }) {
  const all = (prefix, arrays, map, names) =>
    arrays.map((array, i) => [prefix + names[i], array.map(map)]);
  const same = (v) => v;
  return [
    ...all("", mean, same, "xyz"), ...all("scale_", scale, logarithm, "012"),
    ...all("rot_", rotation, same, "0123"), ["opacity", opacity.map(logit)],
    ...all("f_dc_", colour, (v) => (v - 0.5) / SH_C0, "012"),
  ];
}

export function gsplatData(g) {
  const properties = propertiesOf(g).map(([name, storage]) =>
    ({ type: "float", name, storage, byteSize: 4 }));
  return new GSplatData([{ name: "vertex", count: g.n, properties }]);
}

export class FrameSource {
  #scene;
  #createAsset;
  #eye;
  #rotation;

  // scene: of Decoder.open or Ted4Client.open; createAsset(gsplatData, name): as SuperSplat's
  // scene.assetLoader.createGSplatAsset; eye: from where colours are seen; up: what is up in the
  // file, which is turned to +y.
  constructor(scene, createAsset, eye = [0, 0, 0], up = [0, -1, 0]) {
    this.#scene = scene;
    this.#createAsset = createAsset;
    this.#eye = eye;
    // From -y by half a turn about z, as SuperSplat turns PLY files.
    this.#rotation = up[1] < -0.9999 ? new Quat(0, 0, 1, 0)
      : new Quat().setFromDirections(new Vec3(up), Vec3.UP);
  }

  get frameCount() {
    return this.#scene.info.frames;
  }

  async getFrame(index) {
    const g = await this.#scene.frame(index, this.#eye);
    const asset = this.#createAsset(gsplatData(g), `frame_${index}`);
    return { asset, rotation: this.#rotation.clone() };
  }

  // A scene whose client is terminated is gone already, and its close() rejects.
  destroy() {
    this.#scene.close?.().catch(() => {});
  }
}
