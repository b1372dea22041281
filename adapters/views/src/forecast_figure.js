// What was forecast of each month, with its band, and what came; and what is believed of a parameter.
import { mount } from "./echarts.js";
import { monthText, numberText } from "./format.js";
import { monthAxis, yearAxis } from "./month_axis.js";
import { bandSeries, monthBandSeries } from "./shapes.js";
import {
  axisLabel,
  axisName,
  different,
  ink,
  modelFill,
  modelLine,
  page,
  star,
  tooltip,
  valueAxis,
} from "./theme.js";

/** Custom series do not stretch the axis, so it is told what has to fit. */
function verticalAxis(unit, values) {
  const finite = values.filter((value) => value !== null);
  const low = Math.min(...finite);
  const high = Math.max(...finite);
  const room = 0.05 * (high - low || 1);
  return valueAxis({
    name: unit,
    nameGap: 34,
    nameTextStyle: { ...axisName, align: "left", padding: [0, 0, 0, -62] },
    ...(finite.length > 0
      ? { min: low > 0 && low < 0.6 * high ? 0 : low - room, max: high + room }
      : {}),
    axisLabel: {
      ...axisLabel,
      formatter: numberText,
      showMinLabel: low > 0 && low < 0.6 * high,
      showMaxLabel: false,
    },
  });
}

function line(values, more) {
  return { type: "line", showSymbol: false, connectNulls: false, z: 2, data: values, ...more };
}

function draw(place, { unit, months, alarms, slotWidth }, extra, say) {
  place.style.minWidth = `${months.length * slotWidth + 90}px`;
  const keys = months.map(({ month }) => month);
  const runs = alarms.map(({ first, last }) => ({
    first: Math.max(0, keys.indexOf(first)),
    last: keys.indexOf(last),
    label: "Alarm",
    shaded: true,
  }));
  mount(place, {
    grid: { left: 64, right: 12, top: 58, bottom: 44 },
    tooltip: {
      ...tooltip,
      trigger: "axis",
      axisPointer: { type: "line" },
      formatter: (items) => say(months[items[0].dataIndex]),
    },
    xAxis: slotWidth < 9 ? yearAxis(keys) : monthAxis(keys, { initials: true }),
    yAxis: verticalAxis(
      unit,
      months.flatMap((m) => [m.q05, m.q95, m.measured ?? null, m.lastYear ?? null]),
    ),
    series: [
      bandSeries(runs),
      monthBandSeries(
        months.map(({ q05, q95 }) => (q05 === null || q95 === null ? null : [q05, q95])),
        modelFill,
      ),
      line(
        months.map(({ q50 }) => q50),
        { lineStyle: { color: modelLine, width: 2 } },
      ),
      ...extra,
    ],
  });
}

export function drawForecast(place, data) {
  const series = { ...data.forecasts[place.dataset.index], slotWidth: 9 };
  const { months, unit } = series;
  const isOutside = (m) =>
    m.q05 !== null && m.measured !== null && (m.measured < m.q05 || m.measured > m.q95);
  const points = (accepts, style) => ({
    type: "scatter",
    z: 4,
    symbol: star,
    symbolSize: 10,
    data: months.map((m) => (accepts(m) ? m.measured : null)),
    ...style,
  });
  draw(
    place,
    series,
    [
      points((m) => !isOutside(m), { itemStyle: { color: ink, opacity: 1 } }),
      points(isOutside, {
        symbol: "diamond",
        symbolSize: 12,
        itemStyle: { color: different, borderColor: page, borderWidth: 0.8, opacity: 1 },
      }),
    ],
    (m) =>
      [
        monthText(m.month),
        `Measured ${numberText(m.measured)} ${unit}`,
        m.q50 === null
          ? "Learnt from, not forecast"
          : `Forecast ${numberText(m.q50)}, 90 % ${numberText(m.q05)} to ${numberText(m.q95)}`,
      ].join("\n"),
  );
}

export function drawBelieved(place, data) {
  const series = { ...data.believed[place.dataset.index], alarms: [], slotWidth: 4 };
  const { months, unit } = series;
  draw(
    place,
    series,
    [
      line(
        months.map(({ lastYear }) => lastYear),
        { lineStyle: { color: different, width: 1.6, type: [6, 4] } },
      ),
    ],
    (m) =>
      [
        monthText(m.month),
        `All months ${numberText(m.q50)} ${unit}, 90 % ${numberText(m.q05)} to ${numberText(m.q95)}`,
        `Last twelve ${numberText(m.lastYear)} ${unit}`,
      ].join("\n"),
  );
}
