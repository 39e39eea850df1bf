// Colours: blue - neutral - red for signed values, and eight for names, distinguishable by readers with colour blindness.

const DIVERGING = {
  light: [[24, 74, 150], [120, 170, 220], [244, 242, 237], [238, 158, 128], [160, 22, 40]],
  dark: [[122, 184, 255], [52, 98, 160], [42, 46, 53], [168, 78, 62], [255, 148, 128]],
};

const NAMED = {
  light: ["#0072b2", "#d55e00", "#009e73", "#b3569a", "#b07c00", "#3f93c9", "#4a3aa7", "#7a7d1c"],
  dark: ["#58b0ec", "#ff9457", "#43c99d", "#e08fc6", "#e8b53d", "#92d0f5", "#a79bf5", "#c5c85a"],
};

function theme() {
  return document.documentElement.dataset.theme === "dark" ? "dark" : "light";
}

/** Red, green, blue at `s` from 0 to 1 on a scale of five colours, into `out` at `at`. */
function mixed(stops, s, out, at) {
  const x = Math.min(Math.max(s, 0), 1) * 4;
  const k = Math.min(Math.floor(x), 3);
  const w = x - k;
  for (let i = 0; i < 3; i++) out[at + i] = stops[k][i] * (1 - w) + stops[k + 1][i] * w;
}

/** Red, green, blue of a value from -1 to 1, into `out` at `at`. */
function diverging(value, out, at) {
  mixed(DIVERGING[theme()], Number.isFinite(value) ? (value + 1) / 2 : 0.5, out, at);
}

const rgbOut = [0, 0, 0];
function divergingCss(value) {
  diverging(value, rgbOut, 0);
  return `rgb(${rgbOut[0] | 0},${rgbOut[1] | 0},${rgbOut[2] | 0})`;
}

function divergingGradient() {
  return `linear-gradient(90deg, ${[-1, -0.5, 0, 0.5, 1].map(divergingCss).join(", ")})`;
}

function named(k) {
  const all = NAMED[theme()];
  return all[((k % all.length) + all.length) % all.length];
}

/** Blue to red over time, `s` from 0 to 1. */
function timeColour(s) {
  const stops = theme() === "dark"
    ? [[90, 150, 240], [130, 175, 225], [190, 190, 195], [240, 160, 130], [255, 110, 95]]
    : [[20, 60, 140], [70, 130, 200], [170, 170, 178], [225, 130, 100], [150, 20, 35]];
  mixed(stops, s, rgbOut, 0);
  return `rgb(${rgbOut.map(Math.round)})`;
}

/** End of a colour scale: the largest magnitude, or, where few values stand far out, what 98 in 100 stay below. */
function robustLimit(values) {
  const most = largest(values);
  const step = Math.max(1, Math.floor(values.length / 20000));
  const sample = [];
  for (let k = 0; k < values.length; k += step) if (Number.isFinite(values[k])) sample.push(Math.abs(values[k]));
  sample.sort((a, b) => a - b);
  const usual = sample[Math.floor(0.98 * (sample.length - 1))] || 0;
  return { limit: usual > 0 && most > 1.6 * usual ? usual : most || 1, most };
}

/** Colour bar with the values of its ends. */
function colourBar(limit, most, unit) {
  const strip = el("i");
  drawn(() => (strip.style.background = divergingGradient()));
  const beyond = most > 1.001 * limit ? ` and beyond (up to ${quantity(most, unit)})` : "";
  return el("div", { class: "bar" }, el("span", { text: quantity(-limit, unit) }), strip, el("span", { text: `${quantity(limit, unit)}${beyond}` }));
}
