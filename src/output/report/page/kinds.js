// Content of the page for each kind of result, between title and case.

/** The cell of the section under its loads. */
function showCell() {
  if (!data.cell?.length) return;
  const body = section("cell", "The section under its loads", "One pitch of the beam from the side, as its coefficients are computed: at rest in grey, deformed in colour. Displacements are linear in the loads and are drawn magnified by the factor given.");
  body.append(el("div", { class: "grid4" }, ...data.cell.map((part) => pictureCard({ ...part, rows: () => [["along [m]", "high [m]", "displacement along [m]", "displacement high [m]"], rowsOf(floats(part.nodes), 4)] }))));
}

/** Numbers in rows of equal length. */
function rowsOf(numbers, length) {
  return Array.from({ length: numbers.length / length }, (_, k) => numbers.subarray(k * length, (k + 1) * length));
}

/** Uncertainty of the figures from uncertain numbers. */
function showUncertainty() {
  const part = data.uncertainty;
  if (!part) return;
  const body = section("uncertainty", "Uncertainty of the figures", part.about);
  for (const note of part.notes) body.append(el("p", { class: "answer", text: note }));
  for (const table of part.tables) body.append(tableCard(table));
}

/** The drawing with its texts; `describe` returns the text of a bladder. */
function showScene(describe) {
  const scene = data.scene;
  if (!scene) return null;
  const half = scene.bladders?.per_row;
  const there = half ? scene.bladders.present.filter(Boolean).length : 0;
  const plural = (n) => `${n} bladder${n === 1 ? "" : "s"}`;
  const size = there === 2 * half && half && !scene.beams ? `${plural(half)} in each of two rows` : there ? plural(there) : "no bladders";
  const body = section("scene", "Structure", `${scene.beams ? "" : "A beam "}${scene.size}, seen from the side, with ${size}.`);
  const host = el("div");
  const readout = el("div", { class: "readout dim", "aria-live": "polite", text: half ? "Point at a bladder or a tube, or move among bladders with the arrow keys." : "" });
  const legend = el("ul", { class: "legend" });
  const note = el("p", { class: "caption" });
  const card = figure(null, null, host, half ? readout : null, legend, note);
  const parts = half ? ` ${scene.bladders.outlines ? "Outlines" : "Rectangles"} are bladders, which lie across the beam; lines are tubes, which join their ends in front and behind.` : "";
  const scale = (thicker) => (note.textContent = `${thicker > 1.01 ? `To scale along the beam${scene.beams ? "s" : ""}; its height is drawn ${shortest(thicker)} times larger.` : "To scale."} ${scene.beams ? "z to the right, x up; bladders are numbered along each beam. Dots are rigid joints, open circles hinges, squares elastic joints and sliders." : "Root on the left, tip on the right."}${parts}`);
  body.append(card);
  const drawing = drawScene(scene, host, readout, describe || ((b, layout) => bladderWords(b, layout, scene)), scale);
  const bladders = () => drawing.layout.bladders.filter((b) => !b.absent).map((b) => [labelText(b.label), b.row > 0 ? "upper" : "lower", b.network + 1, b.a, b.e, b.size[0], b.size[1]]);
  const table = half ? () => [["bladder", "row", "network", "place along [m]", "place across [m]", "width [m]", "height [m]"], bladders()] : null;
  card.append(downloads("Structure", () => host.querySelector("svg"), table));
  drawn(() => legend.replaceChildren(...sceneWords(scene, drawing.layout).map(([mark, strong, text]) => el("li", {}, mark, el("span", {}, el("b", { text: strong }), ` ${text}`)))));
  return drawing;
}

function bladderWords(b, layout, scene) {
  const k = layout.colourOf(b.network);
  const where = k >= 0 ? `network ${k + 1}` : "joined to no other bladder";
  if (b.absent) return `No bladder ${labelText(b.label)}.`;
  return `Bladder ${labelText(b.label)} (${b.row > 0 ? "upper" : "lower"} row): ${where}; ${scene.bladders.volumes ? scene.bladders.volumes[b.index % scene.bladders.per_row][b.row > 0 ? 0 : 1] : scene.bladders.volume} at rest.`;
}

