// spark.js - a page with PackedSplats. SPDX-License-Identifier: BSD-2-Clause
import { SparkRenderer, SplatMesh } from "@sparkjsdev/spark";
import { Camera, Color, Scene, SRGBColorSpace, WebGLRenderer } from "three";
import { centreOf } from "../../page/camera.js";
import { annexI, createPackedSplats, updatePackedSplats } from "../spark.js";
import { canvas, inUnits, matrices, openScene } from "./scene.js";

let renderer = null, spark, world, eye, scene, packed, mesh;

async function start(camera) {
  scene = await openScene();
  renderer = new WebGLRenderer({ canvas, antialias: false });
  renderer.setSize(camera.width, camera.height, false);
  renderer.setClearColor(
    new Color().setRGB(...scene.info.background.map((v) => v / 255), SRGBColorSpace));
  spark = new SparkRenderer({ renderer, autoUpdate: false, ...annexI(camera.pixel) });
  packed = createPackedSplats(scene.info.gaussians);
  mesh = new SplatMesh({ packedSplats: packed });
  world = new Scene();
  world.add(spark, mesh);
  await mesh.initialized;
  const { toWorld, projection } = matrices(inUnits(camera, scene.info), 0);
  eye = new Camera();
  eye.matrixAutoUpdate = false;
  eye.matrix.fromArray(toWorld);
  eye.projectionMatrix.fromArray(projection);
  eye.projectionMatrixInverse.copy(eye.projectionMatrix).invert();
  eye.updateMatrixWorld(true);
}

// Shows a frame through a camera of annex I, the same in all calls.
globalThis.show = async (camera, frame) => {
  if (renderer === null) await start(camera);
  updatePackedSplats(packed, scene.frame(frame, centreOf(camera)), 2 ** scene.info.exponent);
  mesh.updateVersion();
  await spark.update({ scene: world, camera: eye });
  renderer.render(world, eye);
};
