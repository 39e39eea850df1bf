// Side view of the simulated beam, to scale.

function drawScene(scene, host, readout, describe, scale) {
  const layout = layOut(scene);
  const frame = el("div");
  host.append(frame);
  let chosen = -1;
  const paint = () => {
    const width = Math.max(host.clientWidth, 280);
    frame.replaceChildren((scene.beams ? structureDrawing : sceneDrawing)(scene, layout, width, chosen));
    const picture = frame.firstChild;
    scale(picture.thicker);
    if (!layout.bladders.length) return;
    picture.setAttribute("tabindex", "0");
    picture.setAttribute("data-keys", "");
    picture.addEventListener("pointermove", (event) => {
      const box = picture.getBoundingClientRect();
      const wire = event.target.dataset?.wire;
      if (wire !== undefined) {
        readout.textContent = layout.wires[wire].words;
        readout.classList.remove("dim");
        return;
      }
      choose(picture.nearest(event.clientX - box.left, event.clientY - box.top));
    });
    picture.addEventListener("keydown", (event) => {
      const half = layout.bladders.length / 2;
      const moves = { ArrowLeft: -1, ArrowRight: 1, ArrowUp: chosen >= half ? -half : 0, ArrowDown: chosen < half ? half : 0 };
      if (!(event.key in moves)) return;
      event.preventDefault();
      const row = Math.floor(Math.max(chosen, 0) / half);
      const next = chosen < 0 ? 0 : chosen + moves[event.key];
      choose(Math.abs(moves[event.key]) === 1 ? Math.min(Math.max(next, row * half), (row + 1) * half - 1) : next);
    });
    picture.addEventListener("focus", () => chosen < 0 && choose(0));
  };
  const choose = (b) => {
    if (b < 0) return;
    chosen = b;
    const old = frame.querySelector(".chosen");
    if (old) old.remove();
    frame.firstChild.mark(b);
    readout.textContent = describe(layout.bladders[b], layout);
    readout.classList.remove("dim");
  };
  drawn(paint);
  return { layout, again: () => chosen >= 0 && choose(chosen) };
}

