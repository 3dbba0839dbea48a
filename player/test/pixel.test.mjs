// pixel.test.mjs - the width of pixels by annex I.4. Run by `make player-test`.
// SPDX-License-Identifier: BSD-2-Clause
import assert from "node:assert/strict";
import { test } from "node:test";
import { pixelWidth, widening } from "../adapters/pixel.js";

test("the middle one of a file's cameras tells the width of a pixel", () => {
  const cameras = (...all) => all.map((fx) => ({ fx }));
  assert.equal(pixelWidth(300, []), 1);
  assert.equal(pixelWidth(300, cameras(600)), 2);
  assert.equal(pixelWidth(300, cameras(900, 30, 150)), 0.5);
  assert.equal(pixelWidth(300, cameras(600, 150)), 2); // the larger one in the middle
});

test("Gaussians are widened as in training, and in wider pixels by the rest of them", () => {
  assert.deepEqual(widening(1), { learnt: 0.3, square: 0 });
  assert.deepEqual(widening(0.5), { learnt: 1.2, square: 0 });
  const { learnt, square } = widening(2);
  assert.equal(learnt, 0.075);
  assert.ok(Math.abs(square - 1 / 16) < 1e-15); // (1 - 1/4) / 12
});
