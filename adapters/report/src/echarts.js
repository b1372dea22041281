// The parts of Apache ECharts that the figures use, and how a figure is put on the page.
import { init, use } from "echarts/core";
import { BarChart, BoxplotChart, CustomChart, LineChart, ScatterChart } from "echarts/charts";
import {
  AriaComponent,
  GraphicComponent,
  GridComponent,
  TooltipComponent,
} from "echarts/components";
import { SVGRenderer } from "echarts/renderers";

use([
  AriaComponent,
  BarChart,
  BoxplotChart,
  CustomChart,
  GraphicComponent,
  GridComponent,
  LineChart,
  ScatterChart,
  SVGRenderer,
  TooltipComponent,
]);

/**
 * Draws `option` into `place`, as SVG for sharp print, and keeps it fitted to the window.
 * A place that is out of sight has no size yet; it gets a usual one until it is shown.
 */
export function mount(place, option) {
  const size =
    place.clientWidth > 0 ? {} : { width: 1100, height: parseInt(place.style.height) || 380 };
  const chart = init(place, null, { renderer: "svg", ...size });
  chart.setOption({
    animation: false, // A report does not move; this also serves prefers-reduced-motion.
    textStyle: { fontFamily: getComputedStyle(document.body).fontFamily },
    aria: { enabled: true, label: { description: place.getAttribute("aria-label") } },
    ...option,
  });
  new ResizeObserver(() => {
    const { clientWidth: width, clientHeight: height } = place;
    if (width > 0) chart.resize({ width, height });
  }).observe(place);
  return chart;
}
