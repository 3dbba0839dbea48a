// view.js - draws the Gaussians of a scene with PlayCanvas, as annex I does.
// SPDX-License-Identifier: BSD-2-Clause
import {
  AppBase, AppOptions, CameraComponentSystem, Color, createGraphicsDevice, DEVICETYPE_WEBGL2,
  Entity, FILLMODE_NONE, GSplatComponentSystem, GSPLATDATA_LARGE, Mat4, Quat, TONEMAP_NONE,
  WORKBUFFER_UPDATE_ONCE,
} from "playcanvas";
import { drawAsAnnexI, setPixel } from "../adapters/playcanvas-kernel.js";
import { createContainer, updateContainer } from "../adapters/playcanvas.js";
import { centreOf } from "./camera.js";

const DEPTHS = 1e5; // the farthest depth over the nearest
// To be drawn: PlayCanvas takes a change in with a frame, sorts in a worker, and shows the order in
// the frame after that. One more for what it puts off while it sorts.
const FRAMES_AFTER_CHANGE = 2, FRAMES_AFTER_SORT = 1;

export class View {
  #app;
  #camera;
  #entity = null;
  #container = null;
  #projection = new Mat4();
  // In which the scene is drawn, in the file's units; a power of two. PlayCanvas keeps scales in
  // binary16, as they are in its world.
  #unit = 1;
  #frames = 0; // still to be drawn
  #isSorted = true;
  // Since the last frame: whether the Gaussians were marked as changed, and whether a sort ended.
  #isMarked = false;
  #hasOrder = false;
  sorting = 0; // milliseconds of the last sort
  hasPicture = false; // whether some Gaussians have been drawn, in order, since clear()

  static async create(canvas) {
    const view = new View();
    const options = new AppOptions();
    options.graphicsDevice = await createGraphicsDevice(canvas,
      { deviceTypes: [DEVICETYPE_WEBGL2], antialias: false, alpha: false }).catch(() => {
      throw new Error("the page draws with WebGL 2, which this browser does not offer");
    });
    options.componentSystems = [CameraComponentSystem, GSplatComponentSystem];
    view.#start(canvas, options);
    return view;
  }

  #start(canvas, options) {
    this.#app = new AppBase(canvas);
    this.#app.init(options);
    this.#app.setCanvasFillMode(FILLMODE_NONE);
    this.#app.autoRender = false;
    const { gsplat } = this.#app.scene;
    Object.assign(gsplat,
      { dataFormat: GSPLATDATA_LARGE, minPixelSize: 0, radialSorting: false, antiAlias: true });
    drawAsAnnexI(options.graphicsDevice);
    this.#camera = new Entity("camera", this.#app);
    this.#camera.addComponent("camera", {
      toneMapping: TONEMAP_NONE, calculateProjection: (matrix) => matrix.copy(this.#projection),
    });
    this.#app.root.addChild(this.#camera);
    this.#app.systems.gsplat.on("frame:ready", (camera, layer, isReady) => {
      this.#isSorted = isReady;
    });
    this.#app.scene.on("gsplat:sorted", (milliseconds) => {
      this.sorting = milliseconds;
      this.#hasOrder = true;
      this.#frames = Math.max(this.#frames, FRAMES_AFTER_SORT);
    });
    options.graphicsDevice.on("devicerestored", () => this.#redraw());
    this.#app.on("postrender", () => this.#endFrame());
    this.#app.start();
  }

  // A frame that takes in the first order of a change forgets that Gaussians were marked, even if
  // it has not drawn what came in the meantime (rebuildWorkBuffer of PlayCanvas 2.23).
  #endFrame() {
    const isLost = this.#isMarked && this.#hasOrder;
    this.hasPicture ||= this.#hasOrder && this.#entity !== null;
    this.#isMarked = this.#hasOrder = false;
    this.#frames--;
    if (isLost && this.#entity !== null) this.#mark();
  }

  // What was drawn is gone with the context in which it was.
  #redraw() {
    if (this.#entity === null) this.#change();
    else this.#mark();
  }

  // All Gaussians are taken from the container again.
  #mark() {
    this.#entity.gsplat.workBufferUpdate = WORKBUFFER_UPDATE_ONCE;
    this.#isMarked = true;
    this.#change();
  }

  // changed(now) is called before every frame of the display, drawn() after each that was drawn.
  onFrame(changed, drawn) {
    this.#app.on("update", () => {
      changed(performance.now());
      this.#app.renderNextFrame = this.#frames > 0;
    });
    this.#app.on("postrender", drawn);
  }

  // lost(true) is called when the drawing context is lost, lost(false) when it is back.
  onLoss(lost) {
    const { graphicsDevice } = this.#app;
    graphicsDevice.on("devicelost", () => lost(true));
    graphicsDevice.on("devicerestored", () => lost(false));
  }

  // Nothing is shown until the next Gaussians, which are drawn in that unit.
  clear(unit) {
    this.#entity?.destroy();
    this.#container?.destroy();
    this.#entity = this.#container = null;
    this.#isSorted = true;
    this.hasPicture = false;
    this.#unit = unit;
    this.#change();
  }

  #create(n) {
    this.#container = createContainer(this.#app.graphicsDevice, n);
    this.#entity = new Entity("gaussians", this.#app);
    this.#entity.addComponent("gsplat", { resource: this.#container });
    this.#entity.setLocalScale(1 / this.#unit, 1 / this.#unit, 1 / this.#unit);
    this.#app.root.addChild(this.#entity);
  }

  // g: the Gaussians of a time, from a decoder; as many of them as before, since clear().
  setGaussians(g) {
    if (g.n === 0) return;
    if (this.#container === null) this.#create(g.n);
    updateContainer(this.#container, g);
    this.#isSorted = false;
    this.#mark();
  }

  // camera: of annex I, for the whole canvas; near: the depth at which Gaussians begin to show, in
  // units of clear(); pixel: the width of a pixel (adapters/pixel.js).
  setCamera(camera, near, pixel) {
    const { width, height, fx, fy, cx, cy, R } = camera, far = DEPTHS * near;
    // Camera axes of PlayCanvas point right, up, back.
    const axes = new Mat4();
    axes.set([R[0], R[1], R[2], 0, -R[3], -R[4], -R[5], 0, -R[6], -R[7], -R[8], 0, 0, 0, 0, 1]);
    this.#camera.setPosition(...centreOf(camera).map((v) => v / this.#unit));
    this.#camera.setRotation(new Quat().setFromMat4(axes));
    this.#projection.set([
      2 * fx / width, 0, 0, 0, 0, 2 * fy / height, 0, 0,
      1 - 2 * cx / width, 2 * cy / height - 1, (far + near) / (near - far), -1,
      0, 0, 2 * far * near / (near - far), 0,
    ]);
    Object.assign(this.#camera.camera, { nearClip: near, farClip: far });
    setPixel(this.#app.graphicsDevice, pixel);
    this.#change();
  }

  // Red, green, blue from 0 to 255, as on the display.
  setBackground(rgb) {
    this.#camera.camera.clearColor = new Color(...rgb.map((v) => v / 255));
    this.#change();
  }

  resize(width, height) {
    // setCanvasResolution would multiply by devicePixelRatio where that is less than 1.
    this.#app.graphicsDevice.setResolution(width, height);
    this.#change();
  }

  // Whether what was set last is on the screen, in the right order.
  get isSettled() {
    return this.#frames <= 0 && this.#isSorted;
  }

  #change() {
    this.#frames = FRAMES_AFTER_CHANGE;
  }
}
