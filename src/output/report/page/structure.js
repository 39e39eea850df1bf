// Structures: beams at their places. A place along a beam, `a`, is counted over all beams, one after the other.

/** Largest numbers of beams with curves and with maps of their own. */
const MOST_CURVED = 6;
const MOST_MAPPED = 4;

/** Unpacks the places of nodes; null for a single beam. */
function placeNodes(placed, scene) {
  if (!placed || !scene?.beams) return null;
  const [theta, x, z, angle] = ["theta", "x", "z", "angle"].map((key) => floats(placed[key]));
  const along = Float64Array.from(theta, (t, k) => scene.beams[placed.beam[k]].from + t);
  const parts = placed.starts.map((from, k) => [from, placed.starts[k + 1] ?? theta.length]);
  return { beam: placed.beam, theta, along, x, z, angle, parts };
}

/** The straight structure: root and tip of each beam. */
function straightCurve(scene) {
  const ends = scene.beams.flatMap((beam, k) => [0, beam.length].map((theta) => ({ beam, k, theta })));
  const nodes = {
    along: ends.map((end) => end.beam.from + end.theta),
    z: ends.map((end) => end.beam.z + end.theta * Math.cos(end.beam.angle)),
    x: ends.map((end) => end.beam.x + end.theta * Math.sin(end.beam.angle)),
    angle: ends.map((end) => end.beam.angle),
    parts: scene.beams.map((_, k) => [2 * k, 2 * k + 2]),
  };
  const none = new Float64Array(ends.length);
  return structureCurve(nodes, none, none, { across: 1, along: 1 }, null);
}

/** As `curveOf`, with displacements along the axes of each beam. */
function structureCurve(nodes, u1, u3, factor, angle) {
  const n = nodes.along.length;
  const out = { theta: nodes.along, n, parts: nodes.parts };
  for (const key of ["x", "y", "nx", "ny"]) out[key] = new Float64Array(n);
  const turned = (k, along, across) => [Math.cos(nodes.angle[k]) * along - Math.sin(nodes.angle[k]) * across, Math.sin(nodes.angle[k]) * along + Math.cos(nodes.angle[k]) * across];
  for (let k = 0; k < n; k++) {
    const [dz, dx] = turned(k, u3[k] * factor.along, u1[k] * factor.across);
    out.x[k] = nodes.z[k] + dz;
    out.y[k] = nodes.x[k] + dx;
  }
  for (const [from, to] of nodes.parts) {
    for (let k = from; k < to; k++) {
      const [a, b] = [Math.max(k - 1, from), Math.min(k + 1, to - 1)];
      const [dx, dy] = angle ? turned(k, Math.cos(angle[k]), factor.across * Math.sin(angle[k])) : [out.x[b] - out.x[a], out.y[b] - out.y[a]];
      const size = Math.hypot(dx, dy) || 1;
      out.nx[k] = -dy / size;
      out.ny[k] = dx / size;
    }
  }
  return out;
}

/** Number of the beam at a place. */
function beamAt(scene, a) {
  const beyond = (scene.beams || []).findIndex((beam) => a < beam.from + beam.length);
  return beyond < 0 ? (scene.beams || []).length - 1 : beyond;
}

/** Bounds of what is straight. */
function straightBounds(scene) {
  const bounds = { x0: 0, x1: scene.length, y0: 0, y1: 0 };
  if (!scene.beams) return bounds;
  const curve = straightCurve(scene);
  [bounds.x0, bounds.x1] = extent(curve.x);
  [bounds.y0, bounds.y1] = extent(curve.y);
  return bounds;
}

/** Ends of beams and joints: places slightly inside of their beams, so that each belongs to one beam. */
function endsOf(scene) {
  if (!scene.beams) return scene.ends.map((end, k) => ({ ...end, out: k === 0 ? -1 : 1, tip: k === 1 }));
  const near = 1e-6;
  return scene.beams.flatMap((beam) => beam.ends.map((end, k) => ({ ...end, out: k === 0 ? -1 : 1, tip: k === 1, a: beam.from + beam.length * (k === 0 ? near : 1 - near) })));
}

function jointPlaces(scene, joint) {
  return joint.at.map((at) => at.along + (at.tip ? -1 : 1) * 1e-6 * scene.length);
}

/** True for joints drawn as squares: elastic ones and sliders. */
function isElastic(joint) {
  return joint.kind === "elastic" || joint.kind === "slider";
}

function jointFill(joint) {
  return css(joint.kind === "rigid" ? "--ink" : "--card");
}

