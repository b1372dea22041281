// Monthly box plots of the forecasts against the measured months (after figures 4 to 6 of the seed).
import { mount } from "./echarts.js";
import { monthText, numberText, percentText } from "./format.js";
import { monthAxis, monthSlotWidth } from "./month_axis.js";
import { bandSeries } from "./shapes.js";
import {
  different,
  ink,
  modelFill,
  modelLine,
  mutedInk,
  page,
  star,
  tooltip,
  valueAxis,
} from "./theme.js";

const usualRoleNames = { calibration: "Calibration", validation: "Validation", unused: "Not used" };

/** Stretches of months that serve one purpose. */
function runsOf(months, roleNames) {
  const runs = [];
  months.forEach(({ role }, i) => {
    const last = runs.at(-1);
    if (last?.role === role) last.last = i;
    else
      runs.push({
        role,
        first: i,
        last: i,
        label: roleNames[role],
        shaded: role !== "calibration",
      });
  });
  const nothingJudged = months.every(({ role }) => role === "unused");
  return nothingJudged ? [] : runs;
}

/** Zero where that leaves room to see anything; otherwise the axis says that it starts elsewhere. */
function verticalAxis(months, unit) {
  const values = months
    .flatMap(({ measured, forecast, box }) => [measured, ...(forecast ?? []), ...(box ?? [])])
    .filter(Number.isFinite);
  const low = Math.min(...values);
  const high = Math.max(...values);
  const fromZero = values.length === 0 || low < 0.6 * high;
  return valueAxis({
    name: fromZero ? unit : `${unit} (axis does not start at 0)`.trim(),
    nameLocation: "end",
    nameGap: 34,
    nameTextStyle: { color: mutedInk, fontSize: 12, align: "left", padding: [0, 0, 0, -62] },
    scale: !fromZero,
    axisLabel: { color: mutedInk, fontSize: 12, formatter: numberText },
  });
}

function measuredSeries(months, accepts, style) {
  return {
    type: "scatter",
    z: 4,
    data: months.map((month) => (accepts(month) ? month.measured : null)),
    ...style,
  };
}

function tooltipText(month, unit, roleNames) {
  const lines = [
    `${monthText(month.month)} · ${roleNames[month.role].toLowerCase()}`,
    `Measured ${numberText(month.measured)} ${unit}${month.usable ? "" : " (not usable)"}`,
  ];
  if (month.filled !== null) lines.push(`Estimated intervals ${percentText(month.filled)}`);
  if (month.forecast) {
    const [low, q25, q50, q75, high] = month.forecast.map(numberText);
    lines.push(
      `Forecast median ${q50}`,
      `Half of it ${q25} to ${q75}`,
      `90 % of it ${low} to ${high}`,
    );
  }
  if (month.box) lines.push(`Model alone, median ${numberText(month.box[2])}`);
  if (month.different) lines.push("Flagged as different");
  return lines.join("\n");
}

// Nothing estimated: no number, so that the months with estimates stand out.
function filledText(share) {
  if (!share) return "";
  return share < 0.005 ? "<1 %" : percentText(share, 0);
}

export function drawMonths(place, data) {
  const { months, unit } = data.outputs[place.dataset.index];
  const roleNames = data.roleNames ?? usualRoleNames;
  place.style.minWidth = `${months.length * monthSlotWidth + 80}px`;
  const empty = [NaN, NaN, NaN, NaN, NaN];
  mount(place, {
    grid: { left: 64, right: 12, top: 58, bottom: 58 },
    tooltip: {
      ...tooltip,
      trigger: "axis",
      axisPointer: { type: "shadow", shadowStyle: { color: "rgba(85,96,110,.12)" } },
      formatter: (items) => tooltipText(months[items[0].dataIndex], unit, roleNames),
    },
    xAxis: monthAxis(
      months.map(({ month }) => month),
      { below: months.map(({ filled }) => filledText(filled)) },
    ),
    yAxis: verticalAxis(months, unit),
    series: [
      bandSeries(runsOf(months, roleNames)),
      {
        type: "boxplot",
        z: 2,
        boxWidth: [6, 18],
        itemStyle: { color: modelFill, borderColor: modelLine, borderWidth: 1.3 },
        data: months.map(({ forecast }) => forecast ?? empty),
      },
      {
        type: "scatter",
        z: 3,
        symbol: "rect",
        symbolSize: [14, 2],
        itemStyle: { color: mutedInk, opacity: 1 },
        data: months.map(({ box }) => box?.[2] ?? null),
      },
      measuredSeries(months, (m) => m.usable && !m.different, {
        symbol: star,
        symbolSize: 13,
        itemStyle: { color: ink, borderColor: page, borderWidth: 0.8, opacity: 1 },
      }),
      measuredSeries(months, (m) => !m.usable && !m.different, {
        symbol: star,
        symbolSize: 13,
        itemStyle: { color: page, borderColor: mutedInk, borderWidth: 1.4, opacity: 1 },
      }),
      measuredSeries(months, (m) => m.different, {
        symbol: "diamond",
        symbolSize: 15,
        itemStyle: { color: different, borderColor: page, borderWidth: 0.8, opacity: 1 },
      }),
    ],
  });
}
