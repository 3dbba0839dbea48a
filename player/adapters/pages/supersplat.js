// supersplat.js - a page that plays a FrameSource as SuperSplat does: every frame is a gsplat asset
// that takes the place of the one before. SPDX-License-Identifier: BSD-2-Clause
import { Asset, Entity, GSplatResource } from "playcanvas";
import { centreOf } from "../../page/camera.js";
import { FrameSource } from "../supersplat.js";
import { addCamera, drawn, startApp } from "./app.js";
import { openScene } from "./scene.js";

let app = null, source, entity = null;

function createAsset(data, name) {
  const asset = new Asset(name, "gsplat", { url: name, filename: name });
  asset.resource = new GSplatResource(app.graphicsDevice, data);
  return asset;
}

async function start(camera) {
  const scene = await openScene();
  app = await startApp(camera);
  addCamera(app, camera, scene.info);
  source = new FrameSource(scene, createAsset, centreOf(camera));
  globalThis.frameCount = source.frameCount;
}

// Shows a frame through a camera of annex I, the same in all calls.
globalThis.show = async (camera, frame) => {
  if (app === null) await start(camera);
  const { asset, rotation } = await source.getFrame(frame);
  const before = entity;
  entity = new Entity(asset.name, app);
  entity.addComponent("gsplat", { resource: asset.resource });
  app.root.addChild(entity);
  before?.destroy();
  globalThis.rotation = [rotation.x, rotation.y, rotation.z, rotation.w];
  await drawn(app);
};
