// Prior (dashed) against posterior (histogram) of one parameter (figures 2 and 3 of the seed).
import { mount } from "./echarts.js";
import { numberText } from "./format.js";
import { histogramSeries, summarySeries } from "./shapes.js";
import { axisLabel, axisName, missingLine, mutedInk, tooltip, valueAxis } from "./theme.js";

export function drawParameter(place, data) {
  const parameter = data.parameters[place.dataset.index];
  const min = parameter.prior[0][0]; // the ends of the prior bound the axis
  const max = parameter.prior[parameter.prior.length - 1][0];
  const bins = { start: parameter.binStart, width: parameter.binWidth, heights: parameter.density };
  const margin = 0.02 * (max - min);
  mount(place, {
    grid: { left: 16, right: 16, top: 26, bottom: 48 },
    tooltip: {
      ...tooltip,
      trigger: "item",
      formatter: ({ value: [from, to] }) =>
        `Posterior draws from\n${numberText(from)} to ${numberText(to)}`,
    },
    xAxis: valueAxis({
      min: min - margin,
      max: max + margin,
      splitLine: { show: false },
      axisLine: { show: true, onZero: false, lineStyle: { color: missingLine } },
      axisTick: { show: true },
      // The ends stand a margin outside the prior, at numbers that mean nothing.
      axisLabel: {
        ...axisLabel,
        showMinLabel: false,
        showMaxLabel: false,
        hideOverlap: true,
        formatter: numberText,
      },
      name: parameter.unit,
      nameLocation: "middle",
      nameGap: 27,
      nameTextStyle: axisName,
    }),
    yAxis: { type: "value", show: false },
    series: [
      histogramSeries(bins, { z: 2 }),
      {
        type: "line",
        data: parameter.prior,
        symbol: "none",
        silent: true,
        z: 3,
        lineStyle: { type: [6, 4], width: 2, color: mutedInk },
      },
      summarySeries(parameter),
    ],
  });
}
