// player.js - a file on the screen: decodes and evaluates in workers, and keeps the picture at the
// time and the camera that are wanted now. It knows nothing of the page around its canvas.
// SPDX-License-Identifier: BSD-2-Clause
import { trainedFocal } from "../adapters/pixel.js";
import { timeOfFragment } from "../src/times.js";
import { centreOf, fitted } from "./camera.js";
import { bytesByType, camerasOf, chunksOf, metaOf } from "./chunks.js";
import { Clock } from "./clock.js";
import { Evaluators } from "./evaluators.js";
import { Navigation } from "./navigation.js";
import { cameraOnPath, placeOnPath } from "./path.js";
import { depthAhead, startCamera } from "./start.js";
import { View } from "./view.js";

const NEAREST = 0.02; // in units of the scene (I.2)
const LONGEST = 0.25; // seconds of flight between two frames
const UP = [0, -1, 0]; // where a file does not say

export class Player {
  clock = new Clock();
  navigation;
  lost = () => {}; // hears true when the drawing context is lost, and false when it is back
  file = null; // of the open file: { name, bytes, info, chunks, meta, cameras, milliseconds }
  // Milliseconds of the last evaluation, and until the first picture; counts from the beginning.
  statistics = { evaluate: 0, firstPicture: 0, evaluated: 0, drawn: 0 };
  #canvas;
  #view = null;
  #evaluators;
  #started = null; // the view
  #opening = null; // the last file that was asked for
  #shown = null; // what the Gaussians on the screen were evaluated for
  #gaussians = null; // on the screen
  #unmeasured = null; // a camera of the file, until Gaussians have told where its pivot is
  #pending = new Map(); // what evaluations under way are for, by their numbers, in order
  #asked = 0; // the number of the last evaluation
  #pose = null; // the camera that the view was given
  #focal = null; // of training (trainedFocal)
  #followed = null; // while the path is followed: { camera, time } of it
  #last = 0;
  #failed;

  // workers: one or more that run src/worker.js; wasm: the module's bytes, or its address;
  // failed(error) hears of evaluations that fail, and null from those that do not.
  constructor(canvas, workers, wasm, failed) {
    this.#canvas = canvas;
    this.#failed = failed;
    this.navigation = new Navigation(canvas);
    this.#evaluators = new Evaluators(workers, wasm);
    // Scrubbing does not wait for the next frame of the display.
    this.clock.sought = () => {
      this.#followPath();
      this.#evaluate();
    };
  }

