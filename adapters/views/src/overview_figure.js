// The first picture: every meter's months against what was expected of them, one panel a meter.
import { mount } from "./echarts.js";
import { monthText, numberText, plainText } from "./format.js";
import { yearAxis } from "./month_axis.js";
import { bandSeries, monthBandSeries } from "./shapes.js";
import {
  axisLabel,
  different,
  ink,
  modelFill,
  modelLine,
  page,
  star,
  tooltip,
  valueAxis,
} from "./theme.js";

const panelHeight = 92;
const panelGap = 42;
const firstPanelTop = 30;

const isOutside = ({ measured, band }) =>
  band !== null && measured !== null && (measured < band[0] || measured > band[2]);

/** From zero, so that a panel shows how much and not only how it goes up and down. */
function spanOf(months) {
  const values = months.flatMap(({ measured, band }) => [measured, ...(band ?? [])]);
  const finite = values.filter((value) => value !== null && Number.isFinite(value));
  return { min: Math.min(0, ...finite), max: Math.max(...finite, 1e-9) * 1.06 };
}

function tooltipText(meter, month) {
  const lines = [
    `${plainText(meter.label)}, ${monthText(month.month)}`,
    `Measured ${numberText(month.measured)} ${meter.unit}`,
  ];
  if (month.band) {
    lines.push(`Expected ${numberText(month.band[0])} to ${numberText(month.band[2])}`);
  }
  return lines.join("\n");
}

/** The later months, which the model or the regression has not seen. */
function unseenRuns(months) {
  const first = months.findIndex(({ role }) => role === "validation");
  if (first < 0) return [];
  const last = months.findLastIndex(({ role }) => role === "validation");
  return [{ first, last, label: "", shaded: true }];
}

function seriesOf({ months }, axes) {
  const points = (accepts, style) => ({
    type: "scatter",
    z: 4,
    data: months.map((month) => (accepts(month) ? month.measured : null)),
    ...style,
    ...axes,
  });
  return [
    { ...bandSeries(unseenRuns(months)), ...axes },
    { ...monthBandSeries(months.map(({ band }) => band && [band[0], band[2]]), modelFill), ...axes },
    {
      type: "line",
      showSymbol: false,
      connectNulls: false,
      z: 3,
      lineStyle: { color: modelLine, width: 1.6 },
      data: months.map(({ band }) => band?.[1] ?? null),
      ...axes,
    },
    points((month) => !isOutside(month), {
      symbol: star,
      symbolSize: 9,
      itemStyle: { color: ink, opacity: 1 },
    }),
    points(isOutside, {
      symbol: "diamond",
      symbolSize: 11,
      itemStyle: { color: different, borderColor: page, borderWidth: 0.8, opacity: 1 },
    }),
  ];
}

export function drawOverview(place, data) {
  const meters = data.overview;
  place.style.height = `${firstPanelTop + meters.length * (panelHeight + panelGap)}px`;
  mount(place, {
    grid: meters.map((_, i) => ({
      left: 58,
      right: 8,
      top: firstPanelTop + i * (panelHeight + panelGap),
      height: panelHeight,
    })),
    tooltip: {
      ...tooltip,
      trigger: "axis",
      axisPointer: { type: "line" },
      formatter([{ axisIndex, dataIndex }]) {
        const meter = meters[axisIndex];
        return tooltipText(meter, meter.months[dataIndex]);
      },
    },
    xAxis: meters.map(({ months }, gridIndex) => ({
      ...yearAxis(months.map(({ month }) => month)),
      gridIndex,
    })),
    yAxis: meters.map(({ label, unit, months }, gridIndex) =>
      valueAxis({
        gridIndex,
        ...spanOf(months),
        name: [plainText(label), unit].filter(Boolean).join(", "),
        nameLocation: "end",
        nameGap: 10,
        nameTextStyle: {
          color: ink,
          fontSize: 13,
          fontWeight: 600,
          align: "left",
          padding: [0, 0, 0, -54],
        },
        splitNumber: 2,
        axisLabel: { ...axisLabel, formatter: numberText, showMaxLabel: false, hideOverlap: true },
      }),
    ),
    series: meters.flatMap((meter, i) => seriesOf(meter, { xAxisIndex: i, yAxisIndex: i })),
  });
}
