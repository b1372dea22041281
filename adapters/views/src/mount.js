// How a figure is put on a page. Which parts of Apache ECharts there are is the bundle's business.
import { init } from "echarts/core";

/** A window that scrolls sideways has to be reached without a mouse. */
function makeReachable(plotWindow) {
  if (plotWindow.scrollWidth > plotWindow.clientWidth) plotWindow.tabIndex = 0;
  else plotWindow.removeAttribute("tabindex");
}

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
    // Nothing changes its colour under the pointer: a lighter shade of a variable is not known.
    series: option.series.map((series) => ({ emphasis: { disabled: true }, ...series })),
  });
  new ResizeObserver(() => {
    const { clientWidth: width, clientHeight: height } = place;
    if (width > 0) chart.resize({ width, height });
    makeReachable(place.parentElement);
  }).observe(place);
  return chart;
}
