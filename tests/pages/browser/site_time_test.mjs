// The times of the zoomable charts: round at the site, as those of time_chart_test.cpp, also where
// its clocks change.
import assert from "node:assert/strict";

import { SiteTime } from "../../../adapters/views/src/site_time.js";

const at = (text) => Date.parse(text) / 1000;
const hour = 3600;
const day = 24 * hour;
const midnight = at("2024-03-09T06:00:00Z");
const forward = at("2024-03-10T08:00:00Z");
const back = at("2024-11-03T07:00:00Z");
const chicago = new SiteTime([
  [midnight, -6 * hour],
  [forward, -5 * hour],
  [back, -6 * hour],
]);

function labels(from, length, most = 7) {
  const { ticks, label } = chicago.ticks(from, from + length, most);
  return ticks.map(label);
}

assert.deepEqual(labels(midnight, day), ["9 Mar", "06:00", "12:00", "18:00", "10 Mar"]);
assert.deepEqual(labels(midnight, 3 * day), [
  ...["9 Mar", "12:00", "10 Mar", "12:00", "11 Mar", "12:00", "12 Mar"],
]);
assert.deepEqual(labels(midnight + 20 * hour, 12 * hour), [
  ...["21:00", "10 Mar", "03:00", "06:00", "09:00"], // three hours of which one is skipped
]);
assert.deepEqual(labels(midnight + day, 4 * hour), ["10 Mar", "01:00", "03:00", "04:00", "05:00"]);
assert.deepEqual(labels(midnight + day + hour, 2 * hour), [
  ...["01:00", "01:30", "03:00", "03:30", "04:00"],
]);
assert.deepEqual(labels(midnight, 365 * day), [
  ...["Apr 2024", "Jul 2024", "Oct 2024", "Jan 2025"],
]);
assert.deepEqual(labels(midnight, hour / 2), [
  ...["9 Mar", "00:05", "00:10", "00:15", "00:20", "00:25", "00:30"],
]);
assert.deepEqual(labels(midnight, 3650 * day), ["2026", "2028", "2030", "2032", "2034"]);
assert.ok(labels(midnight, 20000 * day, 4).length <= 4);

// Of an hour that the clocks show twice, the tick is the first; the days stay whole.
const days = chicago.ticks(at("2024-11-02T05:00:00Z"), at("2024-11-05T06:00:00Z"), 4).ticks;
assert.deepEqual(
  days.map((t) => new Date(t * 1000).toISOString()),
  ["2024-11-02T05", "2024-11-03T05", "2024-11-04T06", "2024-11-05T06"].map((t) => `${t}:00:00.000Z`),
);

assert.equal(chicago.spanText(midnight, midnight + 900), "2024-03-09 00:00 to 00:15 −06:00");
assert.equal(chicago.spanText(forward - hour, forward + hour), "2024-03-10 01:00 to 04:00 −06:00");
assert.equal(chicago.spanText(midnight, midnight + day), "2024-03-09");
assert.equal(
  chicago.spanText(at("2024-04-01T05:00:00Z"), at("2024-05-01T05:00:00Z")),
  "2024-04-01 to 2024-04-30",
);
assert.equal(
  chicago.spanText(midnight + 20 * hour, midnight + 26 * hour),
  "2024-03-09 20:00 to 2024-03-10 03:00 −06:00",
);
