// playcanvas.js - a page with a GSplatContainer. SPDX-License-Identifier: BSD-2-Clause
import { Entity, WORKBUFFER_UPDATE_ONCE } from "playcanvas";
import { centreOf } from "../../page/camera.js";
import { createContainer, updateContainer } from "../playcanvas.js";
import { addCamera, drawn, startApp } from "./app.js";
import { inUnits, openScene } from "./scene.js";

let app = null, scene, container, entity;

async function start(camera) {
  scene = await openScene();
  app = await startApp(camera);
  addCamera(app, inUnits(camera, scene.info), { ...scene.info, exponent: 0 });
  container = createContainer(app.graphicsDevice, scene.info.gaussians);
  entity = new Entity("gaussians", app);
  entity.addComponent("gsplat", { resource: container });
  const scale = 2 ** -scene.info.exponent;
  entity.setLocalScale(scale, scale, scale);
  app.root.addChild(entity);
}

// Shows a frame through a camera of annex I, the same in all calls.
globalThis.show = async (camera, frame) => {
  if (app === null) await start(camera);
  updateContainer(container, scene.frame(frame, centreOf(camera)));
  entity.gsplat.workBufferUpdate = WORKBUFFER_UPDATE_ONCE;
  await drawn(app);
};
