// camera_box.js - the box that says which camera of the file is looked through, and leads to
// others.
// SPDX-License-Identifier: BSD-2-Clause

// reset() is for a new file; show() brings the box up to date, but leaves it to who types in it.
export function bindCameraBox(player) {
  const box = document.getElementById("camera");
  let said = null; // the camera of which the box speaks
  function say() {
    said = player.navigation.camera;
    box.value = player.cameraIndex < 0 ? "" : player.cameraIndex + 1;
  }

  function look() {
    const i = box.valueAsNumber - 1;
    if (i in player.cameras) player.useCamera(i);
    say();
  }
  box.addEventListener("change", look);
  // Also back to a camera that was left in the meantime.
  box.addEventListener("keydown", (e) => { if (e.key === "Enter") look(); });

  function show() {
    if (player.navigation.camera !== said && document.activeElement !== box) say();
  }

  function reset() {
    const n = player.cameras.length;
    box.max = n;
    box.disabled = n === 0;
    document.getElementById("cameras").textContent = n > 0 ? `of ${n}` : "none";
    say();
  }

  return { show, reset };
}
