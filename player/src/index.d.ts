// Types of the package ted4. SPDX-License-Identifier: BSD-2-Clause

export type Verdict = "valid" | "invalid" | "limit" | "unsupported" | "io";

/** Why a file, or a query, is refused (specification, chapter 14). */
export class Ted4Error extends Error {
  readonly verdict: Verdict;
  readonly id: string;
  /** Byte offset in the file; undefined for verdicts without one. */
  readonly offset?: number;
  readonly section: string;
  readonly text: string;
  constructor(verdict: Verdict, id: string, offset: number | undefined, section: string,
    text: string);
}

export interface OpenOptions {
  /** Bytes of memory that the file may ask for; 2 GiB if it is missing. */
  maxBytes?: number;
  /** Steps of spec 13.4 that decoding may take (W_E); 0, the default: any. */
  maxWork?: number;
  /** Steps that each query may take (W_R); 0, the default: any. */
  maxQueryWork?: number;
  /** Attribute the file's bytes to its elements, too. */
  budget?: boolean;
  /** Keep the file's bytes, which only tier(0) needs, after decoding; true if it is missing. A
   *  Ted4Client keeps none. */
  keepsFile?: boolean;
}

export interface SceneInfo {
  anchors: number;
  offsets: number;
  gaussians: number;
  moving: number;
  frames: number;
  /** Frames per second. */
  rate: number;
  /** The same as a fraction. */
  rateNum: number;
  rateDen: number;
  level: number;
  view: "none" | "colour" | "full";
  motion: "none" | "bank" | "concat" | "inr";
  activation: boolean;
  origin: [number, number, number];
  exponent: number;
  /** Display-referred sRGB: red, green, blue. */
  background: [number, number, number];
  /** XXH3-128 of the decoded integers (spec 15.2), hexadecimal. */
  hash: string;
}

/** Structure of arrays; world axes are those of the scene; scales are standard deviations;
 *  rotations are w, x, y, z; colours are display-referred sRGB from 0 to 1. */
export interface Gaussians {
  n: number;
  id: Uint32Array;
  mean: Float32Array[];
  scale: Float32Array[];
  rotation: Float32Array[];
  opacity: Float32Array;
  colour: Float32Array[];
}

export interface Element {
  chunk: string;
  element: string;
  bytes: number;
  symbols: number;
}

export type Vector = [number, number, number];
type Source = WebAssembly.Module | BufferSource | Response | Promise<Response> | string | URL;

/** A time of a scene, from 0 / den to den / den, for Scene.gaussians (specification, R-REC-002). */
export interface Time {
  num: number;
  den: number;
}

/** Of a frame, from 0 to frames - 1. */
export function timeOfFrame(j: number, info: SceneInfo): Time;
/** Of a decimal number of seconds after the first frame; undefined if the text is none. */
export function timeOfSeconds(text: string, info: SceneInfo): Time | undefined;
/** Of "#t=SECONDS" or "#frame=J" (specification, 18); undefined if it says no time. */
export function timeOfFragment(fragment: string, info: SceneInfo): Time | undefined;

/** A decoded file, from Decoder.open. */
export class Scene {
  private constructor();
  readonly info: SceneInfo;
  readonly isClassX: boolean;
  /** Arrays lie in the decoder's memory and stay as they are until the next call. */
  gaussians(num: number, den: number, camera?: Vector): Gaussians;
  frame(j: number, camera?: Vector): Gaussians;
  bytesByElement(): Element[];
  /** Size and XXH3-128 of a tier of annex J, 0 to 4; null: no memory. Throws for tier 0 of a file
   *  that was not kept. */
  tier(number: number): { bytes: number; xxh3: string } | null;
  /** The same of the records of the last query (T5). */
  records(): { bytes: number; xxh3: string };
}

export class Decoder {
  private constructor();
  /** An address is fetched, which Node does not do for addresses that begin with file: */
  static load(source: Source): Promise<Decoder>;
  readonly module: WebAssembly.Module;
  /** Throws Ted4Error. */
  open(bytes: Uint8Array | ArrayBuffer, options?: OpenOptions): Scene;
  salvage(bytes: Uint8Array | ArrayBuffer, options?: OpenOptions): {
    error: Ted4Error | null;
    salvage: { tiles: number; tilesDeclared: number; anchorsDeclared: number; stop: Ted4Error };
    scene: Scene | null;
  };
}

export interface TimedGaussians extends Gaussians {
  milliseconds: number;
}

export interface ClientScene {
  info: SceneInfo;
  bytesByElement: Element[] | null;
  milliseconds: number;
  gaussians(num: number, den: number, camera?: Vector): Promise<TimedGaussians>;
  frame(j: number, camera?: Vector): Promise<TimedGaussians>;
  close(): Promise<void>;
}

/** Every call gives a promise. All are rejected once the worker has failed or is terminated. */
export class Ted4Client {
  constructor(worker?: Worker);
  /** An address is relative to the page. */
  load(source: WebAssembly.Module | BufferSource | string | URL): Promise<void>;
  /** An ArrayBuffer goes to the worker and is gone (detached) afterwards; a Uint8Array is copied.
   *  Rejects with Ted4Error. */
  open(bytes: Uint8Array | ArrayBuffer, options?: OpenOptions): Promise<ClientScene>;
  terminate(): void;
}
