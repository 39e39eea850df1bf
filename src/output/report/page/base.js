"use strict";
// Base of the page: data, elements, readable numbers, sections.

const data = JSON.parse(document.getElementById("data").textContent);
const calm = matchMedia("(prefers-reduced-motion: reduce)");

/** An element; `props` are attributes, `text` its text, `on` its listeners. Texts are never markup. */
function el(tag, props = {}, ...children) {
  const node = document.createElement(tag);
  return dress(node, props, children);
}

/** The same for a drawing. */
function svg(tag, props = {}, ...children) {
  const node = document.createElementNS("http://www.w3.org/2000/svg", tag);
  return dress(node, props, children);
}

function dress(node, props, children) {
  for (const [key, value] of Object.entries(props)) {
    if (value === null || value === undefined || (value === false && !key.startsWith("aria-"))) continue;
    if (key === "text") node.textContent = value;
    else if (key === "on") for (const [name, act] of Object.entries(value)) node.addEventListener(name, act);
    else if (key === "style") node.style.cssText = value;
    else node.setAttribute(key, value === true && !key.startsWith("aria-") ? "" : value);
  }
  node.append(...children.flat().filter((c) => c !== null && c !== undefined && c !== false));
  return node;
}

/** Base64 of little-endian single precision. */
function floats(text) {
  if (!text) return null;
  const raw = atob(text);
  const bytes = new Uint8Array(raw.length);
  for (let k = 0; k < raw.length; k++) bytes[k] = raw.charCodeAt(k);
  return new Float32Array(bytes.buffer);
}

function largest(values) {
  let most = 0;
  for (let k = 0; k < values.length; k++) {
    const x = Math.abs(values[k]);
    if (x > most && x < Infinity) most = x;
  }
  return most;
}

function extent(values, from = [Infinity, -Infinity]) {
  let [low, high] = from;
  for (let k = 0; k < values.length; k++) {
    const x = values[k];
    if (x < low) low = x;
    if (x > high && x < Infinity) high = x;
  }
  return [low, high];
}

const PREFIXED = new Set(["m", "s", "Pa", "J", "W", "N", "N m", "Hz", "rad", "m/s"]);
const PREFIXES = ["p", "n", "µ", "m", "", "k", "M", "G"];
const RAISED = "⁰¹²³⁴⁵⁶⁷⁸⁹";

function raised(text) {
  return String(text).replace("-", "⁻").replace(/\d/g, (d) => RAISED[d]);
}

/** `m^3/s` as `m³/s`; nothing for `1`. */
function prettyUnit(unit) {
  return unit === "1" ? "" : String(unit).replace(/\^(-?\d+)/g, (_, n) => raised(n));
}

/** Factor and unit in which a magnitude reads as 1 to 1000. */
function scaledUnit(magnitude, unit) {
  const size = Math.abs(magnitude);
  // as the words of the drawing write volumes and flows
  if (unit === "m^3" || unit === "m^3/s") return size < 1e-5 || !(size < Infinity) ? [1e-9, unit.replace("m^3", "µl")] : [1e-6, unit.replace("m^3", "ml")];
  let power = size > 0 && size < Infinity ? Math.floor(Math.log10(size) / 3 + 1e-12) : 0;
  if (PREFIXED.has(unit)) {
    power = Math.min(Math.max(power, -4), unit === "s" || unit === "rad" ? 0 : 3);
    return [10 ** (3 * power), PREFIXES[power + 4] + unit];
  }
  if (size === 0 || (size >= 0.1 && size < 1e4)) power = 0;
  const name = prettyUnit(unit);
  return [10 ** (3 * power), power === 0 ? name : `·10${raised(3 * power)} ${name}`.trim()];
}

function significant(value, digits = 3) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const power = Math.floor(Math.log10(Math.abs(value)));
  const text = power >= -3 && power < 6
    ? value.toFixed(Math.max(0, digits - 1 - power))
    : value.toExponential(digits - 1).replace(/e\+?(-?\d+)/, (_, n) => `·10${raised(n)}`);
  return text.replace("-", "−");
}

