// The motion: the beam in its true shape, moving with the clock.

/** Fields of a run unpacked: frames × nodes, frames × cells. */
function unpackMotion(m) {
  if (!m || !m.times) return null;
  const out = { ...m };
  for (const key of ["times", "theta", "u1", "u3", "curvature", "angle", "pressure", "x_f", "bladder", "array"]) out[key] = floats(m[key]);
  out.frames = out.times.length;
  out.nodes = out.theta.length;
  out.placed = placeNodes(m.placed, data.scene);
  out.cells = out.pressure ? out.pressure.length / out.frames : 0;
  if (out.cells && data.scene?.bladders) {
    const half = data.scene.bladders.per_row;
    const of = Array.from(out.bladder, (signed) => (signed > 0 ? signed - 1 : half - signed - 1));
    out.present = of.map((b) => data.scene.bladders.present[b]);
    const number = new Float64Array(2 * half);
    for (const b of of) number[b]++;
    out.ofBladder = new Float32Array(out.frames * 2 * half);
    for (let f = 0; f < out.frames; f++) for (let c = 0; c < out.cells; c++) out.ofBladder[f * 2 * half + of[c]] += out.pressure[f * out.cells + c] / number[of[c]];
    out.bladders = 2 * half;
    // The colour scale covers the pressures of the last cycle; much larger pressures at the start exceed it.
    const most = largest(out.pressure);
    const late = largest(out.pressure.subarray(out.cycle[0] * out.cells, (out.cycle.at(-1) + 1) * out.cells));
    out.pressureScale = out.whole ? robustLimit(out.pressure) : { limit: late > 0 && most > 1.6 * late ? late : most || 1, most };
  }
  return out;
}

/** A slider of powers: factors 1, 2, 5, 10, ... up to `most`. */
function factorControl(label, start, act) {
  const steps = [1];
  while (steps.at(-1) < Math.max(100, start * 10)) steps.push(steps.at(-1) * (String(steps.at(-1))[0] === "2" ? 2.5 : 2));
  const shown = el("output", { text: `× ${count(start)}` });
  const slider = el("input", { type: "range", min: 0, max: steps.length - 1, step: 1, value: Math.max(0, steps.indexOf(start)), "data-keys": "" });
  slider.addEventListener("input", () => {
    const factor = steps[Number(slider.value)];
    shown.textContent = `× ${count(factor)}`;
    act(factor);
  });
  return el("label", {}, label, slider, shown);
}

/** Faces of walls and circles, where displacements along are drawn as they are. */
function paintObstacles(ctx, view, scene, factor, [s1, s3]) {
  if (factor.along !== 1) return;
  ctx.save();
  ctx.strokeStyle = css("--faint");
  ctx.lineWidth = 3;
  for (const { point, normal, center, radius } of scene.obstacles || []) {
    const far = 4 * scene.length;
    const at = (k) => [view.X(point[1] - s3 + k * far * normal[0]), view.Y((point[0] - s1 - k * far * normal[1]) * factor.across)];
    ctx.beginPath();
    if (center) {
      const size = radius * view.scale;
      ctx.ellipse(view.X(center[1] - s3), view.Y((center[0] - s1) * factor.across), size, size * factor.across, 0, 0, 2 * Math.PI);
    } else {
      ctx.moveTo(...at(-1));
      ctx.lineTo(...at(1));
    }
    ctx.stroke();
  }
  ctx.restore();
}

