// chunks.js - what a valid file carries beside the scene (spec 5.2, 16.4): its chunks, the lines of
// META, and the cameras of CAMS.
// SPDX-License-Identifier: BSD-2-Clause

const MAGIC = [0x89, 0x54, 0x45, 0x44, 0x34, 0x0d, 0x0a, 0x1a];
const HEADER = 12, FRAME = 20; // bytes of the file header; of a chunk without its payload
const CAMS_HEAD = 20, CAMERA = 80, MAX_CAMERAS = 65536, MAX_SIDE = 16384;
const DEN_END = 2 ** 24; // R-REC-002
const TOLERANCE = 0.001;

// Whether the first bytes of a file are those of a TED4 file (spec 5.1).
export function isTed4(bytes) {
  return MAGIC.every((v, i) => bytes[i] === v);
}

// [{ type, payload }] in the order of the file.
export function chunksOf(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const chunks = [];
  for (let at = HEADER; at + FRAME <= bytes.length;) {
    const size = view.getUint32(at + 8, true);
    const type = String.fromCharCode(...bytes.subarray(at, at + 4));
    chunks.push({ type, payload: bytes.subarray(at + 12, at + 12 + size) });
    at += FRAME + size;
  }
  return chunks;
}

// [{ type, count, bytes }], which sum up to the file without its 12 bytes of header.
export function bytesByType(chunks) {
  const rows = new Map();
  for (const { type, payload } of chunks) {
    const row = rows.get(type) ?? { type, count: 0, bytes: 0 };
    row.count++;
    row.bytes += payload.length + FRAME;
    rows.set(type, row);
  }
  return [...rows.values()];
}

// The lines of META as a Map from key to value.
export function metaOf(chunks) {
  const lines = chunks.filter(({ type }) => type === "META")
    .flatMap(({ payload }) => new TextDecoder().decode(payload).split("\n"));
  return new Map(lines.filter((line) => line.includes("=")).map((line) => {
    const at = line.indexOf("=");
    return [line.slice(0, at), line.slice(at + 1)];
  }));
}

function readCamera(view, at) {
  const word = (i) => view.getUint32(at + 4 * i, true);
  const real = (i) => view.getFloat32(at + 4 * i, true);
  const reals = (from, n) => Array.from({ length: n }, (_, i) => real(from + i));
  return {
    width: word(0), height: word(1), fx: real(2), fy: real(3), cx: real(4), cy: real(5),
    R: reals(6, 9), t: reals(15, 3), num: word(18), den: word(19),
  };
}

function isRotation(R) {
  for (let i = 0; i < 3; i++) {
    for (let j = 0; j < 3; j++) {
      const dot = R[3 * i] * R[3 * j] + R[3 * i + 1] * R[3 * j + 1] + R[3 * i + 2] * R[3 * j + 2];
      if (!(Math.abs(dot - (i === j ? 1 : 0)) <= TOLERANCE)) return false;
    }
  }
  const [a, b, c, d, e, f, g, h, k] = R;
  return a * (e * k - f * h) + b * (f * g - d * k) + c * (d * h - e * g) > 0;
}

function isCamera({ width, height, fx, fy, cx, cy, R, t, num, den }) {
  const isSide = (n) => n >= 1 && n <= MAX_SIDE;
  return isSide(width) && isSide(height) && fx > 0 && fy > 0 &&
    [fx, fy, cx, cy, ...t].every(Number.isFinite) && isRotation(R) && num <= den && den < DEN_END;
}

// A chunk CAMS, or null where it breaks R-EXT-008 and is to be ignored.
function readCams(payload) {
  if (payload.length < CAMS_HEAD) return null;
  const view = new DataView(payload.buffer, payload.byteOffset, payload.byteLength);
  const up = [0, 4, 8].map((at) => view.getFloat32(at, true));
  const kind = view.getUint32(12, true), n = view.getUint32(16, true);
  if (kind > 1 || n > MAX_CAMERAS || payload.length !== CAMS_HEAD + n * CAMERA) return null;
  const length = Math.hypot(...up);
  if (!(length === 0 || Math.abs(length - 1) <= TOLERANCE)) return null;
  const cameras = Array.from({ length: n }, (_, i) => readCamera(view, CAMS_HEAD + i * CAMERA));
  return cameras.every(isCamera) ? { up, kind, cameras } : null;
}

// { up, cameras, path }: up is null if it is unknown; of each kind the last chunk that has cameras
// counts.
export function camerasOf(chunks) {
  const found = { up: null, cameras: [], path: [] };
  for (const { type, payload } of chunks) {
    const cams = type === "CAMS" ? readCams(payload) : null;
    if (cams === null) continue;
    if (cams.cameras.length > 0) found[cams.kind === 0 ? "cameras" : "path"] = cams.cameras;
    if (Math.hypot(...cams.up) > 0) found.up = cams.up;
  }
  return found;
}