/** Rows of the legend: mark, strong words, words. */
function sceneWords(scene, layout) {
  const swatch = (inside) => svg("svg", { viewBox: "0 0 26 14", "aria-hidden": "true" }, inside);
  const line = (colour, dash) => swatch(svg("path", { d: "M1 7H25", style: `stroke:${colour};stroke-width:3;stroke-linecap:round`, "stroke-dasharray": dash || null }));
  const out = [];
  const list = (bladders) => {
    const labels = bladders.map((b) => labelText(layout.bladders[b].label));
    return labels.length > 12 ? `${labels.slice(0, 5).join(" ")} … ${labels.slice(-3).join(" ")} (${labels.length})` : labels.join(" ");
  };
  const plain = { sealed: "sealed", connected: "joined to other parts" };
  if (scene.bladders) {
    (scene.wiring.chains || []).slice(0, 12).forEach((chain, c) => {
      const ends = chain.ends.map((e) => plain[e.kind] || e.words);
      const both = ends[0] === ends[1] ? `both ends ${ends[0]}` : `first end ${ends[0]}, last end ${ends[1]}`;
      out.push([line(wireColour(layout.colourOf(layout.bladders[chain.bladders[0]].network))), `Chain ${c + 1}`, `bladders ${list(chain.bladders)}; ${both}${chain.valve ? `; ${chain.valve}` : ""}`]);
    });
    const single = layout.shown.filter((b) => layout.colourOf(b.network) < 0).map((b) => b.index);
    if (single.length) out.push([line(wireColour(-1)), "Single bladders", list(single)]);
    for (const wire of layout.wires.filter((w) => w.free).slice(0, 10)) out.push([line(wireColour(wire.colour)), "Tube", wire.words.replace(/^Tube /, "")]);
    for (const wire of layout.wires.filter((w) => w.turbine).slice(0, 10)) out.push([line(wireColour(-2), "2 5"), "Turbine", wire.words.replace(/^Turbine /, "")]);
    for (const mark of layout.marks.filter((m) => m.letter).slice(0, 16)) {
      const shape = mark.kind === "pressure" ? svg("circle", { cx: 13, cy: 7, r: 5.5, style: `fill:none;stroke:${wireColour(mark.colour)};stroke-width:2` }) : svg("path", { d: "M7 12H19L13 2Z", style: `fill:none;stroke:${wireColour(mark.colour)};stroke-width:2` });
      out.push([swatch(shape), `${mark.kind === "accumulator" ? "Accumulator" : "Port"} ${mark.letter}`, `${mark.name ? `“${mark.name}” ` : ""}at ${mark.where}: ${mark.words}`]);
    }
  }
  const wall = swatch(svg("path", { d: "M13 0V14", style: `stroke:${css("--faint")};stroke-width:4` }));
  const push = swatch(arrow(3, 7, 23, 7, css("--accent"), false));
  const shake = swatch(arrow(3, 7, 23, 7, css("--accent"), true));
  endsOf(scene).forEach((end, k) => {
    if (end.form === "joined") return;
    const which = scene.beams ? `${scene.beams[Math.floor(k / 2)].name} ${end.tip ? "tip" : "root"}` : k === 0 ? "Root" : "Tip";
    const forms = { clamped: "clamped", pinned: "pinned, free to turn", free: "free", guided: "guided: its slope is held", conditions: "held as given in the case" };
    out.push([wall.cloneNode(true), which, forms[end.form] || end.form]);
    for (const [key, words] of [["across", "moved across"], ["along", "moved along the beam"], ["slope", "turned"]]) if (end.moves[key]) out.push([shake.cloneNode(true), which, `${words}: ${end.moves[key]}`]);
    for (const [key, words] of [["across", "force across"], ["along", "force along"]]) if (end.force[key]) out.push([push.cloneNode(true), which, `${words}: ${end.force[key].words}`]);
    if (end.moment) out.push([push.cloneNode(true), which, `moment: ${end.moment}`]);
    if (end.follower) out.push([push.cloneNode(true), which, `forces that turn with it, ${end.follower}`]);
  });
  const circle = swatch(svg("circle", { cx: 13, cy: 7, r: 5.5, style: `fill:none;stroke:${css("--faint")};stroke-width:3` }));
  for (const one of scene.obstacles || []) out.push(one.center ? [circle.cloneNode(true), "Circle", one.words] : [wall.cloneNode(true), "Wall", one.words]);
  for (const joint of (scene.joints || []).slice(0, 16)) out.push([swatch(jointMark(joint, 13, 7, 4.5)), "Joint", joint.words]);
  for (const load of scene.loads) out.push([push.cloneNode(true), "Load", load.words]);
  for (const beam of scene.beams || []) for (const load of beam.loads) out.push([push.cloneNode(true), `Load on ${beam.name}`, load.words]);
  return out;
}

