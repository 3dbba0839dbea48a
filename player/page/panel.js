// panel.js - what the page says about a file: title, verdict, facts, bytes, statistics.
// SPDX-License-Identifier: BSD-2-Clause

const at = (id) => document.getElementById(id);
const count = (n) => n.toLocaleString("en");

function terms(id, rows) {
  at(id).replaceChildren(...rows.flatMap(([term, text]) => {
    const dt = document.createElement("dt"), dd = document.createElement("dd");
    dt.textContent = term;
    dd.textContent = text;
    return [dt, dd];
  }));
}

function table(id, rows) {
  at(id).replaceChildren(...rows.map((cells) => {
    const row = document.createElement("tr");
    for (const text of cells) row.insertCell().textContent = text;
    return row;
  }));
}

function sceneRows({ bytes, info, meta }) {
  const said = ["author", "licence", "created"].filter((key) => meta.has(key))
    .map((key) => [key[0].toUpperCase() + key.slice(1), meta.get(key)]);
  return [
    ...said,
    ["File", `${count(bytes.length)} bytes`],
    ["Anchors", `${count(info.anchors)}, ${count(info.moving)} moving`],
    ["Gaussians", count(info.gaussians)],
    ["Frames", `${count(info.frames)}, ${Number(info.rate.toPrecision(7))} per second`],
    ["Motion", info.motion],
    ["Activation", info.activation ? "yes" : "no"],
    ["View dependence", info.view],
    ["Level", info.level],
    ["Hash", info.hash],
  ];
}

export function showFile(file) {
  at("title").textContent = file.meta.get("title") ?? file.name;
  document.title = `${at("title").textContent} - TED4 player`;
  at("verdict").textContent = "Valid: strictly decoded, scene hash checked.";
  terms("facts", sceneRows(file));
  table("by-chunk", file.chunks.map(({ type, count: n, bytes }) =>
    [n > 1 ? `${type} (${n})` : type, count(bytes)]));
  table("by-element", []);
}

export function showElements(rows) {
  table("by-element", rows.map(({ chunk, element, bytes }) =>
    [`${chunk} ${element}`, count(bytes)]));
}

// player, and how many times were evaluated and pictures drawn in the last second.
export function showStatistics({ file, statistics, sorting }, evaluated, drawn) {
  terms("statistics", [
    ["Decoding", `${file.milliseconds.toFixed(0)} ms`],
    ["First picture", `${statistics.firstPicture.toFixed(0)} ms`],
    ["Evaluation", `${statistics.evaluate.toFixed(1)} ms`],
    ["Sorting", `${sorting.toFixed(1)} ms`],
    ["Gaussians", count(file.info.gaussians)],
    ["Evaluations per second", count(evaluated)],
    ["Frames drawn per second", count(drawn)],
  ]);
}