/** A dot for a rigid joint, an open circle for a hinge, an open square for others. */
function jointMark(joint, x, y, size) {
  const style = `fill:${jointFill(joint)};stroke:${css("--ink")};stroke-width:2`;
  if (isElastic(joint)) return svg("rect", { class: "joint", x: x - size, y: y - size, width: 2 * size, height: 2 * size, style });
  return svg("circle", { class: "joint", cx: x, cy: y, r: size, style });
}

/** Joints and pinned ends of a structure over its beams. */
function paintJoints(ctx, view, curve, scene, half) {
  const at = [0, 0];
  const point = (a, e = 0) => {
    placed(curve, a, e - scene.line, at);
    return [view.X(at[0]), view.Y(at[1])];
  };
  ctx.strokeStyle = css("--ink");
  for (const end of endsOf(scene).filter((end) => end.form !== "joined" && !end.held.slope && (end.held.across || end.held.along))) {
    const [[x, y], [nx, ny]] = [point(end.a), point(end.a, half)];
    const size = Math.hypot(nx - x, ny - y) || 1;
    const [ux, uy] = [(nx - x) / size, (ny - y) / size];
    ctx.beginPath();
    ctx.moveTo(x, y);
    for (const side of [-1, 1]) ctx.lineTo(x - end.out * 12 * uy + side * 7 * ux, y + end.out * 12 * ux + side * 7 * uy);
    ctx.closePath();
    ctx.lineWidth = 1.6;
    ctx.fillStyle = css("--card");
    ctx.fill();
    ctx.stroke();
  }
  for (const joint of scene.joints) {
    const places = jointPlaces(scene, joint).map((a) => point(a));
    ctx.lineWidth = 2;
    for (const [x, y] of places.slice(1)) {
      ctx.beginPath();
      ctx.moveTo(...places[0]);
      ctx.lineTo(x, y);
      ctx.stroke();
    }
    for (const [x, y] of places) {
      ctx.beginPath();
      if (isElastic(joint)) ctx.rect(x - 4, y - 4, 8, 8);
      else ctx.arc(x, y, 4, 0, 2 * Math.PI);
      ctx.fillStyle = jointFill(joint);
      ctx.fill();
      ctx.stroke();
    }
  }
}

