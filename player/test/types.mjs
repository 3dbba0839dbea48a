// types.mjs - the types of the package (make player-package): a program in TypeScript
// (types/consumer.ts) compiles with them, and they name what the modules export.
// SPDX-License-Identifier: BSD-2-Clause
import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { copyFileSync, mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, symlinkSync,
  writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath } from "node:url";

// node_modules with TypeScript, PlayCanvas and Spark
const MODULES = process.env.TED4_MODULES, TARBALL = process.env.TED4_PACKAGE;
if (MODULES === undefined || TARBALL === undefined)
  throw new Error("TED4_MODULES or TED4_PACKAGE is not set: run make test-player");
const HERE = dirname(fileURLToPath(import.meta.url)), PACKAGE = dirname(HERE);
const OPTIONS = {
  module: "nodenext", target: "es2022", lib: ["es2022", "dom"], strict: true, noEmit: true,
  skipLibCheck: true, types: [],
};
let folder;

before(() => {
  folder = mkdtempSync(join(tmpdir(), "ted4-types-"));
  const modules = join(folder, "node_modules"), ours = join(modules, "ted4");
  mkdirSync(ours, { recursive: true });
  execFileSync("tar", ["-xzf", TARBALL, "-C", ours, "--strip-components=1"]);
  for (const name of ["playcanvas", "@sparkjsdev", "three"])
    symlinkSync(join(MODULES, name), join(modules, name));
  writeFileSync(join(folder, "package.json"), `{ "type": "module" }`);
  writeFileSync(join(folder, "tsconfig.json"),
    JSON.stringify({ compilerOptions: OPTIONS, files: ["consumer.ts"] }));
  copyFileSync(join(HERE, "types/consumer.ts"), join(folder, "consumer.ts"));
});

after(() => rmSync(folder, { recursive: true }));

test("a program in TypeScript compiles, and its mistakes are found", () => {
  const { status, stdout } = spawnSync(join(MODULES, ".bin/tsc"), ["-p", folder],
    { encoding: "utf8" });
  assert.equal(status, 0, stdout);
});

function exported(file) {
  const found = readFileSync(file, "utf8")
    .matchAll(/^export (?:async )?(?:class|function|const) (\w+)/gm);
  return Array.from(found, ([, name]) => name).sort();
}

test("types declare what the adapters export", () => {
  const adapters = join(PACKAGE, "adapters");
  const files = readdirSync(adapters).filter((name) => name.endsWith(".js"));
  assert.ok(files.length > 0);
  for (const file of files)
    assert.deepEqual(exported(join(adapters, file.replace(/js$/, "d.ts"))),
      exported(join(adapters, file)), file);
});
