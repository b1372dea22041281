// The calendar behind the load figure: which hour stands where, where the gaps are, what scale fits.
// No drawing here.
const dayMs = 86_400_000;

/** Days since 1970 of an ISO date; dates here are labels of local days, so UTC serves as calendar. */
const dayNumber = (isoDay) => Date.parse(`${isoDay}T00:00:00Z`) / dayMs;
const isoDay = (number) => new Date(number * dayMs).toISOString().slice(0, 10);

/** The calendar years of a load: {year, start, labels}, start in days since 1970, a label a day. */
export function yearsOf(load) {
  const first = dayNumber(load.firstDay);
  const last = first + load.status.length / 24 - 1;
  const years = [];
  for (
    let year = Number(isoDay(first).slice(0, 4));
    year <= Number(isoDay(last).slice(0, 4));
    year++
  ) {
    const start = dayNumber(`${year}-01-01`);
    const days = dayNumber(`${year + 1}-01-01`) - start;
    years.push({ year, start, labels: Array.from({ length: days }, (_, i) => isoDay(start + i)) });
  }
  return years;
}

/** Index into the load's hours, or -1 outside its days. */
export function hourIndex(load, { start }, day, hour) {
  const i = (start + day - dayNumber(load.firstDay)) * 24 + hour;
  return i < load.status.length ? Math.max(i, -1) : -1;
}

/** Runs of hours of one kind within a day; equal runs on neighbouring days become one rectangle. */
export function gapRectangles(load, year, letter) {
  const is = (day, hour) => load.status[hourIndex(load, year, day, hour)] === letter;
  const rectangles = [];
  let open = new Map(); // "from-to" → rectangle that ended the day before
  year.labels.forEach((_, day) => {
    const next = new Map();
    for (let hour = 0; hour < 24; hour++) {
      if (!is(day, hour)) continue;
      const from = hour;
      while (hour < 23 && is(day, hour + 1)) hour++;
      const name = `${from}-${hour}`;
      const rectangle = open.get(name) ?? [day, day, from, hour];
      if (!open.has(name)) rectangles.push(rectangle);
      rectangle[1] = day;
      next.set(name, rectangle);
    }
    open = next;
  });
  return rectangles;
}

/** All but the top half percent, so that one odd hour does not bleach the rest. */
export function scaleTop(load) {
  const values = load.kW
    .filter((value, i) => value !== null && load.status[i] !== "s")
    .sort((a, b) => a - b);
  return values.length === 0 ? 1 : values[Math.floor(0.995 * (values.length - 1))] || 1;
}
