// unpack.js - starts the player in a page that holds everything: code, module and scene lie in it
// as gzip and base64 (../export.mjs).
// SPDX-License-Identifier: BSD-2-Clause
(async () => {
  const unpack = (id) => {
    const packed = Uint8Array.from(atob(document.getElementById(id).textContent),
      (c) => c.charCodeAt(0));
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
    return new Response(stream).arrayBuffer();
  };
  const [wasm, scene, code] =
    await Promise.all(["ted4-wasm", "ted4-scene", "ted4-code"].map(unpack));
  const { name } = document.getElementById("ted4-scene").dataset;
  globalThis.ted4Embedded = { wasm, scene, name };
  const script = document.createElement("script");
  script.textContent = new TextDecoder().decode(code);
  document.body.append(script);
})().catch(({ message }) => {
  const at = (id) => document.getElementById(id);
  at("message").hidden = false;
  at("close-message").hidden = true; // nothing hears it
  at("message-text").textContent = `This page cannot start in this browser: ${message}`;
});
