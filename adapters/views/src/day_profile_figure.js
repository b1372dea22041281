// A meter's usual day: the mean of each hour by kind of day, over the load that is always there.
import { mount } from "./echarts.js";
import { numberText } from "./format.js";
import { hourAxis, hours } from "./hour_axis.js";
import { axisLabel, axisName, meterLook, mutedInk, tooltip, valueAxis } from "./theme.js";

function tooltipText({ kinds, base, unit }, hour) {
  const lines = kinds.map(({ label, load }) => `${label} ${numberText(load[hour])} ${unit}`);
  if (base !== null) lines.push(`Base load ${numberText(base)} ${unit}`);
  return [`${hour}:00 to ${hour + 1}:00`, ...lines].join("\n");
}

export function drawDayProfile(place, data) {
  const shape = data.shapes[place.dataset.index];
  const series = shape.kinds.map(({ load }, i) => ({
    type: "line",
    data: load,
    z: 3,
    ...meterLook(i),
    symbolSize: 6,
  }));
  if (shape.base !== null) {
    series.push({
      type: "line",
      data: hours.map(() => shape.base),
      showSymbol: false,
      z: 2,
      lineStyle: { color: mutedInk, width: 1.5, type: [2, 3] },
    });
  }
  mount(place, {
    grid: { left: 52, right: 10, top: 30, bottom: 44 },
    tooltip: {
      ...tooltip,
      trigger: "axis",
      axisPointer: { type: "line" },
      formatter: (items) => tooltipText(shape, items[0].dataIndex),
    },
    xAxis: hourAxis,
    yAxis: valueAxis({
      name: shape.unit,
      nameGap: 12,
      nameTextStyle: { ...axisName, align: "left", padding: [0, 0, 0, -40] },
      axisLabel: { ...axisLabel, formatter: numberText },
    }),
    series,
  });
}
