// Headless Chromium over its debugging pipe: no port, no package.
//
// Messages are JSON, each ended by a zero byte; file descriptor 3 takes them, 4 gives them.
import { execFileSync, spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

const flags = [
  "--headless",
  "--no-sandbox",
  "--disable-gpu",
  "--no-first-run",
  "--hide-scrollbars",
  "--disable-background-networking",
  "--disable-component-update",
  "--disable-default-apps",
  "--disable-extensions",
  "--disable-sync",
  "--remote-debugging-pipe",
];

/** The path of the program, or null. */
export function findBrowser() {
  for (const name of ["chromium", "chromium-browser", "google-chrome"]) {
    try {
      return execFileSync("sh", ["-c", `command -v ${name}`], { encoding: "utf8" }).trim();
    } catch {
      // not this one
    }
  }
  return null;
}

export class Chromium {
  #waiting = new Map();
  #listeners = [];
  #lastId = 0;
  #rest = "";

  constructor(program) {
    this.profile = mkdtempSync(join(tmpdir(), "recald-pages-"));
    this.child = spawn(program, [...flags, `--user-data-dir=${this.profile}`, "about:blank"], {
      stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"],
    });
    this.child.stdio[4].setEncoding("utf8");
    this.child.stdio[4].on("data", (text) => this.#take(text));
    this.child.on("exit", () => {
      for (const { reject } of this.#waiting.values()) reject(new Error("Chromium has ended"));
    });
  }

  #take(text) {
    const messages = (this.#rest + text).split("\0");
    this.#rest = messages.pop();
    for (const message of messages.map((one) => JSON.parse(one))) {
      const waiting = this.#waiting.get(message.id);
      this.#waiting.delete(message.id);
      if (!waiting) this.#listeners.forEach((listener) => listener(message));
      else if (message.error) waiting.reject(new Error(message.error.message));
      else waiting.resolve(message.result);
    }
  }

  send(method, params = {}, sessionId = undefined) {
    const id = ++this.#lastId;
    this.child.stdio[3].write(`${JSON.stringify({ id, method, params, sessionId })}\0`);
    return new Promise((resolve, reject) => this.#waiting.set(id, { resolve, reject }));
  }

  onEvent(listener) {
    this.#listeners.push(listener);
  }

  async openTab() {
    const { targetId } = await this.send("Target.createTarget", { url: "about:blank" });
    const { sessionId } = await this.send("Target.attachToTarget", { targetId, flatten: true });
    return new Tab(this, sessionId);
  }

  async close() {
    const ended = new Promise((resolve) => this.child.on("exit", resolve));
    this.send("Browser.close").catch(() => {});
    await ended;
    rmSync(this.profile, { recursive: true, force: true, maxRetries: 5 });
  }
}

class Tab {
  #loaded = () => {};
  complaints = [];

  constructor(browser, sessionId) {
    this.send = (method, params) => browser.send(method, params, sessionId);
    browser.onEvent((event) => {
      if (event.sessionId !== sessionId) return;
      if (event.method === "Page.loadEventFired") this.#loaded();
      if (event.method === "Runtime.exceptionThrown") {
        const { text, exception } = event.params.exceptionDetails;
        this.complaints.push(exception?.description ?? text);
      }
      if (event.method === "Log.entryAdded" && event.params.entry.level === "error") {
        const { text, url } = event.params.entry;
        this.complaints.push(url ? `${text} ${url}` : text);
      }
    });
  }

  async prepare() {
    for (const domain of ["Page", "Runtime", "Log"]) await this.send(`${domain}.enable`);
  }

  async open(url) {
    const loaded = new Promise((resolve) => (this.#loaded = resolve));
    await this.send("Page.navigate", { url });
    await loaded;
  }

  /** Of an expression, or a promise of one, in the page. */
  async value(expression) {
    const { result, exceptionDetails } = await this.send("Runtime.evaluate", {
      expression,
      awaitPromise: true,
      returnByValue: true,
    });
    if (exceptionDetails) {
      throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
    }
    return result.value;
  }

  resize(width, height = 900) {
    return this.send("Emulation.setDeviceMetricsOverride", {
      width,
      height,
      deviceScaleFactor: 1,
      mobile: false,
    });
  }

  /** @param look  "light", "dark" or "print". */
  show(look) {
    return this.send("Emulation.setEmulatedMedia", {
      media: look === "print" ? "print" : "screen",
      features: [{ name: "prefers-color-scheme", value: look === "dark" ? "dark" : "light" }],
    });
  }
}
