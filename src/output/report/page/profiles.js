// Deflection along the beam and pressure along the networks, as the paper draws them, moving with the clock.

function showProfiles(host, motion, clock, scene) {
  const lengths = { low: motion.theta[0], high: motion.theta.at(-1), unit: "m", name: "place along the beam θ" };
  const cycle = motion.cycle;
  const span = `${timeText(motion.times[cycle[0]])} to ${timeText(motion.times[cycle.at(-1)])}`;
  const when = motion.whole ? `the whole run, ${span}` : `the last cycle of the drive, ${span}`;
  const curves = [];
  const across = largest(motion.u1) > 1e-9 * scene.length;
  const [field, sign, words] = across ? [motion.u1, "u₁", "across"] : [motion.u3, "u₃", "along"];
  for (const beam of (motion.beams || []).slice(0, MOST_CURVED)) {
    curves.push({
      title: `Deflection ${sign} along ${beam.name}`, values: across ? beam.u1 : beam.u3, width: beam.nodes, x: beam.theta, axis: { ...lengths, low: 0, high: beam.length, name: `place along ${beam.name} θ` }, name: `${sign} ${words}`, unit: "m", floor: 1e-12 * scene.length,
      about: (most) => `In the axes of ${beam.name}. Every line is one instant of ${when}, from blue (early) to red (late); the thick line is the instant of the player. Largest in this span: ${quantity(most, "m")}.`,
    });
  }
  if (motion.beams?.length > MOST_CURVED) host.before(el("p", { class: "caption", text: `Curves are drawn for the first ${MOST_CURVED} of ${motion.beams.length} beams; fields.npz has all.` }));
  if (!motion.beams) curves.push({
    title: `Deflection ${sign} along the beam`, values: field, width: motion.nodes, x: motion.theta, axis: lengths, name: `${sign} ${words}`, unit: "m", floor: 1e-12 * scene.length,
    about: (most) => `Every line is one instant of ${when}, from blue (early) to red (late); the thick line is the instant of the player. Largest in this span: ${quantity(most, "m")}.`,
  });
  if (motion.pressure) {
    const [low, high] = extent(motion.x_f);
    curves.push({
      title: "Pressure along the networks", values: motion.pressure, width: motion.cells, x: motion.x_f, axis: { low, high, unit: "1", name: "place along the network X_f" }, name: "p", unit: "Pa", floor: 1e-6,
      gap: (k) => k > 0 && motion.array[k] !== motion.array[k - 1],
      about: (most) => `From the first bladder of each network to its last, one network after the other; where one ends the line breaks. Largest in this span: ${quantity(most, "Pa")}.`,
    });
  }
  const paints = [];
  for (const curve of curves) {
    const slot = el("div");
    const part = curve.values.subarray(cycle[0] * curve.width, (cycle.at(-1) + 1) * curve.width);
    const [inside, all] = [extent(part), extent(curve.values)];
    // Earlier values may be many times larger; then the picture covers only the last cycle.
    const wide = all[1] - all[0] > 2 * (inside[1] - inside[0]);
    curve.range = wide ? inside : all;
    const beyond = wide ? " At other times it may leave the picture." : "";
    const heading = (f) => `${curve.name} at ${csvCell(motion.times[f])} s [${curve.unit}]`;
    const rows = () => Array.from({ length: curve.width }, (_, k) => [curve.x[k], ...cycle.map((f) => curve.values[f * curve.width + k])]);
    const table = () => [[withUnit(curve.axis.name, curve.axis.unit), ...cycle.map(heading)], rows()];
    host.append(figure(curve.title, curve.about(largest(part)) + beyond, slot, downloads(curve.title, () => slot.querySelector("svg"), table)));
    let plot = null;
    const paint = () => {
      const [low, high] = roomy(curve.range, curve.floor);
      plot = chart(Math.max(slot.clientWidth, 260), 264, curve.axis, { low, high, unit: curve.unit, name: curve.name }, curve.title);
      const line = (f) => linePath(curve.width, (k) => [plot.px(curve.x[k]), plot.py(curve.values[f * curve.width + k])], curve.gap);
      cycle.forEach((f, k) => plot.area.append(svg("path", { d: line(f), style: `fill:none;stroke:${timeColour(k / Math.max(cycle.length - 1, 1))};stroke-width:1;opacity:0.55` })));
      plot.now = svg("path", { class: "present", style: `fill:none;stroke:${css("--ink")};stroke-width:2.4;stroke-linejoin:round` });
      plot.area.append(plot.now);
      plot.line = line;
      slot.replaceChildren(plot.node);
      plot.now.setAttribute("d", line(clock.index));
    };
    clock.onTick(() => plot && plot.now.setAttribute("d", plot.line(clock.index)));
    paints.push(paint);
  }
  // The width of each is known only when all stand.
  paints.forEach(drawn);
}
