// Zooms into the charts of a running daemon's pages in headless Chromium.
//
//   node check_charts.mjs --modules NODE_MODULES http://127.0.0.1:PORT
//
// The daemon serves a site in Chicago with a meter "main", whose last week is summed up to hours,
// and with forecasts. The browser is in Tokyo, so that its own time would show. PICTURES=DIR keeps
// screenshots there. Exit 0 passed, 1 failed, 77 no Chromium here.
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { parseArgs } from "node:util";

import { Chromium, findBrowser } from "./chromium.mjs";
import { cutLabels, overlappingLabels } from "./in_page.mjs";

const { values: options, positionals } = parseArgs({
  options: { modules: { type: "string" } },
  allowPositionals: true,
});
const [daemon] = positionals;
const pictures = process.env.PICTURES;

const program = findBrowser();
if (!program) {
  console.log("skipped: no chromium, chromium-browser or google-chrome on the PATH");
  process.exit(77);
}
const axe = readFileSync(join(options.modules, "axe-core", "axe.min.js"), "utf8");

let failures = 0;
function expect(holds, what, seen) {
  if (holds) return;
  failures += 1;
  console.log(`failed: ${what}${seen === undefined ? "" : `; seen: ${JSON.stringify(seen)}`}`);
}

const isReady = `document.documentElement.dataset.ready === "true"`;
/** The axis below the first chart: its labels that are no bare numbers. */
const timeLabels = `[...document.querySelector(".plot svg").querySelectorAll("text")]
  .map((text) => text.textContent).filter((text) => /[A-Z]|:/.test(text) && !/kW|ton|MBH/.test(text))`;
const status = `document.querySelector("[role=status]").textContent`;
const asked = `performance.getEntriesByType("resource").map((one) => one.name)`;

/** All text of the drawing, of which the tooltip is a part. */
const tip = `[...document.querySelectorAll(".plot svg text")].map((one) => one.textContent).join(" ")`;

/** Looks every 20 ms until it holds, for 20 s at most. */
async function eventually(tab, expression) {
  for (let looks = 0; looks < 1000; looks += 1) {
    if (await tab.value(expression)) return true;
    await new Promise((resume) => setTimeout(resume, 20));
  }
  return false;
}

async function open(tab, path, width) {
  await tab.resize(width);
  await tab.open(daemon + path);
  expect(await eventually(tab, isReady), `${path} at ${width} px: charts are not drawn in time`);
  const drawn = await tab.value(`({ ...document.documentElement.dataset,
    still: document.querySelectorAll("svg.chart").length })`);
  expect(drawn.charts === "1" || drawn.charts === "2", `${path}: charts`, drawn);
  expect(drawn.errors === "0" && drawn.still === 0, `${path}: every chart gives way`, drawn);
  await tab.value(`document.querySelector(".plot").scrollIntoView({ block: "center" })`);
}

async function middle(tab) {
  const box = await tab.value(
    `(({ left, top, width, height }) => ({ left, top, width, height }))(
      document.querySelector(".plot").getBoundingClientRect())`,
  );
  return { x: box.left + box.width / 2, y: box.top + 0.4 * box.height, box };
}

const mouse = (tab, type, x, y, more = {}) =>
  tab.send("Input.dispatchMouseEvent", { type, x, y, ...more });

async function turnWheel(tab, times) {
  const { x, y } = await middle(tab);
  await mouse(tab, "mouseMoved", x, y);
  for (let turn = 0; turn < times; turn += 1) {
    await mouse(tab, "mouseWheel", x, y, { deltaX: 0, deltaY: -120 });
    await tab.value("new Promise((resume) => requestAnimationFrame(() => resume(true)))");
  }
}

async function pullLeftHandle(tab) {
  const { box } = await middle(tab);
  const y = box.top + box.height - 18;
  const left = box.left + 64; // By margin.left of zoomable_chart.js; a handle is some pixels wide.
  await mouse(tab, "mouseMoved", left, y);
  await mouse(tab, "mousePressed", left, y, { button: "left", buttons: 1, clickCount: 1 });
  for (const share of [1 / 8, 1 / 4]) {
    await mouse(tab, "mouseMoved", left + box.width * share, y, { button: "left", buttons: 1 });
  }
  await mouse(tab, "mouseReleased", left + box.width / 4, y, { button: "left", clickCount: 1 });
}

/** Once the tooltip, which lies over everything, has gone. */
async function checkLooks(tab, where) {
  await mouse(tab, "mouseMoved", 0, 0);
  expect(await eventually(tab, `!${tip}.includes(" to ")`), `${where}: the tooltip goes`);
  const wide = await tab.value("document.documentElement.scrollWidth - window.innerWidth");
  expect(wide <= 0, `${where}: the page is wider than the window`, wide);
  for (const find of [cutLabels, overlappingLabels]) {
    const faults = await tab.value(`(${find})()`);
    expect(faults.length === 0, where, faults);
  }
  await tab.value(axe);
  for (const look of ["light", "dark"]) {
    await tab.show(look);
    const violations = await tab.value(
      `axe.run(document, { resultTypes: ["violations"] }).then(({ violations }) =>
        violations.map(({ id, nodes }) => [id, nodes[0].failureSummary]))`,
    );
    expect(violations.length === 0, `${where}, ${look}`, violations);
    if (!pictures) continue;
    mkdirSync(pictures, { recursive: true });
    const { data } = await tab.send("Page.captureScreenshot", {});
    const name = `${where.replace(/\W+/g, "-")}-${look}.png`;
    writeFileSync(join(pictures, name), Buffer.from(data, "base64"));
  }
  await tab.show("light");
}

