// A deformed beam on a canvas: a band as high as the beam, its bladders coloured by pressure, its tubes as lines.

/** Positions of the nodes of a shape and the unit vectors along which its sections lie: x along, y across. `angle`: of sections that shear; `nodes`: of a structure. */
function curveOf(theta, u1, u3, factor, angle, nodes) {
  if (nodes) return structureCurve(nodes, u1, u3, factor, angle);
  const n = theta.length;
  const out = { theta, n, x: new Float64Array(n), y: new Float64Array(n), nx: new Float64Array(n), ny: new Float64Array(n) };
  for (let k = 0; k < n; k++) {
    out.x[k] = theta[k] + u3[k] * factor.along;
    out.y[k] = u1[k] * factor.across;
  }
  for (let k = 0; k < n; k++) {
    const [a, b] = [Math.max(k - 1, 0), Math.min(k + 1, n - 1)];
    const [dx, dy] = angle ? [Math.cos(angle[k]), factor.across * Math.sin(angle[k])] : [out.x[b] - out.x[a], out.y[b] - out.y[a]];
    const size = Math.hypot(dx, dy) || 1;
    out.nx[k] = -dy / size;
    out.ny[k] = dx / size;
  }
  return out;
}

/** Place of a point of the beam: `a` along, `e` across. */
function placed(curve, a, e, out) {
  const { theta, n } = curve;
  let k = Math.floor(((a - theta[0]) / (theta[n - 1] - theta[0])) * (n - 1));
  k = Math.min(Math.max(k, 0), n - 2);
  while (k > 0 && theta[k] > a) k--;
  while (k < n - 2 && theta[k + 1] < a) k++;
  const w = (a - theta[k]) / (theta[k + 1] - theta[k] || 1);
  const mix = (v) => v[k] * (1 - w) + v[k + 1] * w;
  out[0] = mix(curve.x) + e * mix(curve.nx);
  out[1] = mix(curve.y) + e * mix(curve.ny);
  return out;
}

/** Draws it; `view` maps metres to pixels; `pressure(b)` gives -1 to 1 for a bladder, or null. */
function paintBeam(ctx, view, curve, scene, layout, pressure) {
  const half = scene.height / 2;
  const at = [0, 0];
  const outline = (points) => {
    ctx.beginPath();
    points.forEach(([a, e], k) => {
      placed(curve, a, e - scene.line, at);
      if (k) ctx.lineTo(view.X(at[0]), view.Y(at[1]));
      else ctx.moveTo(view.X(at[0]), view.Y(at[1]));
    });
  };
  for (const part of partsOf(curve)) {
    ctx.beginPath();
    edges(ctx, view, curve, scene, part);
    ctx.closePath();
    ctx.fillStyle = css("--solid");
    ctx.fill();
    ctx.strokeStyle = css("--solid-line");
    ctx.lineWidth = 1;
    ctx.stroke();
  }
  if (layout.bladders.length) {
    const rim = layout.size[0] * view.scale > 6 ? css("--solid-line") : null;
    for (const b of layout.shown) {
      const [w, h] = b.size;
      const [l, r] = [b.a - w / 2, b.a + w / 2];
      if (b.outline) outline(b.outline.map(([z, x]) => [b.a + z, b.e + x]));
      else outline([[l, b.e - h / 2], [b.a, b.e - h / 2], [r, b.e - h / 2], [r, b.e + h / 2], [b.a, b.e + h / 2], [l, b.e + h / 2]]);
      ctx.closePath();
      const p = pressure ? pressure(b.index) : null;
      ctx.fillStyle = p === null ? css("--card") : divergingCss(p);
      ctx.fill();
      if (rim) {
        ctx.strokeStyle = rim;
        ctx.lineWidth = 0.7;
        ctx.stroke();
      }
    }
    ctx.lineCap = "round";
    ctx.lineJoin = "round";
    const thin = layout.segment * view.scale > 9 ? 1.8 : 0.7;
    const lines = layout.wires.map((wire) => (wire.far ? wire.points.map((p) => [p.a, p.e]) : refined(wire.points, layout.segment)));
    // A rim in the colour of the paper keeps lines apart from bladders of any colour.
    ctx.strokeStyle = css("--card");
    ctx.lineWidth = 2.2 * thin;
    for (const points of lines) {
      outline(points);
      ctx.stroke();
    }
    ctx.lineWidth = thin;
    layout.wires.forEach((wire, k) => {
      outline(lines[k]);
      ctx.strokeStyle = wireColour(wire.colour);
      ctx.setLineDash(wire.turbine ? [2, 4] : []);
      ctx.stroke();
    });
    ctx.setLineDash([]);
  }
  for (const end of endsOf(scene)) {
    if (end.form === "joined" || !end.held.slope || !(end.held.across || end.held.along)) continue;
    const a = end.a ?? (end.tip ? curve.theta[curve.n - 1] : curve.theta[0]);
    outline([[a, -half * 1.5 - 4 / view.scale], [a, half * 1.5 + 4 / view.scale]]);
    ctx.strokeStyle = css("--faint");
    ctx.lineWidth = 4;
    ctx.stroke();
  }
  if (scene.joints) paintJoints(ctx, view, curve, scene, half);
}