/** The drawing of given width. */
function sceneDrawing(scene, layout, width, chosen) {
  const across = scene.loads.some((l) => l.kind === "across");
  const others = scene.loads.filter((l) => l.kind === "along" || l.kind === "moment").length;
  const small = width < 560;
  const side = small ? 34 : 64;
  const scale = (width - 2 * side) / scene.length;
  // A beam too thin to be visible is drawn thicker, with a note in the caption.
  const thick = Math.max(scene.height * scale, 16);
  const thicker = thick / (scene.height * scale);
  const above = (across ? 64 : 14) + others * 26 + (layout.marks.some((m) => m.kind !== "sealed" && m.row > 0) ? 30 : 10);
  const below = (layout.marks.some((m) => m.kind !== "sealed" && m.row < 0) ? 34 : 12) + 40;
  const height = above + thick + below;
  const X = (a) => side + a * scale;
  const Y = (e) => above + thick / 2 - e * scale * thicker;
  const node = svg("svg", { class: "fig", width, height, viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": `Side view of the beam: ${scene.size}. ${layout.shown.length} bladders.` });
  const add = (...parts) => node.append(...parts);
  const parts = scene.heights || [scene.height];
  const borders = scene.borders || [0, scene.length];
  const edge = (sign) => parts.flatMap((h, k) => [[borders[k], (sign * h) / 2], [borders[k + 1], (sign * h) / 2]]);
  const around = [...edge(1), ...edge(-1).reverse()].map(([a, e]) => `${X(a).toFixed(1)} ${Y(e).toFixed(1)}`);
  add(svg("path", { d: `M${around.join("L")}Z`, "stroke-linejoin": "round", style: `fill:${css("--solid")};stroke:${css("--solid-line")}` }));
  drawEnds(add, scene, X, Y, thick);
  if (layout.bladders.length) drawBladders(add, layout, X, Y, scale, thicker);
  drawWires(add, layout, X, Y, scale);
  drawMarks(add, layout, X, Y, scene, thicker);
  if (layout.bladders.length) drawNumbers(add, layout, X, Y, scale, thicker);
  drawLoads(add, scene, X, Y(scene.height / 2) - (layout.marks.some((m) => m.kind !== "sealed" && m.row > 0) ? 34 : 8), width, height);
  scaleBar(add, scene, X, height, scale);
  node.thicker = thicker;
  node.nearest = (x, y) => {
    let best = [22 ** 2 + (layout.size[0] * scale) ** 2, -1];
    for (const b of layout.shown) {
      const d = (X(b.a) - x) ** 2 + (Y(b.e) - y) ** 2;
      if (d < best[0]) best = [d, b.index];
    }
    return best[1];
  };
  node.mark = (k) => {
    const b = layout.bladders[k];
    const [w, h] = [b.size[0] * scale, b.size[1] * scale * thicker];
    node.append(svg("rect", { class: "chosen", x: X(b.a) - w / 2 - 2, y: Y(b.e) - h / 2 - 2, width: w + 4, height: h + 4, rx: 4, style: `fill:none;stroke:${css("--accent")};stroke-width:3;pointer-events:none` }));
  };
  if (chosen >= 0) node.mark(chosen);
  return node;
}

function drawBladders(add, layout, X, Y, scale, thicker) {
  for (const b of layout.shown) {
    const [w, h] = [b.size[0] * scale, b.size[1] * scale * thicker];
    const colour = wireColour(layout.colourOf(b.network));
    const style = `fill:${css("--card")};stroke:${colour};stroke-width:${w > 8 ? 1.5 : 0.6}`;
    if (b.outline) add(svg("path", { d: `M${b.outline.map(([z, x]) => `${X(b.a + z).toFixed(1)} ${Y(b.e + x).toFixed(1)}`).join("L")}Z`, style }));
    else add(svg("rect", { x: X(b.a) - w / 2, y: Y(b.e) - h / 2, width: w, height: h, rx: Math.min(3, w / 4), style }));
  }
}

/** Numbers of bladders, over whatever crosses them. */
function drawNumbers(add, layout, X, Y, scale, thicker, degrees = 0) {
  const shown = layout.shown.filter((b) => b.size[0] * scale >= 17);
  const size = (b) => Math.min(11, (b.size[0] * scale) / 2.2);
  const style = `paint-order:stroke;stroke:${css("--card")};stroke-width:3.5px;stroke-linejoin:round;pointer-events:none`;
  for (const b of shown) {
    const h = b.size[1] * scale * thicker;
    const y = b.row > 0 ? Y(b.e) - h / 2 + Math.min(12, h * 0.42) : Y(b.e) + h / 2 - 3;
    add(svg("text", { x: X(b.a), y, "text-anchor": "middle", transform: degrees ? `rotate(${degrees} ${X(b.a)} ${y - 4})` : null, style: `font-size:${size(b)}px;${style}`, text: String(b.short).replace("-", "−") }));
  }
}

function drawWires(add, layout, X, Y, scale) {
  const touchable = layout.wires.length <= 1200;
  const strong = layout.segment * scale > 34 ? 3 : layout.segment * scale > 9 ? 2 : 1.2;
  layout.wires.forEach((wire) => {
    const d = linePath(wire.points.length, (i) => [X(wire.points[i].a), Y(wire.points[i].e)]);
    const colour = wireColour(wire.colour);
    const dash = wire.turbine ? "2 5" : null;
    add(svg("path", { d, style: `fill:none;stroke:${colour};stroke-width:${wire.free || wire.turbine ? 2.2 : strong};stroke-linejoin:round;stroke-linecap:round`, "stroke-dasharray": dash }));
    if (touchable && wire.words) add(svg("path", { d, "data-wire": wire.index, style: "fill:none;stroke:transparent;stroke-width:9;pointer-events:stroke" }));
    const m = middleOf(wire.points);
    const [x, y] = [X(m.a), Y(m.e)];
    if (wire.valve && strong > 1.5) {
      const turn = m.along ? 0 : 90;
      add(svg("path", { d: "M-6 -5V5L6 -5V5Z", transform: `translate(${x} ${y}) rotate(${turn})`, style: `fill:${css("--card")};stroke:${colour};stroke-width:1.6;stroke-linejoin:round` }));
    }
    if (wire.turbine) {
      const blades = [0, 120, 240].map((turn) => svg("path", { d: "M0 0C2 -3 2 -6 0 -7C-2 -6 -2 -3 0 0Z", transform: `rotate(${turn})`, style: `fill:${colour}` }));
      add(svg("g", { transform: `translate(${x} ${y})` }, svg("circle", { r: 9.5, style: `fill:${css("--card")};stroke:${colour};stroke-width:1.8` }), blades));
      if (wire.turbine.rectified) add(svg("path", { d: "M-4 -4L4 0L-4 4ZM4 -4V4", transform: `translate(${x + 19} ${y})`, style: `fill:${css("--card")};stroke:${colour};stroke-width:1.5` }));
    }
  });
  for (const j of layout.junctions || []) add(svg("circle", { cx: X(j.a), cy: Y(j.e), r: 4.5, style: `fill:${wireColour(j.colour)}` }));
}

/** Ends of chains and ports: a bar where nothing flows, a ring where pressure is given, an arrow where flow is. */
function drawMarks(add, layout, X, Y, scene, thicker, degrees = 0) {
  for (const mark of layout.marks) {
    const colour = wireColour(mark.colour);
    const [from, y] = [X(mark.at.a), Y(mark.at.e)];
    const x = X(mark.drawn ?? mark.at.a);
    if (mark.kind === "sealed") {
      add(svg("path", { d: `M${x} ${y - 5}V${y + 5}`, style: `stroke:${colour};stroke-width:3;stroke-linecap:round` }));
      continue;
    }
    const away = mark.row > 0 ? -1 : 1;
    const edge = Y((mark.row * scene.height) / 2) + away * 18;
    add(svg("path", { d: `M${from} ${y}${x === from ? "" : `H${x}`}V${edge - away * 6}`, style: `stroke:${colour};stroke-width:2.2;fill:none` }));
    if (mark.kind === "pressure") add(svg("circle", { cx: x, cy: edge, r: 8.5, style: `fill:${css("--card")};stroke:${colour};stroke-width:2` }));
    else add(svg("path", { d: `M${x - 9} ${edge + away * 8}H${x + 9}L${x} ${edge - away * 8}Z`, style: `fill:${css("--card")};stroke:${colour};stroke-width:2;stroke-linejoin:round` }));
    add(svg("text", { class: "strong", x, y: edge + (mark.kind === "pressure" ? 4 : away > 0 ? 7 : 0), "text-anchor": "middle", transform: degrees ? `rotate(${degrees} ${x} ${edge})` : null, style: "font-size:10px", text: mark.letter }));
  }
}

function arrow(x1, y1, x2, y2, colour, both) {
  const angle = Math.atan2(y2 - y1, x2 - x1);
  const head = (x, y, turn) => `M${x} ${y}L${x - 7 * Math.cos(turn - 0.45)} ${y - 7 * Math.sin(turn - 0.45)}M${x} ${y}L${x - 7 * Math.cos(turn + 0.45)} ${y - 7 * Math.sin(turn + 0.45)}`;
  return svg("path", { d: `M${x1} ${y1}L${x2} ${y2}${head(x2, y2, angle)}${both ? head(x1, y1, angle + Math.PI) : ""}`, style: `fill:none;stroke:${colour};stroke-width:1.8;stroke-linecap:round` });
}

function drawEnds(add, scene, X, Y, thick) {
  const [soft, strong] = [css("--faint"), css("--accent")];
  scene.ends.forEach((end, k) => {
    const out = k === 0 ? -1 : 1;
    const x = X(k === 0 ? 0 : scene.length);
    const y = Y(0);
    const { across, along, slope } = end.held;
    const reach = thick / 2 + 9;
    if (slope && (across || along)) {
      add(svg("path", { d: `M${x} ${y - reach}V${y + reach}`, style: `stroke:${soft};stroke-width:3` }));
      for (let h = -reach + 3; h < reach; h += 8) add(svg("path", { d: `M${x} ${y + h}l${out * 8} 7`, style: `stroke:${soft};stroke-width:1.3` }));
    } else if (across || along) {
      add(svg("path", { d: `M${x} ${y}l${out * 14} -9v18Z`, style: `fill:${css("--card")};stroke:${soft};stroke-width:2` }));
    }
    const at = x + out * 22;
    if (end.moves.along) add(arrow(at - 12, y, at + 12, y, strong, true));
    if (end.moves.across) add(arrow(at, y - 18, at, y + 18, strong, true));
    if (end.moves.slope || end.moment) add(svg("path", { d: `M${at} ${y - 14}a14 14 0 0 ${k === 0 ? 0 : 1} 0 28m${out * -6} -5l${out * 6} 5l${out * 4} -7`, style: `fill:none;stroke:${strong};stroke-width:1.8` }));
    if (end.force.across) {
      const up = end.force.across.sign < 0 ? -1 : 1;
      add(arrow(x + out * 4, y, x + out * 4, y - up * (thick / 2 + 26), strong, false));
    }
    if (end.force.along) {
      const right = end.force.along.sign < 0 ? -1 : 1;
      const [tail, head] = right === out ? [x + out * 4, x + out * 30] : [x + out * 32, x + out * 5];
      add(arrow(tail, y, head, y, strong, false));
    }
  });
}

function drawLoads(add, scene, X, base, width, height) {
  const colour = css("--accent");
  let y = base;
  const few = width < 560 ? 4 : 2;
  for (const load of scene.loads) {
    if (load.kind === "gravity") {
      const size = Math.hypot(load.x, load.z) || 1;
      const [gx, gy] = [width - 26, height - 22];
      add(arrow(gx - (14 * load.z) / size, gy + (14 * load.x) / size, gx + (14 * load.z) / size, gy - (14 * load.x) / size, colour, false));
      add(svg("text", { x: gx - 16 - Math.abs((14 * load.z) / size), y: gy + 4, "text-anchor": "end", text: "g" }));
      continue;
    }
    const places = load.values.length - 1;
    load.values.forEach((v, k) => {
      if (k % few || Math.abs(v) < 0.03) return;
      const x = X((scene.length * k) / places);
      if (load.kind === "across") add(v > 0 ? arrow(x, y, x, y - 10 - 32 * v, colour, false) : arrow(x, y - 10 + 32 * v, x, y, colour, false));
      else if (load.kind === "along") add(arrow(x, y - 8, x + v * 15, y - 8, colour, false));
      else add(svg("path", { d: `M${x - 5} ${y - 8}a5 5 0 1 ${v > 0 ? 1 : 0} 5 5`, style: `fill:none;stroke:${colour};stroke-width:1.5` }));
    });
    y -= load.kind === "across" ? 50 : 26;
  }
}

function scaleBar(add, scene, X, height, scale) {
  const power = 10 ** Math.floor(Math.log10(scene.length / 3));
  const length = [1, 2, 5, 10].map((m) => m * power).filter((l) => l <= scene.length / 3).pop() || power;
  const [x1, x2, y] = [X(0), X(0) + length * scale, height - 14];
  add(svg("path", { d: `M${x1} ${y - 4}v8M${x1} ${y}H${x2}M${x2} ${y - 4}v8`, style: `stroke:${css("--faint")};fill:none` }));
  add(svg("text", { x: x2 + 8, y: y + 4, text: quantity(length, "m", 2).replace(/\.0+ /, " ") }));
}
