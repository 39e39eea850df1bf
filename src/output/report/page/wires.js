// The wiring in coordinates of the beam: `a` along it [m], `e` across it from its middle [m]. Drawing and animation share it.

/** Half the height of the beam at a place along it [m]. */
function halfHeight(scene, a) {
  if (!scene.heights) return scene.height / 2;
  const beyond = scene.borders.findIndex((end) => end > a);
  return scene.heights[beyond < 0 ? scene.heights.length - 1 : Math.max(beyond - 1, 0)] / 2;
}

/** Positions of bladders, with tubes, ports and turbines as lines between them. */
function layOut(scene) {
  const out = { bladders: [], shown: [], wires: [], marks: [] };
  if (!scene.bladders) return out;
  const { per_row: perRow, network } = scene.bladders;
  const borders = scene.borders || Array.from({ length: perRow + 1 }, (_, j) => (j * scene.length) / perRow);
  const segment = Math.max(...borders.slice(1).map((end, j) => end - borders[j]));
  const [wide, high] = [Math.min(scene.bladders.width, 0.92 * segment), Math.min(scene.bladders.height, 0.46 * scene.height)];
  out.segment = segment;
  out.length = scene.length;
  out.size = [wide, high];
  // The outlines of a section, about the middles of their own heights.
  const rows = (scene.bladders.outlines || []).map((points) => {
    const [low, top] = extent(points.map((p) => p[1]));
    const [left, right] = extent(points.map((p) => p[0]));
    return { e: (low + top) / 2, size: [right - left, top - low], outline: points.map(([z, x]) => [z, x - (low + top) / 2]) };
  });
  if (rows.length) out.size = [Math.max(...rows.map((r) => r.size[0])), Math.max(...rows.map((r) => r.size[1]))];
  const number = (a) => (scene.beams ? beamAt(scene, a) : 0);
  const apartBeams = (A, B) => number(A.a) !== number(B.a);
  const first = (j) => (scene.beams ? borders.findIndex((border) => number(border + 1e-9 * scene.length) === number((borders[j] + borders[j + 1]) / 2)) : 0);
  for (let b = 0; b < 2 * perRow; b++) {
    const row = b < perRow ? 1 : -1;
    const j = b % perRow;
    const middle = (borders[j] + borders[j + 1]) / 2;
    const half = halfHeight(scene, middle);
    const width = scene.bladders.widths ? Math.min(scene.bladders.widths[j][row > 0 ? 0 : 1], 0.92 * (borders[j + 1] - borders[j])) : wide;
    const both = scene.bladders.present[j] && scene.bladders.present[perRow + j];
    const size = [width, scene.bladders.heights ? Math.min(scene.bladders.heights[j][row > 0 ? 0 : 1], (both ? 0.92 : 1.84) * half) : high];
    const e = row * Math.min(0.5 * half, 0.96 * half - size[1] / 2);
    out.bladders.push({ index: b, row, label: scene.bladders.labels?.[b] ?? row * (j + 1), short: row * (j + 1 - first(j)), a: middle, e, size, absent: !scene.bladders.present[b], ...rows[row > 0 ? 0 : 1], network: network[b], flipped: false });
  }
  out.shown = out.bladders.filter((b) => !b.absent);
  const sizes = new Map();
  for (const n of network) sizes.set(n, (sizes.get(n) || 0) + 1);
  const joined = [...sizes.keys()].filter((n) => sizes.get(n) > 1).sort((x, y) => x - y);
  // Networks of several bladders have colours, single bladders none.
  out.colourOf = (n) => joined.indexOf(n);
  const { chains, tubes, ports, turbines, junctions } = scene.wiring;
  for (const chain of chains) {
    chain.bladders.forEach((b, k) => {
      const next = chain.bladders[k + 1] ?? null;
      const before = chain.bladders[k - 1] ?? null;
      const other = next ?? before;
      const way = other !== null && apartBeams(out.bladders[b], out.bladders[other]) ? 1 : next !== null ? out.bladders[next].a - out.bladders[b].a : before !== null ? out.bladders[b].a - out.bladders[before].a : 1;
      out.bladders[b].flipped = way < 0;
    });
  }
  const mouth = (b, outlet) => {
    const bladder = out.bladders[b];
    const side = outlet !== bladder.flipped ? 1 : -1;
    return { a: bladder.a + side * 0.24 * bladder.size[0], e: bladder.e };
  };
  const name = (b) => labelText(out.bladders[b].label);
  chains.forEach((chain, c) => {
    const colour = out.colourOf(network[chain.bladders[0]]);
    chain.bladders.forEach((b, k) => {
      out.wires.push({ points: [mouth(b, false), mouth(b, true)], colour, within: true });
      const next = chain.bladders[k + 1];
      if (next === undefined) return;
      const points = [mouth(b, true), mouth(next, false)];
      out.wires.push({ points, far: apartBeams(...points), colour, words: `Tube of chain ${c + 1}, from bladder ${name(b)} to bladder ${name(next)}${chain.valve ? `; ${chain.valve}` : ""}`, valve: chain.valve });
    });
    [[chain.bladders[0], false], [chain.bladders.at(-1), true]].forEach(([b, outlet], k) => {
      const end = chain.ends[k];
      if (end.kind === "connected") return;
      out.marks.push({ ...end, at: mouth(b, outlet), row: out.bladders[b].row, colour, where: `bladder ${name(b)}` });
    });
  });
  const nodes = placeJunctions(out, junctions, tubes, turbines, mouth, scene.beams ? number : null);
  const point = (p) => (p.junction !== undefined ? nodes.get(p.junction) : mouth(p.bladder, p.outlet));
  const colourAt = (p) => (p.junction !== undefined ? nodes.get(p.junction)?.colour ?? -1 : out.colourOf(network[p.bladder]));
  const called = (p) => (p.junction !== undefined ? `junction ${p.junction}` : `bladder ${name(p.bladder)}`);
  let lane = 0;
  const connect = (from, to) => {
    const [A, B] = [point(from), point(to)];
    if (!A || !B) return null;
    if (apartBeams(A, B)) return [A, B];
    const apart = Math.abs(A.a - B.a);
    if (apart < 1.2 * segment && A.e === B.e) return [A, B];
    const far = apart > 2 * segment;
    // Long ones run along the middle of the beam, side by side.
    const e = far ? [0.06, -0.06, 0.1, -0.1, 0][lane++ % 5] * scene.height : 0;
    return [A, { a: A.a, e }, { a: B.a, e }, B];
  };
  for (const tube of tubes) {
    const points = connect(tube.from, tube.to);
    if (points) out.wires.push({ points, far: apartBeams(points[0], points.at(-1)), colour: colourAt(tube.from), free: true, valve: tube.valve, words: `Tube from ${called(tube.from)} to ${called(tube.to)}${tube.valve ? `; ${tube.valve}` : ""}` });
  }
  for (const turbine of turbines) {
    const points = connect(turbine.from, turbine.to);
    const words = `Turbine${turbine.name ? ` “${turbine.name}”` : ""} between ${called(turbine.from)} and ${called(turbine.to)}${turbine.rectified ? ", behind four check valves" : ""}`;
    if (points) out.wires.push({ points, far: apartBeams(points[0], points.at(-1)), colour: -2, turbine, words });
  }
  for (const port of ports) {
    const at = point(port.at);
    if (!at) continue;
    const row = port.at.junction !== undefined ? 1 : out.bladders[port.at.bladder].row;
    out.marks.push({ ...port, at, row, colour: colourAt(port.at), where: called(port.at) });
  }
  for (const row of [1, -1]) {
    for (const beam of scene.beams || [{ from: 0, length: scene.length }]) {
      const drawn = out.marks.filter((mark) => mark.row === row && mark.kind !== "sealed" && (!scene.beams || scene.beams[number(mark.at.a)] === beam));
      apart(drawn.map((mark) => mark.at.a), 0.04 * scene.length, beam.from + beam.length).forEach((a, k) => (drawn[k].drawn = a));
    }
  }
  out.marks.filter((mark) => mark.kind !== "sealed").forEach((mark, k) => (mark.letter = String.fromCharCode(65 + k)));
  out.wires.forEach((wire, k) => (wire.index = k));
  out.junctions = [...nodes.entries()].map(([key, at]) => ({ name: key, ...at }));
  return out;
}