function showAnimation(host, scene, motion, clock) {
  const layout = layOut(scene);
  const root = (f) => [motion.u1[f * motion.nodes], motion.u3[f * motion.nodes]];
  const moves = largest(Array.from({ length: motion.frames }, (_, f) => root(f)[1])) > 1e-3 * scene.length || largest(Array.from({ length: motion.frames }, (_, f) => root(f)[0])) > 1e-3 * scene.length;
  const tiny = largest(motion.u1);
  const factor = { across: roundFactor(tiny, scene.length), along: 1 };
  const still = tiny <= 1e-9 * scene.length;
  const alongSize = largest(motion.u3);
  if (still && !moves) factor.along = roundFactor(alongSize, scene.length);
  // In a structure both directions are drawn with one factor, so that joined beams stay together.
  if (motion.placed) factor.across = factor.along = roundFactor(Math.max(tiny, alongSize), scene.length);
  let follow = false;
  const canvas = el("canvas", { role: "img", "aria-label": "The moving beam, seen from the side" });
  const note = el("p", { class: "caption" });
  const ghost = document.createElement("canvas");
  let view = null;
  const shift = (f) => (follow ? root(f) : [0, 0]);
  const shape = (f, w) => {
    const n = motion.nodes;
    const g = Math.min(f + 1, motion.frames - 1);
    const [s, t] = [shift(f), shift(g)];
    const mix = (v, from, to) => Float64Array.from({ length: n }, (_, k) => (v[f * n + k] - from) * (1 - w) + (v[g * n + k] - to) * w);
    return curveOf(motion.theta, mix(motion.u1, s[0], t[0]), mix(motion.u3, s[1], t[1]), factor, motion.angle ? mix(motion.angle, 0, 0) : null, motion.placed);
  };
  const prepare = () => {
    const bounds = straightBounds(scene);
    for (let f = 0; motion.placed && f < motion.frames; f++) {
      const curve = shape(f, 0);
      for (let k = 0; k < curve.n; k++) widen(bounds, curve.x[k], curve.y[k]);
    }
    for (let f = 0; !motion.placed && f < motion.frames; f++) {
      const [s1, s3] = shift(f);
      for (let k = 0; k < motion.nodes; k++) {
        widen(bounds, motion.theta[k] + (motion.u3[f * motion.nodes + k] - s3) * factor.along, (motion.u1[f * motion.nodes + k] - s1) * factor.across);
      }
    }
    // A disc is seen as a whole unless it is larger than the beam.
    for (const { center, radius } of scene.obstacles || []) {
      if (!center || factor.along !== 1 || radius > scene.length || Math.hypot(...center) > 3 * scene.length) continue;
      for (const side of [-1, 1]) widen(bounds, center[1] + side * radius, (center[0] + side * radius) * factor.across);
    }
    bounds.y0 -= scene.height * 0.8;
    bounds.y1 += scene.height * 0.8;
    view = viewOf(Math.max(canvas.clientWidth, 280), bounds, 460);
    painted(canvas, view.height, () => {});
    ghost.width = canvas.width;
    ghost.height = canvas.height;
    const ctx = ghost.getContext("2d");
    const ratio = canvas.width / Math.max(canvas.clientWidth, 40);
    ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
    ctx.fillStyle = css("--faint");
    // A thin beam leaves a thin trace, which needs more ink.
    ctx.globalAlpha = 0.016 * Math.min(Math.max(16 / (scene.height * view.scale), 1), 8);
    const every = Math.max(1, Math.floor(motion.frames / 40));
    for (let f = 0; f < motion.frames; f += every) {
      paintShade(ctx, view, shape(f, 0), scene);
    }
    const parts = [];
    if (motion.placed) parts.push(...(factor.across === 1 ? [] : [`displacements drawn ${count(factor.across)} times larger`]));
    else if (factor.across !== 1) parts.push(`deflection across drawn ${count(factor.across)} times larger`);
    if (!motion.placed && factor.along !== 1) parts.push(`displacement along drawn ${count(factor.along)} times larger`);
    const truth = parts.length ? `${parts.join(", ")}; everything else to scale.` : "To scale, nothing exaggerated.";
    note.textContent = `${truth[0].toUpperCase()}${truth.slice(1)} The faint shade is everywhere the ${motion.placed ? "structure" : "beam"} goes during the whole motion, the stronger the more often.${layout.bladders.length ? " Cells: bladders, coloured by their pressure; lines: tubes, coloured by network." : ""}`;
  };
  const scale = motion.pressureScale;
  const paint = () =>
    painted(canvas, view.height, (ctx) => {
      const f = clock.index;
      const g = Math.min(f + 1, motion.frames - 1);
      const w = g > f ? Math.min(Math.max((clock.time - motion.times[f]) / (motion.times[g] - motion.times[f]), 0), 1) : 0;
      ctx.save();
      ctx.setTransform(1, 0, 0, 1, 0, 0);
      ctx.drawImage(ghost, 0, 0);
      ctx.restore();
      paintObstacles(ctx, view, scene, factor, shift(f));
      const pressure = scale ? (b) => motion.ofBladder[f * motion.bladders + b] / scale.limit : null;
      paintBeam(ctx, view, shape(f, w), scene, layout, pressure);
    });
  const again = () => {
    prepare();
    paint();
  };
  const controls = el("div", { class: "controls" });
  if (motion.placed) controls.append(factorControl("Exaggerate", factor.across, (x) => ((factor.across = factor.along = x), again())));
  else if (!still) controls.append(factorControl("Exaggerate across", factor.across, (x) => ((factor.across = x), again())));
  if (!motion.placed && (factor.along !== 1 || (alongSize > 0 && alongSize < 0.02 * scene.length))) controls.append(factorControl("Exaggerate along", factor.along, (x) => ((factor.along = x), again())));
  if (moves && !motion.placed) {
    const box = el("input", { type: "checkbox", on: { change: () => ((follow = box.checked), again()) } });
    controls.append(el("label", {}, box, "Follow the root"));
  }
  const now = () => {
    const [f, n] = [clock.index, motion.nodes];
    return Array.from(motion.theta, (place, k) => [place, motion.u1[f * n + k], motion.u3[f * n + k]]);
  };
  host.append(canvas, downloads("Motion at this instant", () => canvasDrawing(canvas), () => [["theta [m]", `u1 at ${csvCell(clock.time)} s [m]`, "u3 [m]"], now()]));
  if (scale) host.append(colourBar(scale.limit, scale.most, "Pa"));
  host.append(controls, note);
  drawn(again);
  clock.onTick(paint);
}
