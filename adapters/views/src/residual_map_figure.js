// Measured minus modelled as heat maps, before beside after, on one scale of colours.
import { mount } from "./echarts.js";
import { monthText, percentText } from "./format.js";
import { monthAxis } from "./month_axis.js";
import {
  axisLabel,
  axisName,
  chooseMark,
  ink,
  missing,
  missingLine,
  mutedInk,
  page,
  residualColour,
  residualColours,
  tooltip,
} from "./theme.js";
import { dayName, hoursText, partAt, partsOfDay, partsOfWeek } from "./week.js";

const leftLabels = 44;
const panelGap = 34;
const useWords = { fit: "fitted", choose: "used to choose", kept: "kept back" };

const signed = (share) => `${share > 0 ? "+" : ""}${percentText(share)}`.replace("-", "−");
const shareText = (share) => (share === null ? "no reading there" : `meter ${signed(share)}`);

/** The panels that there are, from left to right; a title only where there are two. */
function panelsOf(meter, map) {
  const panels = [["Before", meter.before[map]]];
  if (meter.after) panels.push(["After", meter.after[map]]);
  return panels.map(([title, rows]) => ({ title: meter.after ? title : "", rows }));
}

/** Grids share the width evenly; only the first one has room for labels on its left. */
function gridsOf(place, panels, vertical) {
  const width = Math.max(place.clientWidth, 320) - leftLabels - 8;
  const each = (width - panelGap * (panels.length - 1)) / panels.length;
  return panels.map((_, i) => ({
    left: leftLabels + i * (each + panelGap),
    width: each,
    ...vertical,
  }));
}

/** One rectangle a cell; cells without a measurement are hatched. */
function cellSeries(cells, scale, axes, words) {
  return {
    type: "custom",
    data: cells,
    encode: { x: 0, y: 1 },
    z: 2,
    itemStyle: {
      decal: {
        dashArrayX: [1, 0],
        dashArrayY: [1.5, 4],
        rotation: Math.PI / 4,
        color: missingLine,
      },
    },
    tooltip: { formatter: ({ dataIndex }) => words(cells[dataIndex]) },
    renderItem(params, api) {
      const [column, row, share] = cells[params.dataIndex];
      const [width, height] = api.size([1, 1]);
      const [x, y] = api.coord([column, row]);
      const style =
        share === null
          ? { fill: missing, decal: api.visual("decal") }
          : { fill: residualColour(share / scale) };
      return {
        type: "rect",
        shape: { x: x - width / 2, y: y - height / 2, width: width + 0.4, height: height + 0.4 },
        style,
      };
    },
    ...axes,
  };
}

/** A bar over each month that was not fitted: full where kept back, hollow where used to choose. */
function useSeries(uses, axes) {
  return {
    type: "custom",
    data: uses.map((_, month) => [month, 0]),
    encode: { x: 0 },
    silent: true,
    clip: false,
    renderItem({ dataIndex, coordSys }, api) {
      const use = uses[dataIndex];
      if (use === "fit") return null;
      const [width] = api.size([1, 1]);
      const [x] = api.coord([dataIndex, 0]);
      const kept = use === "kept";
      return {
        type: "rect",
        shape: { x: x - width / 2 + 1, y: coordSys.y - 9, width: width - 2, height: 6 },
        style: { fill: kept ? ink : page, stroke: kept ? ink : chooseMark, lineWidth: 1.2 },
      };
    },
    ...axes,
  };
}

/** Lines between the days of the week. */
function daySeries(axes) {
  return {
    type: "custom",
    data: [1, 2, 3, 4, 5, 6].map((day) => [0, day * partsOfDay]),
    encode: { y: 1 },
    silent: true,
    z: 4,
    renderItem({ dataIndex, coordSys: { x, width } }, api) {
      const [, height] = api.size([1, 1]);
      const y = api.coord([0, (dataIndex + 1) * partsOfDay])[1] - height / 2;
      return {
        type: "line",
        shape: { x1: x, x2: x + width, y1: y, y2: y },
        style: { stroke: page, lineWidth: 1.5 },
      };
    },
    ...axes,
  };
}

/** What the colours mean. */
function writeScale(place, scale) {
  const line = document.createElement("p");
  line.className = "key scale";
  const bar = document.createElement("i");
  bar.style.background = `linear-gradient(90deg, ${residualColours.join(", ")})`;
  line.append(`meter reads ${percentText(scale, 0)} less`, bar, `${percentText(scale, 0)} more`);
  place.parentElement.before(line);
}

