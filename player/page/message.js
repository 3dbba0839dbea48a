// message.js - what has gone wrong, above the picture: it stays until it is closed, or until what
// it is about goes well. Of several, the last one shows, and then the one before.
// SPDX-License-Identifier: BSD-2-Clause

const at = (id) => document.getElementById(id);
const texts = new Map(); // by what they are about, in order
const last = () => [...texts].at(-1) ?? [];

function show() {
  const [, text = ""] = last();
  at("message").hidden = texts.size === 0;
  at("message-text").textContent = text; // after it shows, so that screen readers say it
}

// about: "file", one that was asked for, "time", one of the scene that is shown, or "context", in
// which it is drawn.
export function showMessage(text, about) {
  texts.delete(about);
  texts.set(about, text);
  show();
}

// Forgets what is said about that.
export function clearMessage(about) {
  const [shown] = last();
  texts.delete(about);
  if (shown === about) show();
}

export function bindMessage() {
  at("close-message").addEventListener("click", () => clearMessage(last()[0]));
}
