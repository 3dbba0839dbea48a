// times.js - times as queries: { num, den } of R-REC-002, from fractions, frames, seconds, and the
// fragment of an address (18). All is exact.
// SPDX-License-Identifier: BSD-2-Clause

const DEN_END = 1 << 24;
const DECIMAL = /^(-?\d+)(?:\.(\d+))?$/;

function divisor(a, b) {
  while (b !== 0n) [a, b] = [b, a % b];
  return a;
}

// The integer nearest to num / den, of two the even one.
function rounded(num, den) {
  const whole = num / den, twice = 2n * (num % den);
  return twice > den || (twice === den && whole % 2n === 1n) ? whole + 1n : whole;
}

// R-HDR-005: the query of the time num / den. Integers or BigInts, 0 <= num <= den; den 0: time 0.
export function timeOf(num, den) {
  if (den == 0) return { num: 0, den: 1 };
  const common = divisor(BigInt(den), BigInt(num)), last = BigInt(DEN_END - 1);
  const a = BigInt(num) / common, b = BigInt(den) / common;
  return b < DEN_END ? { num: Number(a), den: Number(b) }
    : { num: Number(rounded(a * last, b)), den: DEN_END - 1 };
}

// R-HDR-005: of frame j, from 0 to frames - 1. Of another one: no time, which a decoder refuses.
export function timeOfFrame(j, { frames }) {
  return frames > 1 || j == 0 ? timeOf(j, frames - 1) : { num: 1, den: 0 };
}

// R-MED-001: of a decimal number of seconds after the first frame, a text. undefined: it is none.
export function timeOfSeconds(text, { frames, rateNum, rateDen }) {
  const match = DECIMAL.exec(text);
  if (match === null) return undefined;
  const [, whole, decimals = ""] = match;
  const num = BigInt(whole + decimals) * BigInt(rateNum);
  const den = 10n ** BigInt(decimals.length) * BigInt(rateDen) * BigInt(frames - 1);
  if (num <= 0n) return timeOf(0, 1);
  return num < den || den === 0n ? timeOf(num, den) : timeOf(1, 1);
}

// Of "#t=s" or "#frame=j" (18), in a scene with that info. undefined: it says no time.
export function timeOfFragment(fragment, info) {
  const [, name, value] = /^#(t|frame)=(.*)$/.exec(fragment) ?? [];
  if (name === "t") return timeOfSeconds(value, info);
  if (name === undefined || !/^\d+$/.test(value)) return undefined;
  return timeOfFrame(Math.min(Number(value), info.frames - 1), info);
}
