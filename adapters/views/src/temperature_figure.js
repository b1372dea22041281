// A meter's days against the outdoor temperature, with the regression that forecasts them.
import { mount } from "./echarts.js";
import { numberText } from "./format.js";
import { axisLabel, axisName, ink, meterLook, missingLine, tooltip, valueAxis } from "./theme.js";

const temperatureText = (value, unit) => `${value.toFixed(1)} ${unit}`.replace("-", "−");

/** Fitted days are full, those that the regression has not seen are hollow. */
function dayStyle(kind, unseen) {
  const { symbol, itemStyle } = meterLook(kind);
  return {
    symbol,
    symbolSize: 6,
    itemStyle: unseen
      ? { color: "transparent", borderColor: itemStyle.color, borderWidth: 1.2, opacity: 1 }
      : { color: itemStyle.color, opacity: 0.55 },
  };
}

export function drawTemperature(place, data) {
  const { days, lines, energyUnit, dailyUnit, outdoorUnit } =
    data.temperatures[place.dataset.index];
  const scatter = [false, true].flatMap((unseen) =>
    [0, 1, 2].map((kind) => ({
      type: "scatter",
      z: 2,
      data: days
        .filter((day) => day.kind === kind && day.unseen === unseen)
        .map(({ outdoor, energy, date }) => [outdoor, energy, date]),
      ...dayStyle(kind, unseen),
    })),
  );
  mount(place, {
    grid: { left: 64, right: 14, top: 34, bottom: 48 },
    tooltip: {
      ...tooltip,
      trigger: "item",
      formatter: ({ value: [outdoor, energy, date] }) =>
        `${date ?? "Regression"}\n${temperatureText(outdoor, outdoorUnit)}, ${numberText(energy)} ${energyUnit}`,
    },
    xAxis: valueAxis({
      scale: true,
      splitLine: { show: false },
      axisLine: { show: true, onZero: false, lineStyle: { color: missingLine } },
      axisTick: { show: true },
      axisLabel: {
        ...axisLabel,
        hideOverlap: true,
        formatter: (value) => `${value}`.replace("-", "−"),
      },
      name: `mean outdoor temperature of the day, ${outdoorUnit}`,
      nameLocation: "middle",
      nameGap: 28,
      nameTextStyle: axisName,
    }),
    yAxis: valueAxis({
      axisLine: { show: false, onZero: false },
      name: dailyUnit,
      nameGap: 14,
      nameTextStyle: { ...axisName, align: "left", padding: [0, 0, 0, -56] },
      axisLabel: { ...axisLabel, formatter: numberText },
    }),
    series: [
      ...scatter.filter((series) => series.data.length > 0),
      ...lines.map(({ kind, points }) => ({
        type: "line",
        data: points,
        showSymbol: false,
        z: 4,
        lineStyle: { color: ink, width: 2.4, type: meterLook(kind).lineStyle.type },
      })),
    ],
  });
}
