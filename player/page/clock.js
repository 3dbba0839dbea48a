// clock.js - the time that is shown: playing, stepping, looping. position is in frames, from 0 to
// frames - 1, and may lie between two.
// SPDX-License-Identifier: BSD-2-Clause
import { timeOf } from "../src/times.js";

const PARTS = 8; // of a frame, to which positions are rounded

export class Clock {
  frames = 1;
  rate = 1; // frames per second
  speed = 1;
  isLooping = true;
  isPlaying = false;
  sought = () => {}; // is called after seek and step
  #position = 0;
  #exact = null; // the query of the position where that is known
  #last = 0;

  // A new scene, from its start.
  reset(frames, rate) {
    Object.assign(this, { frames, rate, isPlaying: false });
    this.#put(0);
  }

  #put(position) {
    this.#position = position;
    this.#exact = null;
  }

  get position() {
    return Math.min(this.#position, this.frames - 1);
  }

  seek(position) {
    this.#put(Math.min(Math.max(position, 0), this.frames - 1));
    this.sought();
  }

  // To the time of a query, which is not rounded to parts. Denominator 0: no time, and nothing
  // changes.
  seekTo({ num, den }) {
    if (den !== 0) {
      this.#position = num * (this.frames - 1) / den;
      this.#exact = { num, den };
    }
    this.sought();
  }

  play(now) {
    if (this.frames === 1) return;
    if (!this.isLooping && this.position === this.frames - 1) this.#put(0);
    this.isPlaying = true;
    this.#last = now;
  }

  pause() {
    this.isPlaying = false;
  }

  // To the next whole frame, or that many on.
  step(n) {
    this.pause();
    const frame = n > 0 ? Math.floor(this.position) + n : Math.ceil(this.position) + n;
    this.seek(frame);
  }

  // now: milliseconds. The last frame is shown as long as the others.
  advance(now) {
    if (!this.isPlaying) return;
    this.#put(this.#position + (now - this.#last) / 1000 * this.rate * this.speed);
    this.#last = now;
    if (this.#position < this.frames) return;
    if (this.isLooping) {
      this.#position %= this.frames;
    } else {
      this.#position = this.frames - 1;
      this.pause();
    }
  }

  // A query (spec 11); whole frames are exact.
  get query() {
    return this.#exact ?? timeOf(Math.round(PARTS * this.position), PARTS * (this.frames - 1));
  }

  // The position as a part of the whole time, from 0 to 1; not rounded.
  get part() {
    return this.frames === 1 ? 0 : this.position / (this.frames - 1);
  }
}
