// A category axis of months: names of months, the year under its first month, optionally a line of
// small text between the two.
import { isNumbered, monthName, monthNumber, yearOf } from "./format.js";
import { axisLabel, ink, mutedInk, rule } from "./theme.js";

export const monthSlotWidth = 28; // Pixels a month needs for "Mar" and "12 %".

const categoryAxis = (keys) => ({
  type: "category",
  data: keys,
  axisTick: { show: false },
  axisLine: { lineStyle: { color: rule } },
});

/** Years alone, where months have no room. @param keys  "2021-03" …, or numbers of months */
export function yearAxis(keys) {
  return {
    ...categoryAxis(keys),
    axisLabel: {
      ...axisLabel,
      ...(keys.every(isNumbered)
        ? { hideOverlap: true }
        : { interval: (i) => monthNumber(keys[i]) === 1, formatter: yearOf }),
    },
  };
}

/** @param keys  "2021-03" …, or numbers of months; @param below  one short text a month, or null for none. */
export function monthAxis(keys, { below = null, initials = false } = {}) {
  const isYearStart = (i) =>
    !isNumbered(keys[i]) && (i === 0 || yearOf(keys[i]) !== yearOf(keys[i - 1]));
  return {
    ...categoryAxis(keys),
    axisLabel: {
      ...axisLabel,
      interval: 0,
      formatter(key, i) {
        const name = isNumbered(key) ? key : monthName(monthNumber(key));
        const lines = [initials ? name[0] : name];
        if (below) lines.push(`{below|${below[i] || " "}}`);
        if (isYearStart(i)) lines.push(`{year|${yearOf(key)}}`);
        return lines.join("\n");
      },
      fontSize: initials ? 10.5 : 12,
      lineHeight: 16,
      rich: {
        below: { color: mutedInk, fontSize: 10.5, lineHeight: 15 },
        year: { color: ink, fontSize: 12, fontWeight: 600, lineHeight: 17 },
      },
    },
  };
}
