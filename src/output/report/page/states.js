// Pages with a beam that is not in time: states along a load path, shapes of modes.

/** The static states under growing loads. */
function showPath() {
  const shapes = data.shapes;
  const path = data.path;
  const scene = data.scene;
  if (shapes && scene) {
    const [theta, x, z] = [floats(shapes.theta), floats(shapes.x), floats(shapes.z)];
    const n = theta.length;
    const states = shapes.states;
    const share = states.map((s) => path?.rows?.[s]?.[0] ?? 0);
    const body = section("path", "The states along the path", "From rest to the end, all loads grow together. Move the slider to walk along.");
    const canvas = el("canvas", { role: "img", "aria-label": "The beam in its state" });
    const slider = el("input", { type: "range", min: 0, max: states.length - 1, step: 1, value: states.length - 1, "aria-label": "State along the path", id: "state" });
    const words = el("div", { class: "readout", id: "state-words" });
    const layout = layOut(scene);
    const nodes = placeNodes(shapes.placed, scene);
    const moved = (values, rest) => Float64Array.from(values, (value, k) => value - rest[k % n]);
    // Displacements of a structure are along the axes of the case.
    const [up, right] = nodes ? [moved(x, nodes.x), moved(z, nodes.z)] : [null, null];
    const fixed = nodes && { ...nodes, angle: new Float64Array(n) };
    const size = nodes ? Math.max(largest(up), largest(right)) : largest(x);
    const factor = { across: roundFactor(size, scene.length), along: 1 };
    if (nodes) factor.along = factor.across;
    const bounds = straightBounds(scene);
    if (nodes) up.forEach((across, k) => widen(bounds, nodes.z[k % n] + right[k] * factor.along, nodes.x[k % n] + across * factor.across));
    else x.forEach((across, k) => widen(bounds, z[k], across * factor.across));
    bounds.y0 -= 0.8 * scene.height;
    bounds.y1 += 0.8 * scene.height;
    const curve = (s) => {
      if (nodes) return structureCurve(fixed, up.subarray(s * n, (s + 1) * n), right.subarray(s * n, (s + 1) * n), factor, null);
      const u3 = new Float64Array(n);
      for (let k = 0; k < n; k++) u3[k] = z[s * n + k] - theta[k];
      return curveOf(theta, x.subarray(s * n, (s + 1) * n), u3, factor);
    };
    const note = factor.across === 1 ? "To scale, nothing exaggerated." : `${nodes ? "Displacements" : "Deflection across"} drawn ${count(factor.across)} times larger.`;
    body.append(figure(null, `${note} The faint shade is where the other states of the path lie.`, canvas, el("div", { class: "controls" }, el("label", { style: "flex:1 1 200px" }, "State", slider)), words));
    slider.style.flex = "1 1 auto";
    const state = () => Array.from(theta, (place, k) => [place, x[Number(slider.value) * n + k], z[Number(slider.value) * n + k]]);
    canvas.after(downloads("The state", () => canvasDrawing(canvas), () => [["theta [m]", "x [m]", "z [m]"], state()]));
    const columns = (path?.headings || []).map((h) => /^(.*) \[(.*)\]$/.exec(h)).map((m) => (m ? [m[1], m[2]] : null));
    const paint = () => {
      const view = viewOf(Math.max(canvas.clientWidth, 260), bounds, 460);
      const now = Number(slider.value);
      painted(canvas, view.height, (ctx) => {
        ctx.fillStyle = css("--faint");
        ctx.globalAlpha = 0.05;
        const every = Math.max(1, Math.floor(states.length / 60));
        for (let s = 0; s < states.length; s += every) paintShade(ctx, view, curve(s), scene);
        ctx.globalAlpha = 1;
        paintBeam(ctx, view, curve(now), scene, layout, null);
      });
      const row = path?.rows?.[states[now]] || [];
      const ways = row[columns.findIndex((c) => c && c[0] === "unstable_modes")];
      const verdict = ways === 0 ? "stable" : ways > 0 ? `unstable in ${ways} way${ways === 1 ? "" : "s"}` : "stability unknown";
      const parts = columns.map((c, k) => (c && c[0] in data.headlines && typeof row[k] === "number" ? `${data.headlines[c[0]]} ${quantity(row[k], c[1])}` : null)).filter(Boolean);
      words.textContent = `${shortest(100 * share[now])} % of the loads · ${parts.join(" · ")} · ${verdict}`;
      for (const act of follow) act(states[now]);
    };
    const follow = [];
    slider.addEventListener("input", paint);
    loadCurves(body, path, columns, follow);
    drawn(paint);
  }
  showEvents();
  if (path) section("table", "Every state", null).append(tableCard({ ...path, title: null, name: "Every state", about: "The first column is the load factor; the last counts the ways in which the state gives way (0: stable)." }));
  if (scene) showScene();
}

