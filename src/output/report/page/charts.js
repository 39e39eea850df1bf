// Charts of many runs: marks that are read with pointer or keys, bars that are put in order, histories of several runs.

/** Round values from `a` to `b`, two at least: each with its logarithm and a text with enough digits. */
function roundMarks(a, b, count, unit) {
  const least = (b - a) / Math.max(count, 5);
  const power = 10 ** Math.floor(Math.log10(least));
  const step = [1, 2, 5, 10].map((m) => m * power).find((s) => s >= least * (1 - 1e-9));
  const [factor, shown] = unit ? scaledUnit(b, unit) : [1, ""];
  const digits = Math.floor(Math.log10(b)) - Math.floor(Math.log10(step) + 1e-9) + 1;
  const all = [];
  for (let k = Math.ceil(a / step - 1e-9); k * step <= b * (1 + 1e-12); k++) all.push([Math.log10(k * step), `${Number(((k * step) / factor).toPrecision(digits))} ${shown}`.trim()]);
  return all;
}

/** Marks of an axis of decimal logarithms: decades, or 1, 2 and 5 of each where there are few; two at least. */
function logMarks(low, high, count, unit) {
  const power = (v) => {
    const n = Math.floor(Math.log10(v) + 1e-9);
    const digit = Math.round(v / 10 ** n);
    return digit === 1 ? `10${raised(n)}` : `${digit}·10${raised(n)}`;
  };
  const text = (v) => (unit ? shortest(v / scaledUnit(v, unit)[0]) + ` ${scaledUnit(v, unit)[1]}` : power(v));
  const within = (v) => v >= low - 1e-9 && v <= high + 1e-9;
  const every = Math.max(1, Math.ceil((high - low) / Math.max(count, 1)));
  let all = [];
  for (let n = Math.ceil(low - 1e-9); n <= high + 1e-9; n++) if (n % every === 0) all.push(n);
  if (all.length < 2) {
    all = [];
    for (let n = Math.floor(low); n <= high; n++) for (const m of [1, 2, 5]) all.push(n + Math.log10(m));
    all = all.filter(within);
  }
  if (all.length < 2) return roundMarks(10 ** low, 10 ** high, count, unit);
  return all.map((v) => [v, text(10 ** v)]);
}

