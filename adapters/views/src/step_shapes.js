// Shapes over stretches of time: values hold from a point's start to its end.
import { ink, modelFill } from "./theme.js";

/** Points without a hole between them. */
export function stretchesOf(points) {
  const stretches = [];
  let last = null;
  for (const point of points) {
    if (point.mean !== null) {
      if (last === null || last.end !== point.start) stretches.push([]);
      stretches.at(-1).push(point);
    }
    last = point.mean === null ? null : point;
  }
  return stretches;
}

/** The means, for a line with step "end"; an empty place parts the stretches. */
export function lineData(points) {
  return stretchesOf(points).flatMap((stretch, i) => [
    ...(i > 0 ? [[stretch[0].start, null]] : []),
    ...stretch.map(({ start, mean }) => [start, mean]),
    [stretch.at(-1).end, stretch.at(-1).mean],
  ]);
}

/** From the lowest to the highest value of each point. */
export function bandSeries(points) {
  const stretches = stretchesOf(points);
  return {
    id: "band",
    type: "custom",
    clip: true,
    silent: true,
    z: 1,
    encode: { x: [0, 1], y: [2, 3] },
    data: stretches.map((stretch) => [
      stretch[0].start,
      stretch.at(-1).end,
      Math.min(...stretch.map(({ low }) => low)),
      Math.max(...stretch.map(({ high }) => high)),
    ]),
    renderItem(params, api) {
      const stretch = stretches[params.dataIndex];
      const edge = (value) =>
        stretch.flatMap((point) => [
          api.coord([point.start, point[value]]),
          api.coord([point.end, point[value]]),
        ]);
      return {
        type: "polygon",
        shape: { points: [...edge("high"), ...edge("low").reverse()] },
        style: { fill: modelFill },
      };
    },
  };
}

/** Short thick lines over the others. Each mark: [begin, end, value]. */
export function markSeries(marks) {
  return {
    id: "marks",
    type: "custom",
    clip: true,
    silent: true,
    z: 3,
    encode: { x: [0, 1], y: [2] },
    data: marks,
    renderItem(params, api) {
      const [begin, end, value] = marks[params.dataIndex];
      const [x1, y1] = api.coord([begin, value]);
      const [x2, y2] = api.coord([end, value]);
      return {
        type: "line",
        shape: { x1, y1, x2, y2 },
        style: { stroke: ink, lineWidth: 4 },
      };
    },
  };
}