/** Displacements and pressure over the load factor, with a mark at the present state. */
function loadCurves(body, path, columns, follow) {
  const grid = el("div", { class: "grid2" });
  body.append(grid);
  for (const [name, title] of Object.entries(data.headlines)) {
    const k = columns.findIndex((c) => c && c[0] === name);
    if (k < 0) continue;
    const values = path.rows.map((r) => (typeof r[k] === "number" ? r[k] : NaN));
    if (!(largest(values) > 1e-12)) continue;
    const share = path.rows.map((r) => r[0]);
    const slot = el("div");
    grid.append(figure(title, `At the end of the path ${quantity(values.at(-1), columns[k][1])}. The ring is the state shown above.${data.events?.length ? " Dashed: where something happens on the way." : ""}`, slot, downloads(`${title} over load factor`, () => slot.querySelector("svg"), () => [["load_factor [1]", withUnit(name, columns[k][1])], share.map((s, i) => [s, values[i]])])));
    let mark = null;
    let plot = null;
    let at = path.rows.length - 1;
    const move = () => {
      if (!plot || !(at in share)) return;
      mark.setAttribute("cx", plot.px(share[at]));
      mark.setAttribute("cy", plot.py(values[at]));
    };
    const draw = () => {
      const [low, high] = roomy(extent(values));
      const [x0, x1] = roomy(extent(share));
      plot = chart(Math.max(slot.clientWidth, 260), 240, { low: x0, high: x1, unit: "1", name: "load factor" }, { low, high, unit: columns[k][1], name: title }, title);
      plot.area.append(svg("path", { d: linePath(values.length, (i) => [plot.px(share[i]), plot.py(values[i])]), style: `fill:none;stroke:${css("--accent")};stroke-width:2.2` }));
      for (const e of data.events || []) {
        const x = plot.px(e.load_factor);
        plot.area.append(svg("line", { x1: x, x2: x, y1: 0, y2: 240, "stroke-dasharray": "3 4", style: `stroke:${css("--faint")}` }));
      }
      mark = svg("circle", { r: 6, style: `fill:${css("--card")};stroke:${css("--accent")};stroke-width:2.6` });
      plot.area.append(mark);
      slot.replaceChildren(plot.node);
      move();
    };
    follow.push((s) => ((at = s), move()));
    drawn(draw);
  }
}

function showEvents() {
  const events = data.events || [];
  const slopes = Object.entries(data.derivatives || {});
  if (events.length) {
    const body = section("events", "Events", null);
    body.append(figure(null, null, el("ul", {}, events.map((e) => el("li", { text: `At ${significant(100 * e.load_factor, 4)} % of the loads: ${e.what}` })))));
  }
  if (!slopes.length) return;
  const rows = slopes.flatMap(([pointer, s]) => Object.entries(s.derivatives).map(([name, d]) => [pointer, name, d, 0.01 * d * s.value]));
  section("derivatives", "Sensitivities: change of the figure per 1 %", null).append(tableCard({ headings: ["number of the case", "quantity", "derivative", "change for 1 % more"], rows, about: "Derivatives of the last state." }));
}

