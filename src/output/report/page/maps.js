// Space over time as colours: where and when something happens.

function showMaps(host, motion, clock, scene) {
  const n = motion.nodes;
  const maps = [];
  if (motion.beams) {
    mapsOfBeams(host, maps, motion, scene);
    for (const map of maps) showMap(host, map, motion, clock);
    return;
  }
  const along = (title, values, unit, about) => maps.push({ title, unit, about, rows: n, low: "root", high: "tip", at: (f, k) => values[f * n + k], values, place: (k) => `θ = ${quantity(motion.theta[k], "m")}` });
  if (largest(motion.u1) > 1e-9 * scene.length) along("Deflection across, u₁", motion.u1, "m", "Red: the beam is up there, blue: down.");
  if (largest(motion.u3) > 1e-9 * scene.length) along("Displacement along, u₃", motion.u3, "m", "Red: moved towards the tip, blue: towards the root.");
  if (motion.curvature && largest(motion.curvature) * scene.length > 1e-9) along("Curvature κ", motion.curvature, "1/m", "Red: the upper side is stretched, blue: the lower.");
  if (motion.ofBladder) {
    const half = motion.bladders / 2;
    [["Pressure, upper row", 0], ["Pressure, lower row", half]].forEach(([title, from]) => {
      const values = motion.ofBladder;
      maps.push({
        title, unit: "Pa", about: "Red: above the pressure outside, blue: below.", rows: half, low: "root", high: "tip", scale: motion.pressureScale,
        at: (f, k) => values[f * motion.bladders + from + k], place: (k) => `bladder ${from ? "−" : ""}${k + 1}`,
      });
    });
  }
  for (const map of maps) showMap(host, map, motion, clock);
}

/** Maps of each beam of a structure. */
function mapsOfBeams(host, maps, motion, scene) {
  const layout = layOut(scene);
  const beams = motion.beams.slice(0, MOST_MAPPED);
  if (beams.length < motion.beams.length) host.before(el("p", { class: "caption", text: `Maps are drawn for the first ${MOST_MAPPED} of ${motion.beams.length} beams; fields.npz has all.` }));
  beams.forEach((beam, number) => {
    const along = (title, values, unit, about) => {
      if (values && largest(values) * (unit === "m" ? 1 : scene.length ** 2) > 1e-9 * scene.length) maps.push({ title: `${title} of ${beam.name}`, unit, about, rows: beam.nodes, values, at: (f, k) => values[f * beam.nodes + k], place: (k) => `${beam.name}, θ = ${quantity(beam.theta[k], "m")}` });
    };
    along("Deflection across, u₁,", beam.u1, "m", "In the axes of the beam. Red: towards its upper side, blue: towards its lower side.");
    along("Displacement along, u₃,", beam.u3, "m", "In the axes of the beam. Red: moved towards the tip, blue: towards the root.");
    along("Curvature κ", beam.curvature, "1/m", "Red: the upper side is stretched, blue: the lower.");
    for (const row of motion.ofBladder ? [1, -1] : []) {
      const own = layout.bladders.filter((b) => b.row === row && beamAt(scene, b.a) === number);
      maps.push({
        title: `Pressure, ${row > 0 ? "upper" : "lower"} row of ${beam.name}`, unit: "Pa", about: "Red: above the pressure outside, blue: below.", rows: own.length, values: motion.ofBladder, scale: motion.pressureScale,
        at: (f, k) => motion.ofBladder[f * motion.bladders + own[k].index], place: (k) => `bladder ${labelText(own[k].label)}`,
      });
    }
  });
}

function showMap(host, map, motion, clock) {
  const scale = map.scale || robustLimit(map.values);
  const canvas = el("canvas", { role: "img", "aria-label": `${map.title} over time and place` });
  const now = el("div", { class: "now" });
  const holder = el("div", { class: "map", tabindex: "0", role: "group", "aria-label": `${map.title} over time and place. Arrow keys move the time.` }, canvas, now);
  const readout = el("span", { text: "point at the map to read it" });
  const [t0, t1] = [motion.times[0], motion.times.at(-1)];
  const places = Array.from({ length: map.rows }, (_, k) => k);
  const table = () => [["t [s]", ...places.map((k) => withUnit(`${map.title.replace(/,$/, "")} at ${map.place(k)}`, map.unit))], Array.from(motion.times, (t, f) => [t, ...places.map((k) => map.at(f, k))])];
  const card = el("div", { class: "figure" },
    el("div", { class: "maphead" }, el("h3", { text: map.title }), readout), holder,
    el("div", { class: "mapaxis" }, el("span", { text: timeText(t0) }), el("span", { text: "time →   (bottom: root, top: tip)" }), el("span", { text: timeText(t1) })),
    colourBar(scale.limit, scale.most, map.unit), el("p", { class: "caption", text: map.about }), downloads(map.title, () => mapDrawing(map, motion, scale), table));
  host.append(card);
  const picture = document.createElement("canvas");
  const place = (event) => {
    const box = canvas.getBoundingClientRect();
    const x = Math.min(Math.max((event.clientX - box.left) / box.width, 0), 1);
    const y = Math.min(Math.max((event.clientY - box.top) / box.height, 0), 1);
    return [t0 + x * (t1 - t0), Math.min(Math.floor((1 - y) * map.rows), map.rows - 1)];
  };
  holder.addEventListener("pointermove", (event) => {
    const [t, k] = place(event);
    const f = frameAt(motion.times, t);
    readout.textContent = `${quantity(map.at(f, k), map.unit)} · ${map.place(k)} · t = ${quantity(motion.times[f], "s", 4)}`;
  });
  holder.addEventListener("click", (event) => (clock.play(false), clock.goTime(place(event)[0])));
  const paint = () => {
    // As many columns as can be seen; the frames between are passed over.
    const columns = Math.min(motion.frames, 1000);
    picture.width = columns;
    picture.height = map.rows;
    const ctx = picture.getContext("2d");
    const image = ctx.createImageData(columns, map.rows);
    for (let c = 0; c < columns; c++) {
      const f = Math.round((c * (motion.frames - 1)) / Math.max(columns - 1, 1));
      for (let k = 0; k < map.rows; k++) {
        const at = ((map.rows - 1 - k) * columns + c) * 4;
        diverging(map.at(f, k) / scale.limit, image.data, at);
        image.data[at + 3] = 255;
      }
    }
    ctx.putImageData(image, 0, 0);
    painted(canvas, 168, (context, w, h) => {
      context.imageSmoothingEnabled = map.rows > 40;
      context.drawImage(picture, 0, 0, w, h);
    });
    mark();
  };
  const mark = () => (now.style.left = `${(100 * (clock.time - t0)) / (t1 - t0 || 1)}%`);
  drawn(paint);
  clock.onTick(mark);
}
