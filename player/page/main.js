// main.js - the page: connects its controls with a Player, and opens what is dropped, chosen,
// embedded or named by ?file=.
// SPDX-License-Identifier: BSD-2-Clause
import workerText from "worker-text";
import { Ted4Error } from "../src/decoder.js";
import { bindCameraBox } from "./camera_box.js";
import { isTed4 } from "./chunks.js";
import { bindKeys } from "./keys.js";
import { bindMessage, clearMessage, showMessage } from "./message.js";
import { showElements, showFile, showStatistics } from "./panel.js";
import { Player } from "./player.js";
import { bindTimeline } from "./timeline.js";

const HEAD = 64; // bytes of a file that are enough to refuse it
const WIDE = 640; // pixels in which there is room for the panel beside the scene
const LOST = "The browser has taken the drawing context away, and may give it back. " +
  "If it does not, reload the page.";
const at = (id) => document.getElementById(id);
// A page that holds everything (export.mjs) leaves { wasm, scene, name } here.
const embedded = globalThis.ted4Embedded ?? {};

function startWorker() {
  return new Worker(URL.createObjectURL(new Blob([workerText], { type: "text/javascript" })));
}

function explain(name, error) {
  if (!(error instanceof Ted4Error)) return `${name}: ${error.message}`;
  const place = error.offset === undefined ? "" : ` at byte ${error.offset}`;
  return `${name} is refused (${error.verdict}): ${error.id}${place}\n${error.text}`;
}

const wasm = embedded.wasm ?? new URL("ted4.wasm", document.baseURI).href;
// Drawing and sorting take a core of their own, but not all the time.
const cores = navigator.hardwareConcurrency ?? 1; // some browsers do not say
const workers = Array.from({ length: Math.min(cores, 2) }, startWorker);
const player = new Player(at("picture"), workers, wasm, (error) => {
  if (error === null) clearMessage("time");
  else showMessage(explain(player.file.name, error), "time");
});
player.lost = (isLost) => {
  if (isLost) showMessage(LOST, "context");
  else clearMessage("context");
};

function showPanel(isShown) {
  at("panel").hidden = !isShown;
  at("show-panel").setAttribute("aria-expanded", isShown);
}

function showOpened() {
  document.body.classList.add("playing-file");
  at("timeline").hidden = false;
  showPanel(innerWidth >= WIDE);
  showFile(player.file);
  if (at("sizes").open) showSizes();
  const { info } = player.file;
  at("background").value =
    `#${info.background.map((v) => v.toString(16).padStart(2, "0")).join("")}`;
  cameraBox.reset();
  at("follows-path").disabled = player.file.cameras.path.length === 0;
  timeline.reset();
}

// Of a file, and of its times.
function forgetMessages() {
  clearMessage("file");
  clearMessage("time");
}

// since: when the file was asked for; fragment(): of its address.
async function open(name, reading, since, fragment) {
  forgetMessages();
  try {
    if (!await player.open(reading, name, since, fragment)) return;
    forgetMessages();
    showOpened();
  } catch (error) {
    showMessage(explain(name, error), "file");
  }
}

async function read(address) {
  const response = await fetch(address);
  if (!response.ok) throw new Error(`${response.status} ${response.statusText}`);
  return response.arrayBuffer();
}

async function showSizes() {
  const { file } = player;
  if (file === null || !at("sizes").open) return;
  try {
    const rows = await player.bytesByElement();
    if (file === player.file) showElements(rows);
  } catch (error) {
    if (file === player.file) showMessage(`Bytes by element: ${error.message}`, "file");
  }
}

// The bytes of a chosen file; of one that is no TED4 file, however large, only the first ones.
async function bytesOf(file) {
  const head = await file.slice(0, HEAD).arrayBuffer();
  return isTed4(new Uint8Array(head)) ? file.arrayBuffer() : head;
}

function bindFiles() {
  const openFile = (file) => {
    if (file) open(file.name, bytesOf(file), performance.now());
  };
  at("file").addEventListener("change", () => {
    openFile(at("file").files[0]);
    at("file").value = ""; // so that the same file may be chosen again
  });
  at("open").addEventListener("click", () => at("file").click());
  addEventListener("dragover", (e) => {
    e.preventDefault();
    document.body.classList.add("dropping");
  });
  addEventListener("dragleave", (e) => {
    if (e.relatedTarget === null) document.body.classList.remove("dropping");
  });
  addEventListener("drop", (e) => {
    e.preventDefault();
    document.body.classList.remove("dropping");
    openFile(e.dataTransfer.files[0]);
  });
}

function bindView() {
  at("show-panel").addEventListener("click", () => showPanel(at("panel").hidden));
  at("sizes").addEventListener("toggle", showSizes);
  at("follows-path").addEventListener("change", () => {
    player.followsPath = at("follows-path").checked;
  });
  at("looks-around").addEventListener("change", () => {
    player.navigation.looksAround = at("looks-around").checked;
  });
  at("background").addEventListener("input", () => {
    const { value } = at("background");
    player.setBackground([1, 3, 5].map((i) => parseInt(value.slice(i, i + 2), 16)));
  });
}

// Once a second, the statistics of that second.
function countPictures() {
  let before = { ...player.statistics };
  setInterval(() => {
    if (player.file === null) return;
    const { evaluated, drawn } = player.statistics;
    showStatistics(player, evaluated - before.evaluated, drawn - before.drawn);
    before = { evaluated, drawn };
  }, 1000);
}

const timeline = bindTimeline(player.clock), cameraBox = bindCameraBox(player);
bindKeys(player, timeline);
bindFiles();
bindMessage();
bindView();
countPictures();
at("welcome").hidden = false; // from now on files are heard of

function frame() {
  timeline.show();
  cameraBox.show();
  at("follows-path").checked = player.followsPath;
  requestAnimationFrame(frame);
}
requestAnimationFrame(frame);

addEventListener("hashchange", () => player.seekFragment(location.hash));
const address = new URLSearchParams(location.search).get("file"), fragment = () => location.hash;
if (embedded.scene) open(embedded.name, embedded.scene, 0, fragment);
else if (address) open(address.split("/").pop(), read(address), 0, fragment);

globalThis.ted4Player = player; // for scripts of the page
