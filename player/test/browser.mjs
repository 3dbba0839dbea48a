// browser.mjs - Chromium or Firefox, as TED4_BROWSER says, driven by Puppeteer. Drawing is done in
// software, so that it works on machines without a GPU; Firefox needs a display for it (xvfb-run).
// SPDX-License-Identifier: BSD-2-Clause
import { createRequire } from "node:module";
import { join } from "node:path";
import { needed } from "./fixture.mjs";

const puppeteer = createRequire(join(needed("TED4_MODULES"), "/"))("puppeteer-core");
const BROWSERS = {
  chromium: {
    browser: "chrome", executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", pipe: true,
    args: ["--no-sandbox", "--no-first-run", "--disable-gpu-vsync", "--use-angle=swiftshader",
      "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist", "--force-device-scale-factor=1",
      "--hide-scrollbars", "--disable-background-networking", "--disable-component-update"],
  },
  firefox: {
    browser: "firefox", executablePath: process.env.FIREFOX ?? "/usr/bin/firefox-esr",
    headless: false, extraPrefsFirefox: { "webgl.force-enabled": true },
  },
};
const LAUNCH = BROWSERS[process.env.TED4_BROWSER ?? "chromium"];

const pause = (milliseconds) => new Promise((resolve) => { setTimeout(resolve, milliseconds); });

export class Browser {
  #browser = puppeteer.launch({ defaultViewport: null, ...LAUNCH });

  // A new tab of that many pixels.
  async page(width, height) {
    const page = new Page(await (await this.#browser).newPage());
    await page.resize(width, height);
    return page;
  }

  async close() {
    await (await this.#browser).close();
  }
}

export class Page {
  #page;
  errors = []; // uncaught exceptions, and errors on the console
  requests = []; // addresses

  constructor(page) {
    this.#page = page;
    page.on("pageerror", (error) => this.errors.push(error.stack ?? error.message));
    page.on("console", (message) => {
      if (message.type() === "error")
        this.errors.push(`${message.text()} ${message.location()?.url ?? ""}`);
    });
    page.on("request", (request) => this.requests.push(request.url()));
  }

  close() {
    return this.#page.close();
  }

  // ratio: pixels of the screen per pixel of the page.
  resize(width, height, ratio = 1) {
    return this.#page.setViewport({ width, height, deviceScaleFactor: ratio });
  }

  // Runs a script in every document that is opened from then on, before those of its own.
  before(source) {
    return this.#page.evaluateOnNewDocument(source);
  }

  open(url) {
    return this.#page.goto(url, { waitUntil: "load" });
  }

  // The value, or what its promise gives, of an expression of the page.
  evaluate(expression) {
    return this.#page.evaluate(expression);
  }

  // Waits until the expression is true.
  async until(expression, seconds = 60) {
    const end = Date.now() + 1000 * seconds;
    while (!await this.evaluate(`Boolean(${expression})`)) {
      if (Date.now() > end)
        throw new Error(`not within ${seconds} s: ${expression}; ${this.errors.join("; ")}`);
      await pause(50);
    }
  }

  // A PNG, base64.
  screenshot() {
    return this.#page.screenshot({ encoding: "base64", captureBeyondViewport: false });
  }

  // times: how often the key is sent while it is down.
  async press(key, times = 1) {
    for (let i = 0; i < times; i++) await this.#page.keyboard.down(key);
    await this.#page.keyboard.up(key);
  }

  // Holds the key until the expression is true.
  async hold(key, expression) {
    await this.#page.keyboard.down(key);
    await this.until(expression);
    await this.#page.keyboard.up(key);
  }

  // Chooses a file in the dialog that the action opens.
  async choose(file, action) {
    const [chooser] = await Promise.all([this.#page.waitForFileChooser(), action()]);
    await chooser.accept([file]);
  }

  // Two fingers, from and to [x, y] each.
  async pinch(from, to) {
    const fingers = [];
    for (const at of from) fingers.push(await this.#page.touchscreen.touchStart(...at));
    for (const [i, at] of to.entries()) await fingers[i].move(...at);
    for (const finger of fingers) await finger.end();
  }

  async drag(x, y, toX, toY, button = "left") {
    const { mouse } = this.#page;
    await mouse.move(x, y);
    await mouse.down({ button });
    await mouse.move(toX, toY);
    await mouse.up({ button });
  }

  async wheel(x, y, deltaY) {
    await this.#page.mouse.move(x, y);
    await this.#page.mouse.wheel({ deltaY });
  }
}