/** Marks over two axes, logarithmic unless `linear`; those of a series are switched by its button, the nearest is read out. */
function showMarks(part) {
  const off = new Set();
  const slot = el("div", { class: "chart", tabindex: "0", role: "group", "data-keys": "" });
  const readout = el("div", { class: "readout dim", "aria-live": "polite", text: "Point at a mark, or go through them with the arrow keys." });
  const place = part.linear ? (v) => v : Math.log10;
  const points = () => part.series.flatMap((s, k) => (off.has(k) ? [] : s.points.map(([x, y, words]) => ({ x: place(x), y: place(y), words, series: k }))));
  let [plot, ring, at] = [null, null, -1];
  const mark = (k) => {
    const all = points();
    if (!all.length) return;
    at = (k + all.length) % all.length;
    const one = all[at];
    readout.textContent = one.words;
    readout.classList.remove("dim");
    ring.setAttribute("cx", plot.px(one.x));
    ring.setAttribute("cy", plot.py(one.y));
    ring.style.display = "";
  };
  const draw = () => {
    const all = points();
    const range = (values) => {
      const [low, high] = values.length ? extent(values) : [-1, 1];
      const room = part.linear ? 0.03 * (high - low || 1) : Math.max(0.06 * (high - low), 0.12);
      return [low - room, high + room];
    };
    const [x0, x1] = range(all.map((p) => p.x));
    const [y0, y1] = range(all.map((p) => p.y));
    const width = Math.max(slot.clientWidth, 240);
    const height = Math.min(440, Math.max(280, 0.62 * width));
    const axis = (a, low, high, count) => {
      const unit = a.unit === "1" ? "" : a.unit;
      return part.linear ? { low, high, unit, name: a.name } : { low, high, unit: "", name: a.name, marks: logMarks(low, high, count, unit) };
    };
    const label = `${part.title}: ${part.y.name} over ${part.x.name}, ${all.length} marks`;
    slot.setAttribute("aria-label", `${label}. Arrow keys go through them.`);
    plot = chart(width, height, axis(part.x, x0, x1, Math.floor(width / 90)), axis(part.y, y0, y1, 6), label);
    const limit = part.limit && part.limit.at > 0 ? Math.min(Math.log10(part.limit.at), x1) : -Infinity;
    if (limit > x0) plot.area.append(svg("rect", { x: plot.px(x0), y: 0, width: plot.px(limit) - plot.px(x0), height, style: `fill:${css("--track")}` }));
    for (const [from, to] of part.shades || []) plot.area.append(svg("rect", { x: plot.px(from), y: 0, width: plot.px(to) - plot.px(from), height, style: `fill:${css("--track")}` }));
    const path = (list, style, dash) => plot.area.append(svg("path", { d: linePath(list.length, (i) => [plot.px(list[i].x), plot.py(list[i].y)]), style: `fill:none;${style}`, "stroke-dasharray": dash || null }));
    const front = (part.front || []).map(([x, y]) => ({ x: Math.log10(x), y: Math.log10(y) }));
    path(front, `stroke:${css("--line")};stroke-width:9;stroke-linejoin:round`);
    part.series.forEach((s, k) => {
      if (off.has(k)) return;
      const own = all.filter((p) => p.series === k);
      const colour = named(s.colour);
      if (part.dots) return own.forEach((p) => plot.area.append(svg("circle", { cx: plot.px(p.x), cy: plot.py(p.y), r: 1.8, style: `fill:${colour}` })));
      path(own, `stroke:${colour};stroke-width:1.5`, s.dash);
      own.forEach((p, i) => plot.area.append(svg("circle", { cx: plot.px(p.x), cy: plot.py(p.y), r: 4.5, style: `stroke:${colour};stroke-width:2;fill:${s.points[i][3] ? colour : css("--card")}` })));
    });
    ring = svg("circle", { r: 9, style: `fill:none;stroke:${css("--ink")};stroke-width:1.6;display:none` });
    plot.area.append(ring);
    slot.replaceChildren(plot.node);
    if (at >= 0) mark(Math.min(at, all.length - 1));
  };
  slot.addEventListener("pointermove", (event) => {
    const box = plot.node.getBoundingClientRect();
    const [x, y] = [event.clientX - box.left, event.clientY - box.top];
    const far = points().map((p) => Math.hypot(plot.px(p.x) - x, plot.py(p.y) - y));
    const near = far.indexOf(Math.min(...far));
    if (far[near] < 40) mark(near);
  });
  slot.addEventListener("keydown", (event) => {
    const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
    if (!step) return;
    event.preventDefault();
    mark(at < 0 && step < 0 ? -1 : at + step);
  });
  const chips = part.series.map((s, k) => {
    const button = el("button", { type: "button", "aria-pressed": true }, el("i", { class: "swatch" }), s.name);
    drawn(() => (button.firstChild.style.background = named(s.colour)));
    button.addEventListener("click", () => {
      if (!off.delete(k)) off.add(k);
      button.setAttribute("aria-pressed", !off.has(k));
      at = -1;
      draw();
    });
    return button;
  });
  const card = figure(part.title, part.about, el("div", { class: "chips", role: "group", "aria-label": "Series" }, chips), slot, readout);
  const shown = () => part.series.flatMap((s, k) => (off.has(k) ? [] : [{ label: s.name, colour: named(s.colour), dash: s.dash?.split?.(" ") }]));
  const rows = () => part.series.flatMap((s) => s.points.map(([x, y, words]) => [s.name, x, y, words]));
  card.append(downloads(part.title, () => withLegend(slot.querySelector("svg").cloneNode(true), shown()), () => [["series", withUnit(part.x.name, part.x.unit), withUnit(part.y.name, part.y.unit), "remark"], rows()]));
  return { card, draw };
}

