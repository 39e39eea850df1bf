// Columns over time or frequency: chosen by buttons, zoomed together, read at the cursor.

const TIME = { label: "time [s]", name: "t [s]" };
const FREQUENCY = { label: "frequency [Hz]", name: "f [Hz]", logarithmic: true };

/** Panels over one axis of times, or of others, that zoom and read together, marked at the time of a clock, if any; `fill` adds them. */
function makePanels(times, clock, fill, axis = TIME) {
  const slot = el("div");
  const group = { axis, key: `g${(makePanels.count = (makePanels.count || 0) + 1)}`, slot, plots: [], range: null, full: [times[0], times[times.length - 1]] };
  const time = () => (clock ? clock.time : times[0]);
  group.zoom = (low, high) => {
    const [a, b] = group.full;
    const width = Math.min(Math.max(high - low, (b - a) * 1e-4), b - a);
    const start = Math.min(Math.max(low, a), b - width);
    group.range = [start, start + width];
    group.busy = true;
    for (const { plot } of group.plots) plot.setScale("x", { min: start, max: start + width });
    group.busy = false;
    group.mark();
  };
  group.mark = () => {
    for (const { plot, line } of group.plots) {
      const x = plot.valToPos(time(), "x");
      line.style.display = x >= 0 && x <= plot.over.clientWidth ? "" : "none";
      line.style.left = `${x}px`;
      // Without a pointer the figures are those of the clock.
      if (plot.cursor.left === undefined || plot.cursor.left < 0) plot.setLegend({ idx: frameAt(times, time()) });
    }
  };
  group.add = (series, height, title) => group.plots.push(onePanel(slot, group, times, series, height, title));
  group.paint = () => {
    for (const { plot } of group.plots) plot.destroy();
    group.plots = [];
    slot.replaceChildren();
    fill();
    // Once more when the plots stand: their first picture comes a moment later.
    setTimeout(group.mark, 0);
  };
  group.begin = () => {
    if (clock) clock.onTick(group.mark);
    drawn(group.paint);
  };
  return group;
}

