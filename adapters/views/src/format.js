// Numbers and months as people read them.
const monthNames = [
  "Jan",
  "Feb",
  "Mar",
  "Apr",
  "May",
  "Jun",
  "Jul",
  "Aug",
  "Sep",
  "Oct",
  "Nov",
  "Dec",
];

/** 12345.6 → "12,346", 0.01234 → "0.01234", null → "–"; four significant digits. */
export function numberText(value) {
  if (value === null || !Number.isFinite(value)) return "–";
  const digits =
    Math.abs(value) >= 1000 ? { maximumFractionDigits: 0 } : { maximumSignificantDigits: 4 };
  return value.toLocaleString("en", digits).replace("-", "−");
}

/** 0.153 → "15.3 %". */
export function percentText(share, decimals = 1) {
  return `${(share * 100).toFixed(decimals)} %`;
}

export const yearOf = (key) => key.slice(0, 4);
export const monthNumber = (key) => Number(key.slice(5, 7));
export const monthName = (number) => monthNames[number - 1];
/** A design may number its months, without a calendar: "7". */
export const isNumbered = (key) => !key.includes("-");
export const monthText = (key) =>
  isNumbered(key) ? `Month ${key}` : `${monthName(monthNumber(key))} ${yearOf(key)}`;

/** Names are data: what ECharts reads as rich-text markup in them is taken out. */
export const plainText = (text) => text.replace(/[{}|]/g, " ");
