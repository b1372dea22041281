// A gateway as its operator meets it: simulated meters with a scripted fault, a building that is run
// on weekends although its drawings say otherwise, a mail server, and a browser.
//
//   node operator.mjs --recald PROGRAM --sim PROGRAM --sink message_sink.py [--pictures FOLDER]
//
// The fault is seen on the page and heard by mail; a click asks for the cause, a mail and the page
// name it, a click puts it into the model, and another takes it out again. Exit 0 passed, 1 failed,
// 77 skipped.
import { execFileSync, spawn } from "node:child_process";
import {
  existsSync,
  mkdirSync,
  mkdtempSync,
  openSync,
  readdirSync,
  readFileSync,
  rmSync,
  writeFileSync,
} from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { parseArgs } from "node:util";

import { Chromium, findBrowser } from "./chromium.mjs";

const { values: options } = parseArgs({
  options: {
    recald: { type: "string" },
    sim: { type: "string" },
    sink: { type: "string" },
    pictures: { type: "string" },
  },
});

for (const name of ["recald", "sim", "sink"]) options[name] = resolve(options[name]);
const program = findBrowser();
if (!program) {
  console.log("skipped: no chromium, chromium-browser or google-chrome on the PATH");
  process.exit(77);
}
if (!existsSync("/usr/lib/python3/dist-packages/aiosmtpd")) {
  console.log("skipped: the Debian package python3-aiosmtpd is absent");
  process.exit(77);
}

const token = "operator-token-0123456789";
const began = "2024-11-28T05:00:00Z"; // from here on the meters are polled; before, imported
const folder = mkdtempSync(join(tmpdir(), "recald-operator-"));
const at = (name) => join(folder, name);
const read = (name) => (existsSync(at(name)) ? readFileSync(at(name), "utf8") : "");
const children = [];

function begin(name, command, ...words) {
  const log = openSync(at(`${name}.log`), "a");
  const child = spawn(command, words, { cwd: folder, stdio: ["ignore", log, log] });
  child.ended = new Promise((resume) => child.on("exit", (code, signal) => resume(code ?? signal)));
  children.push(child);
  return child;
}

const run = (command, ...words) =>
  execFileSync(command, words, { cwd: folder, encoding: "utf8", maxBuffer: 1e9 });

/** Looks until there is an answer; its limit is for a machine that does much beside. */
async function wait(what, look, limit_s = 480) {
  const until = Date.now() + 1000 * limit_s;
  for (;;) {
    // A page that is just being replaced may never answer.
    const found = await Promise.race([look(), new Promise((resume) => setTimeout(resume, 5000))]);
    if (found) return found;
    if (Date.now() > until) throw new Error(`waited ${limit_s} s in vain: ${what}`);
    await new Promise((resume) => setTimeout(resume, 100));
  }
}

function check(what, holds) {
  if (!holds) throw new Error(`not so: ${what}`);
}

function writeSite(mailPort) {
  writeFileSync(at("token"), token, { mode: 0o600 });
  const meter = (id, unit, map, rated_kW) => `
[[meter]]
id = "${id}"
source = "modbus"
utility = "${id}"
bus = "plant"
unit = ${unit}
map = "${map}"
rated_kW = ${rated_kW}
poll = "5m"
`;
  const port = /127\.0\.0\.1:(\d+)/.exec(read("meters.log"))[1];
  const model = read("site.toml");
  writeFileSync(
    at("live.toml"),
    `${model.slice(model.indexOf("[site]"), model.indexOf("[weather]"))}
watermark = "6h"
${model.slice(model.indexOf("[weather]"), model.indexOf("[[meter]]"))}
[recalibration]
months = 36
[http]
listen = "127.0.0.1:0"
token_file = "token"
[alerts]
pages = "http://gateway.example.org:8080"
[[alerts.mail]]
server = "smtp://127.0.0.1:${mailPort}"
from = "recald@example.org"
to = "operator@example.org"
[bus.plant]
type = "tcp"
host = "127.0.0.1"
port = ${port}
${meter("electricity", 1, "abb-b23", 420)}
${meter("chilled_water", 2, "belimo-energy-valve", 1270)}
${meter("heating", 3, "eastron-sdm630", 1050)}
${model.slice(model.indexOf("[[model]]"))}`,
  );
}

