// export.test.mjs - what export.mjs says of arguments that are none; make passes empty ones on.
// SPDX-License-Identifier: BSD-2-Clause
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { test } from "node:test";
import { fileURLToPath } from "node:url";

const program = fileURLToPath(new URL("../export.mjs", import.meta.url));

test("without a scene, or without a name for the page, the usage is said", () => {
  for (const args of [[], ["player"], ["player", "", ""], ["player", "x.ted4", ""],
    ["player", "", "x.html"]]) {
    const { status, stderr } = spawnSync("node", [program, ...args], { encoding: "utf8" });
    assert.deepEqual([status, stderr],
      [3, "export.mjs: usage: node export.mjs PLAYER SCENE.ted4 OUT.html\n"], args.join());
  }
});