function onePanel(host, group, times, series, height, title) {
  const most = Math.max(...series.map((s) => largest(s.values)));
  const [factor, unit] = scaledUnit(most, series[0].unit);
  const banded = series.filter((s) => s.widths && largest(s.widths) > 0);
  const clean = (values) => Array.from(values, (x) => (Number.isFinite(x) ? x / factor : null));
  const [soft, line] = [css("--soft"), css("--line")];
  const axis = { stroke: soft, grid: { stroke: line, width: 1 }, ticks: { stroke: line, width: 1 }, font: "12px ui-sans-serif, system-ui, sans-serif" };
  const holder = el("div", { class: "panel" });
  host.append(holder);
  // a change of the theme paints the panels again: colours are those of the newest
  const [index, parts] = [group.plots.length, [times, series, title, group.axis]];
  const drawing = () => panelDrawing(...group.plots[index].parts, group.range || group.full);
  const shown = (u, v) => (v === null || v === undefined ? "–" : significant(v, 5));
  const { label: xlabel, name, logarithmic } = group.axis;
  const x = { time: false, min: group.range?.[0], max: group.range?.[1], ...(logarithmic ? { distr: 3, range: (u, low, high) => [low, high] } : {}) };
  const decades = (low, high) => Array.from({ length: 40 }, (_, k) => [1, 2, 5].map((m) => m * 10 ** (k - 20))).flat().filter((v) => v >= low * 0.999 && v <= high * 1.001);
  const round = (u, k, low, high) => (high > 1e4 * low ? decades(low, high).filter((v) => Math.log10(v) % 1 === 0) : high > 5 * low ? decades(low, high) : ticks(low, high, 6));
  const minus = (u, all) => tickTexts(all, 1);
  // what is too long to stand along the axis stands in the legend below
  const heading = 6.6 * (title.length + unit.length + 3) > height - 50 ? "" : `${title} `;
  const ylabel = `${heading}${unit ? `[${unit}]` : ""}`.trim() || title.slice(0, Math.floor((height - 50) / 6.6));
  const options = {
    width: Math.max(holder.clientWidth, 240), height, cursor: { sync: { key: group.key }, drag: { x: true, y: false, uni: 20 }, points: { size: 6 } },
    legend: { live: true, markers: { dash: (u, k) => (u.series[k].dash ? "dashed" : "solid") } }, scales: { x, y: { range: (u, low, high) => bandRange(u, banded, factor, low, high) } },
    axes: [{ ...axis, ...(logarithmic ? { splits: round, filter: (u, all) => all, values: (u, all) => all.map((v) => shortest(Number(v.toPrecision(3)))) } : { values: minus }), label: xlabel, labelSize: 18, labelFont: axis.font, size: 32 }, { ...axis, values: minus, size: 62, label: ylabel, labelSize: 18, labelFont: axis.font }],
    series: [{ label: name, value: shown }, ...series.map((s) => ({ label: `${s.label}${unit && !s.words ? ` [${unit}]` : ""}`, stroke: s.colour, width: 1.6, value: s.words ? (u, v, k, at) => (at === null ? "–" : s.words(at)) : shown, points: { show: false }, dash: s.dash }))],
    hooks: { drawAxes: [(u) => banded.forEach((s) => paintBand(u, times, s, factor))], setScale: [(u, key) => key === "x" && !group.busy && group.plots.some((p) => p.plot === u) && group.zoom(u.scales.x.min, u.scales.x.max)] },
  };
  const plot = new uPlot(options, [Array.from(times), ...series.map((s) => clean(s.values))], holder);
  plot.ctx.canvas.setAttribute("role", "img");
  plot.ctx.canvas.setAttribute("aria-label", `${series.map((s) => s.label).join(", ")} over ${xlabel.replace(/ \[.*/, "")}`);
  const mark = el("div", { class: "nowline" });
  plot.over.append(mark);
  plot.over.addEventListener("dblclick", () => group.zoom(...group.full));
  holder.append(downloads(title, drawing, () => panelTable(...parts)));
  return { plot, line: mark, holder, parts };
}

/** Range of the vertical axis, with the bands that are in view. */
function bandRange(u, banded, factor, low, high) {
  if (low === null) return [null, null];
  const [from, to] = u.series[0].idxs || [0, -1];
  for (const s of banded) for (let k = from; k <= to; k++) {
    if (!Number.isFinite(s.values[k]) || !Number.isFinite(s.widths[k])) continue;
    low = Math.min(low, (s.values[k] - s.widths[k]) / factor);
    high = Math.max(high, (s.values[k] + s.widths[k]) / factor);
  }
  return uPlot.rangeNum(low, high, 0.1, true);
}

/** Shade around a curve. */
function paintBand(u, times, s, factor) {
  const { ctx, bbox } = u;
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  ctx.beginPath();
  const edge = (k, side) => Number.isFinite(s.values[k]) && Number.isFinite(s.widths[k]) && ctx.lineTo(u.valToPos(times[k], "x", true), u.valToPos((s.values[k] + side * s.widths[k]) / factor, "y", true));
  for (let k = 0; k < times.length; k++) edge(k, 1);
  for (let k = times.length - 1; k >= 0; k--) edge(k, -1);
  ctx.globalAlpha = 0.2;
  ctx.fillStyle = s.colour;
  ctx.fill();
  ctx.restore();
}

/** Values at other times, linear between; not a number outside. */
function interpolated(values, from, times) {
  let k = 0;
  return Array.from(times, (t) => {
    while (k < from.length - 1 && from[k] < t) k++;
    if (from[k] === t) return values[k];
    return k > 0 && from[k] > t ? values[k - 1] + ((values[k] - values[k - 1]) * (t - from[k - 1])) / (from[k] - from[k - 1]) : NaN;
  });
}