/** Places along the beam, moved as little as keeps them a gap apart and within it: the first stays where there is room. */
function apart(places, gap, length) {
  const order = places.map((a, k) => [a, k]).sort(([a, i], [b, j]) => a - b || i - j);
  const moved = [...places];
  let least = -Infinity;
  for (const [a, k] of order) least = (moved[k] = Math.max(a, least)) + gap;
  let most = Math.max(length, ...places);
  for (const [, k] of order.reverse()) most = (moved[k] = Math.min(moved[k], most)) - gap;
  return moved;
}

/** Junctions in the middle of the beam, between what they join, beside one another. */
function placeJunctions(out, names, tubes, turbines, mouth, number) {
  const nodes = new Map();
  for (const key of names) {
    const met = [...tubes, ...turbines].flatMap((t) => [[t.from, t.to], [t.to, t.from]]).filter(([p]) => p.junction === key).map(([, q]) => q);
    const bladders = met.filter((q) => q.bladder !== undefined);
    const all = bladders.map((q) => mouth(q.bladder, q.outlet).a);
    // In a structure a junction is drawn on the beam of its first bladder.
    const places = number ? all.filter((a) => number(a) === number(all[0])) : all;
    const a = places.length ? places.reduce((s, x) => s + x, 0) / places.length : 0.5 * out.length;
    const first = bladders[0];
    nodes.set(key, { a, e: 0, colour: first ? out.colourOf(out.bladders[first.bladder].network) : -1 });
  }
  const placed = [...nodes.values()];
  if (!number) apart(placed.map((node) => node.a), 0.06 * out.length, out.length).forEach((a, k) => (placed[k].a = a));
  return nodes;
}

/** Label of a bladder with a minus sign: -3 or left:-3. */
function labelText(label) {
  return String(label).replace(/-(?=\d+$)/, "−");
}

/** Colour of a wire or mark: of its network, or of what belongs to none. */
function wireColour(k) {
  return k >= 0 ? named(k) : k === -2 ? css("--ink") : css("--wire-grey");
}

/** The middle of the longest part of a line. */
function middleOf(points) {
  let best = [0, points[0], points[1]];
  for (let k = 0; k + 1 < points.length; k++) {
    const [p, q] = [points[k], points[k + 1]];
    const length = Math.hypot(p.a - q.a, p.e - q.e);
    if (length > best[0]) best = [length, p, q];
  }
  return { a: (best[1].a + best[2].a) / 2, e: (best[1].e + best[2].e) / 2, along: Math.abs(best[1].a - best[2].a) >= Math.abs(best[1].e - best[2].e) };
}