/** Shapes of small motions, moving. `one` has the name of a shape, `texts` of the list (null: not in it), the `first` shape, and of each its words and if it oscillates. Returns a function that chooses a shape. */
function movingShapes(body, shapes, one) {
  const get = (name) => floats(shapes[name]);
  const theta = get("theta_m");
  const nodes = placeNodes(shapes.placed, data.scene);
  // Without the case only the line of the beam is known.
  const scene = data.scene || { length: theta.at(-1), height: 0.06 * theta.at(-1), ends: [], loads: [], bladders: null };
  const n = theta.length;
  const layout = layOut(scene);
  const [a1, f1, a3, f3, ap, fp] = ["u1_amplitude_m", "u1_phase_rad", "u3_amplitude_m", "u3_phase_rad", "pressure_amplitude_pa", "pressure_phase_rad"].map(get);
  const select = el("select", { "aria-label": one.name, id: one.name.toLowerCase() }, one.texts.map((text, k) => text && el("option", { value: k, text, selected: k === one.first })));
  const canvas = el("canvas", { role: "img", "aria-label": `The moving shape: ${one.name.toLowerCase()}` });
  const words = el("p", { class: "caption" });
  let phase = 0;
  let playing = !calm.matches;
  const button = showPlaying(el("button", { type: "button", class: "main" }), playing);
  const slider = el("input", { type: "range", min: 0, max: 100, value: 0, "aria-label": "Phase", style: "flex:1 1 160px", "data-keys": "" });
  body.append(figure(null, null, el("div", { class: "controls" }, el("label", {}, one.name, select), button, slider), canvas, words));
  const table = () => {
    const k = Number(select.value);
    const columns = [["u1 amplitude [m]", a1], ["u1 phase [rad]", f1], ["u3 amplitude [m]", a3], ["u3 phase [rad]", f3]];
    return [["theta [m]", ...columns.map((c) => c[0])], Array.from(theta, (place, i) => [place, ...columns.map((c) => c[1][k * n + i])])];
  };
  canvas.after(downloads(`Moving shape, ${one.name.toLowerCase()}`, () => canvasDrawing(canvas), table));
  const bounds = straightBounds(scene);
  const reach = nodes ? 0.13 * Math.max(bounds.x1 - bounds.x0, bounds.y1 - bounds.y0) : 0.13 * scene.length;
  bounds.x0 -= nodes ? reach + 0.6 * scene.height : 0.02 * scene.length;
  bounds.x1 += nodes ? reach + 0.6 * scene.height : 0.05 * scene.length;
  bounds.y0 -= reach + 0.6 * scene.height;
  bounds.y1 += reach + 0.6 * scene.height;
  const paint = () => {
    const k = Number(select.value);
    const part = (values, count) => values.subarray(k * count, (k + 1) * count);
    const size = Math.max(largest(part(a1, n)), largest(part(a3, n)), 1e-300);
    const factor = (0.11 * (nodes ? reach / 0.13 : scene.length)) / size;
    const oscillates = one.oscillates(k);
    // Modes that decay without oscillation are also drawn oscillating, to show their shape.
    const at = (a, f, i) => a[i] * Math.cos(2 * Math.PI * phase + (oscillates ? f[i] : Math.cos(f[i]) < 0 ? Math.PI : 0));
    const [u1, u3] = [new Float64Array(n), new Float64Array(n)];
    for (let i = 0; i < n; i++) {
      u1[i] = at(part(a1, n), part(f1, n), i);
      u3[i] = at(part(a3, n), part(f3, n), i);
    }
    const view = viewOf(Math.max(canvas.clientWidth, 260), bounds, 420);
    const per = shapes.bladders || 0;
    const most = ap ? largest(part(ap, per)) : 0;
    const pressure = most > 0 ? (b) => at(part(ap, per), part(fp, per), b) / most : null;
    painted(canvas, view.height, (ctx) => paintBeam(ctx, view, curveOf(theta, u1, u3, { across: factor, along: factor }, null, nodes), scene, layout, pressure));
    slider.value = Math.round(100 * phase);
    words.textContent = `${one.words(k, size, most)}${pressure ? " Bladders are coloured by their pressure: red and blue are opposite." : ""}`;
  };
  let before = null;
  const frame = (now) => {
    if (playing) {
      if (before !== null) phase = (phase + Math.min(now - before, 100) / 2400) % 1;
      before = now;
      paint();
      requestAnimationFrame(frame);
    }
  };
  const play = (on) => {
    playing = on;
    before = null;
    showPlaying(button, on);
    if (on) requestAnimationFrame(frame);
  };
  const chosen = () => (one.follow?.(Number(select.value)), paint());
  button.addEventListener("click", () => play(!playing));
  select.addEventListener("change", chosen);
  slider.addEventListener("input", () => (play(false), (phase = Number(slider.value) / 100), paint()));
  document.addEventListener("keydown", (event) => {
    if (event.key !== " " || event.target.closest("button, select, summary, a, input, [data-keys]")) return;
    event.preventDefault();
    play(!playing);
  });
  drawn(paint);
  if (playing) requestAnimationFrame(frame);
  return (k) => ((select.value = k), chosen());
}

