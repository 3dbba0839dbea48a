// message.js - what has gone wrong, above the picture: it stays until it is closed, or until what
// it is about goes well. SPDX-License-Identifier: BSD-2-Clause

const at = (id) => document.getElementById(id);

// about: "file", one that was asked for, "time", one of the scene that is shown, or "context", in
// which it is drawn.
export function showMessage(text, about) {
  at("message").dataset.about = about;
  at("message").hidden = false;
  at("message-text").textContent = text; // after it shows, so that screen readers say it
}

// Hides what is said about that; about all, if it is missing.
export function clearMessage(about) {
  if (about === undefined || at("message").dataset.about === about) at("message").hidden = true;
}

export function bindMessage() {
  at("close-message").addEventListener("click", () => clearMessage());
}
