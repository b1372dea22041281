// A chart of the daemon's pages that can be zoomed: a line in steps, a band around it, and marks.
import { fetchPoints, pointsIn, wantedSpan, withPart } from "./finer_points.js";
import { numberText } from "./format.js";
import { mount } from "./mount.js";
import { SiteTime } from "./site_time.js";
import { bandSeries, lineData, markSeries } from "./step_shapes.js";
import {
  axisLabel,
  axisName,
  grid,
  modelFill,
  modelLine,
  mutedInk,
  page,
  rule,
  tooltip,
  valueAxis,
} from "./theme.js";

const margin = { left: 60, right: 32, top: 30, bottom: 66 }; // px; half a label fits on the right
const pixelsOfTick = 64;
const ticksMost = 12;
const settled_ms = 250; // Who turns the wheel has not chosen a span yet.

const pointOf = ([start, end, low, mean, high]) => ({ start, end, low, mean, high });

/** In colours of the page; none of its own, which would not follow a dark page. */
const slider = {
  type: "slider",
  left: margin.left,
  right: margin.right,
  height: 28,
  bottom: 4,
  brushSelect: false,
  showDetail: false, // The axis has the times.
  borderColor: rule,
  backgroundColor: "transparent",
  fillerColor: "var(--zoomed)",
  dataBackground: { lineStyle: { color: mutedInk }, areaStyle: { color: grid } },
  selectedDataBackground: { lineStyle: { color: modelLine }, areaStyle: { color: modelFill } },
  handleStyle: { color: page, borderColor: mutedInk },
  moveHandleStyle: { color: mutedInk, opacity: 1 },
  emphasis: {
    handleStyle: { color: page, borderColor: modelLine },
    moveHandleStyle: { color: modelLine },
  },
};

class ZoomableChart {
  #data;
  #time;
  #points;
  #chart;
  #said;
  #timer = 0;
  #asked = 0;

  constructor(place, said, data) {
    this.#data = data;
    this.#said = said;
    this.#time = new SiteTime(data.offsets);
    this.#points = data.points.map(pointOf);
    this.#chart = mount(place, this.#option());
    this.#chart.on("datazoom", () => this.#zoomed());
    new ResizeObserver(() => this.#drawTicks()).observe(place);
    this.#drawTicks();
  }

  #option() {
    const { span, unit, finer } = this.#data;
    const shortest = finer?.interval_s ?? Math.min(...this.#points.map((p) => p.end - p.start));
    const least = Math.min(8 * shortest, span[1] - span[0]);
    const zoom = { filterMode: "none", minValueSpan: least };
    return {
      grid: margin,
      tooltip: {
        ...tooltip,
        trigger: "axis",
        axisPointer: { type: "line", snap: false, lineStyle: { color: mutedInk } },
        formatter: (items) => this.#tooltipText(items[0].axisValue),
      },
      // The page can still be scrolled with a finger on the chart.
      dataZoom: [
        { type: "inside", ...zoom, preventDefaultMouseMove: false },
        { ...slider, ...zoom },
      ],
      xAxis: valueAxis({
        min: span[0],
        max: span[1],
        axisLine: { show: true, onZero: false, lineStyle: { color: rule } },
        axisTick: { show: true, lineStyle: { color: rule } },
      }),
      yAxis: valueAxis({
        name: unit,
        nameGap: 14,
        nameTextStyle: { ...axisName, align: "left", padding: [0, 0, 0, -52] },
        axisLabel: { ...axisLabel, formatter: numberText },
      }),
      series: [...this.#seriesOfPoints(), markSeries(this.#data.marks)],
    };
  }

  #seriesOfPoints() {
    return [
      bandSeries(this.#points),
      {
        id: "line",
        type: "line",
        step: "end",
        showSymbol: false,
        z: 2,
        lineStyle: { color: modelLine, width: 1.5 },
        itemStyle: { color: modelLine },
        data: lineData(this.#points),
      },
    ];
  }

  #tooltipText(t) {
    const { unit, words, marks } = this.#data;
    const point = this.#points.find(({ start, end }) => start <= t && t < end);
    if (!point) return "";
    const lines = [this.#time.spanText(point.start, point.end)];
    if (point.mean === null) return [...lines, "No valid reading"].join("\n");
    const mark = marks.find(([begin, end]) => begin <= t && t < end);
    if (mark) lines.push(`${words.mark} ${numberText(mark[2])} ${unit}`);
    lines.push(`${words.line} ${numberText(point.mean)} ${unit}`);
    if (point.low < point.high) {
      lines.push(`${words.band} ${numberText(point.low)} to ${numberText(point.high)}`);
    }
    return lines.join("\n");
  }

  #visible() {
    const { startValue, endValue } = this.#chart.getOption().dataZoom[0];
    return [startValue, endValue];
  }

  /** In local time of the site, which the library does not know. */
  #drawTicks() {
    const room = Math.floor(this.#chart.getWidth() / pixelsOfTick);
    const most = Math.min(Math.max(room, 2), ticksMost);
    const { ticks, label } = this.#time.ticks(...this.#visible(), most);
    this.#chart.setOption({
      xAxis: {
        axisLabel: { ...axisLabel, customValues: ticks, hideOverlap: true, formatter: label },
        axisTick: { customValues: ticks },
      },
    });
  }

  #zoomed() {
    this.#drawTicks();
    clearTimeout(this.#timer);
    if (this.#data.finer) this.#timer = setTimeout(() => this.#refine(), settled_ms);
  }

  async #refine() {
    const span = wantedSpan(this.#points, ...this.#visible(), this.#data.finer);
    if (!span) return;
    const number = (this.#asked += 1);
    try {
      const part = await fetchPoints(span, this.#data.finer);
      if (number !== this.#asked) return; // Somebody has zoomed on.
      if (part.length <= pointsIn(this.#points, ...span).length) return;
      this.#points = withPart(this.#points, span, part);
      this.#chart.setOption({ series: this.#seriesOfPoints() });
      this.#said.textContent = `Finer values from ${this.#time.spanText(...span)}.`;
    } catch (error) {
      this.#said.textContent = `Finer values could not be fetched: ${error.message}.`;
    }
  }
}

/** @param said  Where it tells what it has done. */
export function drawZoomable(place, said, data) {
  return new ZoomableChart(place, said, data);
}
