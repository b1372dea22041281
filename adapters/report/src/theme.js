// Colours and shapes. Hues after Okabe and Ito, told apart by every common kind of colour vision;
// no meaning rests on colour alone, so each comes with a shape or a pattern of its own.
export const ink = "#1d2733";
export const mutedInk = "#55606e";
export const rule = "#c9d0d8";
export const grid = "#e6eaee";
export const validationGround = "#f1f5f9";
export const modelFill = "#a9cde4";
export const modelLine = "#0b5f95";
export const limit = "#a33c00";
export const different = "#b34700";
export const missing = "#dde1e6";
export const missingLine = "#7b8591";
export const suspectLine = "#a33c00";

// Light to dark in even steps (ColorBrewer YlGnBu); no grey, which is kept for gaps.
export const loadColours = [
  "#edf8b1",
  "#c7e9b4",
  "#7fcdbb",
  "#41b6c4",
  "#1d91c0",
  "#225ea8",
  "#0c2c84",
];

export const star =
  "path://M12 .6l3.3 7.4 8.1.8-6.1 5.3 1.8 7.9L12 17.9l-7.1 4.1 1.8-7.9L.6 8.8l8.1-.8z";

// The parts of the electricity profile: colour and pattern by place in the stack.
export const parts = [
  { color: "#7a8793", decal: { symbol: "none" } },
  {
    color: "#f0b93a",
    decal: {
      symbol: "rect",
      dashArrayX: [1, 0],
      dashArrayY: [2, 5],
      rotation: -Math.PI / 4,
      color: "rgba(0,0,0,.35)",
    },
  },
  {
    color: "#4ba3d6",
    decal: {
      symbol: "circle",
      dashArrayX: [
        [7, 7],
        [0, 7, 7, 0],
      ],
      dashArrayY: [7, 0],
      symbolSize: 0.6,
      color: "rgba(0,0,0,.4)",
    },
  },
  {
    color: "#2f9e7d",
    decal: {
      symbol: "rect",
      dashArrayX: [1, 0],
      dashArrayY: [1, 5],
      rotation: Math.PI / 2,
      color: "rgba(255,255,255,.75)",
    },
  },
  {
    color: "#b98bc9",
    decal: {
      symbol: "rect",
      dashArrayX: [1, 0],
      dashArrayY: [2, 6],
      rotation: Math.PI / 2,
      color: "rgba(0,0,0,.3)",
    },
  },
];

export const part = (index) => parts[index % parts.length];

// Names and sentences of the site are shown as they are, never as markup: rich text, not HTML.
export const tooltip = {
  renderMode: "richText",
  confine: true,
  backgroundColor: "#ffffff",
  borderColor: mutedInk,
  borderWidth: 1,
  padding: [7, 10],
  textStyle: { color: ink, fontSize: 12.5, lineHeight: 18 },
};

export const axisLabel = { color: mutedInk, fontSize: 12 };
export const axisName = { color: mutedInk, fontSize: 12 };

export function valueAxis(more) {
  return {
    type: "value",
    axisLabel,
    nameTextStyle: axisName,
    axisLine: { show: false },
    axisTick: { show: false },
    splitLine: { lineStyle: { color: grid } },
    ...more,
  };
}