const titles = (panels, grids) =>
  panels.map(({ title }, i) => ({
    type: "text",
    left: grids[i].left,
    top: 4,
    silent: true,
    style: { text: title, fill: ink, fontSize: 13, fontWeight: 600 },
  }));

function categoryAxis(gridIndex, data, more) {
  return {
    type: "category",
    gridIndex,
    data,
    axisLine: { show: false },
    axisTick: { show: false },
    axisLabel,
    nameTextStyle: axisName,
    ...more,
  };
}

function drawPanels(place, meter, panels, vertical, axesOf, seriesOf) {
  const grids = gridsOf(place, panels, vertical);
  const chart = mount(place, {
    grid: grids,
    tooltip: { ...tooltip, trigger: "item" },
    graphic: titles(panels, grids),
    ...axesOf(panels),
    series: panels.flatMap((panel, i) => seriesOf(panel, { xAxisIndex: i, yAxisIndex: i })),
  });
  // Two panels share a width that only the window knows.
  new ResizeObserver(() => {
    const fitted = gridsOf(place, panels, vertical);
    chart.setOption({ grid: fitted, graphic: titles(panels, fitted) });
  }).observe(place);
  writeScale(place, meter.scale);
}

export function drawWeekMap(place, data) {
  const meter = data.maps[place.dataset.index];
  const rows = Array.from({ length: partsOfWeek }, (_, row) => row);
  const initials = data.months.length > 14;
  const words = (panel) => ([month, row, share]) =>
    [
      `${panel.title ? `${panel.title}: ` : ""}${dayName(row)} ${hoursText(partAt(row))}`,
      `${monthText(data.months[month])}, ${useWords[data.uses[month]]}`,
      shareText(share),
    ].join("\n");
  const axesOf = (panels) => ({
    xAxis: panels.map((_, gridIndex) => ({ ...monthAxis(data.months, { initials }), gridIndex })),
    yAxis: panels.map((_, gridIndex) =>
      categoryAxis(gridIndex, rows, {
        inverse: true,
        axisLabel: {
          ...axisLabel,
          show: gridIndex === 0,
          interval: (row) => row % partsOfDay === 2,
          formatter: (row) => dayName(Number(row)),
        },
      }),
    ),
  });
  const cellsOf = (panel) =>
    data.months.flatMap((_, month) =>
      rows.map((row) => [month, row, panel.rows[partAt(row)][month]]),
    );
  drawPanels(
    place,
    meter,
    panelsOf(meter, "month"),
    { top: 36, bottom: 42 },
    axesOf,
    (panel, axes) => [
      cellSeries(cellsOf(panel), meter.scale, axes, words(panel)),
      daySeries(axes),
      useSeries(data.uses, axes),
    ],
  );
}

export function drawTemperatureMap(place, data) {
  const meter = data.maps[place.dataset.index];
  const limits = data.temperatureLimits;
  const bins = limits.slice(0, -1);
  const parts = Array.from({ length: partsOfDay }, (_, part) => part);
  const words = (panel) => ([bin, part, share]) =>
    [
      `${panel.title ? `${panel.title}: ` : ""}${hoursText(part)}`,
      `${limits[bin]} to ${limits[bin + 1]} ${data.temperatureUnit}`.replaceAll("-", "−"),
      shareText(share),
    ].join("\n");
  const axesOf = (panels) => ({
    xAxis: panels.map((_, gridIndex) =>
      categoryAxis(gridIndex, bins, {
        axisLabel: {
          ...axisLabel,
          hideOverlap: true,
          formatter: (low) => `${low}…`.replace("-", "−"),
        },
        name: `outdoor temperature, ${data.temperatureUnit} and above`,
        nameLocation: "middle",
        nameGap: 27,
      }),
    ),
    yAxis: panels.map((_, gridIndex) =>
      categoryAxis(gridIndex, parts, {
        inverse: true,
        axisLabel: {
          ...axisLabel,
          color: mutedInk,
          show: gridIndex === 0,
          formatter: (part) => `${4 * part} h`,
        },
      }),
    ),
  });
  const cellsOf = (panel) =>
    bins.flatMap((_, bin) => parts.map((part) => [bin, part, panel.rows[part][bin]]));
  drawPanels(
    place,
    meter,
    panelsOf(meter, "temperature"),
    { top: 24, bottom: 46 },
    axesOf,
    (panel, axes) => [cellSeries(cellsOf(panel), meter.scale, axes, words(panel))],
  );
}