/** Shapes of modes. */
function showModes() {
  const { shapes } = data;
  const modes = shapes ? data.modes.slice(0, shapes.most) : data.modes;
  if (shapes && modes?.length) {
    const body = section("shapes", "Mode shapes", "Every small motion is a sum of these. Amplitudes are drawn as large as can be seen; what counts is the shape, and where the pressure is.");
    const name = (m, k) => `${k + 1} · ${m.kind}${m.frequency_hz ? ` ${quantity(m.frequency_hz, "Hz", 4)}` : m.time_s ? `, ${quantity(m.time_s, "s")}` : ""}`;
    const facts = (m) => [m.frequency_hz ? `swings at ${quantity(m.frequency_hz, "Hz", 5)}` : "does not swing", m.damping_ratio ? `damping ratio ${significant(m.damping_ratio, 3)}` : null, m.growth_per_s < 0 ? `dies away within ${quantity(m.time_s, "s")}` : m.growth_per_s > 0 ? `grows at ${significant(m.growth_per_s, 3)} per second` : null].filter(Boolean);
    movingShapes(body, shapes, {
      name: "Mode",
      texts: modes.map((m, k) => (["rigid", "volume"].includes(m.kind) ? null : name(m, k))),
      first: Math.max(modes.findIndex((m) => m.kind === "oscillation" || m.kind === "flutter"), 0),
      oscillates: (k) => Boolean(modes[k].frequency_hz),
      words: (k) => `Mode ${k + 1} ${facts(modes[k]).join(", ")}.`,
    });
  }
  if (data.passivity) document.getElementById("main").append(figure("Passivity of the coupling", data.passivity));
  if (data.table) section("table", "Every mode", null).append(tableCard({ ...data.table, title: null, name: data.table.title, about: "Undrained: the same shape with every bladder sealed. Drained: with one pressure in each network. The growth rate is negative where the motion dies away." }));
  const shapesTable = () => {
    const values = (name) => floats(shapes[name]);
    const theta = values("theta_m");
    const parts = ["u1_amplitude_m", "u1_phase_rad", "u3_amplitude_m", "u3_phase_rad"].map((name) => [name, values(name)]);
    const columns = data.modes.slice(0, shapes.most).flatMap((_, m) => parts.map(([name, of]) => [`mode ${m + 1} ${name.replace(/_(m|rad)$/, " [$1]").replace("_", " ")}`, of, m]));
    return [["theta [m]", ...columns.map((c) => c[0])], Array.from(theta, (place, i) => [place, ...columns.map(([, of, m]) => of[m * theta.length + i])])];
  };
  if (data.picture) section("picture", "All shapes at once", null).append(pictureCard({ picture: data.picture, rows: shapes && shapesTable, title: null, about: "Displacement along the beam of every mode, with the pressures of the bladders." }));
  if (data.scene) showScene();
}

