// server.mjs - serves files of several folders, the first that has one, on a free port of loopback;
// FILE?wait=1000 a second later than asked for.
// SPDX-License-Identifier: BSD-2-Clause
import { readFile } from "node:fs/promises";
import { createServer } from "node:http";
import { extname, join, normalize } from "node:path";

const TYPES = {
  ".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".wasm": "application/wasm",
};

async function find(folders, name) {
  for (const folder of folders) {
    try {
      return await readFile(join(folder, name));
    } catch {
      continue; // the next folder may have it
    }
  }
  return null;
}

// { origin, close() }
export async function serve(...folders) {
  const server = createServer(async ({ url }, response) => {
    const { pathname, searchParams } = new URL(url, "http://localhost");
    const name = normalize(decodeURIComponent(pathname));
    const bytes = await find(folders, name === "/" ? "index.html" : name);
    const wait = Number(searchParams.get("wait"));
    if (wait > 0) await new Promise((resolve) => { setTimeout(resolve, wait); });
    const type = TYPES[extname(name)] ?? (name === "/" ? "text/html" : "application/octet-stream");
    response.writeHead(bytes === null ? 404 : 200, { "Content-Type": type });
    response.end(bytes ?? undefined);
  });
  await new Promise((resolve) => { server.listen(0, "127.0.0.1", resolve); });
  return { origin: `http://127.0.0.1:${server.address().port}`, close: () => server.close() };
}
