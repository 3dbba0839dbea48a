// browser.mjs - headless Chromium, driven by the DevTools protocol over a pipe. Drawing is done in
// software (SwiftShader), so that it works on machines without a GPU.
// SPDX-License-Identifier: BSD-2-Clause
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

const CHROMIUM = process.env.CHROMIUM ?? "chromium";
const FLAGS = ["--headless=new", "--no-sandbox", "--no-first-run", "--disable-gpu-vsync",
  "--remote-debugging-pipe", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
  "--ignore-gpu-blocklist", "--force-device-scale-factor=1", "--hide-scrollbars",
  "--disable-background-networking", "--disable-component-update"];

export class Browser {
  #process;
  #folder = mkdtempSync(join(tmpdir(), "ted4-chromium-"));
  #waiting = new Map();
  #calls = 0;
  #pages = new Map();

  constructor() {
    this.#process = spawn(CHROMIUM, [...FLAGS, `--user-data-dir=${this.#folder}`, "about:blank"],
      { stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"] });
    let rest = "";
    this.#process.stdio[4].setEncoding("utf8").on("data", (text) => {
      const parts = (rest + text).split("\0");
      rest = parts.pop();
      for (const part of parts) this.#receive(JSON.parse(part));
    });
    this.#process.on("error", (e) => { throw e; });
  }

  #receive({ id, result, error, method, params, sessionId }) {
    if (id === undefined) {
      this.#pages.get(sessionId)?.receive(method, params);
      return;
    }
    const { resolve, reject } = this.#waiting.get(id);
    this.#waiting.delete(id);
    if (error) reject(new Error(error.message));
    else resolve(result);
  }

  send(method, params = {}, sessionId = undefined) {
    const id = ++this.#calls;
    this.#process.stdio[3].write(`${JSON.stringify({ id, method, params, sessionId })}\0`);
    return new Promise((resolve, reject) => this.#waiting.set(id, { resolve, reject }));
  }

  // A new tab of that many pixels.
  async page(width, height) {
    const { targetId } = await this.send("Target.createTarget", { url: "about:blank" });
    const { sessionId } = await this.send("Target.attachToTarget", { targetId, flatten: true });
    const page = new Page((method, params) => this.send(method, params, sessionId),
      () => this.send("Target.closeTarget", { targetId }));
    this.#pages.set(sessionId, page);
    await page.start(width, height);
    return page;
  }

  async close() {
    const exited = new Promise((resolve) => { this.#process.once("exit", resolve); });
    this.send("Browser.close").catch(() => {});
    await exited;
    rmSync(this.#folder, { recursive: true, force: true, maxRetries: 5 });
  }
}

export class Page {
  #send;
  #loaded = null;
  #choosing = null;
  errors = []; // uncaught exceptions, and errors on the console
  requests = []; // addresses

  constructor(send, close) {
    this.#send = send;
    this.close = close;
  }

  async start(width, height) {
    for (const domain of ["Page", "Runtime", "Network", "Log"])
      await this.#send(`${domain}.enable`);
    await this.resize(width, height);
  }

  receive(method, params) {
    if (method === "Page.loadEventFired") this.#loaded?.();
    if (method === "Page.fileChooserOpened") this.#choosing?.(params.backendNodeId);
    if (method === "Runtime.exceptionThrown")
      this.errors.push(params.exceptionDetails.exception?.description ??
        params.exceptionDetails.text);
    if (method === "Log.entryAdded" && params.entry.level === "error")
      this.errors.push(`${params.entry.text} ${params.entry.url ?? ""}`);
    if (method === "Network.requestWillBeSent") this.requests.push(params.request.url);
  }

  // ratio: pixels of the screen per pixel of the page.
  resize(width, height, ratio = 1) {
    return this.#send("Emulation.setDeviceMetricsOverride",
      { width, height, deviceScaleFactor: ratio, mobile: false });
  }

  // Runs a script in every document that is opened from then on, before those of its own.
  before(source) {
    return this.#send("Page.addScriptToEvaluateOnNewDocument", { source });
  }

  async open(url) {
    const loaded = new Promise((resolve) => { this.#loaded = resolve; });
    await this.#send("Page.navigate", { url });
    await loaded;
  }

  // The value, or what its promise gives, of an expression of the page.
  async evaluate(expression) {
    const { result, exceptionDetails } = await this.#send("Runtime.evaluate",
      { expression, awaitPromise: true, returnByValue: true });
    if (exceptionDetails)
      throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
    return result.value;
  }

  // Waits until the expression is true.
  async until(expression, seconds = 60) {
    const end = Date.now() + 1000 * seconds;
    while (!await this.evaluate(`Boolean(${expression})`)) {
      if (Date.now() > end)
        throw new Error(`not within ${seconds} s: ${expression}; ${this.errors.join("; ")}`);
      await new Promise((resolve) => { setTimeout(resolve, 50); });
    }
  }

  // A PNG, base64.
  async screenshot() {
    return (await this.#send("Page.captureScreenshot", { format: "png" })).data;
  }

  // times: how often the key is sent while it is down.
  async press(key, code = key, times = 1) {
    const text = key === "Enter" ? "\r" : key.length === 1 ? key : undefined;
    for (let i = 0; i < times; i++)
      await this.#send("Input.dispatchKeyEvent",
        { type: "keyDown", key, code, text, autoRepeat: i > 0 });
    await this.#send("Input.dispatchKeyEvent", { type: "keyUp", key, code });
  }

  // Chooses a file in the dialog that the action opens.
  async choose(file, action) {
    await this.#send("Page.setInterceptFileChooserDialog", { enabled: true });
    const opened = new Promise((resolve) => { this.#choosing = resolve; });
    await action();
    const backendNodeId = await opened;
    await this.#send("DOM.setFileInputFiles", { files: [file], backendNodeId });
  }

  async hold(key, code, milliseconds) {
    await this.#send("Input.dispatchKeyEvent", { type: "keyDown", key, code });
    await new Promise((resolve) => { setTimeout(resolve, milliseconds); });
    await this.#send("Input.dispatchKeyEvent", { type: "keyUp", key, code });
  }

  // Two fingers, from and to [x, y] each.
  async pinch(from, to) {
    const touch = (type, points) => this.#send("Input.dispatchTouchEvent",
      { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
    await touch("touchStart", from);
    await touch("touchMove", to);
    await touch("touchEnd", []);
  }

  async drag(x, y, toX, toY, button = "left") {
    const event = (type, px, py, buttons) => this.#send("Input.dispatchMouseEvent",
      { type, x: px, y: py, button, buttons, clickCount: 1 });
    const down = button === "left" ? 1 : 2;
    await event("mousePressed", x, y, down);
    await event("mouseMoved", toX, toY, down);
    await event("mouseReleased", toX, toY, 0);
  }

  async wheel(x, y, deltaY) {
    await this.#send("Input.dispatchMouseEvent", { type: "mouseWheel", x, y, deltaX: 0, deltaY });
  }
}
