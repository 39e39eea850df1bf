// Energy: what came in, where it is, where it went, what does not close.

function showLedger(host, ledger, history, clock) {
  if (history) showEnergies(host, ledger, history, clock);
  const rows = [];
  const most = Math.max(1e-300, ...[...ledger.in, ...ledger.out, ...ledger.stored].map((e) => Math.abs(e.joule)), Math.abs(ledger.start || 0));
  const bar = (x) => {
    const width = (50 * Math.abs(x)) / most;
    return el("span", { class: "signed", "aria-hidden": "true" }, el("i", { class: x < 0 ? "minus" : null, style: `width:${width}%;left:${x < 0 ? 50 - width : 50}%` }));
  };
  const row = (words, joule, sum) => rows.push(el("tr", { class: sum ? "sum" : null }, el("td", { text: words }), el("td", { class: "n", text: joule === null ? "–" : quantity(joule, "J", 5) }), el("td", {}, joule === null || sum === "plain" ? null : bar(joule))));
  const group = (words) => rows.push(el("tr", { class: "group" }, el("td", { colspan: 3, text: words })));
  group("What should be there");
  row("energy at the start", ledger.start);
  // numbers have the signs with which they add up, words have none
  for (const e of ledger.in) row(e.words, e.joule);
  for (const e of ledger.out) row(e.words, e.joule);
  row("makes", ledger.expected, true);
  group("What is there at the end");
  for (const e of ledger.stored) row(e.words, e.joule);
  row("makes", ledger.now, true);
  group("Difference");
  row("not accounted for", ledger.residual, "plain");
  const open = ledger.relative === null ? "" : `At no time was more than ${significant(100 * ledger.relative, 2)} % of the largest energy unaccounted for: that is the error of the time integration.`;
  const others = ledger.others.map((o) => `${o.words} to ${significant(o.relative, 2)}`);
  const rest = others.length ? ` Other balances close, relative to their own size: ${others.join(", ")}.` : "";
  host.append(figure("The books at the end", `${open}${rest}`, el("div", { class: "scroll" }, el("table", {}, el("tbody", {}, rows)))));
}

function showEnergies(host, ledger, history, clock) {
  const by = (name) => history.columns.find((c) => c.name === name);
  const sum = (names) => {
    const found = names.map(by).filter((c) => c && largest(c.values) > 0);
    if (!found.length) return null;
    const out = new Float64Array(history.times.length);
    for (const c of found) for (let k = 0; k < out.length; k++) out[k] += c.values[k];
    return out;
  };
  const { columns } = ledger;
  const lines = [
    ["put in from outside", sum(columns.in)],
    ["stored now", sum(columns.stored)],
    ["lost", sum(columns.lost)],
    ["harvested", sum(columns.harvested)],
    ["added by the published forms", sum(columns.added)],
  ].filter(([, values]) => values && largest(values) > 0);
  const residual = by(columns.open[0]);
  if (!lines.length) return;
  const group = makePanels(history.times, clock, () => {
    group.add(lines.map(([label, values], k) => ({ label, values, unit: "J", colour: named(k) })), 280, "energy");
    if (residual) group.add([{ label: residual.label, values: residual.values, unit: "J", colour: css("--bad") }], 150, "residual");
  });
  host.append(figure("Over time", "What was put in equals what is stored, lost and harvested; the small picture shows by how much it does not.", zoomTools(group), group.slot));
  group.begin();
}