/** Amplitude and phase over frequency, read at the pointer, and the motion of the beam at chosen frequencies. */
function showResponse() {
  const { curves, shapes } = data;
  const hz = floats(curves.hz);
  const clock = { time: hz[0], ticks: [], onTick: (act) => clock.ticks.push(act) };
  if (hz.length > 1) {
    const all = curves.all.map((c) => ({ ...c, real: floats(c.real), imag: floats(c.imag), error: floats(c.error) }));
    const size = (c, k) => Math.hypot(c.real[k], c.imag[k]);
    const decibel = (x) => (x > 0 ? 20 * Math.log10(x) : NaN);
    const degrees = (c, k) => (Math.atan2(c.imag[k], c.real[k]) * 180) / Math.PI;
    const error = (c, k) => (c.error?.length && size(c, k) > 0 ? ` ± ${significant((100 * c.error[k]) / size(c, k), 2)} %` : "");
    const words = (c) => (k) => (size(c, k) > 0 ? `${significant(size(c, k), 4)} = ${significant(decibel(size(c, k)), 4)} dB${error(c, k)}` : "0");
    const unwound = (c) => {
      let turns = 0;
      return Float64Array.from(hz, (_, k) => {
        const step = k ? degrees(c, k) - degrees(c, k - 1) : 0;
        turns -= Math.round(step / 360);
        return size(c, k) > 0 ? degrees(c, k) + 360 * turns : NaN;
      });
    };
    const choose = (plot) => plot.over.addEventListener("click", (event) => {
      if (!chooseShape) return;
      const x = event.clientX - plot.over.getBoundingClientRect().left;
      const far = shapes.hz.map((f) => Math.abs(plot.valToPos(f, "x") - x));
      chooseShape(far.indexOf(Math.min(...far)));
    });
    const group = makePanels(hz, clock, () => {
      const series = (values, text) => all.map((c, k) => ({ label: c.label, unit: "", values: values(c), words: text(c), colour: named(k), dash: DASHES[Math.floor(k / 8) % DASHES.length] }));
      group.add(series((c) => Float64Array.from(hz, (_, k) => decibel(size(c, k))), words), 280, "amplitude [dB]");
      group.add(series(unwound, (c) => (k) => (size(c, k) > 0 ? `${significant(degrees(c, k), 4)}°` : "–")), 170, "phase [°]");
      for (const { plot } of group.plots) choose(plot);
    }, FREQUENCY);
    const click = shapes ? " A click chooses the nearest frequency whose motion is shown below." : "";
    const card = figure("Amplitude and phase", `Output over input (${curves.input}), in SI units. Below each picture stand the figures at the pointer, with the estimated error. Drag across to look closer; a double click shows the whole band.${click}`, group.slot);
    answerSection().append(card);
    group.begin();
  }
  const responses = curves.all.map((c) => [c.label, floats(c.real), floats(c.imag)]);
  const headings = responses.flatMap(([label]) => [`real part of ${label} [output/input]`, `imaginary part of ${label} [output/input]`]);
  for (const part of data.figures || []) part.rows = () => [["f [Hz]", ...headings], Array.from(hz, (f, k) => [f, ...responses.flatMap(([, re, im]) => [re[k], im[k]])])];
  let chooseShape = null;
  if (shapes) {
    const body = section("shapes", data.scene?.beams ? "Motion of the structure" : "Motion of the beam", "The shape of the steady motion at peaks and at the frequencies of --frequency, over one cycle of the input. Amplitudes are drawn as large as can be seen.");
    const follow = (k) => ((clock.time = shapes.hz[k]), clock.ticks.forEach((act) => act()));
    const unit = (x, name) => `${significant(x, 4)} ${name}`;
    chooseShape = movingShapes(body, shapes, {
      name: "Frequency",
      texts: shapes.hz.map((f) => quantity(f, "Hz", 5)),
      first: 0,
      oscillates: () => true,
      words: (k, moved, pressed) => `At ${quantity(shapes.hz[k], "Hz", 5)}, per unit of the input: largest displacement ${unit(moved, "m")}${pressed > 0 ? `, largest pressure ${unit(pressed, "Pa")}` : ""}. Phase 0 is that of the largest input.`,
      follow,
    });
    follow(0);
  }
  showMany();
}