/** The drawing of a straight structure of given width. */
function structureDrawing(scene, layout, width, chosen) {
  const [side, above, below] = [52, 52, 62];
  const bounds = straightBounds(scene);
  const inner = viewOf(width - 2 * side, bounds, 420);
  const height = inner.height + above + below;
  const scale = inner.scale;
  const [X, Y] = [(x) => side + inner.X(x), (y) => above + inner.Y(y)];
  const thick = Math.max(scene.height * scale, 12);
  const thicker = thick / (scene.height * scale);
  const curve = straightCurve(scene);
  const at = [0, 0];
  const screen = (a, e) => {
    placed(curve, a, e * thicker, at);
    return [X(at[0]), Y(at[1])];
  };
  const node = svg("svg", { class: "fig", width, height, viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": `Side view of the structure: ${scene.size}. ${layout.shown.length} bladders.` });
  const add = (...parts) => node.append(...parts);
  for (const { point, normal, center, radius } of scene.obstacles || []) {
    const style = `fill:none;stroke:${css("--faint")};stroke-width:3`;
    if (center) add(svg("circle", { cx: X(center[1]), cy: Y(center[0]), r: radius * scale, style }));
    else add(svg("path", { d: [-1, 1].map((k) => `${k < 0 ? "M" : "L"}${X(point[1] + 4 * k * scene.length * normal[0])} ${Y(point[0] - 4 * k * scene.length * normal[1])}`).join(""), style }));
  }
  const groups = scene.beams.map((beam) => {
    const degrees = (beam.angle * 180) / Math.PI;
    const group = svg("g", { transform: `translate(${X(beam.z).toFixed(2)} ${Y(beam.x).toFixed(2)}) rotate(${-degrees})` });
    add(group);
    return { beam, degrees, add: (...parts) => group.append(...parts), X: (a) => (a - beam.from) * scale, Y: (e) => -e * scale * thicker };
  });
  groups.forEach((group, number) => {
    const own = (b) => beamAt(scene, b) === number;
    const whole = [group.beam.from, group.beam.from + group.beam.length];
    const graded = (sign) => scene.heights.flatMap((h, k) => (own((scene.borders[k] + scene.borders[k + 1]) / 2) ? [[scene.borders[k], (sign * h) / 2], [scene.borders[k + 1], (sign * h) / 2]] : []));
    const edge = (sign) => (scene.heights ? graded(sign) : whole.map((a) => [a, (sign * scene.height) / 2]));
    const around = [...edge(1), ...edge(-1).reverse()].map(([a, e]) => `${group.X(a).toFixed(1)} ${group.Y(e).toFixed(1)}`);
    group.add(svg("path", { d: `M${around.join("L")}Z`, "stroke-linejoin": "round", style: `fill:${css("--solid")};stroke:${css("--solid-line")}` }));
    const local = { ends: group.beam.ends.map((end) => (end.form === "joined" ? { ...end, held: {}, moves: {}, force: {} } : end)), loads: group.beam.loads, length: group.beam.length };
    const along = (a) => a * scale;
    drawEnds(group.add, local, along, group.Y, thick);
    drawLoads(group.add, { ...local, loads: local.loads.filter((load) => load.kind !== "gravity") }, along, group.Y(scene.height / 2) - 8, width, height);
    if (!layout.bladders.length) return;
    const part = { ...layout, shown: layout.shown.filter((b) => own(b.a)), wires: layout.wires.filter((wire) => !wire.far && own(wire.points[0].a)), junctions: (layout.junctions || []).filter((j) => own(j.a)), marks: layout.marks.filter((mark) => own(mark.at.a)) };
    drawBladders(group.add, part, group.X, group.Y, scale, thicker);
    drawWires(group.add, part, group.X, group.Y, scale);
    drawMarks(group.add, part, group.X, group.Y, scene, thicker, group.degrees);
    drawNumbers(group.add, part, group.X, group.Y, scale, thicker, group.degrees);
  });
  const far = layout.wires.filter((wire) => wire.far).map((wire) => ({ ...wire, points: wire.points.map((p) => screen(p.a, p.e)).map(([a, e]) => ({ a, e })) }));
  drawWires(add, { wires: far, segment: (layout.segment || 0) * scale }, (x) => x, (y) => y, 1);
  for (const joint of scene.joints) {
    const places = jointPlaces(scene, joint).map((a) => screen(a, 0));
    for (const [x, y] of places) add(svg("path", { d: `M${places[0].join(" ")}L${x} ${y}`, style: `stroke:${css("--ink")};stroke-width:2` }));
    for (const [x, y] of places) add(jointMark(joint, x, y, 5));
  }
  for (const { beam } of groups) {
    const [x, y] = screen(beam.from + beam.length / 2, 0);
    const [ux, uy] = [-Math.sin(beam.angle), -Math.cos(beam.angle)];
    const away = thick / 2 + 12;
    add(svg("text", { class: "strong", x: x + ux * away, y: y + uy * away + 4, "text-anchor": Math.abs(ux) < 0.5 ? "middle" : ux < 0 ? "end" : "start", style: `paint-order:stroke;stroke:${css("--card")};stroke-width:3.5px`, text: beam.name }));
  }
  drawLoads(add, { ...scene, loads: scene.loads.filter((load) => load.kind === "gravity") }, X, 0, width, height);
  scaleBar(add, scene, (a) => 20 + a * scale, height, scale);
  node.thicker = thicker;
  node.nearest = (x, y) => {
    let best = [22 ** 2 + (layout.size[0] * scale) ** 2, -1];
    for (const b of layout.shown) {
      const [bx, by] = screen(b.a, b.e);
      const d = (bx - x) ** 2 + (by - y) ** 2;
      if (d < best[0]) best = [d, b.index];
    }
    return best[1];
  };
  node.mark = (k) => {
    const b = layout.bladders[k];
    const { beam, X: along, Y: across } = groups[beamAt(scene, b.a)];
    const [w, h] = [b.size[0] * scale + 4, b.size[1] * scale * thicker + 4];
    const place = `translate(${X(beam.z)} ${Y(beam.x)}) rotate(${(-beam.angle * 180) / Math.PI})`;
    node.append(svg("rect", { class: "chosen", transform: place, x: along(b.a) - w / 2, y: across(b.e) - h / 2, width: w, height: h, rx: 4, style: `fill:none;stroke:${css("--accent")};stroke-width:3;pointer-events:none` }));
  };
  if (chosen >= 0) node.mark(chosen);
  return node;
}

/** Fields of each beam of a moving structure: its name, its places, and the values of its nodes, frame after frame. */
function fieldsOfBeams(motion, scene) {
  return scene.beams.map((beam, number) => {
    const own = motion.placed.beam.flatMap((b, k) => (b === number ? [k] : []));
    const of = (values) => values && Float32Array.from({ length: motion.frames * own.length }, (_, i) => values[Math.floor(i / own.length) * motion.nodes + own[i % own.length]]);
    return { name: beam.name, length: beam.length, nodes: own.length, tip: own.at(-1), theta: Float32Array.from(own, (k) => motion.placed.theta[k]), u1: of(motion.u1), u3: of(motion.u3), curvature: of(motion.curvature) };
  });
}
