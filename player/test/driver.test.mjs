// driver.test.mjs - the decoder behind the driver contract: what it says it can do, and does. Run
// by `make player-test`. SPDX-License-Identifier: BSD-2-Clause
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { fileURLToPath } from "node:url";

const root = new URL("../../", import.meta.url);
const path = (name) => fileURLToPath(new URL(name, root));

function ask(...words) {
  return JSON.parse(execFileSync("node", [path("player/test/driver.mjs"), ...words]));
}

const capabilities = ask("--ted4-capabilities");

test("versions are those of the decoder's header", () => {
  const header = readFileSync(path("ref-decoder/ted4.h"), "utf8");
  const defined = (name) => header.match(new RegExp(`#define ${name} +"(.*)"`))[1];
  assert.equal(capabilities.version, defined("TED4_VERSION"));
  assert.equal(capabilities.spec, defined("TED4_SPEC_VERSION"));
});

// The runner takes a refusal of a profile that is not claimed for no failure.
test("both profiles are claimed, and decoded", () => {
  assert.deepEqual(capabilities.profiles, ["Main", "Compact"]);
  for (const name of ["worked/WRK-annex-b2", "valid/compact/CMP-ancillary-TILE"]) {
    const { result } = ask("--ted4-run", path(`conformance/vectors/${name}.ted4`), "--tiers", "T0");
    assert.equal(result, "valid", name);
  }
});