/** Bars over a logarithmic scale, an entry a line, put in order by buttons. */
function showBars(part) {
  const sizes = part.rows.flatMap((r) => [r.value, r.ring]).filter((x) => x > 0);
  const [least, most] = extent(sizes.map(Math.log10), [Math.log10(part.limit.at), Math.log10(part.limit.at)]);
  const [low, high] = [Math.floor(least - 0.2), Math.max(Math.ceil(most), 0)];
  const share = (v) => `${(100 * Math.min(Math.max((Math.log10(v) - low) / (high - low), 0), 1)).toFixed(2)}%`;
  const percent = (v) => (v === null || v === undefined ? "failed" : v > 0 ? `${shortest(Number((100 * v).toPrecision(2)))} %` : "nothing");
  const line = (r) => el("li", {},
    el("b", { text: r.name }),
    el("div", { class: "track", "aria-hidden": "true" },
      r.value > 0 ? el("i", { class: `fill ${r.tone}`, style: `width:${share(r.value)}` }) : null,
      r.ring > 0 ? el("i", { class: "ringed", style: `left:${share(r.ring)}` }) : null,
      el("i", { class: "limit", style: `left:${share(part.limit.at)}` })),
    el("span", { class: "figures", text: percent(r.value) }),
    el("span", { class: "words", text: r.words }));
  const list = el("ul", { class: "bars", "aria-label": part.title });
  const orders = [["As listed", null], ["Largest change first", (r) => -(r.ring ?? r.value ?? -1)], ["Most work saved first", (r) => r.work ?? Infinity]];
  const buttons = orders.map(([text, key], k) => el("button", { type: "button", text, "aria-pressed": k === 0, on: { click: () => {
    buttons.forEach((b, i) => b.setAttribute("aria-pressed", i === k));
    list.replaceChildren(...(key ? [...part.rows].sort((a, b) => key(a) - key(b)) : part.rows).map(line));
  } } }));
  list.replaceChildren(...part.rows.map(line));
  const scale = el("div", { class: "barscale", "aria-hidden": "true" }, logMarks(low, high, 4, "").map(([v, text]) => el("span", { style: `left:${(100 * (v - low)) / (high - low)}%`, text })));
  const card = figure(part.title, part.about, el("div", { class: "chips", role: "group", "aria-label": "Order" }, buttons), list, scale);
  const drawing = () => {
    const x = { low, high, unit: "", name: "share", marks: logMarks(low, high, 4, "") };
    const height = 24 * part.rows.length + 60;
    const marks = part.rows.map((r, k) => [part.rows.length - k - 0.5, r.name]);
    const plot = chart(640, height, x, { low: 0, high: part.rows.length, unit: "", name: "", marks }, part.title, 170);
    const at = (v) => plot.px(Math.min(Math.max(Math.log10(v), low), high));
    part.rows.forEach((r, k) => {
      const y = plot.py(part.rows.length - k - 0.5);
      if (r.value > 0) plot.area.append(svg("rect", { x: plot.px(low), y: y - 6, width: at(r.value) - plot.px(low), height: 12, style: `fill:${named(0)}` }));
      if (r.ring > 0) plot.area.append(svg("circle", { cx: at(r.ring), cy: y, r: 4.5, style: `fill:none;stroke:${css("--ink")};stroke-width:1.5` }));
    });
    plot.area.append(svg("path", { d: `M${at(part.limit.at)} 0V${height}`, "stroke-dasharray": "3 4", style: `stroke:${css("--faint")}` }));
    return plot.node;
  };
  card.append(downloads(part.title, drawing, () => [["name", "change [1]", "estimate [1]", "remark"], part.rows.map((r) => [r.name, r.value, r.ring, r.words])]));
  return { card, draw: null };
}

/** Dash patterns of lines that share a colour: with eight colours, forty lines are distinguishable. */
const DASHES = [null, [8, 4], [2, 3], [12, 3, 2, 3], [5, 2, 1, 2, 1, 2]];

/** Histories of several runs over each other: a panel for each quantity that is chosen. */
function showOverlay(part) {
  const body = section("histories", "Over time", "The runs over each other; quantities are chosen by their buttons.");
  const times = floats(part.times);
  const all = part.quantities.map((q) => ({ ...q, runs: q.values.map(floats) }));
  const choice = columnChoice(all);
  const group = makePanels(times, null, () => {
    for (const q of choice.chosen()) {
      group.add(q.runs.map((values, k) => ({ label: part.runs[k], unit: q.unit, values, colour: named(k), dash: DASHES[Math.floor(k / 8) % DASHES.length] })), 230, q.label);
    }
  });
  const chips = all.map((q) => choice.chip(q, group.paint));
  body.append(figure(null, part.note, el("div", { class: "chips", role: "group", "aria-label": "Quantities" }, chips), zoomTools(group), group.slot));
  group.begin();
}

function showCharts() {
  for (const part of data.charts || []) {
    const { card, draw } = part.kind === "bars" ? showBars(part) : showMarks(part);
    answerSection().append(card);
    if (draw) drawn(draw);
  }
}
