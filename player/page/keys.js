// keys.js - the keys of the page (see the help in index.html).
// SPDX-License-Identifier: BSD-2-Clause

const at = (id) => document.getElementById(id);

// Keys that a focused control takes itself.
function belongsTo(control, key) {
  if (control.closest("dialog")) return true;
  if (control.matches("select, input:not([type=range], [type=checkbox])")) return key !== "?";
  if (control.matches("button, summary, [type=checkbox]")) return key === " " || key === "Enter";
  return control.matches("[type=range]") && (key === "Home" || key === "End" ||
    key.startsWith("Arrow"));
}

export function bindKeys(player, timeline) {
  const { clock, navigation } = player;
  const second = () => Math.max(1, Math.round(clock.rate));
  const help = () => at("help").showModal();
  const steps = {
    ",": () => clock.step(-1),
    ".": () => clock.step(1),
    ArrowLeft: () => clock.step(-second()),
    ArrowRight: () => clock.step(second()),
    Home: () => clock.seek(0),
    End: () => clock.seek(clock.frames - 1),
  };
  const switches = {
    " ": timeline.toggle,
    0: () => { if (player.cameras.length > 0) player.useCamera(0); },
    p: () => { player.followsPath = !player.followsPath; },
    h: () => document.body.classList.toggle("bare"),
    "?": help,
  };
  at("show-help").addEventListener("click", help);
  addEventListener("keydown", (e) => {
    if (e.ctrlKey || e.metaKey || e.altKey || belongsTo(e.target, e.key)) return;
    // Caps Lock makes capital letters.
    const key = e.key.length === 1 ? e.key.toLowerCase() : e.key;
    const action = steps[key] ?? switches[key];
    // A key that is held steps on, but switches once.
    if (action && !(e.repeat && key in switches)) action();
    if (action || navigation.press(e)) e.preventDefault();
  });
  addEventListener("keyup", (e) => navigation.release(e));
  addEventListener("blur", () => navigation.releaseAll());
}