function writeMeters() {
  const device = (unit, layout, meter) => `
[[endpoint.device]]
unit = ${unit}
layout = "${layout}"
recording = "readings.csv"
meter = "${meter}"
`;
  writeFileSync(
    at("meters.toml"),
    "[[endpoint]]\n" +
      device(1, "abb-b23", "electricity") +
      device(2, "belimo-energy-valve", "chilled_water") +
      device(3, "eastron-sdm630", "heating"),
  );
  // Two real minutes: beside other work the daemon takes half a minute to begin.
  writeFileSync(at("meters.faults"), "2h..20h unit 2 silent\n");
}

function importPast() {
  const lines = read("readings.csv").split("\n");
  const past = lines.filter((line, i) => i === 0 || (line !== "" && line < began));
  writeFileSync(at("past.csv"), past.join("\n") + "\n");
  run(options.recald, "import", "live.toml", "past.csv", "--reason", "the old system's readings");
}

const mails = () =>
  readdirSync(at("mail"))
    .filter((name) => name.endsWith(".json"))
    .sort()
    .map((name) => JSON.parse(read(join("mail", name))));
const mailOf = (words) =>
  wait(`a mail about "${words}"`, () => mails().find(({ text }) => text.includes(words)));

/** As somebody who types the token into the browser's own question for it. */
async function logIn(tab, browser) {
  browser.onEvent(({ method, params }) => {
    const { requestId } = params ?? {};
    if (method === "Fetch.requestPaused") tab.send("Fetch.continueRequest", { requestId });
    if (method === "Fetch.authRequired") {
      const answer = { response: "ProvideCredentials", username: "operator", password: token };
      tab.send("Fetch.continueWithAuth", { requestId, authChallengeResponse: answer });
    }
  });
  await tab.send("Fetch.enable", { handleAuthRequests: true });
}

let pictures = 0;
async function picture(tab, name) {
  if (!options.pictures) return;
  mkdirSync(options.pictures, { recursive: true });
  pictures += 1;
  const { data } = await wait("a picture", () =>
    tab.send("Page.captureScreenshot", { captureBeyondViewport: true }),
  );
  writeFileSync(join(options.pictures, `${pictures}-${name}.png`), Buffer.from(data, "base64"));
}

const text = (tab) => tab.value("document.body?.innerText ?? \"\"");
const shows = (tab, words) =>
  wait(`"${words}" on the page`, async () => (await text(tab)).includes(words));

/** Presses the button of which the label has these words, when it is there. */
async function click(tab, words) {
  await wait(`a button "${words}"`, () =>
    tab.value(`(() => {
      const button = [...document.querySelectorAll("button")]
        .find((one) => one.textContent.includes(${JSON.stringify(words)}));
      button?.click();
      return button !== undefined;
    })()`),
  );
}

/** The row of the version says so, and no other does. */
const isInForce = (tab, version) =>
  wait(`${version} in force`, () =>
    tab.value(`(() => {
      const rows = [...document.querySelectorAll("tr")].map((row) => row.innerText);
      const inForce = rows.filter((text) => text.includes("✔ in force"));
      return inForce.length === 1 && inForce[0].startsWith(${JSON.stringify(version)});
    })()`),
  );

