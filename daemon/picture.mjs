// Draws daemon/picture.png, the picture in the README, from the pages of a demo, in headless Chromium.
//
//   node daemon/picture.mjs .demo daemon/picture.png
//
// Above, the forecasts of a meter's months; below, the effect that the diagnosis names and how the gap shrinks.
import { writeFileSync } from "node:fs";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";

import { Chromium, findBrowser } from "../tests/pages/browser/chromium.mjs";

const [folder, picture] = process.argv.slice(2);
const scale = 1.3; // pixels of the picture for each of the pages
const whole = 930; // widths of the parts, in pixels of the pages
const half = 450;

const program = findBrowser();
if (!program) {
  console.error("daemon/picture.sh: install chromium first");
  process.exit(1);
}
const browser = new Chromium(program);

/** Waits until an expression is true in the page. */
async function until(tab, expression) {
  for (let tries = 0; tries < 200; ++tries) {
    if (await tab.value(expression)) return;
    await new Promise((done) => setTimeout(done, 50));
  }
  throw new Error(`never true: ${expression}`);
}

async function open(url, pageWidth, { pixels = 1, first } = {}) {
  const tab = await browser.openTab();
  await tab.prepare();
  if (first) await tab.send("Page.addScriptToEvaluateOnNewDocument", { source: first });
  await tab.send("Page.setBypassCSP", { enabled: true }); // the page allows no style but its own
  await tab.show("light");
  await tab.send("Emulation.setDeviceMetricsOverride", {
    width: pageWidth,
    height: 16000, // the whole page, for a cut does not scroll
    deviceScaleFactor: pixels,
    mobile: false,
  });
  await tab.open(url);
  return tab;
}

/** A page of the demo with all its figures drawn. */
async function openPage(name, pageWidth, first) {
  const tab = await open(pathToFileURL(resolve(folder, name)).href, pageWidth, { pixels: scale, first });
  await until(tab, `document.documentElement.dataset.ready === "true"`);
  return tab;
}

/** An element as it is drawn. */
async function cut(tab, element) {
  const clip = await tab.value(`(() => {
    const { left, top, width, height } = (${element}).getBoundingClientRect();
    return { x: left, y: Math.floor(top + scrollY), width, height: Math.ceil(height), scale: 1 };
  })()`);
  const { data } = await tab.send("Page.captureScreenshot", { format: "png", clip });
  return data;
}

/** The last two years of the last meter: one that was fitted, and one that the model had not seen. */
async function forecasts() {
  const shortened = `const parse = JSON.parse;
    JSON.parse = (text) => {
      const data = parse(text);
      for (const output of data.outputs ?? []) output.months = output.months.slice(-24);
      return data;
    };`;
  const tab = await openPage("report.html", whole + 64, shortened);
  const figure = `[...document.querySelectorAll("#fit figure")]
    .filter((one) => one.querySelector("[data-figure=months]")).at(-1)`;
  await tab.value(`(() => {
    const figure = ${figure};
    figure.querySelector("details").remove();
    figure.querySelector(".plot-window").style.background = "none"; // without its shadows
    figure.querySelector("figcaption").style.maxWidth = "none";
    const key = document.querySelector("#fit .key");
    [...key.children].slice(2).forEach((mark) => mark.remove());
    figure.querySelector("h3").after(key);
  })()`);
  return cut(tab, figure);
}

/** The first effect that was named: its words, and what it does to the meters. */
async function effect() {
  const tab = await openPage("diagnosis.html", half + 32);
  const card = `document.querySelector("#outcome .effects li")`;
  await tab.value(`(() => {
    const card = ${card};
    card.querySelectorAll(".side-by-side > div:last-child, p.muted").forEach((one) => one.remove());
    card.querySelector(".side-by-side").style.display = "block";
    for (let one = card.querySelector("table"); one !== card; one = one.parentElement) {
      one.style.cssText += "; width: 100%; max-width: none; background: none";
    }
  })()`);
  return cut(tab, card);
}

/** How far days scatter around the meters, before and after. */
async function gap() {
  const tab = await openPage("diagnosis.html", half + 32);
  await tab.value(`(() => {
    const figure = document.querySelector("#gap figure");
    figure.querySelector("details").remove();
    figure.querySelector(".plot-window").style.background = "none"; // without its shadows
    figure.querySelector("h3").after(document.querySelector("#step-key"));
  })()`);
  return cut(tab, `document.querySelector("#gap figure")`);
}

/** The parts on one sheet. */
async function draw() {
  const image = (data) => `<img src="data:image/png;base64,${data}">`;
  const [above, left, right] = [await forecasts(), await effect(), await gap()];
  const sheet = `<main>${image(above)}<div>${image(left)}${image(right)}</div></main>`;
  const tab = await open("about:blank", Math.round(scale * (whole + 40)));
  await tab.value(`(() => {
    document.body.innerHTML = ${JSON.stringify(sheet)};
    document.body.style.margin = 0;
    document.querySelector("main").style.cssText = "padding: 26px; background: #fff";
    document.querySelector("div").style.cssText =
      "display: flex; justify-content: space-between; align-items: flex-start; margin-top: 32px";
    return Promise.all([...document.images].map((one) => one.decode())).then(() => true);
  })()`);
  writeFileSync(picture, Buffer.from(await cut(tab, `document.querySelector("main")`), "base64"));
}

try {
  await draw();
} finally {
  await browser.close();
}
