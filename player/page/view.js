// view.js - draws the Gaussians of a scene with Spark, as annex I does: for a pinhole camera, with
// 0.3 pixels squared added to covariances and opacities left alone, in the order of depth.
// SPDX-License-Identifier: BSD-2-Clause
import { SparkRenderer } from "@sparkjsdev/spark";
import { Camera, Color, ColorManagement, LinearSRGBColorSpace, Scene, WebGLRenderer } from "three";
import { centreOf } from "./camera.js";
import { Gaussians } from "./gaussians.js";

const LEAST_ALPHA = 1 / 255; // I.3
const LIKE_ANNEX_I = {
  preBlurAmount: 0.3, blurAmount: 0, sortRadial: false, accumExtSplats: true,
  minAlpha: LEAST_ALPHA, maxStdDev: Math.sqrt(-2 * Math.log(LEAST_ALPHA)),
};
const DEPTHS = 1e5; // the farthest depth over the nearest

// Colours are display-referred already.
ColorManagement.enabled = false;

export class View {
  #renderer;
  #spark;
  #scene = new Scene();
  #camera = new Camera();
  #gaussians = null;
  #dirty = true;

  constructor(canvas) {
    this.#renderer = new WebGLRenderer({ canvas, antialias: false });
    this.#renderer.outputColorSpace = LinearSRGBColorSpace;
    this.#spark = new SparkRenderer({
      renderer: this.#renderer, onDirty: () => { this.#dirty = true; }, ...LIKE_ANNEX_I,
    });
    this.#scene.add(this.#spark);
    this.#camera.matrixAutoUpdate = false;
  }

  // A new scene of n Gaussians; 0: none.
  reset(n) {
    if (this.#gaussians !== null) {
      this.#scene.remove(this.#gaussians);
      this.#gaussians.dispose();
    }
    this.#gaussians = n > 0 ? new Gaussians(n) : null;
    if (n > 0) this.#scene.add(this.#gaussians);
    this.#dirty = true;
  }

  // g: the Gaussians of a time, from a decoder.
  setGaussians(g) {
    this.#gaussians?.set(g);
    this.#dirty = true;
  }

  // camera: of annex I, for the whole canvas; near: the depth at which Gaussians begin to show.
  setCamera(camera, near) {
    const { width, height, fx, fy, cx, cy, R } = camera;
    const [x, y, z] = centreOf(camera), far = DEPTHS * near;
    // Camera axes of three.js point right, up, back.
    this.#camera.matrix.set(
      R[0], -R[3], -R[6], x, R[1], -R[4], -R[7], y, R[2], -R[5], -R[8], z, 0, 0, 0, 1);
    this.#camera.projectionMatrix.set(
      2 * fx / width, 0, 1 - 2 * cx / width, 0, 0, 2 * fy / height, 2 * cy / height - 1, 0,
      0, 0, (far + near) / (near - far), 2 * far * near / (near - far), 0, 0, -1, 0);
    this.#camera.projectionMatrixInverse.copy(this.#camera.projectionMatrix).invert();
    this.#camera.updateMatrixWorld(true);
    this.#dirty = true;
  }

  // Red, green, blue from 0 to 255, as on the display.
  setBackground(rgb) {
    this.#renderer.setClearColor(new Color(...rgb.map((v) => v / 255)));
    this.#dirty = true;
  }

  resize(width, height) {
    this.#renderer.setSize(width, height, false);
    this.#dirty = true;
  }

  // Draws if anything has changed; whether it did.
  draw() {
    if (!this.#dirty) return false;
    this.#dirty = false;
    this.#renderer.render(this.#scene, this.#camera);
    return true;
  }

  // Whether what was set last is on the screen, in the right order.
  get isSettled() {
    return !this.#dirty && !this.#spark.sorting && !this.#spark.sortDirty;
  }
}
