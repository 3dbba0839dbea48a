// player.js - a file on the screen: decodes and evaluates in a worker, and keeps the picture at the
// time and the camera that are wanted now. It knows nothing of the page around its canvas.
// SPDX-License-Identifier: BSD-2-Clause
import { Ted4Client } from "../src/client.js";
import { centreOf, fitted } from "./camera.js";
import { bytesByType, camerasOf, chunksOf, metaOf } from "./chunks.js";
import { Clock } from "./clock.js";
import { Navigation } from "./navigation.js";
import { cameraOnPath, placeOnPath } from "./path.js";
import { depthAhead, startCamera } from "./start.js";
import { View } from "./view.js";

const NEAREST = 0.02; // in units of the scene (I.2)
const UP = [0, -1, 0]; // where a file does not say

export class Player {
  clock = new Clock();
  navigation;
  file = null; // of the open file: { name, bytes, info, chunks, meta, cameras, milliseconds }
  // Milliseconds of the last evaluation, and until the first picture; counts from the beginning.
  statistics = { evaluate: 0, firstPicture: 0, evaluated: 0, drawn: 0 };
  #canvas;
  #view = null;
  #client;
  #loaded; // the decoder
  #started = null; // the view
  #scene = null;
  #shown = null; // what the Gaussians on the screen were evaluated for
  #pending = null; // the evaluation under way
  #pose = null; // the camera that the view was given
  #followed = null; // while the path is followed: { camera, time } of it
  #last = 0;
  #failed;

  // worker: runs src/worker.js; wasm: the module's bytes, or its address; failed(error) hears of
  // evaluations that fail.
  constructor(canvas, worker, wasm, failed) {
    this.#canvas = canvas;
    this.#failed = failed;
    this.navigation = new Navigation(canvas);
    this.#client = new Ted4Client(worker);
    this.#loaded = this.#client.load(wasm);
    // Scrubbing does not wait for the next frame of the display.
    this.clock.sought = () => {
      this.#followPath();
      this.#evaluate();
    };
  }

  async #startView() {
    this.#view = await View.create(this.#canvas);
    this.#view.onFrame((now) => this.#tick(now), () => { this.statistics.drawn++; });
  }

  // Shows a file from its start. since: when it was asked for. Rejects with Ted4Error; then what
  // was there before stays.
  async open(bytes, name, since = performance.now()) {
    await this.#loaded;
    const opening = this.#client.open(bytes);
    // Starting to draw takes this thread as long as decoding takes the worker.
    this.#started ??= this.#startView();
    const [scene] = await Promise.all([opening, this.#started]);
    const chunks = chunksOf(bytes), cameras = camerasOf(chunks);
    const up = cameras.up ?? UP;
    const isSeen = cameras.cameras.length + cameras.path.length > 0;
    const start = isSeen ? null : startCamera(await scene.gaussians(0, 1), up);
    this.#scene?.close();
    this.#scene = scene;
    this.#shown = this.#followed = null;
    this.statistics.firstPicture = 0;
    this.file = {
      name, bytes, since, info: scene.info, chunks: bytesByType(chunks), meta: metaOf(chunks),
      cameras, milliseconds: scene.milliseconds,
    };
    this.clock.reset(scene.info.frames, scene.info.rate);
    this.#view.clear();
    this.#view.setBackground(scene.info.background);
    Object.assign(this.navigation, { up, ...start });
    if (isSeen) this.useCamera(0);
  }

  // The file's cameras, then those of its path.
  get cameras() {
    return this.file === null ? [] : [...this.file.cameras.cameras, ...this.file.cameras.path];
  }

  // Looks through a camera of the file, at its time.
  useCamera(i) {
    const camera = this.cameras[i];
    this.followsPath = false;
    this.navigation.camera = camera;
    this.clock.seek(this.clock.positionOf(camera));
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
    this.navigation.camera = cameraOnPath(path, placeOnPath(path, time));
    this.#followed = { camera: this.navigation.camera, time };
  }

  // The bytes of the file by element. Slow: the file is decoded again.
  async bytesByElement() {
    const scene = await this.#client.open(this.file.bytes, { budget: true });
    scene.close();
    return scene.bytesByElement;
  }

  setBackground(rgb) {
    this.#view?.setBackground(rgb);
  }

  // Before every frame of the display.
  #tick(now) {
    this.clock.advance(now);
    this.navigation.fly((now - this.#last) / 1000);
    this.#last = now;
    this.#followPath();
    this.#evaluate();
    if (this.file === null) return;
    this.#followCamera();
    if (this.statistics.firstPicture === 0 && this.isSettled)
      this.statistics.firstPicture = now - this.file.since;
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
    this.#view.setCamera(fitted(camera, width, height), NEAREST * 2 ** this.file.info.exponent);
  }

  // What the Gaussians depend on: the time, and the camera's place if colours depend on it.
  #wanted() {
    const { num, den } = this.clock.query;
    const centre = this.file.info.view === "none" ? [0, 0, 0] : centreOf(this.navigation.camera);
    return { num, den, centre, key: [num, den, ...centre].join() };
  }

  // One evaluation at a time; the next one is for what is wanted then.
  #evaluate() {
    if (this.file === null || this.#pending !== null) return;
    const wanted = this.#wanted(), scene = this.#scene;
    if (this.#shown === wanted.key) return;
    this.#pending = scene.gaussians(wanted.num, wanted.den, wanted.centre).then((g) => {
      if (scene === this.#scene) this.#show(g, wanted.key);
    }).catch((error) => {
      this.#shown = wanted.key; // and is not tried again
      this.#failed(error);
    }).finally(() => {
      this.#pending = null;
      this.#evaluate();
    });
  }

  // The first Gaussians of a file that lists cameras tell where the pivot is.
  #show(g, key) {
    if (this.#shown === null && this.cameras.length > 0)
      this.navigation.distance = depthAhead(this.navigation.camera, g);
    this.#shown = key;
    this.statistics.evaluate = g.milliseconds;
    this.statistics.evaluated++;
    this.#view.setGaussians(g);
  }

  // The Gaussians of a time as seen from a place (ClientScene.gaussians). The screen stays.
  gaussians(num, den, centre) {
    return this.#scene.gaussians(num, den, centre);
  }

  // Milliseconds of the last sort.
  get sorting() {
    return this.#view.sorting;
  }

  // Whether the wanted time and camera are on the screen.
  get isSettled() {
    return this.file !== null && this.#pending === null && this.#shown === this.#wanted().key &&
      this.#pose?.camera === this.navigation.camera && this.#view.isSettled;
  }
}
