// times.test.mjs - times of frames, of seconds and of fragments, as exact fractions.
// SPDX-License-Identifier: BSD-2-Clause
import assert from "node:assert/strict";
import { test } from "node:test";
import { timeOf, timeOfFragment, timeOfFrame, timeOfSeconds } from "../src/times.js";

const UINT32_MAX = 2 ** 32 - 1, LAST = 2 ** 24 - 1;

test("R-HDR-005: times are fractions in lowest terms, rounded where these are too large", () => {
  for (const [j, frames, num, den] of [
    [3, 5, 3, 4], [4, 9, 1, 2], [0, 5, 0, 1], [0, 1, 0, 1],
    [2 ** 31 - 1, UINT32_MAX, 1, 2],
    [UINT32_MAX - 2, UINT32_MAX, LAST, LAST], // 16777214.996 of 2^24 - 1
    [1000000001, UINT32_MAX, 3906250, LAST], // 3906249.77
    [29, 2 ** 25 - 1, 14, LAST], [11, 2 ** 25 - 1, 6, LAST], // 14.5 and 5.5: the even one
  ]) assert.deepEqual(timeOfFrame(j, { frames }), { num, den }, `${j} of ${frames}`);
  // The decoder refuses what is no time.
  for (const [j, frames] of [[1, 1], [-1, 1], [NaN, 1], [10, 10], [-3, 10]]) {
    const { num, den } = timeOfFrame(j, { frames });
    assert.ok(!(num >= 0 && num <= den && den > 0), `${j} of ${frames}: ${num} / ${den}`);
  }
  assert.deepEqual(timeOf(6n, 8n), { num: 3, den: 4 });
});

test("R-MED-001: seconds", () => {
  for (const [text, frames, rateNum, rateDen, num, den] of [
    ["0", 60, 30, 1, 0, 1], ["1", 61, 30, 1, 1, 2], ["1.5", 61, 30, 1, 3, 4],
    ["1.50", 61, 30, 1, 3, 4], ["-0.5", 61, 30, 1, 0, 1], ["-0", 61, 30, 1, 0, 1],
    ["0.5", 16, 30000, 1001, 1000, 1001], // 15 frames of 30000/1001 end at 0.5005
    ["0.5005", 16, 30000, 1001, 1, 1], ["99", 61, 30, 1, 1, 1], ["99", 1, 30, 1, 0, 1],
    ["0.1234567", 2, 1, 1, 1234567, 10000000], ["0.1234567", 4, 1, 1, 690420, LAST], // 690419.87
    ["0.5", UINT32_MAX, UINT32_MAX - 2, 1, 8388607, LAST], // 8388607.50
    ["999999.9999999", UINT32_MAX, 1, 4294967291, 0, LAST],
    ["999999.9999999", UINT32_MAX, 4294967291, 1000001, 16777198, LAST],
  ]) assert.deepEqual(timeOfSeconds(text, { frames, rateNum, rateDen }), { num, den }, text);
  for (const text of ["", "s", "1.", ".5", "1s", "1e3", "+1", " 1", "nan", "--1", "1,5"])
    assert.equal(timeOfSeconds(text, { frames: 61, rateNum: 30, rateDen: 1 }), undefined, text);
});

test("a fragment says a time, a frame, or nothing", () => {
  const info = { frames: 11, rateNum: 5, rateDen: 1 };
  for (const [fragment, num, den] of [
    ["#t=0.1", 1, 20], ["#t=-3", 0, 1], ["#frame=5", 1, 2], ["#frame=0", 0, 1], ["#frame=10", 1, 1],
    ["#frame=11", 1, 1], ["#frame=99999999999999999999999", 1, 1],
  ]) assert.deepEqual(timeOfFragment(fragment, info), { num, den }, fragment);
  for (const fragment of ["", "#", "#t", "#t=", "#t=x", "#frame=", "#frame=-1", "#frame=1.5",
    "#frame=1e1", "#time=1", "t=1", "#t=1&frame=2"])
    assert.equal(timeOfFragment(fragment, info), undefined, fragment);
});
