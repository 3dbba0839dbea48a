// export.mjs PLAYER SCENE.ted4 OUT.html - one file that holds the player of a folder (make player)
// and a scene, and opens from the disk without a server.
// SPDX-License-Identifier: BSD-2-Clause
import { readFileSync, realpathSync, writeFileSync } from "node:fs";
import { basename, join } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";

const STYLE = '<link rel="stylesheet" href="style.css">';
const MAGIC = Buffer.from("\x89TED4\r\n\x1a", "latin1"); // spec 5.1
const SCRIPT = '<script src="player.js"></script>';

function packed(id, bytes, name = "") {
  const base64 = gzipSync(bytes, { level: 9 }).toString("base64");
  const attribute = name.replace(/[&<>"]/g, (c) => `&#${c.charCodeAt(0)};`);
  return `<script type="text/plain" id="${id}" data-name="${attribute}">${base64}</script>\n`;
}

function replaced(text, from, to) {
  if (!text.includes(from)) throw new Error(`index.html has no ${from}`);
  return text.replace(from, () => to);
}

export function exportPage(player, scene, name) {
  const read = (file) => readFileSync(join(player, file));
  const scripts = packed("ted4-wasm", read("ted4.wasm")) + packed("ted4-scene", scene, name) +
    packed("ted4-code", read("player.js")) +
    `<script>\n${readFileSync(new URL("page/unpack.js", import.meta.url), "utf8")}</script>`;
  const style = `<style>\n${read("style.css")}</style>`;
  return replaced(replaced(read("index.html").toString(), STYLE, style), SCRIPT, scripts);
}

function main([player, file, out]) {
  if (!player || !file || !out)
    throw new Error("usage: node export.mjs PLAYER SCENE.ted4 OUT.html");
  const scene = readFileSync(file);
  if (!scene.subarray(0, MAGIC.length).equals(MAGIC)) throw new Error(`${file}: not a TED4 file`);
  const page = exportPage(player, scene, basename(file));
  writeFileSync(out, page);
  const size = Buffer.byteLength(page);
  console.log(`${out}: ${size} bytes, ${size - scene.length} more than the scene`);
}

if (process.argv[1] && realpathSync(process.argv[1]) === fileURLToPath(import.meta.url)) {
  try {
    main(process.argv.slice(2));
  } catch ({ message }) {
    console.error(`export.mjs: ${message}`);
    process.exitCode = 3;
  }
}
