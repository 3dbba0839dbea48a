// app.js - the least application of PlayCanvas that shows Gaussians, for the pages of adapters.
// SPDX-License-Identifier: BSD-2-Clause
import {
  AppBase, AppOptions, CameraComponentSystem, Color, createGraphicsDevice, DEVICETYPE_WEBGL2,
  Entity, FILLMODE_NONE, GSplatComponentSystem, GSPLATDATA_LARGE, Mat4, RESOLUTION_FIXED,
  TONEMAP_NONE,
} from "playcanvas";
import { drawAsAnnexI, setPixel } from "../playcanvas-kernel.js";
import { canvas, matrices } from "./scene.js";

// camera: of annex I, with pixel, the width of its pixels.
export async function startApp(camera) {
  const options = new AppOptions();
  options.graphicsDevice = await createGraphicsDevice(canvas,
    { deviceTypes: [DEVICETYPE_WEBGL2], antialias: false, alpha: false });
  options.componentSystems = [CameraComponentSystem, GSplatComponentSystem];
  const app = new AppBase(canvas);
  app.init(options);
  app.setCanvasFillMode(FILLMODE_NONE);
  Object.assign(app.scene.gsplat, { dataFormat: GSPLATDATA_LARGE, minPixelSize: 0 });
  // ?plain: as an application draws that knows nothing of annex I.
  if (!new URLSearchParams(location.search).has("plain")) {
    app.scene.gsplat.antiAlias = true;
    drawAsAnnexI(app.graphicsDevice);
    setPixel(app.graphicsDevice, camera.pixel);
  }
  app.start();
  return app;
}

// An entity that looks through a camera of annex I.
export function addCamera(app, camera, { background, exponent }) {
  const { toWorld, projection } = matrices(camera, exponent);
  const matrix = new Mat4().set(projection), world = new Mat4().set(toWorld);
  const entity = new Entity("camera", app);
  app.setCanvasResolution(RESOLUTION_FIXED, camera.width, camera.height);
  entity.addComponent("camera", {
    toneMapping: TONEMAP_NONE, clearColor: new Color(...background.map((v) => v / 255)),
    nearClip: 0.02 * 2 ** exponent, farClip: 1000 * 2 ** exponent,
    calculateProjection: (target) => target.copy(matrix),
  });
  entity.setPosition(world.getTranslation());
  entity.setEulerAngles(world.getEulerAngles());
  app.root.addChild(entity);
}

// Once what was set has been sorted and drawn.
export function drawn(app) {
  return new Promise((resolve) => {
    let frames = 0;
    const count = (camera, layer, isReady) => {
      frames = isReady ? frames + 1 : 0;
      if (frames < 5) return;
      app.systems.gsplat.off("frame:ready", count);
      resolve();
    };
    app.systems.gsplat.on("frame:ready", count);
  });
}