async function checkMeter(tab, width) {
  const where = `meter at ${width} px`;
  await open(tab, "/meters/main", width);
  const before = await tab.value(timeLabels);
  expect(before.length >= 2, `${where}: labels of the time axis`, before);
  await turnWheel(tab, 9);
  expect(
    await eventually(tab, `JSON.stringify(${timeLabels}) !== '${JSON.stringify(before)}'`),
    `${where}: the wheel changes the axis`,
    before,
  );
  expect(await eventually(tab, `${status}.startsWith("Finer values from 20")`), `${where}: finer`);
  const words = await tab.value(status);
  expect(/−0[56]:00\.$/.test(words), `${where}: times are Chicago's`, words);
  const requests = await tab.value(asked);
  const history = requests.filter((one) => one.includes("/api/v1/history?meter=main&from=20"));
  expect(history.length > 0, `${where}: asks for the history`, requests);
  expect(
    requests.every((one) => one.startsWith(daemon)),
    `${where}: asks nobody else`,
    requests,
  );
  // A point is a quarter of an hour now.
  const { x, y } = await middle(tab);
  await mouse(tab, "mouseMoved", x + 3, y);
  const quarter = String.raw`/20\d\d-\d\d-\d\d \d\d:(00 to ..:15|15 to ..:30|30 to ..:45|45 to ..:00) −0[56]:00.* Mean [\d.]+ tons/`;
  expect(await eventually(tab, `${quarter}.test(${tip})`), `${where}: tooltip`, await tab.value(tip));
  await checkLooks(tab, `${where}, zoomed`);
}

async function checkSlider(tab) {
  await open(tab, "/meters/main", 1440);
  const before = await tab.value(timeLabels);
  await pullLeftHandle(tab);
  expect(
    await eventually(tab, `JSON.stringify(${timeLabels}) !== '${JSON.stringify(before)}'`),
    "the slider changes the axis",
    before,
  );
  await checkLooks(tab, "meter, slider");
}

async function checkMonths(tab, width) {
  const where = `months at ${width} px`;
  await open(tab, "/months", width);
  const before = await tab.value(timeLabels);
  await turnWheel(tab, 4);
  expect(
    await eventually(tab, `JSON.stringify(${timeLabels}) !== '${JSON.stringify(before)}'`),
    `${where}: the wheel changes the axis`,
    before,
  );
  await checkLooks(tab, where);
}

const stillStands = `document.querySelector("svg.chart").getBoundingClientRect().height > 100 &&
  document.querySelector(".plot") === null`;

/** What a reader has before the script comes, or when it never does. */
async function checkWithoutScript(tab) {
  await tab.send("Network.enable");
  await tab.send("Network.setBlockedURLs", { urls: ["*/charts.js"] });
  await tab.open(`${daemon}/meters/main`);
  expect(await tab.value(stillStands), "the chart is an SVG without the script");
  await tab.send("Network.setBlockedURLs", { urls: [] });
  tab.complaints.splice(0); // that it was blocked
}

/** A browser that lacks something: the drawing is begun and cannot be ended. */
async function checkFailure(tab) {
  await tab.send("Page.addScriptToEvaluateOnNewDocument", {
    source: "delete window.ResizeObserver;",
  });
  await tab.open(`${daemon}/meters/main`);
  expect(await eventually(tab, isReady), "a chart that fails ends");
  expect(await tab.value("document.documentElement.dataset.errors === '1'"), "and is counted");
  expect(await tab.value(stillStands), "a chart that fails leaves its SVG");
}

const browser = new Chromium(program);
try {
  const tab = await browser.openTab();
  await tab.prepare();
  await tab.send("Emulation.setTimezoneOverride", { timezoneId: "Asia/Tokyo" });
  await tab.send("Emulation.setLocaleOverride", { locale: "en" });
  for (const width of [1440, 390]) {
    await checkMeter(tab, width);
    await checkMonths(tab, width);
  }
  await checkSlider(tab);
  await tab.open(`${daemon}/`);
  const first = await tab.value(asked);
  expect(!first.some((one) => one.endsWith("charts.js")), "the first page has still charts", first);
  expect(tab.complaints.length === 0, "complaints in the console", tab.complaints.splice(0));
  await checkWithoutScript(tab);
  await checkFailure(tab);
} finally {
  await browser.close();
}
console.log(`${failures} faults`);
process.exit(failures === 0 ? 0 : 1);
