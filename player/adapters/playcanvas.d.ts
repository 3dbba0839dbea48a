// Types of adapters/playcanvas.js. SPDX-License-Identifier: BSD-2-Clause
import type { GraphicsDevice, GSplatContainer } from "playcanvas";
import type { Gaussians } from "../src/index.js";

/** A container for n Gaussians, 1 or more. */
export function createContainer(device: GraphicsDevice, n: number): GSplatContainer;

/** Puts Gaussians into a container that was made for as many of them. The component then needs
 *  workBufferUpdate = WORKBUFFER_UPDATE_ONCE. */
export function updateContainer(container: GSplatContainer, gaussians: Gaussians): void;