function showRun() {
  const motion = unpackMotion(data.motion);
  const history = unpackHistory(data.history);
  const scene = data.scene;
  let clock = null;
  if (motion && scene) {
    if (motion.placed) motion.beams = fieldsOfBeams(motion, scene);
    clock = makeClock(motion.times, motion.frequency_hz ? 1 / motion.frequency_hz : null);
  }
  const describe = (b, layout) => {
    let text = bladderWords(b, layout, scene);
    if (motion?.ofBladder) {
      const own = Array.from({ length: motion.frames }, (_, f) => motion.ofBladder[f * motion.bladders + b.index]);
      const [low, high] = extent(own);
      const shown = (p) => quantity(settled(p, motion.pressureScale.most), "Pa");
      text += ` Pressure now ${shown(own[clock.index])}; least ${shown(low)}, largest ${shown(high)}.`;
    }
    return text;
  };
  const drawing = showScene(describe);
  if (clock) {
    const body = section("motion", "Motion", "Press play, drag the slider, or use the space bar and the arrow keys (with Shift: ten steps). Everything below follows the same time.");
    const notes = [];
    if (motion.frames < motion.recorded) notes.push(`${count(motion.recorded)} instants were recorded; ${count(motion.frames)} of them are shown.`);
    if (motion.nodes < motion.nodes_recorded) notes.push(`Of ${count(motion.nodes_recorded)} nodes ${count(motion.nodes)} are shown.`);
    const inCycle = motion.frequency_hz ? (motion.frames - 1) / (motion.times.at(-1) - motion.times[0]) / motion.frequency_hz : Infinity;
    if (inCycle < 12) notes.push(`A cycle of the drive holds about ${shortest(Math.round(inCycle * 10) / 10)} of the instants shown; motion between them is not visible.`);
    const host = el("div", { class: "figure" });
    body.append(host);
    showAnimation(host, scene, motion, clock);
    if (notes.length) host.append(el("p", { class: "caption", text: notes.join(" ") }));
    const tip = motion.nodes - 1;
    body.append(player(clock, (c) => {
      const tips = motion.beams?.slice(0, 3).flatMap((beam) => [[`${beam.name} tip u₁`, motion.u1], [`${beam.name} tip u₃`, motion.u3]].map(([label, values]) => [label, quantity(settled(values[c.index * motion.nodes + beam.tip], scene.length), "m")]));
      const all = tips ? [["time", quantity(c.time, "s", 4)], ...tips] : [["time", quantity(c.time, "s", 4)], ["tip across", quantity(settled(motion.u1[c.index * motion.nodes + tip], scene.length), "m")], ["tip along", quantity(settled(motion.u3[c.index * motion.nodes + tip], scene.length), "m")]];
      if (motion.pressure) {
        const now = motion.pressure.subarray(c.index * motion.cells, (c.index + 1) * motion.cells);
        const [low, high] = extent(now.filter((_, cell) => !motion.present || motion.present[cell]));
        all.push(["pressure", `${quantity(settled(low, motion.pressureScale.most), "Pa")} to ${quantity(settled(high, motion.pressureScale.most), "Pa")}`]);
      }
      return all;
    }));
    clock.onTick(() => !clock.playing && drawing.again());
    body.append(el("div", { class: "grid2", id: "profiles" }));
    showProfiles(body.lastChild, motion, clock, scene);
    if (motion.frames > 1) {
      body.append(el("div", { class: "grid2", id: "maps" }));
      showMaps(body.lastChild, motion, clock, scene);
    }
  }
  const within = document.getElementById("motion") || document.getElementById("main");
  if (history) {
    const part = section("histories", "Over time", "Every recorded quantity at every output time.", within);
    showHistories(part, history, clock);
  }
  if (data.ledger) {
    const part = section("energy", "Energy balance", "The equations conserve energy, so the balance must close.", within);
    showLedger(part, data.ledger, history, clock);
  }
  for (const part of data.sections || []) {
    const body = section("cycle", part.title, null);
    body.append(el("p", { class: "answer", text: part.text }), tableCard(part.table));
  }
  if (clock) clock.go(firstInstant(motion, scene));
}

/** The instant shown first: that of the largest values in the last cycle, or in the whole run. */
function firstInstant(motion, scene) {
  const wet = motion.ofBladder && !motion.whole;
  const n = wet ? motion.bladders : motion.nodes;
  const values = wet ? motion.ofBladder : (largest(motion.u1) > 1e-9 * scene.length ? motion.u1 : motion.u3);
  let best = [-1, 0];
  for (let f = motion.cycle[0]; f <= motion.cycle.at(-1); f++) {
    const size = largest(values.subarray(f * n, (f + 1) * n));
    if (size > best[0]) best = [size, f];
  }
  return best[1];
}

function showMany() {
  showCharts();
  for (const part of data.figures || []) {
    const card = pictureCard(part);
    if (card) answerSection().append(card);
  }
  if (data.overlay) showOverlay(data.overlay);
  if (data.table) section("table", data.table.title, null).append(tableCard({ ...data.table, title: null, name: data.table.title }));
  (data.tables || []).forEach((table, k) => section(`table-${k + 1}`, table.title, null).append(tableCard({ ...table, title: null, name: table.title })));
  if (data.scene) showScene();
}