/** Buttons for those who do not drag. */
function zoomTools(group) {
  const by = (label, aria, change) => {
    const act = () => {
      const [a, b] = group.range || group.full;
      group.zoom(...change(a, b, b - a));
    };
    return el("button", { type: "button", "aria-label": aria, title: aria, text: label, on: { click: act } });
  };
  return el("div", { class: "toolbar", role: "group", "aria-label": "Zoom" },
    by("◀", "Earlier", (a, b, w) => [a - w / 2, b - w / 2]), by("+", "Zoom in", (a, b, w) => [a + w / 4, b - w / 4]),
    by("−", "Zoom out", (a, b, w) => [a - w / 2, b + w / 2]), by("▶", "Later", (a, b, w) => [a + w / 2, b + w / 2]),
    el("button", { type: "button", text: "Whole run", on: { click: () => group.zoom(...group.full) } }));
}

/** Columns that share a unit and a size share a panel. */
function families(columns) {
  const out = [];
  const sized = columns.map((c) => ({ ...c, size: largest(c.values) }));
  for (const column of sized) {
    const fits = (f) => f[0].unit === column.unit && f[0].group === column.group && Math.max(f[0].size, column.size) <= 25 * Math.min(f[0].size || column.size, column.size || f[0].size);
    const family = out.find(fits);
    if (family) family.push(column);
    else out.push([column]);
  }
  return out;
}

function unpackHistory(history) {
  if (!history) return null;
  const columns = history.columns.map((c) => ({ ...c, values: floats(c.values) }));
  const banded = floats(history.banded);
  for (const c of columns) if (c.widths) c.widths = interpolated(floats(c.widths), banded, columns[0].values);
  return { ...history, times: columns[0].values, columns: columns.slice(1) };
}

/** Columns chosen by buttons, at first the usual ones. */
function columnChoice(columns) {
  const names = new Set(columns.filter((c) => c.usual).map((c) => c.name));
  if (!names.size && columns.length) names.add(columns[0].name);
  const chip = (c, act) => {
    const button = el("button", { type: "button", text: c.label, title: c.about, "aria-pressed": names.has(c.name), "data-column": c.name });
    button.addEventListener("click", () => {
      if (!names.delete(c.name)) names.add(c.name);
      button.setAttribute("aria-pressed", names.has(c.name));
      act();
    });
    return button;
  };
  return { chip, chosen: () => columns.filter((c) => names.has(c.name)) };
}

function showHistories(host, history, clock) {
  const all = history.columns.filter((c) => c.values.length && largest(c.values) > 0);
  const zero = history.columns.filter((c) => !all.includes(c)).map((c) => c.label);
  const choice = columnChoice(all);
  const group = makePanels(history.times, clock, () => {
    let colour = 0;
    for (const family of families(choice.chosen())) {
      const series = family.map((c) => ({ label: c.label, unit: c.unit, values: c.values, widths: c.widths, colour: named(colour++) }));
      group.add(series, 210, family.length > 1 ? family[0].group.toLowerCase() : family[0].label);
    }
  });
  const groups = new Map();
  for (const column of all) groups.set(column.group, [...(groups.get(column.group) || []), column]);
  const chips = [...groups].map(([title, columns]) =>
    el("div", { class: "chipgroup" }, el("span", { text: title }), el("div", { class: "chips" }, columns.map((c) => choice.chip(c, group.paint)))));
  const shade = all.some((c) => c.widths) ? " The shade around a curve is its estimated error." : "";
  const card = figure(null, `Drag across a picture to look closer; a double click or Escape shows the whole run again. Below each picture stand the figures at the pointer, or at the time of the player.${shade}`, ...chips, zoomTools(group), group.slot, zero.length ? el("p", { class: "caption", text: `Zero throughout: ${zero.join(", ")}.` }) : null, history.note ? el("p", { class: "caption", text: history.note }) : null);
  card.addEventListener("keydown", (event) => event.key === "Escape" && group.zoom(...group.full));
  document.addEventListener("keydown", (event) => event.key === "Escape" && event.target === document.body && group.zoom(...group.full));
  host.append(card);
  group.begin();
}