  async #startView() {
    try {
      this.#view = await View.create(this.#canvas);
    } catch (error) {
      this.#started = null; // so that the next file tries again
      throw error;
    }
    this.#view.onFrame((now) => this.#tick(now), () => { this.statistics.drawn++; });
    this.#view.onLoss((isLost) => this.lost(isLost));
  }

  // Shows a file from its start, or from the time that the fragment of its address says once the
  // file is there. reading: its bytes, or a promise of them; since: when it was asked for;
  // fragment(). Whether it is shown: not when another one was asked for in the meantime. Rejects
  // with Ted4Error; then what was there before stays.
  async open(reading, name, since = performance.now(), fragment = () => "") {
    const opening = this.#opening = {};
    try {
      const opened = await this.#prepare(await reading);
      // A worker that has failed has no scene to let go of.
      if (opening !== this.#opening) opened.scene.close().catch(() => {});
      else this.#begin(opened, { name, since }, fragment());
    } catch (error) {
      if (opening === this.#opening) throw error;
    }
    return opening === this.#opening;
  }

  // A file that is decoded and not shown yet. start: { camera, distance }, where it has no cameras.
  async #prepare(buffer) {
    const bytes = new Uint8Array(buffer), decoding = this.#evaluators.open(bytes);
    // Starting to draw takes this thread as long as decoding takes the worker.
    this.#started ??= this.#startView();
    try {
      const [{ scene, use }] = await Promise.all([decoding, this.#started]);
      const chunks = chunksOf(bytes), cameras = camerasOf(chunks), up = cameras.up ?? UP;
      const isSeen = cameras.cameras.length + cameras.path.length > 0;
      const start = isSeen ? null : startCamera(await scene.gaussians(0, 1), up, scene.info);
      return { bytes, scene, use, chunks, cameras, up, start };
    } catch (error) {
      // Nobody will have the scene, which may be decoded only after the drawing has failed.
      decoding.then(({ scene }) => scene.close()).catch(() => {});
      throw error;
    }
  }

  #begin({ bytes, scene, use, chunks, cameras, up, start }, asked, fragment) {
    use();
    this.#pending.clear();
    this.#shown = this.#followed = this.#gaussians = this.#unmeasured = null;
    this.statistics.firstPicture = 0;
    this.#focal = trainedFocal(cameras.cameras);
    this.file = {
      ...asked, bytes, info: scene.info, chunks: bytesByType(chunks), meta: metaOf(chunks),
      cameras, milliseconds: scene.milliseconds,
    };
    this.clock.reset(scene.info.frames, scene.info.rate);
    this.#view.clear(2 ** scene.info.exponent);
    this.#pose = null;
    this.#view.setBackground(scene.info.background);
    Object.assign(this.navigation, { up, distance: 2 ** scene.info.exponent, ...start });
    if (start === null) this.useCamera(0, timeOfFragment(fragment, scene.info));
    else this.seekFragment(fragment);
  }

  // To the time that the fragment of an address says, if it says one.
  seekFragment(fragment) {
    const time = this.file === null ? undefined : timeOfFragment(fragment, this.file.info);
    if (time !== undefined) this.clock.seekTo(time);
  }

  // The file's cameras, then those of its path.
  get cameras() {
    return this.file === null ? [] : [...this.file.cameras.cameras, ...this.file.cameras.path];
  }

  // Looks through a camera of the file, at its time or another one.
  useCamera(i, time = this.cameras[i]) {
    this.followsPath = false;
    this.#place(this.cameras[i]);
    this.clock.seekTo(time);
  }

  // The camera of the file that is looked through, from 0; -1: none of them.
  get cameraIndex() {
    if (this.file === null) return -1;
    const { cameras, path } = this.file.cameras, { camera } = this.navigation;
    const i = cameras.indexOf(camera), onPath = i < 0 ? path.indexOf(camera) : -1;
    return onPath < 0 ? i : cameras.length + onPath;
  }

  // Looks through a camera. Where its pivot is, the Gaussians of its time tell better than those
  // that are on the screen, but they may be the same.
  #place(camera) {
    this.navigation.camera = this.#unmeasured = camera;
    if (this.#gaussians !== null) this.#measure(this.#gaussians);
  }

  // Whether Gaussians have told how far ahead the pivot of a camera is. Those that do not show tell
  // nothing.
  #measure(g) {
    const depth = depthAhead(this.#unmeasured, g);
    if (depth !== undefined) this.navigation.distance = depth;
    return depth !== undefined;
  }

  // Whether the camera is the one that the file's path has at the time that is shown. It ends when
  // the camera is moved in another way.
  get followsPath() {
    return this.#followed !== null;
  }

  set followsPath(isWanted) {
    const isPossible = this.file !== null && this.file.cameras.path.length > 0;
    this.#followed = isWanted && isPossible ? { camera: this.navigation.camera, time: -1 } : null;
    this.#followPath();
  }

  #followPath() {
    if (this.#followed?.camera !== this.navigation.camera) this.#followed = null;
    const time = this.clock.part;
    if (this.#followed === null || this.#followed.time === time) return;
    const { path } = this.file.cameras;
    this.#place(cameraOnPath(path, placeOnPath(path, time)));
    this.#followed = { camera: this.navigation.camera, time };
  }

  // The bytes of the file by element. Slow: the file is decoded again.
  bytesByElement() {
    return this.#evaluators.bytesByElement();
  }

  setBackground(rgb) {
    this.#view?.setBackground(rgb);
  }

  // Before every frame of the display.
  #tick(now) {
    this.clock.advance(now);
    this.navigation.fly(Math.min(LONGEST, (now - this.#last) / 1000));
    this.#last = now;
    this.#followPath();
    this.#evaluate();
    if (this.file === null) return;
    this.#followCamera();
    // While it plays, newer Gaussians are always on their way.
    if (this.statistics.firstPicture === 0 && (this.#view.hasPicture || this.isSettled)) {
      this.statistics.firstPicture = now - this.file.since;
      this.#evaluators.share();
    }
  }

  #followCamera() {
    const ratio = globalThis.devicePixelRatio ?? 1;
    const width = Math.max(1, Math.round(this.#canvas.clientWidth * ratio));
    const height = Math.max(1, Math.round(this.#canvas.clientHeight * ratio));
    const { camera } = this.navigation;
    const before = this.#pose;
    if (before?.camera === camera && before.width === width && before.height === height) return;
    if (before?.width !== width || before.height !== height) this.#view.resize(width, height);
    this.#pose = { camera, width, height };
    const shown = fitted(camera, width, height);
    this.#view.setCamera(shown, NEAREST, this.#focal === null ? 1 : this.#focal / shown.fx);
  }

  // What the Gaussians depend on: the time, and the camera's place if colours depend on it.
  #wanted() {
    const { num, den } = this.clock.query;
    const centre = this.file.info.view === "none" ? [0, 0, 0] : centreOf(this.navigation.camera);
    return { num, den, centre, key: [num, den, ...centre].join() };
  }

  // As many evaluations at a time as there are workers; the next one is for what is wanted then.
  // What comes after something newer is dropped.
  #evaluate() {
    if (this.file === null || !this.#evaluators.isFree) return;
    const { num, den, centre, key } = this.#wanted(), number = ++this.#asked;
    if (this.#shown === key || [...this.#pending.values()].at(-1) === key) return;
    this.#pending.set(number, key);
    this.#evaluators.gaussians(num, den, centre).then((g) => {
      if (!this.#isNext(number)) return;
      this.#show(g, key);
      this.#failed(null);
    }, (error) => {
      // Those under way may go well: another worker may have memory that this one lacks.
      if (!this.#pending.delete(number)) return;
      this.#shown = key; // and is not tried again
      this.#failed(error);
    }).catch((error) => this.#failed(error)).finally(() => this.#evaluate());
  }

  // Whether an evaluation that has ended is to be shown: not when a later one, or another file,
  // came before it.
  #isNext(number) {
    if (!this.#pending.has(number)) return false;
    for (const n of [...this.#pending.keys()]) if (n <= number) this.#pending.delete(n);
    return true;
  }

  #show(g, key) {
    const isWaiting = this.#unmeasured === this.navigation.camera;
    if (!isWaiting || this.#measure(g)) this.#unmeasured = null;
    this.#gaussians = g;
    this.#shown = key;
    this.statistics.evaluate = g.milliseconds;
    this.statistics.evaluated++;
    this.#view.setGaussians(g);
  }

  // The Gaussians of a time as seen from a place (ClientScene.gaussians). The screen stays.
  gaussians(num, den, centre) {
    return this.#evaluators.gaussians(num, den, centre);
  }

  // How many times can be evaluated at once: 1, and more some time after the first picture.
  get evaluators() {
    return this.#evaluators.count;
  }

  // Milliseconds of the last sort.
  get sorting() {
    return this.#view.sorting;
  }

  // Whether the wanted time and camera are on the screen.
  get isSettled() {
    return this.file !== null && this.#pending.size === 0 && this.#shown === this.#wanted().key &&
      this.#pose?.camera === this.navigation.camera && this.#view.isSettled;
  }
}
