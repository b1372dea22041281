// Measured load as a calendar: one panel a year, one column a day, midnight at the top. Hours
// without a trustworthy value have a pattern and no colour.
import { mount } from "./echarts.js";
import { monthName, numberText } from "./format.js";
import { gapRectangles, hourIndex, scaleTop, yearsOf } from "./load_calendar.js";
import { stretched, yearImage } from "./load_image.js";
import {
  axisLabel,
  axisName,
  ink,
  loadColours,
  missing,
  missingLine,
  page,
  suspectLine,
} from "./theme.js";

const panelHeight = 128;
const panelGap = 44;
const firstPanelTop = 26;

const statusWords = { o: "", p: ", partly estimated", m: "missing", s: "suspect, kept out" };

/** A picture instead of ten thousand shapes a year: five years of three meters stay quick. */
function imageSeries(load, year, top, axes) {
  const image = yearImage(load, year, top);
  return {
    type: "custom",
    data: [[0, 0]],
    silent: true,
    z: 2,
    renderItem({ coordSys: { x, y, width, height } }) {
      return {
        type: "image",
        style: { image: stretched(image, width, height), x, y, width, height },
      };
    },
    ...axes,
  };
}

const looks = {
  m: {
    fill: missing,
    decal: { dashArrayX: [1, 0], dashArrayY: [1.5, 4], rotation: Math.PI / 4, color: missingLine },
  },
  s: {
    fill: page,
    decal: { dashArrayX: [1, 0], dashArrayY: [2, 3], rotation: -Math.PI / 4, color: suspectLine },
  },
  p: {
    fill: "transparent",
    decal: {
      symbol: "circle",
      dashArrayX: [4, 4],
      dashArrayY: [4, 4],
      symbolSize: 0.7,
      color: ink,
    },
  },
};

function gapSeries(load, year, letter, axes) {
  return {
    type: "custom",
    data: gapRectangles(load, year, letter),
    encode: { x: [0, 1], y: [2, 3] },
    silent: true,
    z: 3,
    itemStyle: { color: looks[letter].fill, decal: looks[letter].decal },
    renderItem(_, api) {
      const [firstDay, lastDay, firstHour, lastHour] = [0, 1, 2, 3].map((i) => api.value(i));
      const [dayWidth, hourHeight] = api.size([1, 1]);
      const [left, top] = api.coord([firstDay, firstHour]);
      return {
        type: "rect",
        shape: {
          x: left - dayWidth / 2,
          y: top - hourHeight / 2,
          width: Math.max((lastDay - firstDay + 1) * dayWidth, 1),
          height: (lastHour - firstHour + 1) * hourHeight,
        },
        style: { fill: looks[letter].fill, decal: api.visual("decal") },
      };
    },
    ...axes,
  };
}

function dayAxis({ labels }, gridIndex) {
  const isMiddle = (label) => label.slice(8) === "15";
  return {
    type: "category",
    gridIndex,
    data: labels,
    axisLine: { show: false },
    axisTick: { interval: (_, label) => label.slice(8) === "01", alignWithLabel: false, length: 6 },
    axisLabel: {
      ...axisLabel,
      interval: (_, label) => isMiddle(label),
      formatter: (label) => monthName(Number(label.slice(5, 7))),
    },
  };
}

function hourAxis({ year }, gridIndex) {
  return {
    type: "category",
    gridIndex,
    inverse: true,
    data: Array.from({ length: 24 }, (_, hour) => hour),
    name: `${year}`,
    nameLocation: "start",
    nameGap: 9,
    nameTextStyle: {
      ...axisName,
      color: ink,
      fontSize: 13,
      fontWeight: 600,
      align: "left",
      padding: [0, 0, 0, -40],
    },
    axisLine: { show: false },
    axisTick: { show: false },
    axisLabel: {
      ...axisLabel,
      interval: (hour) => hour % 6 === 0,
      formatter: (hour) => `${hour} h`,
    },
  };
}

const amountText = ({ unit, unitsPerKW }, kW) => `${numberText(kW * unitsPerKW)} ${unit}`;

/** What the colours mean, and the hour under the pointer. */
function writeScale(place, load, top) {
  const scale = document.createElement("p");
  scale.className = "key scale";
  const bar = document.createElement("i");
  bar.style.background = `linear-gradient(90deg, ${loadColours.join(", ")})`;
  const readout = document.createElement("span");
  readout.className = "readout";
  readout.textContent = "Point at an hour to read it.";
  scale.append("0", bar, `${amountText(load, top)} and more`, readout);
  place.parentElement.before(scale);
  return readout;
}

function readoutText(load, year, day, hour) {
  const i = hourIndex(load, year, day, hour);
  if (i < 0) return "";
  const status = statusWords[load.status[i]];
  const value = "op".includes(load.status[i]) ? amountText(load, load.kW[i]) : "";
  return `${year.labels[day]}, ${hour}:00 to ${hour + 1}:00: ${value}${status}`;
}

function followPointer(chart, load, years, readout) {
  chart.getZr().on("mousemove", ({ offsetX, offsetY }) => {
    const pixel = [offsetX, offsetY];
    const panel = years.findIndex((_, gridIndex) => chart.containPixel({ gridIndex }, pixel));
    if (panel < 0) return;
    const [day, hour] = chart.convertFromPixel({ gridIndex: panel }, pixel);
    readout.textContent = readoutText(load, years[panel], day, hour);
  });
}

export function drawLoad(place, data) {
  const load = data.loads[place.dataset.index];
  const years = yearsOf(load);
  const top = scaleTop(load);
  place.style.height = `${firstPanelTop + years.length * (panelHeight + panelGap)}px`;
  const chart = mount(place, {
    grid: years.map((_, i) => ({
      left: 44,
      right: 4,
      top: firstPanelTop + i * (panelHeight + panelGap),
      height: panelHeight,
    })),
    xAxis: years.map(dayAxis),
    yAxis: years.map(hourAxis),
    series: years.flatMap((year, i) => {
      const axes = { xAxisIndex: i, yAxisIndex: i };
      return [
        imageSeries(load, year, top, axes),
        ...["p", "m", "s"].map((letter) => gapSeries(load, year, letter, axes)),
      ];
    }),
  });
  followPointer(chart, load, years, writeScale(place, load, top));
}
