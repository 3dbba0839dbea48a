// Types of adapters/playcanvas.js. SPDX-License-Identifier: BSD-2-Clause
import type { GraphicsDevice, GSplatContainer } from "playcanvas";
import type { Gaussians } from "../src/index.js";

/** A container for n Gaussians, 1 or more. PlayCanvas rounds scales to binary16 in world
 *  coordinates: where they are below 6e-5 or above 65504, scale the entity of the container by
 *  2 ** -info.exponent, and scale the camera's position and clipping planes with it. */
export function createContainer(device: GraphicsDevice, n: number): GSplatContainer;

/** Puts Gaussians into a container that was made for as many of them. The component then needs
 *  workBufferUpdate = WORKBUFFER_UPDATE_ONCE. */
export function updateContainer(container: GSplatContainer, gaussians: Gaussians): void;
