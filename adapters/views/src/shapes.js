// Shapes that several figures share, as custom series: histograms, rules and background bands.
import { ink, limit, modelFill, modelLine, mutedInk, validationGround } from "./theme.js";

/** Bars between exact bin edges: `heights[i]` over [start + i width, start + (i+1) width). */
export function histogramSeries({ start, width, heights }, more = {}) {
  return {
    type: "custom",
    data: heights.map((height, i) => [start + i * width, start + (i + 1) * width, height]),
    encode: { x: [0, 1], y: 2 },
    renderItem(_, api) {
      const [left, top] = api.coord([api.value(0), api.value(2)]);
      const [right, bottom] = api.coord([api.value(1), 0]);
      return {
        type: "rect",
        shape: { x: left, y: top, width: Math.max(right - left, 0.5), height: bottom - top },
        style: { fill: modelFill, stroke: modelLine, lineWidth: 0.6 },
      };
    },
    ...more,
  };
}

/** A dashed vertical limit with its name beside its upper end. */
export function limitSeries(x, label, more = {}) {
  return {
    type: "custom",
    data: [[x]],
    encode: { x: 0 },
    silent: true,
    z: 5,
    renderItem(params, api) {
      const area = params.coordSys;
      const at = api.coord([x, 0])[0];
      const leftSide = at > area.x + area.width * 0.7;
      return {
        type: "group",
        children: [
          {
            type: "line",
            shape: { x1: at, x2: at, y1: area.y, y2: area.y + area.height },
            style: { stroke: limit, lineWidth: 2, lineDash: [6, 4] },
          },
          {
            type: "text",
            style: {
              text: label,
              x: at + (leftSide ? -6 : 6),
              y: area.y + 1,
              align: leftSide ? "right" : "left",
              fill: limit,
              fontSize: 12,
              fontWeight: 600,
            },
          },
        ],
      };
    },
    ...more,
  };
}

/** The posterior's mean (a line over the full height) and 90 % interval (a bracket at the top). */
export function summarySeries({ mean, q05, q95 }) {
  return {
    type: "custom",
    data: [[q05, mean, q95]],
    encode: { x: [0, 1, 2] },
    silent: true,
    z: 6,
    renderItem(params, api) {
      const area = params.coordSys;
      const [left, middle, right] = [q05, mean, q95].map((value) => api.coord([value, 0])[0]);
      const y = area.y - 9;
      const line = (x1, y1, x2, y2, lineWidth) => ({
        type: "line",
        shape: { x1, y1, x2, y2 },
        style: { stroke: ink, lineWidth },
      });
      return {
        type: "group",
        children: [
          line(left, y, right, y, 2),
          line(left, y - 4, left, y + 4, 2),
          line(right, y - 4, right, y + 4, 2),
          line(middle, y - 4, middle, area.y + area.height, 2.5),
        ],
      };
    },
  };
}

/**
 * Names what stretches of months are for and rules a line between them.
 * Each run: {first, last, label, shaded}, first and last being places on the category axis.
 */
export function bandSeries(runs) {
  return {
    type: "custom",
    data: runs.map((run) => [run.first, run.last]),
    encode: { x: [0, 1] },
    silent: true,
    z: 0,
    renderItem(params, api) {
      const run = runs[params.dataIndex];
      const area = params.coordSys;
      const half = api.size([1, 0])[0] / 2;
      const left = api.coord([run.first, 0])[0] - half;
      const right = api.coord([run.last, 0])[0] + half;
      const children = [
        {
          type: "rect",
          shape: { x: left, y: area.y - 24, width: right - left, height: area.height + 24 },
          style: { fill: run.shaded ? validationGround : "transparent" },
        },
        {
          type: "text",
          style: {
            text: run.label,
            x: left + 8,
            y: area.y - 18,
            fill: ink,
            fontSize: 12.5,
            fontWeight: 600,
          },
        },
      ];
      if (run.first > 0) {
        children.push({
          type: "line",
          shape: { x1: left, x2: left, y1: area.y - 24, y2: area.y + area.height },
          style: { stroke: mutedInk, lineWidth: 1.5 },
        });
      }
      return { type: "group", children };
    },
  };
}

/**
 * A band over places on a category axis, a polygon for each stretch without a hole.
 * @param limits  [low, high] of each place, or null.
 */
export function monthBandSeries(limits, fill) {
  const stretches = [];
  let open = null;
  limits.forEach((limit, i) => {
    if (!limit) open = null;
    else if (open) open.push([i, ...limit]);
    else stretches.push((open = [[i, ...limit]]));
  });
  return {
    type: "custom",
    silent: true,
    z: 1,
    data: stretches.map((stretch, i) => [stretch[0][0], i]),
    renderItem(params, api) {
      const stretch = stretches[params.dataIndex];
      const half = api.size([1, 0])[0] / 2;
      const at = (i, value) => api.coord([i, value]);
      const below = stretch.map(([i, low]) => at(i, low));
      const above = stretch.map(([i, , high]) => at(i, high));
      // A month alone is a bar, not a line that nobody sees.
      const widened = (points) =>
        points.length > 1 ? points : [-half, half].map((step) => [points[0][0] + step, points[0][1]]);
      return {
        type: "polygon",
        shape: { points: [...widened(below), ...widened(above).reverse()] },
        style: { fill, opacity: 0.6 },
      };
    },
  };
}
