// The week in four-hour parts. Data count from Sunday 00 h; people's weeks begin on Monday.
const dayNames = ["Mon", "Tue", "Wed", "Thu", "Fri", "Sat", "Sun"];

export const partsOfDay = 6;
export const partsOfWeek = 7 * partsOfDay;

/** Place in the data of the row that stands at `row` counted from Monday 00 h. */
export const partAt = (row) => (row + partsOfDay) % partsOfWeek;

export const dayName = (row) => dayNames[Math.floor(row / partsOfDay)];

/** "00–04 h" of a part of the day or week. */
export function hoursText(part) {
  const from = 4 * (part % partsOfDay);
  const two = (hour) => String(hour).padStart(2, "0");
  return `${two(from)}–${two(from + 4)} h`;
}
