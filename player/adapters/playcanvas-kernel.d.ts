// Types of adapters/playcanvas-kernel.js. SPDX-License-Identifier: BSD-2-Clause
import type { GraphicsDevice } from "playcanvas";

/** To be called once for a device of an application with a GSplatComponentSystem, before anything
 *  is drawn. Only for WebGL. Throws Error if this PlayCanvas has other shaders. */
export function drawAsAnnexI(device: GraphicsDevice): void;
