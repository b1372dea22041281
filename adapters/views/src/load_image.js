// The load of a year as a picture, one pixel an hour, stretched to its panel.
import { hourIndex } from "./load_calendar.js";
import { loadColours } from "./theme.js";

/** 256 colours as [red, green, blue], evenly between those of the theme. */
const palette = Array.from({ length: 256 }, (_, i) => {
  const at = (i / 255) * (loadColours.length - 1);
  const below = Math.min(Math.floor(at), loadColours.length - 2);
  const channel = (hex, k) => parseInt(hex.slice(1 + 2 * k, 3 + 2 * k), 16);
  return [0, 1, 2].map((k) => {
    const [low, high] = [channel(loadColours[below], k), channel(loadColours[below + 1], k)];
    return Math.round(low + (high - low) * (at - below));
  });
});

/** One pixel an hour, clear where there is no value to trust. */
export function yearImage(load, year, top) {
  const canvas = document.createElement("canvas");
  canvas.width = year.labels.length;
  canvas.height = 24;
  const context = canvas.getContext("2d");
  const pixels = context.createImageData(canvas.width, canvas.height);
  for (let day = 0; day < canvas.width; day++) {
    for (let hour = 0; hour < 24; hour++) {
      const i = hourIndex(load, year, day, hour);
      if (i < 0 || load.kW[i] === null || !"op".includes(load.status[i])) continue;
      const shade = Math.round(255 * Math.min(Math.max(load.kW[i] / top, 0), 1));
      pixels.data.set([...palette[shade], 255], 4 * (hour * canvas.width + day));
    }
  }
  context.putImageData(pixels, 0, 0);
  return canvas;
}

/** The picture at a panel's size, doubled for sharp screens, with no blur between hours. */
export function stretched(image, width, height) {
  const canvas = document.createElement("canvas");
  canvas.width = Math.round(2 * width);
  canvas.height = Math.round(2 * height);
  const context = canvas.getContext("2d");
  context.imageSmoothingEnabled = false;
  context.drawImage(image, 0, 0, canvas.width, canvas.height);
  return canvas;
}
