// Makes the charts of the daemon's pages zoomable, when the page is there already: each SVG that the
// daemon has drawn gives way to a chart of the same numbers. One that fails leaves its SVG.
//
// When all is drawn, the root element says so, as in the reports: data-ready, data-charts, data-errors.
import { use } from "echarts/core";
import { CustomChart, LineChart } from "echarts/charts";
import {
  AriaComponent,
  DataZoomComponent,
  GridComponent,
  TooltipComponent,
} from "echarts/components";
import { SVGRenderer } from "echarts/renderers";

import { drawZoomable } from "./zoomable_chart.js";

use([
  AriaComponent,
  CustomChart,
  DataZoomComponent,
  GridComponent,
  LineChart,
  SVGRenderer,
  TooltipComponent,
]);

const root = document.documentElement;
let charts = 0;
let errors = 0;

function replace(figure) {
  const data = JSON.parse(figure.querySelector("script").textContent);
  const plot = document.createElement("div");
  plot.className = "plot";
  plot.setAttribute("role", "img");
  plot.setAttribute("aria-label", data.title);
  const said = document.createElement("p");
  said.className = "muted";
  said.setAttribute("role", "status");
  said.textContent = "Zoom with the wheel, two fingers or the handles below; drag to move.";
  const drawn = figure.querySelector("svg");
  drawn.after(plot, said);
  drawn.style.display = "none";
  try {
    drawZoomable(plot, said, data);
    drawn.remove();
    charts += 1;
  } catch (error) {
    errors += 1;
    console.error(`chart ${data.title}`, error);
    plot.remove();
    said.remove();
    drawn.style.display = "";
  }
}

/** One by one, giving way in between. */
async function replaceAll() {
  for (const figure of document.querySelectorAll(".zoomable")) {
    replace(figure);
    await new Promise((resume) => setTimeout(resume));
  }
  root.dataset.charts = charts;
  root.dataset.errors = errors;
  root.dataset.ready = "true";
}

/** With a view box a drawing fits on paper as a picture does. */
window.addEventListener("beforeprint", () => {
  for (const svg of document.querySelectorAll(".plot svg")) {
    svg.setAttribute("viewBox", `0 0 ${svg.getAttribute("width")} ${svg.getAttribute("height")}`);
  }
});
window.addEventListener("afterprint", () => {
  for (const svg of document.querySelectorAll(".plot svg")) svg.removeAttribute("viewBox");
});
replaceAll();
