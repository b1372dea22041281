// Draws the report's figures into the places that the page marks with data-figure.
//
// The page is complete without this script: words and tables are HTML. When all is drawn, the root
// element says so: data-ready, data-charts (drawn) and data-errors (figures that failed).
import { drawCandidates } from "./candidates_figure.js";
import { drawCvrmse } from "./cvrmse_figure.js";
import { addDownloads } from "./csv.js";
import { drawBelieved, drawForecast } from "./forecast_figure.js";
import { drawDayProfile } from "./day_profile_figure.js";
import { drawLoad } from "./load_figure.js";
import { drawMonths } from "./months_figure.js";
import { drawOverview } from "./overview_figure.js";
import { drawParameter } from "./parameter_figure.js";
import { drawPeaks } from "./peaks_figure.js";
import { drawProfile, writeProfileKey } from "./profile_figure.js";
import { drawTemperatureMap, drawWeekMap } from "./residual_map_figure.js";
import { drawSignature } from "./signature_figure.js";
import { drawSteps, writeStepKey } from "./steps_figure.js";
import { drawTemperature } from "./temperature_figure.js";

const drawings = {
  believed: drawBelieved,
  candidates: drawCandidates,
  cvrmse: drawCvrmse,
  dayprofile: drawDayProfile,
  forecast: drawForecast,
  load: drawLoad,
  months: drawMonths,
  overview: drawOverview,
  parameter: drawParameter,
  peaks: drawPeaks,
  profile: drawProfile,
  signature: drawSignature,
  steps: drawSteps,
  temperature: drawTemperature,
  temperaturemap: drawTemperatureMap,
  weekmap: drawWeekMap,
};

const root = document.documentElement;
const data = JSON.parse(document.getElementById("report-data").textContent);
let charts = 0;
let errors = 0;

/** A figure that fails leaves the others, and its own table, in peace. */
function draw(place) {
  try {
    drawings[place.dataset.figure](place, data);
    charts += 1;
  } catch (error) {
    errors += 1;
    console.error(`figure ${place.dataset.figure} ${place.dataset.index}`, error);
    place.classList.add("failed");
    place.textContent = "This figure could not be drawn. Its data are in the table below.";
  }
}

const undrawn = [...document.querySelectorAll("[data-figure]")];

/** Figure by figure, giving way in between, so that the words can be read at once. */
async function drawAll() {
  while (undrawn.length > 0) {
    draw(undrawn.shift());
    await new Promise((resume) => setTimeout(resume));
  }
  root.dataset.charts = charts;
  root.dataset.errors = errors;
  root.dataset.ready = "true";
}

/** One meter's calendar at a time; the others stay drawn, out of sight. */
function showChosenLoad() {
  const select = document.getElementById("load-choice");
  for (const choice of document.querySelectorAll("[data-choice]")) {
    choice.hidden = select !== null && choice.dataset.choice !== select.value;
  }
}

/**
 * On paper each meter's calendar is there, and with a view box a drawing scales like a picture.
 * Who prints at once does not wait for the figures, so what is left is drawn here.
 */
function preparePrint() {
  for (const choice of document.querySelectorAll("[data-choice]")) choice.hidden = false;
  for (const more of document.querySelectorAll("details.more, .notices details")) more.open = true;
  while (undrawn.length > 0) draw(undrawn.shift());
  for (const svg of document.querySelectorAll(".plot svg")) {
    svg.setAttribute("viewBox", `0 0 ${svg.getAttribute("width")} ${svg.getAttribute("height")}`);
  }
}

function endPrint() {
  for (const svg of document.querySelectorAll(".plot svg")) svg.removeAttribute("viewBox");
  showChosenLoad();
}

root.classList.add("script");
for (const details of document.querySelectorAll("figure details.data")) details.open = false;
addDownloads(data);
writeProfileKey(data);
writeStepKey(data);
showChosenLoad();
document.getElementById("load-choice")?.addEventListener("change", showChosenLoad);
window.addEventListener("beforeprint", preparePrint);
window.addEventListener("afterprint", endPrint);
drawAll();
