// Probability of each explanation as bars; "no effect" and "something else" stand among them.
import { mount } from "./echarts.js";
import { percentText, plainText } from "./format.js";
import { axisLabel, axisName, candidateLooks, ink, tooltip, valueAxis } from "./theme.js";

const barsMax = 12;
const barHeight = 26;

/** The ends, which no data reach, are said as what they are: bounds. */
function probabilityText(probability) {
  if (probability > 0.999) return ">99.9 %";
  return probability < 0.001 ? "<0.1 %" : percentText(probability);
}

/** The likeliest ones, and always none and unknown, whatever their place. */
function shownOf(candidates) {
  return candidates.filter(({ kind }, i) => i < barsMax || kind !== "effect");
}

export function drawCandidates(place, data) {
  const shown = shownOf(data.candidates);
  place.style.height = `${shown.length * barHeight + 60}px`;
  mount(place, {
    grid: { left: 8, right: 56, top: 8, bottom: 44, containLabel: true },
    tooltip: {
      ...tooltip,
      trigger: "item",
      formatter: ({ dataIndex }) =>
        `${plainText(shown[dataIndex].label)}\n${probabilityText(shown[dataIndex].probability)}`,
    },
    xAxis: valueAxis({
      min: 0,
      max: 1,
      axisLabel: { ...axisLabel, hideOverlap: true, formatter: (share) => percentText(share, 0) },
      name: "probability",
      nameLocation: "middle",
      nameGap: 26,
      nameTextStyle: axisName,
    }),
    yAxis: {
      type: "category",
      inverse: true,
      data: shown.map(({ label }) => plainText(label)),
      axisTick: { show: false },
      axisLine: { show: false },
      axisLabel: { ...axisLabel, color: ink, interval: 0, width: 260, overflow: "break" },
    },
    series: [
      {
        type: "bar",
        barWidth: "62%",
        data: shown.map(({ probability, kind }) => ({
          value: probability,
          itemStyle: candidateLooks[kind],
        })),
        label: {
          show: true,
          position: "right",
          color: ink,
          fontSize: 12,
          formatter: ({ value }) => probabilityText(value),
        },
      },
    ],
  });
}
