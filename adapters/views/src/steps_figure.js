// One measure of the gap on the months kept back, from the model as drawn through each addition.
import { mount } from "./echarts.js";
import { numberText, percentText, plainText } from "./format.js";
import { axisLabel, meterLook, rule, tooltip, valueAxis } from "./theme.js";

const labelWidth = 110;

export function drawSteps(place, data) {
  const { labels, measures } = data.steps;
  const { percent, meters } = measures[place.dataset.index];
  const text = (value) => {
    if (value === null || value === undefined) return "–";
    return percent ? percentText(value) : numberText(value);
  };
  mount(place, {
    grid: { left: 8, right: 20, top: 16, bottom: 8, containLabel: true },
    tooltip: {
      ...tooltip,
      trigger: "axis",
      formatter: (items) =>
        [
          plainText(labels[items[0].dataIndex]),
          ...meters.map(
            ({ label, values }) => `${plainText(label)} ${text(values[items[0].dataIndex])}`,
          ),
        ].join("\n"),
    },
    xAxis: {
      type: "category",
      data: labels.map(plainText),
      boundaryGap: true,
      axisTick: { show: false },
      axisLine: { lineStyle: { color: rule }, onZero: false },
      axisLabel: { ...axisLabel, interval: 0, width: labelWidth, overflow: "break", lineHeight: 16 },
    },
    yAxis: valueAxis({
      ...(percent ? { min: 0 } : {}),
      splitNumber: 4,
      axisLabel: { ...axisLabel, formatter: (v) => (percent ? percentText(v, 0) : numberText(v)) },
    }),
    series: meters.map(({ values }, i) => ({
      type: "line",
      data: values,
      ...meterLook(i),
    })),
  });
}

/** Says which line is which meter; the meters' names are data, hence textContent. */
export function writeStepKey(data) {
  const key = document.getElementById("step-key");
  if (!key) return;
  data.steps.measures[0].meters.forEach(({ label }, i) => {
    const span = document.createElement("span");
    const sign = document.createElement("i");
    sign.className = "sign";
    sign.style.color = meterLook(i).itemStyle.color;
    sign.textContent = meterLook(i).sign;
    span.append(sign, label);
    key.append(span);
  });
}
