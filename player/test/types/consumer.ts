// consumer.ts - a program in TypeScript that uses every function of the adapters, and times;
// types.mjs has it compiled. SPDX-License-Identifier: BSD-2-Clause
import { SparkRenderer, SplatMesh, type PackedSplats } from "@sparkjsdev/spark";
import type { GraphicsDevice, GSplatContainer, GSplatData, Quat } from "playcanvas";
import {
  Decoder, Scene, Ted4Client, Ted4Error, timeOfFragment, type Gaussians, type Vector,
} from "ted4";
import { trainedFocal, widening } from "ted4/adapters/pixel.js";
import { drawAsAnnexI, setPixel } from "ted4/adapters/playcanvas-kernel.js";
import { createContainer, updateContainer } from "ted4/adapters/playcanvas.js";
import { annexI, createPackedSplats, updatePackedSplats } from "ted4/adapters/spark.js";
import { FrameSource, gsplatData } from "ted4/adapters/supersplat.js";

const eye: Vector = [0, 0, -4];

export async function useAll(device: GraphicsDevice, bytes: Uint8Array): Promise<Quat> {
  const decoder = await Decoder.load("ted4.wasm");
  const scene = decoder.open(bytes);
  const { num, den } = timeOfFragment("#t=1.5", scene.info) ?? { num: 0, den: 1 };
  const gaussians: Gaussians = scene.gaussians(num, den, eye);
  drawAsAnnexI(device);
  const pixel = (trainedFocal([{ fx: 400 }]) ?? 800) / 800;
  setPixel(device, pixel);
  console.log(widening(pixel).learnt + widening(pixel).square);
  const container: GSplatContainer = createContainer(device, gaussians.n);
  updateContainer(container, gaussians);
  const packedSplats: PackedSplats = createPackedSplats(gaussians.n);
  updatePackedSplats(packedSplats, gaussians);
  new SplatMesh({ packedSplats }).updateVersion();
  const data: GSplatData = gsplatData(gaussians);
  const source = new FrameSource(scene, (frame, name) => `${name}: ${frame.numSplats}`, eye);
  const { asset, rotation } = await source.getFrame(source.frameCount - 1);
  console.log(asset.toUpperCase(), data.numSplats);
  source.destroy();
  console.log(new Ted4Error("limit", "limit.memory", undefined, "13.4", "no memory").offset);
  return rotation;
}

export async function useInWorker(bytes: ArrayBuffer): Promise<FrameSource<GSplatData>> {
  const client = new Ted4Client();
  await client.load(new URL("ted4.wasm", document.baseURI));
  const scene = await client.open(bytes);
  return new FrameSource(scene, (frame) => frame, eye, [0, 0, 1]);
}

type SparkOptions = ConstructorParameters<typeof SparkRenderer>[0];

export function sparkRenderer(options: SparkOptions): SparkRenderer {
  return new SparkRenderer({ ...options, ...annexI(0.5) });
}

export function misuse(device: GraphicsDevice, source: FrameSource<string>): void {
  // @ts-expect-error: the number of Gaussians is missing.
  createContainer(device);
  // @ts-expect-error: no Gaussians.
  updatePackedSplats(createPackedSplats(1), { n: 1 });
  // @ts-expect-error: there is no such member.
  source.frames();
  // @ts-expect-error: only the constructor sets it.
  source.frameCount = 3;
  // @ts-expect-error: decoders come from Decoder.load.
  new Decoder();
  // @ts-expect-error: scenes come from Decoder.open.
  new Scene();
  // @ts-expect-error: identifier, section and text are missing.
  new Ted4Error("text");
}
