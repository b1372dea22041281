// An operator at the pages of a fleet: what is urgent comes first, a filter finds the site whose job
// failed, a click lets the job run again.
//
//   node check_fleet.mjs ADDRESS
//
// ADDRESS serves the fleet of tests/daemon/fleet_in_browser_test.cpp. Exit 0 passed, 1 failed, 77 no
// Chromium here.
import { Chromium, findBrowser } from "./chromium.mjs";

const address = process.argv[2];
const program = findBrowser();
if (!program) {
  console.log("skipped: no chromium, chromium-browser or google-chrome on the PATH");
  process.exit(77);
}

function check(what, holds, seen) {
  if (!holds) throw new Error(`not so: ${what}; ${JSON.stringify(seen)}`);
}

/** Looks until it is so; a page that is just being replaced may have nothing. */
async function wait(tab, expression) {
  for (let i = 0; i < 200; i += 1) {
    try {
      if (await tab.value(expression)) return true;
    } catch {
      // between two pages
    }
    await new Promise((resume) => setTimeout(resume, 50));
  }
  return false;
}

const firstCells = `[...document.querySelectorAll("tbody tr td:first-child, tbody tr th")]
  .map((cell) => cell.textContent)`;
const text = "document.body.textContent";

const browser = new Chromium(program);
try {
  const tab = await browser.openTab();
  await tab.prepare();

  await tab.open(`${address}/`);
  const sites = await tab.value(`[...document.querySelectorAll('table a[href^="/sites/"]')]
    .map((link) => link.getAttribute("href"))`);
  check(
    "silent, then failed, then changed",
    sites.join() === "/sites/tower,/sites/south,/sites/north",
    sites,
  );
  const words = await tab.value(text);
  for (const part of ["3 sites: 1 silent", "1 with a job that failed", "1,234 USD a month",
    "Steam is 8 % above its forecast", "Hall <north>"]) {
    check(`the first page says "${part}"`, words.includes(part), words);
  }
  check("two of three sites are on the map", (await tab.value(
    `document.querySelectorAll("svg a circle").length`)) === 2);

  // Its results are a click away.
  await tab.value(`document.querySelector('table a[href="/sites/north"]').click()`);
  check("the site's page", await wait(tab, `location.pathname === "/sites/north" &&
    document.querySelector('a[href$="/calibration/report.html"]') !== null`), await tab.value(text));
  await tab.value(`document.querySelector('a[href$="/calibration/report.html"]').click()`);
  check("the report", await wait(tab, `document.title === "Calibration"`));

  // Those in trouble, and again.
  await tab.open(`${address}/rerun`);
  await tab.value(`document.querySelector('select[name="state"]').value = "trouble";
    document.querySelector("form.filter button").click()`);
  check("one job is listed", await wait(tab, `document.querySelector("button[data-post]")?.textContent ===
    "Run these 1 jobs again"`), await tab.value(text));
  check("why it failed", (await tab.value(text)).includes("there are 2 months, and 12 are needed"));
  await tab.value(`document.querySelector("button[data-post]").click()`);
  check("it runs again", await wait(tab,
    `${text}.includes("No job of these sites can run again")`), await tab.value(text));
  await tab.open(`${address}/audit`);
  check("the audit has it", (await tab.value(firstCells)).length > 0 &&
    (await tab.value(text)).includes("calibration of 2024-03"), await tab.value(text));

  check("nothing went wrong on the way", tab.complaints.length === 0, tab.complaints);
} finally {
  await browser.close();
}
