// package.mjs - the package as npm installs it (make player-package): it holds all that it exports,
// and the program of the README runs in Node. SPDX-License-Identifier: BSD-2-Clause
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import {
  copyFileSync, existsSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync,
} from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { needed, PLAYER, SCENE } from "./fixture.mjs";

const README = new URL("../README.md", import.meta.url);
let folder, installed;

before(() => {
  folder = mkdtempSync(join(tmpdir(), "ted4-package-"));
  installed = join(folder, "node_modules/ted4");
  writeFileSync(join(folder, "package.json"), `{ "type": "module" }`);
  execFileSync("npm", ["install", "--offline", "--no-audit", "--no-fund", "--loglevel=error",
    needed("TED4_PACKAGE")], { cwd: folder });
});

after(() => rmSync(folder, { recursive: true }));

test("the package holds all that it exports", () => {
  const { exports } = JSON.parse(readFileSync(join(installed, "package.json"), "utf8"));
  const paths = Object.values(exports)
    .flatMap((target) => (typeof target === "string" ? [target] : Object.values(target)))
    .filter((path) => !path.includes("*"));
  assert.ok(paths.includes("./ted4.wasm"));
  for (const path of paths) assert.ok(existsSync(join(installed, path)), path);
});

test("the licences of what it is made of are in the package and in the page's script", () => {
  const licence = readFileSync(join(installed, "LICENSE"), "utf8");
  const script = readFileSync(join(PLAYER, "player.js"), "utf8");
  for (const [text, owners] of [[licence, ["the TED4 authors", "Yann Collet"]],
    [script, ["the TED4 authors", "Yann Collet", "PlayCanvas Ltd"]]])
    for (const owner of owners)
      assert.match(text, new RegExp(`Copyright \\(c\\) [-0-9, ]*${owner}`, "i"), owner);
});

test("all that its adapters import is declared", () => {
  const { peerDependencies } = JSON.parse(readFileSync(join(installed, "package.json"), "utf8"));
  const adapters = join(installed, "adapters");
  const names = readdirSync(adapters).flatMap((file) =>
    [...readFileSync(join(adapters, file), "utf8").matchAll(/from "([^".][^"]*)"/g)]
      .map(([, name]) => name));
  assert.deepEqual([...new Set(names)].sort(), Object.keys(peerDependencies).sort());
});

test("the program of the README runs in Node", () => {
  const [, program] = /```js\n([^]*?)```/.exec(readFileSync(README, "utf8"));
  copyFileSync(SCENE, join(folder, "scene.ted4"));
  writeFileSync(join(folder, "program.js"), `${program}\nconsole.log(g.n, scene.info.gaussians);`);
  const said = execFileSync("node", ["program.js"], { cwd: folder, encoding: "utf8" });
  assert.match(said, /^([1-9]\d*) \1\n$/);
});
