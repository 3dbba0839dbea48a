// timeline.js - the controls of time below the picture. SPDX-License-Identifier: BSD-2-Clause

const at = (id) => document.getElementById(id);

// The controls take several lines where the window is narrow. The style sheet keeps them free.
function tellHeight() {
  const { style } = document.documentElement, timeline = at("timeline");
  new ResizeObserver(() => style.setProperty("--bar", `${timeline.offsetHeight}px`))
    .observe(timeline);
}

// Connects the controls with a clock. show() brings them up to date.
export function bindTimeline(clock) {
  tellHeight();
  const time = at("time");
  const toggle = () => (clock.isPlaying ? clock.pause() : clock.play(performance.now()));
  at("play").addEventListener("click", toggle);
  at("back").addEventListener("click", () => clock.step(-1));
  at("on").addEventListener("click", () => clock.step(1));
  at("loop").addEventListener("change", () => { clock.isLooping = at("loop").checked; });
  at("speed").addEventListener("change", () => { clock.speed = Number(at("speed").value); });
  time.addEventListener("input", () => {
    clock.pause();
    clock.seek(time.valueAsNumber);
  });

  let shown = "";
  function show() {
    const seconds = (clock.position / clock.rate).toFixed(2);
    const text = `${Math.floor(clock.position)} (${seconds} s)`;
    const state = `${text}${clock.isPlaying}${clock.position}`;
    if (state === shown) return;
    shown = state;
    time.value = clock.position;
    time.setAttribute("aria-valuetext", `frame ${text}`);
    at("frame").textContent = text;
    const action = clock.isPlaying ? "Pause" : "Play";
    at("play").textContent = clock.isPlaying ? "❚❚" : "▶";
    at("play").title = action;
    at("play").setAttribute("aria-label", action);
  }

  function reset() {
    time.max = clock.frames - 1;
    for (const id of ["play", "back", "on", "time"]) at(id).disabled = clock.frames === 1;
  }

  return { toggle, show, reset };
}
