// gaussians.js - the arrays of a query as a SplatGenerator of Spark. One texture holds each array
// as a layer, in binary32 as it is, so that nothing is packed or rounded on the way.
// SPDX-License-Identifier: BSD-2-Clause
import { dyno, SplatGenerator } from "@sparkjsdev/spark";
import { DataArrayTexture, FloatType, RedFormat } from "three";

const WIDTH = 2048; // texels in a row of a layer
const LAYERS = 14; // mean, scale, rotation w x y z, opacity, colour
// Rotations of Spark are x, y, z, w.
const READ = `
float readLayer(sampler2DArray values, ivec2 at, int layer) {
  return texelFetch(values, ivec3(at, layer), 0).r;
}
vec3 readThree(sampler2DArray values, ivec2 at, int layer) {
  return vec3(readLayer(values, at, layer), readLayer(values, at, layer + 1),
    readLayer(values, at, layer + 2));
}
Gsplat readGaussian(sampler2DArray values, int index) {
  ivec2 at = ivec2(index % ${WIDTH}, index / ${WIDTH});
  Gsplat g;
  g.flags = GSPLAT_FLAG_ACTIVE;
  g.index = index;
  g.center = readThree(values, at, 0);
  g.scales = readThree(values, at, 3);
  g.quaternion = vec4(readThree(values, at, 7), readLayer(values, at, 6));
  g.rgba = vec4(readThree(values, at, 11), readLayer(values, at, 10));
  return g;
}`;

function createTexture(n) {
  const height = Math.max(1, Math.ceil(n / WIDTH));
  const values = new Float32Array(WIDTH * height * LAYERS);
  const texture = new DataArrayTexture(values, WIDTH, height, LAYERS);
  texture.format = RedFormat;
  texture.type = FloatType;
  texture.internalFormat = "R32F";
  return texture;
}

// index -> Gsplat, from the texture of the uniform.
function createGenerator(values) {
  return dyno.dynoBlock({ index: "int" }, { gsplat: dyno.Gsplat }, ({ index }) => {
    const read = new dyno.Dyno({
      inTypes: { values: "sampler2DArray", index: "int" }, outTypes: { gsplat: dyno.Gsplat },
      inputs: { values, index },
      globals: () => [dyno.defineGsplat, READ],
      statements: ({ inputs, outputs }) =>
        [`${outputs.gsplat} = readGaussian(${inputs.values}, ${inputs.index});`],
    });
    return { gsplat: read.outputs.gsplat };
  });
}

export class Gaussians extends SplatGenerator {
  #texture;

  // n: number of Gaussians, the same at all times.
  constructor(n) {
    const texture = createTexture(n);
    const values = dyno.dynoSampler2DArray(texture, "ted4Values");
    super({ numSplats: n, generator: createGenerator(values) });
    this.#texture = texture;
  }

  // g: of Scene.gaussians or ClientScene.gaussians.
  set({ mean, scale, rotation, opacity, colour }) {
    const { data, width, height } = this.#texture.image;
    [...mean, ...scale, ...rotation, opacity, ...colour].forEach((array, layer) => {
      data.set(array, layer * width * height);
    });
    this.#texture.needsUpdate = true;
    this.updateVersion();
  }

  dispose() {
    this.#texture.dispose();
  }
}
