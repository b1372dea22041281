// Electricity by hour of the day: the parts stacked, the measured mean as a line.
import { mount } from "./echarts.js";
import { numberText, plainText } from "./format.js";
import { hourAxis, hours } from "./hour_axis.js";
import { axisLabel, axisName, ink, page, part, parts, tooltip, valueAxis } from "./theme.js";

/** One scale for all day types, so that a Sunday looks as small as it is. */
function highest(dayTypes) {
  const sums = dayTypes.flatMap(({ parts, measured }) =>
    hours.map((hour) =>
      Math.max(
        measured[hour] ?? 0,
        parts.reduce((sum, { kW }) => sum + (kW[hour] ?? 0), 0),
      ),
    ),
  );
  const top = Math.max(...sums, 1e-9);
  const step = 10 ** Math.floor(Math.log10(top));
  return Math.ceil((top / step) * 2) * 0.5 * step;
}

function tooltipText(dayType, hour) {
  const lines = dayType.parts.map(
    ({ label, kW }) => `${plainText(label)} ${numberText(kW[hour])} kW`,
  );
  return [
    `${hour}:00 to ${hour + 1}:00`,
    ...lines.reverse(),
    `Measured ${numberText(dayType.measured[hour])} kW`,
  ].join("\n");
}

export function drawProfile(place, data) {
  const dayType = data.dayTypes[place.dataset.index];
  mount(place, {
    grid: { left: 48, right: 10, top: 30, bottom: 44 },
    tooltip: {
      ...tooltip,
      trigger: "axis",
      axisPointer: { type: "shadow", shadowStyle: { color: "rgba(85,96,110,.12)" } },
      formatter: (items) => tooltipText(dayType, items[0].dataIndex),
    },
    xAxis: hourAxis,
    yAxis: valueAxis({
      name: "kW",
      nameGap: 12,
      nameTextStyle: { ...axisName, align: "left", padding: [0, 0, 0, -36] },
      max: highest(data.dayTypes),
      axisLabel: { ...axisLabel, formatter: numberText },
    }),
    series: [
      ...dayType.parts.map(({ kW }, i) => ({
        type: "bar",
        stack: "parts",
        barCategoryGap: "6%",
        data: kW,
        itemStyle: {
          color: part(i).color,
          decal: part(i).decal,
          borderColor: page,
          borderWidth: 0.5,
        },
      })),
      {
        type: "line",
        data: dayType.measured,
        symbol: "circle",
        symbolSize: 5,
        lineStyle: { color: ink, width: 2 },
        itemStyle: { color: page, borderColor: ink, borderWidth: 1.5 },
        z: 5,
      },
    ],
  });
}

/** Whether a part is more than nothing at some hour; what is not there has no place in a key. */
const isThere = (dayTypes, i) =>
  dayTypes.some(({ parts }) => parts[i].kW.some((kW) => kW !== null && kW > 0));

/** Says which colour and pattern is which part; the parts' names are data, hence textContent. */
export function writeProfileKey(data) {
  const key = document.getElementById("profile-key");
  if (!key) return;
  const entry = (className, label) => {
    const span = document.createElement("span");
    const sign = document.createElement("i");
    sign.className = className;
    span.append(sign, label);
    key.append(span);
  };
  entry("sign line dotted", "measured mean");
  data.dayTypes[0].parts.forEach(({ label }, i) => {
    if (isThere(data.dayTypes, i)) entry(`sign part part-${i % parts.length}`, label);
  });
}
