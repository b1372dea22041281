// Finer values of a part of a chart, from the daemon's history.

/** Fewer points than this share of what there is room for are too few. */
const enough = 0.5;

const isoText = (t) => new Date(t * 1000).toISOString().replace(".000", "");

/** The points that share some time with the span. */
export const pointsIn = (points, from, to) =>
  points.filter(({ start, end }) => start < to && from < end);

/** What is worth asking for: [from, to] in whole points of `points`, or null. */
export function wantedSpan(points, from, to, source) {
  const seen = pointsIn(points, from, to);
  if (seen.length === 0 || seen.length >= enough * source.points) return null;
  if (seen.every(({ start, end }) => end - start <= source.interval_s)) return null;
  return [seen[0].start, seen.at(-1).end];
}

/** @return the history's points in the unit of the chart. */
export async function fetchPoints([from, to], source) {
  const answer = await fetch(
    `${source.address}&from=${isoText(from)}&to=${isoText(to)}&points=${source.points}`,
  );
  if (!answer.ok) throw new Error(`the history answers ${answer.status}`);
  const { step_s, points } = await answer.json();
  const shown = (value) => (value === null ? null : value * source.factor + source.offset);
  return points.map(({ start, least, mean, most }) => {
    const at = Date.parse(start) / 1000;
    return {
      start: at,
      end: Math.min(at + step_s, to),
      low: shown(least),
      mean: shown(mean),
      high: shown(most),
    };
  });
}

/** `points` with those of a span replaced. */
export const withPart = (points, [from, to], part) => [
  ...points.filter(({ end }) => end <= from),
  ...part,
  ...points.filter(({ start }) => start >= to),
];
