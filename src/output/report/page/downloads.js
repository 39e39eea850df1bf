// Downloads of pictures: each as an SVG that stands alone, in the colours of the light theme, and its data as CSV with names and units.

/** Text of a cell: numbers with the digits of single precision; no text is a formula of a spreadsheet. */
function csvCell(x) {
  if (x === null || x === undefined || (typeof x === "number" && !Number.isFinite(x))) return "";
  if (typeof x === "number") return String(Number(x.toPrecision(8)));
  const text = /^[=+\-@]/.test(x) && Number.isNaN(Number(x)) ? `'${x}` : String(x);
  return /[",\n]/.test(text) ? `"${text.replace(/"/g, '""')}"` : text;
}

function csvText(headings, rows) {
  return [headings, ...rows].map((row) => Array.from(row, csvCell).join(",") + "\n").join("");
}

/** A heading: `tip u₁ [m]`. */
function withUnit(name, unit) {
  return /\]$/.test(name) ? name : `${name} [${unit || "1"}]`;
}

function save(name, ending, type, text) {
  const url = URL.createObjectURL(new Blob([text], { type }));
  const plain = `${data.name} ${name}`.replace(/[₀-₉]/g, (d) => "₀₁₂₃₄₅₆₇₈₉".indexOf(d)).toLowerCase().replace(/[^\p{L}\p{N}]+/gu, "-").replace(/^-|-$/g, "");
  const link = el("a", { href: url, download: `${plain}.${ending}` });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(url), 10000);
}

/** Result of `act` in the light theme: paper is white. */
function inLight(act) {
  const now = theme();
  if (now === "light") return act();
  const set = (to) => ((document.documentElement.dataset.theme = to), redraw());
  set("light");
  try {
    return act();
  } finally {
    set(now);
  }
}

/** Buttons below a picture: `picture()` returns its drawing, `table()` its headings and rows. */
function downloads(name, picture, table) {
  const button = (kind, make) => el("button", { type: "button", class: "small", text: kind, "aria-label": `Download ${name} as ${kind}`, title: `Download ${name} as ${kind}`, on: { click: make } });
  return el("div", { class: "downloads", role: "group", "aria-label": `Download ${name}` },
    button("SVG", () => save(name, "svg", "image/svg+xml", inLight(() => standalone(picture())))),
    table ? button("CSV", () => save(name, "csv", "text/csv", csvText(...table()))) : null);
}

const STYLES = { fill: "rgb(0, 0, 0)", stroke: "none", "stroke-width": "1px", "stroke-dasharray": "none", "stroke-linecap": "butt", "stroke-linejoin": "miter", "fill-opacity": "1", "stroke-opacity": "1", opacity: "1", "text-anchor": "start" };
const LETTERS = { "font-size": "16px", "font-weight": "400" };
const SANS = "Helvetica, Arial, Liberation Sans, DejaVu Sans, sans-serif";

/** A colour as programs for drawings read it. */
function plainColour(text) {
  const parts = /^color\(srgb ([\d.]+) ([\d.]+) ([\d.]+)/.exec(text);
  return parts ? `rgb(${parts.slice(1).map((x) => Math.round(255 * x)).join(", ")})` : text;
}

/** Text of a drawing whose styles are attributes, on white. */
function standalone(source) {
  const shown = source.isConnected;
  // styles are computed for what stands in the page only
  if (!shown) document.getElementById("main").append(source);
  const copy = source.cloneNode(true);
  const pairs = [[source, copy]];
  const own = source.querySelectorAll("*");
  copy.querySelectorAll("*").forEach((node, k) => pairs.push([own[k], node]));
  const box = source.viewBox.baseVal;
  const size = box.width ? [box.x, box.y, box.width, box.height] : [0, 0, source.clientWidth, source.clientHeight];
  for (const [from, to] of pairs) {
    const style = getComputedStyle(from);
    if (style.display === "none" && from !== source) {
      to.remove();
      continue;
    }
    for (const [name, usual] of Object.entries(from.localName === "text" ? { ...STYLES, ...LETTERS } : STYLES)) {
      const value = style.getPropertyValue(name);
      if (value && value !== usual) to.setAttribute(name, plainColour(value));
      else to.removeAttribute(name);
    }
    for (const { name } of [...to.attributes]) if (/^(class|style|tabindex|role|data-|aria-)/.test(name)) to.removeAttribute(name);
  }
  if (!shown) source.remove();
  for (const [name, value] of [["xmlns", "http://www.w3.org/2000/svg"], ["width", size[2]], ["height", size[3]], ["viewBox", size.join(" ")], ["font-family", SANS]]) copy.setAttribute(name, value);
  copy.prepend(svg("rect", { x: size[0], y: size[1], width: size[2], height: size[3], fill: "#ffffff" }));
  return new XMLSerializer().serializeToString(copy);
}

/** Drawing of a panel of histories with its legend; `x` is the axis of times or frequencies, `range` the visible part. */
function panelDrawing(times, series, title, { label, logarithmic }, range) {
  const [, xname, xunit] = /^(.*) \[(.*)\]$/.exec(label);
  const place = logarithmic ? Math.log10 : (v) => v;
  const [from, to] = range;
  const inside = Array.from(times, (t) => t >= from && t <= to);
  let limits = [Infinity, -Infinity];
  for (const s of series) for (const side of [-1, 1]) limits = extent(Array.from(s.values, (v, k) => (inside[k] ? v + side * (s.widths?.[k] || 0) : NaN)), limits);
  const [low, high] = roomy(limits);
  const x = { low: place(from), high: place(to), unit: xunit, name: xname };
  if (logarithmic) Object.assign(x, { unit: "", name: label, marks: x.high - x.low < 1 ? roundMarks(from, to, 6, "") : logMarks(x.low, x.high, 6, "").map(([v]) => [v, shortest(Number((10 ** v).toPrecision(3)))]) });
  const unit = series[0].unit || /\[(.*)\]$/.exec(title)?.[1] || "1";
  const plot = chart(640, 300, x, { low, high, unit, name: title.replace(/ \[.*\]$/, "") }, title);
  const at = (k, v) => [plot.px(place(times[k])), plot.py(v)];
  for (const s of series.filter((s) => s.widths)) {
    const known = [...times.keys()].filter((k) => inside[k] && Number.isFinite(s.values[k]) && Number.isFinite(s.widths[k]));
    const edge = (list, side) => list.map((k) => at(k, s.values[k] + side * s.widths[k]).map((p) => p.toFixed(2)).join(" "));
    if (known.length) plot.area.append(svg("path", { d: `M${[...edge(known, 1), ...edge(known.reverse(), -1)].join("L")}Z`, style: `fill:${s.colour};fill-opacity:0.2` }));
  }
  for (const s of series) plot.area.append(svg("path", { d: linePath(times.length, (k) => (inside[k] ? at(k, s.values[k]) : [NaN, NaN])), style: `fill:none;stroke:${s.colour};stroke-width:1.6`, "stroke-dasharray": s.dash?.join(" ") || null }));
  return series.length > 1 ? withLegend(plot.node, series) : plot.node;
}

/** The drawing with names and samples of its series above. */
function withLegend(node, series) {
  const [, , width, height] = node.getAttribute("viewBox").split(" ").map(Number);
  const above = 18 * series.length + 6;
  series.forEach((s, k) => {
    const y = 18 * k + 12 - above;
    node.append(svg("path", { d: `M62 ${y}H90`, style: `fill:none;stroke:${s.colour};stroke-width:1.8`, "stroke-dasharray": s.dash?.join(" ") || null }), svg("text", { x: 98, y: y + 4, text: s.label }));
  });
  node.setAttribute("viewBox", `0 ${-above} ${width} ${height + above}`);
  node.setAttribute("height", height + above);
  return node;
}

/** Data of a panel: abscissa, curves, half widths of their error bands. */
function panelTable(times, series, title, { name }) {
  const unit = /\[(.*)\]$/.exec(title)?.[1];
  const columns = series.flatMap((s) => [[withUnit(s.label, s.unit || unit), s.values], ...(s.widths ? [[withUnit(`error of ${s.label}`, s.unit), s.widths]] : [])]);
  return [[name, ...columns.map((c) => c[0])], Array.from(times, (t, k) => [t, ...columns.map((c) => c[1][k])])];
}

/** Places and colours of cells over time as areas, a colour an area. */
function mapDrawing(map, motion, scale) {
  const [t0, t1] = [motion.times[0], motion.times[motion.frames - 1]];
  const plot = chart(640, 260, { low: t0, high: t1, unit: "s", name: "time" }, { low: 0, high: map.rows, unit: "1", name: map.title, marks: [[0, map.low], [map.rows, map.high]] }, map.title);
  const columns = Math.min(motion.frames, 400);
  const frame = (c) => Math.round((c * (motion.frames - 1)) / Math.max(columns - 1, 1));
  // the last place stands in the middle of its cell, at the end of the axis half of it
  const edge = (c) => plot.px(c <= 0 ? t0 : c >= columns ? t1 : (motion.times[frame(c - 1)] + motion.times[frame(c)]) / 2).toFixed(2);
  const areas = new Map();
  const level = (f, k) => Math.round(24 * Math.min(Math.max(map.at(f, k) / scale.limit, -1), 1)) / 24;
  for (let k = 0; k < map.rows; k++) for (let c = 0, end; c < columns; c = end) {
    const value = level(frame(c), k);
    for (end = c + 1; end < columns && level(frame(end), k) === value; ) end++;
    const text = `M${edge(c)} ${plot.py(k).toFixed(2)}H${edge(end)}V${plot.py(k + 1).toFixed(2)}H${edge(c)}Z`;
    areas.set(value, (areas.get(value) || "") + text);
  }
  for (const [value, d] of areas) plot.area.append(svg("path", { d, style: `fill:${divergingCss(value)};stroke:${divergingCss(value)};stroke-width:0.3` }));
  for (let k = 0; k < 24; k++) plot.node.append(svg("rect", { x: 150 + 8 * k, y: -16, width: 8, height: 10, style: `fill:${divergingCss((k - 11.5) / 11.5)}` }));
  plot.node.append(svg("text", { x: 144, y: -7, "text-anchor": "end", text: quantity(-scale.limit, map.unit) }), svg("text", { x: 348, y: -7, text: quantity(scale.limit, map.unit) }));
  plot.node.setAttribute("viewBox", "0 -22 640 282");
  return plot.node;
}

/** A context of a canvas that writes paths instead of pixels. */
function vectorContext(width, height) {
  const node = svg("svg", { class: "fig", width, height, viewBox: `0 0 ${width} ${height}` });
  let path = "";
  const put = (letter, ...numbers) => (path += letter + numbers.map((x) => Number(x.toFixed(2))).join(" "));
  const shape = (style) => node.append(svg("path", { d: path, style }));
  const arc = (x, y, a, b, from, to) => {
    // two halves, so that a full turn has a direction
    const at = (angle) => [x + a * Math.cos(angle), y + b * Math.sin(angle)];
    put(path && !path.endsWith("Z") ? "L" : "M", ...at(from));
    for (const angle of [(from + to) / 2, to]) put("A", a, b, 0, 0, to > from ? 1 : 0, ...at(angle));
  };
  const own = {
    node, fillStyle: "#000", strokeStyle: "#000", lineWidth: 1, globalAlpha: 1, lineCap: "butt", lineJoin: "miter", dash: [], kept: [],
    save: () => own.kept.push({ ...own, kept: null }),
    restore: () => Object.assign(own, { ...own.kept.pop(), kept: own.kept }),
    setTransform: () => {}, clip: () => {}, drawImage: () => {},
    setLineDash: (dash) => (own.dash = dash),
    beginPath: () => (path = ""), closePath: () => (path += "Z"),
    moveTo: (x, y) => put("M", x, y), lineTo: (x, y) => put(path ? "L" : "M", x, y),
    rect: (x, y, w, h) => (put("M", x, y), put("H", x + w), put("V", y + h), put("H", x), own.closePath()),
    arc: (x, y, r, from, to) => arc(x, y, r, r, from, to),
    ellipse: (x, y, a, b, turn, from, to) => arc(x, y, a, b, from, to),
    fill: () => shape(`fill:${own.fillStyle};fill-opacity:${own.globalAlpha}`),
    stroke: () => shape(`fill:none;stroke:${own.strokeStyle};stroke-width:${own.lineWidth};stroke-opacity:${own.globalAlpha};stroke-linecap:${own.lineCap};stroke-linejoin:${own.lineJoin}${own.dash.length ? `;stroke-dasharray:${own.dash.join(" ")}` : ""}`),
  };
  return own;
}

/** Drawing of what a canvas shows. */
function canvasDrawing(canvas) {
  const { draw, width, height } = canvas.shown;
  const context = vectorContext(width, height);
  draw(context, width, height);
  return context.node;
}