/** Ranges of the nodes of single beams, or of parts of them between joints. */
function partsOf(curve) {
  return curve.parts || [[0, curve.n]];
}

/** The sides of a part, there and back. */
function edges(ctx, view, curve, scene, [from, to]) {
  // Slightly inside, so that a border of segments belongs to the part.
  const middle = (curve.theta[from] + curve.theta[to - 1]) / 2;
  const half = (k) => halfHeight(scene, curve.parts ? curve.theta[k] + 1e-6 * (middle - curve.theta[k]) : curve.theta[k]);
  const edge = (k, height) => {
    const e = height - scene.line;
    ctx.lineTo(view.X(curve.x[k] + e * curve.nx[k]), view.Y(curve.y[k] + e * curve.ny[k]));
  };
  const e = half(from) - scene.line;
  ctx.moveTo(view.X(curve.x[from] + e * curve.nx[from]), view.Y(curve.y[from] + e * curve.ny[from]));
  for (let k = from + 1; k < to; k++) edge(k, half(k));
  for (let k = to - 1; k >= from; k--) edge(k, -half(k));
}

/** The outline of a shape filled with the present colour, for what is shown behind. */
function paintShade(ctx, view, curve, scene) {
  ctx.beginPath();
  for (const part of partsOf(curve)) edges(ctx, view, curve, scene, part);
  ctx.fill();
}

/** More points on long lines, so that they bend with the beam. */
function refined(points, segment) {
  const out = [[points[0].a, points[0].e]];
  for (let k = 1; k < points.length; k++) {
    const [p, q] = [points[k - 1], points[k]];
    const parts = Math.max(1, Math.ceil(Math.abs(q.a - p.a) / segment));
    for (let i = 1; i <= parts; i++) out.push([p.a + ((q.a - p.a) * i) / parts, p.e + ((q.e - p.e) * i) / parts]);
  }
  return out;
}

/** Widens bounds to a point. */
function widen(bounds, x, y) {
  if (x < bounds.x0) bounds.x0 = x;
  if (x > bounds.x1) bounds.x1 = x;
  if (y < bounds.y0) bounds.y0 = y;
  if (y > bounds.y1) bounds.y1 = y;
}

/** A view that holds all of [x0, x1] × [y0, y1], to scale, in a given width; higher than wide it never is. */
function viewOf(width, bounds, most) {
  const margin = 20;
  let scale = (width - 2 * margin) / Math.max(bounds.x1 - bounds.x0, 1e-12);
  let height = (bounds.y1 - bounds.y0) * scale + 2 * margin;
  if (height > most) {
    scale *= (most - 2 * margin) / (height - 2 * margin);
    height = most;
  }
  height = Math.max(height, 120);
  const left = (width - (bounds.x1 - bounds.x0) * scale) / 2;
  const middle = (bounds.y0 + bounds.y1) / 2;
  return { scale, height, X: (x) => left + (x - bounds.x0) * scale, Y: (y) => height / 2 - (y - middle) * scale };
}

/** A round factor by which a motion is drawn larger so that it shows: 1 where it shows already. */
function roundFactor(size, length) {
  if (!(size > 1e-9 * length) || size > 0.02 * length) return 1;
  const raw = (0.1 * length) / size;
  const power = 10 ** Math.floor(Math.log10(raw));
  return [5, 2, 1].map((m) => m * power).find((f) => f <= raw) || power;
}
