// Colours and shapes. Hues after Okabe and Ito, told apart by every common kind of colour vision;
// no meaning rests on colour alone, so each comes with a shape or a pattern of its own.
//
// Colours are the style sheet's variables, which a drawing passes on as they are: it follows a light
// page, a dark one and paper without being drawn anew. Only pictures and scales have fixed ones.
export const page = "var(--page)";
export const ink = "var(--ink)";
export const mutedInk = "var(--muted)";
export const rule = "var(--axis)";
export const grid = "var(--grid)";
export const validationGround = "var(--ground)";
export const modelFill = "var(--model-fill)";
export const modelLine = "var(--model-line)";
export const limit = "var(--limit)";
export const different = "var(--different)";
export const missing = "var(--missing)";
export const missingLine = "var(--missing-line)";
export const suspectLine = "var(--suspect-line)";

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

// Less than the model, none, more than it (ColorBrewer's blue and orange ends): light in the middle.
export const residualColours = ["#08519c", "#6baed6", "#f5f5f2", "#fd8d3c", "#a63603"];
export const chooseMark = "var(--muted)";

/** Colour of a share of the full scale, −1 to 1; beyond that it stays full. */
export function residualColour(share) {
  const at = ((Math.min(Math.max(share, -1), 1) + 1) / 2) * (residualColours.length - 1);
  const below = Math.min(Math.floor(at), residualColours.length - 2);
  const channels = [1, 3, 5].map((k) => {
    const [low, high] = [below, below + 1].map((i) =>
      parseInt(residualColours[i].slice(k, k + 2), 16),
    );
    return Math.round(low + (high - low) * (at - below));
  });
  return `rgb(${channels.join(",")})`;
}

// Effects are full bars; what is no effect is pale or striped, so that it is not taken for one.
export const candidateLooks = {
  effect: { color: modelLine },
  none: { color: grid, borderColor: mutedInk, borderWidth: 1.2 },
  unknown: {
    color: grid,
    borderColor: mutedInk,
    borderWidth: 1.2,
    decal: {
      symbol: "rect",
      dashArrayX: [1, 0],
      dashArrayY: [2, 4],
      rotation: Math.PI / 4,
      color: mutedInk,
    },
  },
};

// Meters as lines: colour, shape and dash together. `sign` is the shape in the key.
const meterLooks = [
  { color: "var(--line-0)", symbol: "circle", type: "solid", sign: "●" },
  { color: "var(--line-1)", symbol: "diamond", type: [7, 3], sign: "◆" },
  { color: "var(--line-2)", symbol: "triangle", type: [2, 3], sign: "▲" },
  { color: "var(--line-3)", symbol: "rect", type: [8, 3, 2, 3], sign: "■" },
];

export function meterLook(index) {
  const { color, symbol, type, sign } = meterLooks[index % meterLooks.length];
  return {
    symbol,
    sign,
    symbolSize: 9,
    itemStyle: { color },
    lineStyle: { color, type, width: 2 },
  };
}

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
  backgroundColor: page,
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
