// A small chart as a drawing: axes with round numbers, lines, marks.

/** Round numbers between two values, about `count` of them. */
function ticks(low, high, count) {
  const raw = (high - low) / Math.max(count, 1);
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 2.5, 5, 10].map((m) => m * power).find((s) => s >= raw * 0.999) || 10 * power;
  const all = [];
  for (let x = Math.ceil(low / step - 1e-9) * step; x <= high + 1e-9 * step; x += step) all.push(Math.abs(x) < 1e-9 * step ? 0 : x);
  return all;
}

/** Numbers at ticks, all with the same places behind the point. */
function tickTexts(all, factor) {
  const step = all.length > 1 ? Math.abs(all[1] - all[0]) / factor : Math.abs(all[0] || 1) / factor;
  let places = 0;
  while (places < 6 && Math.abs(step * 10 ** places - Math.round(step * 10 ** places)) > 1e-6) places++;
  return all.map((x) => (x / factor).toFixed(places).replace("-", "−"));
}

/**
 * A chart of given height. `x` and `y` are {low, high, unit, name}, with `marks` of [value, text] where these are not round numbers; returns {node, place(x, y), area, clear()} whose
 * `area` takes what is drawn within the frame.
 */
function chart(width, height, x, y, label, left = 62) {
  const box = { left, right: 16, top: 12, bottom: 44 };
  const node = svg("svg", { class: "fig", width, height, viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": label });
  const [w, h] = [width - box.left - box.right, height - box.top - box.bottom];
  const room = (a) => (a.high > a.low ? a.high - a.low : 1);
  const px = (v) => box.left + ((v - x.low) / room(x)) * w;
  const py = (v) => box.top + h - ((v - y.low) / room(y)) * h;
  const [fx, ux] = scaledUnit(Math.max(Math.abs(x.low), Math.abs(x.high)), x.unit);
  const [fy, uy] = scaledUnit(Math.max(Math.abs(y.low), Math.abs(y.high)), y.unit);
  const marks = (a, factor, count) => {
    if (a.marks) return a.marks;
    // a single mark shows no scale
    let all = [];
    for (let more = 0; all.length < 2 && more < 8; more++) all = ticks(a.low, a.high, Math.max(2, count) + more);
    return tickTexts(all, factor).map((text, k) => [all[k], text]);
  };
  for (const [v, text] of marks(x, fx, Math.floor(w / 90))) {
    node.append(svg("line", { class: "axis", x1: px(v), x2: px(v), y1: box.top, y2: box.top + h }));
    node.append(svg("text", { x: px(v), y: box.top + h + 17, "text-anchor": "middle", text }));
  }
  for (const [v, text] of marks(y, fy, Math.floor(h / 44))) {
    node.append(svg("line", { class: "axis", x1: box.left, x2: box.left + w, y1: py(v), y2: py(v) }));
    node.append(svg("text", { x: box.left - 8, y: py(v) + 4, "text-anchor": "end", text }));
  }
  const unitOf = (u) => (u ? ` [${u}]` : "");
  node.append(svg("text", { x: box.left + w / 2, y: height - 6, "text-anchor": "middle", text: `${x.name}${unitOf(ux)}` }));
  node.append(svg("text", { transform: `translate(13 ${box.top + h / 2}) rotate(-90)`, "text-anchor": "middle", text: `${y.name}${unitOf(uy)}` }));
  const clip = `clip-${(chart.count = (chart.count || 0) + 1)}`;
  node.append(svg("clipPath", { id: clip }, svg("rect", { x: box.left, y: box.top - 2, width: w, height: h + 4 })));
  const area = svg("g", { "clip-path": `url(#${clip})` });
  node.append(area, svg("rect", { class: "axis", fill: "none", x: box.left, y: box.top, width: w, height: h }));
  return { node, area, px, py };
}

/** Outline through points; breaks where a value is not a number or `gap(k)` is true. */
function linePath(count, at, gap) {
  let text = "";
  let pen = false;
  for (let k = 0; k < count; k++) {
    const [x, y] = at(k);
    if (!Number.isFinite(x) || !Number.isFinite(y) || (gap && gap(k))) pen = false;
    if (!Number.isFinite(x) || !Number.isFinite(y)) continue;
    text += `${pen ? "L" : "M"}${x.toFixed(2)} ${y.toFixed(2)}`;
    pen = true;
  }
  return text;
}

/** A range with some room on both sides, around zero when all is zero. */
function roomy([low, high], floor) {
  if (!(high >= low)) return [-1, 1];
  const middle = (low + high) / 2;
  const half = Math.max((high - low) / 2, floor || 0, Math.abs(middle) * 1e-9) * 1.06;
  return half > 0 ? [middle - half, middle + half] : [middle - 1, middle + 1];
}
