// CV(RMSE) of each posterior draw, with the limit of Guideline 14; calibration above validation.
import { mount } from "./echarts.js";
import { histogramSeries, limitSeries } from "./shapes.js";
import { axisName, missingLine, tooltip, valueAxis } from "./theme.js";

const limitPercent = 15;

/** Percent axis over all bins and the limit, its ends on whole steps. */
function axisSpan(histograms) {
  const edges = histograms.flatMap(({ start, width, counts }) => [
    start,
    start + width * counts.length,
  ]);
  const low = 100 * Math.min(limitPercent / 100, ...edges);
  const high = 100 * Math.max(limitPercent / 100, ...edges);
  const interval = [1, 2, 5, 10, 20, 50, 100].find((step) => (high - low) / step <= 6) ?? 200;
  return {
    interval,
    min: Math.floor((low - 0.01) / interval) * interval,
    max: Math.ceil((high + 0.01) / interval) * interval,
  };
}

export function drawCvrmse(place, data) {
  const { cvrmse } = data.outputs[place.dataset.index];
  const panels = [
    ["Draws, calibration months", cvrmse.calibration],
    ["Draws, validation months", cvrmse.validation],
  ].filter(([, histogram]) => histogram.counts.length > 0);

  const span = axisSpan(panels.map(([, histogram]) => histogram));
  const height = 100 / panels.length;

  mount(place, {
    tooltip: {
      ...tooltip,
      trigger: "item",
      formatter: ({ value: [from, to, count] }) =>
        `${from.toFixed(1)} to ${to.toFixed(1)} %\n${count} draws`,
    },
    grid: panels.map((_, i) => ({
      left: 44,
      right: 16,
      top: `${i * height + (panels.length > 1 ? 11 : 12)}%`,
      height: panels.length > 1 ? "28%" : "62%",
    })),
    xAxis: panels.map((_, i) =>
      valueAxis({
        gridIndex: i,
        ...span,
        splitLine: { show: false },
        axisLine: { show: true, lineStyle: { color: missingLine } },
        axisTick: { show: true },
        name: i === panels.length - 1 ? "CV(RMSE), %" : "",
        nameLocation: "middle",
        nameGap: 26,
        nameTextStyle: axisName,
      }),
    ),
    yAxis: panels.map(([name], i) =>
      valueAxis({
        gridIndex: i,
        name,
        nameGap: 12,
        nameTextStyle: { ...axisName, align: "left", padding: [0, 0, 0, -34] },
        splitNumber: 2,
        minInterval: 1,
      }),
    ),
    series: panels.flatMap(([, { start, width, counts }], i) => {
      const axes = { xAxisIndex: i, yAxisIndex: i };
      const bins = { start: 100 * start, width: 100 * width, heights: counts };
      return [histogramSeries(bins, axes), limitSeries(limitPercent, "limit 15 %", axes)];
    }),
  });
}
