// The hours of a day as a horizontal axis.
import { axisLabel, axisName, rule } from "./theme.js";

export const hours = Array.from({ length: 24 }, (_, hour) => hour);

export const hourAxis = {
  type: "category",
  data: hours,
  axisTick: { show: false },
  axisLine: { lineStyle: { color: rule } },
  axisLabel: { ...axisLabel, interval: (hour) => hour % 6 === 0 },
  name: "hour of the day",
  nameLocation: "middle",
  nameGap: 26,
  nameTextStyle: axisName,
};
