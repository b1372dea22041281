// Measured monthly peaks. A month with gaps has a hollow triangle: its true peak may be higher.
import { mount } from "./echarts.js";
import { monthText, numberText, plainText } from "./format.js";
import { monthAxis } from "./month_axis.js";
import { axisLabel, axisName, ink, modelLine, page, rule, tooltip, valueAxis } from "./theme.js";

function tooltipText(month, unit) {
  const lines = [`${monthText(month.month)}: ${numberText(month.peak)} ${unit}`];
  if (month.start) lines.push(plainText(month.start));
  if (month.exceedable) lines.push("The true peak may be higher");
  return lines.join("\n");
}

export function drawPeaks(place, data) {
  const { months, unit } = data.peaks[place.dataset.index];
  place.style.minWidth = `${months.length * 11 + 70}px`;
  const only = (accepts) => months.map((month) => (accepts(month) ? month.peak : null));
  mount(place, {
    grid: { left: 52, right: 10, top: 30, bottom: 44 },
    tooltip: {
      ...tooltip,
      trigger: "axis",
      axisPointer: { type: "none" },
      formatter: (items) => tooltipText(months[items[0].dataIndex], unit),
    },
    xAxis: monthAxis(
      months.map(({ month }) => month),
      { initials: true },
    ),
    yAxis: valueAxis({
      name: unit,
      nameGap: 12,
      nameTextStyle: { ...axisName, align: "left", padding: [0, 0, 0, -40] },
      axisLabel: { ...axisLabel, formatter: numberText },
    }),
    series: [
      {
        type: "bar",
        barWidth: 2,
        silent: true,
        itemStyle: { color: rule },
        data: only(() => true),
      },
      {
        type: "scatter",
        symbol: "circle",
        symbolSize: 8,
        itemStyle: { color: modelLine, opacity: 1 },
        data: only((month) => !month.exceedable),
      },
      {
        type: "scatter",
        symbol: "triangle",
        symbolSize: 10,
        itemStyle: { color: page, borderColor: ink, borderWidth: 1.5, opacity: 1 },
        data: only((month) => month.exceedable),
      },
    ],
  });
}
