// pixel.test.mjs - the width of pixels by annex I.4. Run by `make player-test`.
// SPDX-License-Identifier: BSD-2-Clause
import assert from "node:assert/strict";
import { test } from "node:test";
import { trainedFocal, widening } from "../adapters/pixel.js";

test("the middle one of a file's cameras has the focal length of training", () => {
  const cameras = (...all) => all.map((fx) => ({ fx }));
  assert.equal(trainedFocal([]), null);
  assert.equal(trainedFocal(cameras(600)), 600);
  assert.equal(trainedFocal(cameras(900, 30, 150)), 150);
  assert.equal(trainedFocal(cameras(600, 150)), 600); // the larger one in the middle
});

test("Gaussians are widened as in training, and in wider pixels by the rest of them", () => {
  assert.deepEqual(widening(1), { learnt: 0.3, square: 0 });
  assert.deepEqual(widening(0.5), { learnt: 1.2, square: 0 });
  const { learnt, square } = widening(2);
  assert.equal(learnt, 0.075);
  assert.ok(Math.abs(square - 1 / 16) < 1e-15); // (1 - 1/4) / 12
});