async function operate(tab, address) {
  const get = async (path) =>
    (
      await fetch(address + path, { headers: { Authorization: `Bearer ${token}` } })
    ).json();

  console.log("the silent meter is seen, and heard");
  await tab.open(`${address}/`);
  await shows(tab, "✖ down");
  await picture(tab, "silent");
  const silent = await mailOf("'chilled_water' has given no reading");
  check("the mail leads to the meter", silent.text.includes("/meters/chilled_water"));
  check("its subject says it", silent.subject.startsWith("Office: "));
  await mailOf("'chilled_water' answers again");
  await tab.open(`${address}/meters/chilled_water`);
  await picture(tab, "meter");

  console.log("its cause is asked for, and read");
  await tab.open(`${address}/model`);
  await click(tab, "Look for missing effects");
  await wait("the diagnosis begins", async () =>
    (await get("/api/v1/diagnoses")).diagnoses.some(({ state }) => state === "running"),
  );
  await shows(tab, "A diagnosis has been running");
  await picture(tab, "running");
  const named = await mailOf("A likely cause was found");
  console.log(`  ${named.text.split("\n").find((line) => line.includes("named"))}`);
  await shows(tab, "proposed");
  await picture(tab, "proposed");
  const report = await tab.value(
    `[...document.querySelectorAll("a")].find((one) => one.href.endsWith("diagnosis.html")).href`,
  );
  await tab.open(report);
  check("the report opens", (await text(tab)).length > 1000);
  await picture(tab, "report");

  console.log("the model is changed by a click, and changed back");
  const { versions } = await get("/api/v1/model");
  const proposed = versions.find(({ status }) => status === "proposed").version;
  await tab.open(`${address}/model`);
  await click(tab, "Put ");
  await isInForce(tab, proposed.slice(0, 12));
  check("the daemon says so too", (await get("/api/v1/model")).active === proposed);
  await picture(tab, "in-force");
  await click(tab, "Go back by one version");
  await isInForce(tab, "drawings");
  check("the daemon says so too", (await get("/api/v1/model")).active === "drawings");
  await picture(tab, "reverted");
  await tab.open(`${address}/events`);
  await shows(tab, "mail to operator@example.org");
  check("its mails are told of", (await text(tab)).includes("alert was sent"));
  await tab.open(`${address}/data`);
  await picture(tab, "data");
  check(`the browser complains of nothing: ${tab.complaints}`, tab.complaints.length === 0);
}

let failed = false;
const browser = new Chromium(program);
try {
  mkdirSync(at("mail"));
  begin("sink", "/usr/bin/python3", options.sink, at("mail"));
  const [, mailPort] = await wait("the mail server", () => /mail (\d+) /.exec(read("sink.log")));
  writeFileSync(
    at("scenario.toml"),
    '[building]\nuse = "office"\n[[effect]]\nname = "weekend_operation"\n',
  );
  run(options.sim, "building", "--scenario", "scenario.toml", "--out", ".", "--years", "3", "--start", "2022", "--seed", "1");
  const clock = `${began}@${Math.floor(Date.now() / 1000)}x600`;
  writeMeters();
  begin("meters", options.sim, "meters", "meters.toml", "--clock", clock, "--faults", "meters.faults");
  await wait("the meters", () => read("meters.log").includes("ready:"));
  writeSite(mailPort);
  importPast();
  const daemon = begin("recald", options.recald, "run", "live.toml", "--clock", clock);
  const [, port] = await wait("the daemon", () => / port=(\d+)/.exec(read("recald.log")));
  const tab = await browser.openTab();
  await tab.prepare();
  await tab.resize(1200);
  await logIn(tab, browser);
  await operate(tab, `http://127.0.0.1:${port}`);
  daemon.kill("SIGTERM");
  check("the daemon ends in good order", (await daemon.ended) === 0);
} catch (error) {
  failed = true;
  console.log(`failed: ${error.stack}`);
  console.log(read("recald.log").split("\n").slice(-30).join("\n"));
  console.log(JSON.stringify(existsSync(at("mail")) ? mails() : [], null, 1));
} finally {
  for (const child of children) child.kill("SIGKILL");
  await Promise.all(children.map((child) => child.ended));
  await browser.close();
  rmSync(folder, { recursive: true, force: true });
}
process.exit(failed ? 1 : 0);
