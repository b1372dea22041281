// Opens pages in headless Chromium and looks for what a reader would trip over.
//
//   node check_pages.mjs --modules NODE_MODULES [--pictures FOLDER] PAGE…
//
// A page is a file, PAGE.html, or an address, http://….
//
// At 390, 768 and 1440 pixels, light, dark at the narrowest and the widest, and on paper, which is
// as wide as 768: axe-core's rules; at each width that nothing makes the whole page scroll sideways
// and that no label in a figure is cut or lies over another; at the widest that every table fits.
// Then the page is printed before its figures are drawn, and has to have them all the same. Exit 0
// passed, 1 failed, 77 no Chromium here.
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { basename, join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { parseArgs } from "node:util";

import { Chromium, findBrowser } from "./chromium.mjs";
import { cutLabels, keepFirstRows, overlappingLabels, wideTables } from "./in_page.mjs";

const looksAt = new Map([
  [390, ["light", "dark"]],
  [768, ["light", "print"]],
  [1440, ["light", "dark"]],
]);

const { values: options, positionals: pages } = parseArgs({
  options: { modules: { type: "string" }, pictures: { type: "string" } },
  allowPositionals: true,
});

const program = findBrowser();
if (!program) {
  console.log("skipped: no chromium, chromium-browser or google-chrome on the PATH");
  process.exit(77);
}

const axe = readFileSync(join(options.modules, "axe-core", "axe.min.js"), "utf8");
let failures = 0;
function complain(page, what) {
  failures += 1;
  console.log(`failed: ${page}: ${what}`);
}

const isReady = `new Promise((resume) => {
  const look = () =>
    document.querySelector("[data-figure], .zoomable") === null ||
    document.documentElement.dataset.ready === "true"
      ? resume(true)
      : setTimeout(look, 5);
  look();
})`;

async function picture(tab, name) {
  if (!options.pictures) return;
  mkdirSync(options.pictures, { recursive: true });
  const { data } = await tab.send("Page.captureScreenshot", { captureBeyondViewport: true });
  writeFileSync(join(options.pictures, `${name}.png`), Buffer.from(data, "base64"));
}

async function checkRules(tab, page, where) {
  const violations = await tab.value(
    `axe.run(document, { resultTypes: ["violations"] }).then(({ violations }) =>
      violations.map(({ id, help, nodes }) => ({ id, help, nodes: nodes.length,
        first: nodes[0].target.join(" "), why: nodes[0].failureSummary })))`,
  );
  for (const { id, help, nodes, first, why } of violations) {
    complain(page, `${where}: ${id}: ${help}; ${nodes} times, first ${first}\n${why}`);
  }
}

async function checkLayout(tab, page, width) {
  const wide = await tab.value("document.documentElement.scrollWidth - window.innerWidth");
  if (wide > 0) complain(page, `${width} px: the page is ${wide} px wider than the window`);
  const finders = [cutLabels, overlappingLabels, ...(width === 1440 ? [wideTables] : [])];
  for (const find of finders) {
    for (const fault of await tab.value(`(${find})()`)) complain(page, `${width} px: ${fault}`);
  }
}

const addressOf = (page) => (page.startsWith("http:") ? page : pathToFileURL(resolve(page)).href);
const nameOf = (page) => (page.startsWith("http:") ? page : basename(page, ".html"));

async function checkPage(tab, file) {
  const page = nameOf(file);
  const url = addressOf(file);
  for (const [width, looks] of looksAt) {
    await tab.resize(width);
    await tab.show("light");
    await tab.open(url);
    await tab.value(isReady);
    await checkLayout(tab, page, width);
    await tab.value(`(${keepFirstRows})()`);
    await tab.value(axe);
    for (const look of looks) {
      await tab.show(look);
      await checkRules(tab, page, `${width} px, ${look}`);
      await picture(tab, `${page}-${width}-${look}`);
    }
  }
  for (const complaint of tab.complaints.splice(0)) complain(page, complaint);
}

/** Time stands still, so that nothing is drawn but what printing itself draws. */
async function checkPrintingAtOnce(tab, file) {
  const page = nameOf(file);
  const { identifier } = await tab.send("Page.addScriptToEvaluateOnNewDocument", {
    source: "window.setTimeout = () => 0;",
  });
  await tab.show("light");
  await tab.open(addressOf(file));
  await tab.send("Page.printToPDF", { printBackground: true });
  const blank = await tab.value(
    `[...document.querySelectorAll("[data-figure]")].filter((place) => !place.querySelector("svg")).length`,
  );
  if (blank > 0) complain(page, `${blank} figures are blank when the page is printed at once`);
  await tab.send("Page.removeScriptToEvaluateOnNewDocument", { identifier });
  tab.complaints.splice(0);
}

const browser = new Chromium(program);
try {
  const tab = await browser.openTab();
  await tab.prepare();
  for (const file of pages) {
    await checkPage(tab, file);
    await checkPrintingAtOnce(tab, file);
  }
} finally {
  await browser.close();
}
console.log(`${pages.length} pages, ${failures} faults`);
process.exit(failures === 0 ? 0 : 1);
