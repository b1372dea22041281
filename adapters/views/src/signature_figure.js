// The gap before an addition against what the model changed: by part of the week above, by outdoor
// temperature below.
import { mount } from "./echarts.js";
import { percentText } from "./format.js";
import {
  axisLabel,
  axisName,
  ink,
  modelFill,
  modelLine,
  mutedInk,
  rule,
  tooltip,
  valueAxis,
} from "./theme.js";
import { dayName, hoursText, partAt, partsOfDay, partsOfWeek } from "./week.js";

const signed = (share) =>
  share === null ? "–" : `${share > 0 ? "+" : ""}${percentText(share)}`.replace("-", "−");

/** One scale for all meters of an effect, so that a meter which it does not touch looks flat. */
function spanOf(signatures, effect) {
  const values = signatures
    .filter((signature) => signature.effect === effect)
    .flatMap(({ residual, change, alone }) => [residual, change, alone])
    .flatMap(({ week, temperature }) => [...week, ...temperature])
    .filter(Number.isFinite);
  const low = Math.min(0, ...values);
  const high = Math.max(0, ...values);
  const step = [0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5].find((s) => (high - low) / s <= 4) ?? 1;
  return {
    min: Math.floor(low / step) * step,
    max: Math.max(Math.ceil(high / step), 1) * step,
    interval: step,
  };
}

function seriesOf({ residual, change, alone }, axes) {
  const line = (data, lineStyle) => ({
    type: "line",
    data,
    symbol: "none",
    lineStyle,
    z: 4,
    ...axes,
  });
  return [
    {
      type: "bar",
      data: residual,
      barCategoryGap: "12%",
      itemStyle: { color: modelFill, borderColor: modelLine, borderWidth: 0.6 },
      ...axes,
    },
    line(alone, { color: mutedInk, width: 2, type: [5, 4] }),
    line(change, { color: ink, width: 2.2 }),
  ];
}

export function drawSignature(place, data) {
  const signature = data.signatures[place.dataset.index];
  const limits = data.temperatureLimits;
  const span = spanOf(data.signatures, signature.effect);
  const rows = Array.from({ length: partsOfWeek }, (_, row) => row);
  const byWeek = (values) => rows.map((row) => values.week[partAt(row)]);
  const panels = [
    {
      labels: rows,
      name: "",
      what: (i) => `${dayName(i)} ${hoursText(partAt(i))}`,
      axisLabel: {
        interval: (row) => row % partsOfDay === 3,
        formatter: (row) => dayName(Number(row)),
      },
      residual: byWeek(signature.residual),
      change: byWeek(signature.change),
      alone: byWeek(signature.alone),
    },
    {
      labels: limits.slice(0, -1),
      name: `outdoor temperature, ${data.temperatureUnit} and above`,
      what: (i) => `${limits[i]} to ${limits[i + 1]} ${data.temperatureUnit}`.replaceAll("-", "−"),
      axisLabel: { hideOverlap: true, formatter: (low) => `${low}…`.replace("-", "−") },
      residual: signature.residual.temperature,
      change: signature.change.temperature,
      alone: signature.alone.temperature,
    },
  ];
  mount(place, {
    grid: [
      { left: 52, right: 10, top: 14, height: "36%" },
      { left: 52, right: 10, bottom: 46, height: "32%" },
    ],
    tooltip: {
      ...tooltip,
      trigger: "axis",
      axisPointer: { type: "shadow", shadowStyle: { color: "rgba(85,96,110,.12)" } },
      formatter([{ axisIndex, dataIndex }]) {
        const panel = panels[axisIndex];
        return [
          panel.what(dataIndex),
          `Gap before ${signed(panel.residual[dataIndex])}`,
          `Model changed ${signed(panel.change[dataIndex])}`,
          `Effect alone ${signed(panel.alone[dataIndex])}`,
        ].join("\n");
      },
    },
    xAxis: panels.map(({ labels, name, axisLabel: more }, gridIndex) => ({
      type: "category",
      gridIndex,
      data: labels,
      axisTick: { show: false },
      axisLine: { lineStyle: { color: rule }, onZero: false },
      axisLabel: { ...axisLabel, ...more },
      name,
      nameLocation: "middle",
      nameGap: 27,
      nameTextStyle: axisName,
    })),
    yAxis: panels.map((_, gridIndex) =>
      valueAxis({
        gridIndex,
        ...span,
        axisLabel: {
          ...axisLabel,
          formatter: (share) => percentText(share, span.interval < 0.01 ? 1 : 0).replace("-", "−"),
        },
      }),
    ),
    series: panels.flatMap((panel, i) => seriesOf(panel, { xAxisIndex: i, yAxisIndex: i })),
  });
}