/** `12.3 mm`, `−4.07 kPa`; a dash where there is none. */
function quantity(value, unit, digits = 3) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  if (Math.abs(value) < 1e-30) value = 0;
  const [factor, name] = scaledUnit(value, unit);
  const number = significant(value / factor, digits);
  return name.startsWith("·") ? number + name : `${number} ${name}`.trim();
}

/** Zero for what is only round-off beside `size`. */
function settled(value, size) {
  return Math.abs(value) < 1e-12 * size ? 0 : value;
}

/** A time without the zeros behind its point. */
function timeText(t) {
  const [number, unit] = quantity(t, "s", 4).split(" ");
  return `${number.includes(".") ? number.replace(/\.?0+$/, "") : number} ${unit || "s"}`;
}

function count(n) {
  return String(n).replace(/\B(?=(\d{3})+$)/g, " ");
}

/** Value of a colour or other custom property in the present theme. */
const cssKept = new Map();
function css(name) {
  // Asked for every bladder of every frame.
  if (!cssKept.has(name)) cssKept.set(name, getComputedStyle(document.documentElement).getPropertyValue(name).trim());
  return cssKept.get(name);
}

/** Draws a figure, now and whenever the theme or the width of the page changes. */
const redraws = [];
function drawn(draw) {
  redraws.push(draw);
  draw();
}
function redraw() {
  cssKept.clear();
  for (const draw of redraws) draw();
}

/** Text whose parts between backticks are code. */
function prose(text) {
  return String(text).split("`").map((part, k) => (k % 2 ? el("code", { text: part }) : part));
}

/** A file of the folder: a link where the page lies in it, else its name. */
function fileLink(name) {
  return data.elsewhere ? el("code", { text: name }) : el("a", { href: encodeURIComponent(name), text: name });
}

const contents = [];

/** A section with title and one sentence; it is listed among the contents. */
function section(id, title, lead, into = document.getElementById("main")) {
  const body = el("section", { id, "aria-labelledby": `${id}-title` }, el("h2", { id: `${id}-title`, text: title }));
  if (lead) body.append(el("p", { class: "lead", text: lead }));
  into.append(body);
  contents.push([id, title]);
  return body;
}

/** The section of charts and pictures. */
function answerSection() {
  return document.getElementById("answer") || section("answer", "The picture", null);
}

/** A card with a title and a sentence below. */
function figure(title, caption, ...inside) {
  const head = title ? el("h3", { text: title }) : null;
  return el("div", { class: "figure" }, head, ...inside, caption ? el("p", { class: "caption", text: caption }) : null);
}

/** A canvas sharp on every screen: calls `draw(context, width, height)` in CSS pixels. */
function painted(canvas, height, draw) {
  const width = Math.max(canvas.clientWidth, 40);
  const ratio = Math.min(window.devicePixelRatio || 1, 2);
  const [w, h] = [Math.round(width * ratio), Math.round(height * ratio)];
  if (canvas.width !== w || canvas.height !== h) {
    canvas.width = w;
    canvas.height = h;
    canvas.style.height = `${height}px`;
  }
  const context = canvas.getContext("2d");
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, width, height);
  canvas.shown = { draw, width, height };
  draw(context, width, height);
}

function copyButton(label, text) {
  const button = el("button", { type: "button", text: label });
  button.addEventListener("click", async () => {
    let done = false;
    try {
      await navigator.clipboard.writeText(text);
      done = true;
    } catch {
      // Without a clipboard, as in some browsers for local files, the old way.
      const area = el("textarea", { style: "position:fixed;left:-99px" });
      area.value = text;
      document.body.append(area);
      area.select();
      done = document.execCommand("copy");
      area.remove();
      button.focus();
    }
    button.textContent = done ? "Copied" : "Select and copy by hand";
    setTimeout(() => (button.textContent = label), 1600);
  });
  return button;
}
