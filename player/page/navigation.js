// navigation.js - moves the camera by mouse, touch and keys: orbit about a pivot, or look around in
// place; pan; come nearer; fly. Keys that fly and turn go by their places on the keyboard.
// SPDX-License-Identifier: BSD-2-Clause
import {
  add, centreOf, down, fitted, forward, moved, orbited, right, scaled,
} from "./camera.js";

const TURN = 0.005; // radians a pixel
const WHEEL = 0.001; // of the logarithm of the distance, a unit
const FAST = 4; // times faster with Shift
const CROSSING_SECONDS = 3; // to fly as far as the pivot is
const TURN_SPEED = 200; // pixels of a drag, a second, by keys
const TURNS = { KeyI: [0, -1], KeyK: [0, 1], KeyJ: [-1, 0], KeyL: [1, 0] }; // right, down
const FLIGHT = {
  KeyW: [0, 0, 1], KeyS: [0, 0, -1], KeyA: [-1, 0, 0], KeyD: [1, 0, 0], KeyQ: [0, 1, 0],
  KeyE: [0, -1, 0],
}; // right, down, forward

export class Navigation {
  camera = null;
  up = [0, -1, 0];
  distance = 1; // of the pivot, straight ahead
  looksAround = false;
  #canvas;
  #pointers = new Map();
  #keys = new Set();
  #isFast = false;

  constructor(canvas) {
    this.#canvas = canvas;
    canvas.addEventListener("pointerdown", (e) => {
      canvas.setPointerCapture(e.pointerId);
      this.#pointers.set(e.pointerId, e);
    });
    for (const type of ["pointerup", "pointercancel", "lostpointercapture"])
      canvas.addEventListener(type, (e) => this.#pointers.delete(e.pointerId));
    canvas.addEventListener("pointermove", (e) => this.#drag(e));
    canvas.addEventListener("contextmenu", (e) => e.preventDefault());
    canvas.addEventListener("wheel", (e) => {
      e.preventDefault();
      this.#approach(Math.exp(WHEEL * e.deltaY));
    }, { passive: false });
  }

  #drag(e) {
    const before = this.#pointers.get(e.pointerId);
    if (before === undefined || this.camera === null) return;
    const dx = e.clientX - before.clientX, dy = e.clientY - before.clientY;
    if (this.#pointers.size === 2) this.#pinch(before, e);
    else if (e.shiftKey || e.buttons > 1) this.#pan(dx, dy);
    else this.#turn(dx, dy);
    this.#pointers.set(e.pointerId, e);
  }

  // One of two fingers moves; both move the middle, and the distance between them is the size.
  #pinch(before, now) {
    const other = [...this.#pointers].find(([id]) => id !== now.pointerId)[1];
    const span = (e) => Math.hypot(e.clientX - other.clientX, e.clientY - other.clientY) + 1;
    this.#approach(span(before) / span(now));
    this.#pan((now.clientX - before.clientX) / 2, (now.clientY - before.clientY) / 2);
  }

  #turn(dx, dy) {
    const sign = this.looksAround ? 1 : -1;
    const pivot = this.looksAround ? centreOf(this.camera)
      : add(centreOf(this.camera), scaled(forward(this.camera), this.distance));
    this.camera = orbited(this.camera, pivot, this.up, -sign * TURN * dx, -sign * TURN * dy);
  }

  // By pixels of the page; the pivot stays under the pointer.
  #pan(dx, dy) {
    const { fx, fy } = fitted(this.camera, this.#canvas.clientWidth, this.#canvas.clientHeight);
    const x = -dx * this.distance / fx, y = -dy * this.distance / fy;
    this.camera = moved(this.camera,
      add(scaled(right(this.camera), x), scaled(down(this.camera), y)));
  }

  // The pivot stays, and its distance is multiplied.
  #approach(factor) {
    if (this.camera === null) return;
    const step = this.distance * (1 - factor);
    this.camera = moved(this.camera, scaled(forward(this.camera), step));
    this.distance *= factor;
  }

  // Whether the key flies or turns.
  press(e) {
    this.#isFast = e.shiftKey;
    if (!(e.code in FLIGHT || e.code in TURNS)) return false;
    this.#keys.add(e.code);
    return true;
  }

  release(e) {
    this.#isFast = e.shiftKey;
    this.#keys.delete(e.code);
  }

  releaseAll() {
    this.#keys.clear();
  }

  // Flies and turns for that many seconds, if keys are down.
  fly(seconds) {
    if (this.#keys.size === 0 || this.camera === null) return;
    const time = seconds * (this.#isFast ? FAST : 1);
    for (const code of this.#keys)
      if (code in TURNS) this.#turn(...TURNS[code].map((v) => v * TURN_SPEED * time));
      else this.#advance(FLIGHT[code], this.distance / CROSSING_SECONDS * time);
  }

  #advance(direction, way) {
    const axes = [right(this.camera), down(this.camera), forward(this.camera)];
    direction.forEach((v, i) => {
      this.camera = moved(this.camera, scaled(axes[i], v * way));
    });
  }
}
