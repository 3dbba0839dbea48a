// Types of adapters/supersplat.js. SPDX-License-Identifier: BSD-2-Clause
import type { GSplatData, Quat } from "playcanvas";
import type { ClientScene, Gaussians, Scene, Vector } from "../src/index.js";

/** The properties of a PLY file of 3D Gaussian splatting. */
export function gsplatData(gaussians: Gaussians): GSplatData;

/** Asset: what createAsset gives, or promises. */
export class FrameSource<Asset> {
  /** createAsset: as SuperSplat's scene.assetLoader.createGSplatAsset; eye: from where colours are
   *  seen, in world coordinates (default: the origin); up: the unit vector that is up in the file,
   *  which is turned to +y (default: -y). */
  constructor(scene: Scene | ClientScene, createAsset: (data: GSplatData, name: string) => Asset,
    eye?: Vector, up?: Vector);
  readonly frameCount: number;
  /** index: 0 to frameCount - 1. Rejects with Ted4Error. */
  getFrame(index: number): Promise<{ asset: Asset; rotation: Quat }>;
  /** Gives back the scene of a Ted4Client. */
  destroy(): void;
}
