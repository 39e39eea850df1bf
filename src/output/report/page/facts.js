// Words and numbers: title, warnings, tiles, effects, the solver's work, parameters, files.

function showTop() {
  const button = el("button", { type: "button", class: "theme", id: "theme" });
  const name = () => (button.textContent = theme() === "dark" ? "Light" : "Dark");
  button.setAttribute("aria-label", "Switch between light and dark");
  button.addEventListener("click", () => {
    setTheme(theme() === "dark" ? "light" : "dark");
    name();
    try {
      localStorage.setItem("slcbeam-theme", theme());
    } catch {
      // Some browsers keep nothing for local files.
    }
  });
  name();
  document.getElementById("top").append(el("div", { class: "brand" }, "slcbeam ", el("span", { text: `· ${(data.label || "").toLowerCase()}` })), button);
}

function setTheme(to) {
  document.documentElement.dataset.theme = to;
  redraw();
}

/** Before anything is drawn: the theme kept, else that of the system. */
function firstTheme() {
  const dark = matchMedia("(prefers-color-scheme: dark)");
  let kept = null;
  try {
    kept = localStorage.getItem("slcbeam-theme");
  } catch {
    kept = null;
  }
  document.documentElement.dataset.theme = kept || (dark.matches ? "dark" : "light");
  dark.addEventListener("change", () => !kept && setTheme(dark.matches ? "dark" : "light"));
  // Paper is white.
  let before = null;
  addEventListener("beforeprint", () => ((before = theme()), setTheme("light")));
  addEventListener("afterprint", () => before && setTheme(before));
}

function showHead(main) {
  const status = data.status;
  main.append(el("div", { class: "head" },
    el("div", { class: "titleline" }, el("h1", { text: data.name }), status ? el("span", { class: `badge ${status.tone}`, text: status.word }) : null),
    data.about ? el("p", { class: "about" }, prose(data.about)) : null,
    data.answer ? el("p", { class: "answer", text: held(data.answer) }) : null,
    data.facts ? el("ul", { class: "factline" }, data.facts.map((text) => el("li", { text }))) : null));
  if (status?.reason) {
    const title = status.tone === "bad" ? (data.kind === "run" ? "The run did not reach its end" : "It did not reach its end") : "Why it ended early";
    main.append(el("div", { class: `notice ${status.tone === "bad" ? "bad" : ""}`, role: "note", id: "reason" }, el("h2", { text: title }), el("p", { text: status.reason })));
  }
}

/** Paragraphs and lists of a short text; marks of emphasis fall away. */
function paragraphs(text) {
  const plain = text.replace(/\n\*\*Do\.\*\*/g, "\n\nWhat to do:").replace(/\*\*/g, "").replace(/\[([^\]]+)\]\([^)]+\)/g, "$1");
  return plain.split(/\n\s*\n/).filter((t) => t.trim() && !t.startsWith("```")).map((t) => el("p", {}, prose(t.replace(/\s*\n\s*/g, " "))));
}

function showWarnings(main) {
  const groups = data.warnings || [];
  if (!groups.length) return;
  const item = (group) => {
    const texts = group.texts.map((text) => (group.title ? text.replace(/^[^:]{3,48}:\s+/, "") : text));
    const more = group.explanation ? el("details", {}, el("summary", { text: `What this means (${group.code})` }), paragraphs(group.explanation)) : null;
    return el("li", {}, group.title ? el("b", { text: group.title }) : null, texts.map((text) => el("div", {}, prose(text))), more);
  };
  const shown = groups.length > 4 ? 3 : groups.length;
  const rest = groups.slice(shown);
  main.append(el("div", { class: "notice", role: "note", id: "warnings" },
    el("h2", { text: groups.length === 1 ? "One warning" : `${groups.length} warnings` }),
    el("ul", {}, groups.slice(0, shown).map(item)),
    rest.length ? el("details", {}, el("summary", { text: `${rest.length} more` }), el("ul", {}, rest.map(item))) : null));
}

/** A text whose numbers do not part from their units where lines break. */
function held(text) {
  return text.replace(/± /g, "±\u00a0").replace(/(\d) (?=(?:[fpnµmkMG]?(?:m|s|Pa|J|W|N|Hz|rad|l)\b|%))/g, "$1\u00a0");
}

function showTiles(main) {
  if (!data.tiles?.length) return;
  main.append(el("div", { class: { 6: "tiles three" }[data.tiles.length] || (data.tiles.length > 6 ? "tiles four" : "tiles"), id: "tiles" }, data.tiles.map((t) =>
    el("div", { class: "tile" }, el("div", { class: "label", text: t.label }), el("div", { class: "value", text: held(t.value) }), el("div", { class: "note", text: held(t.note) }), t.band ? el("div", { class: "note band" }, t.band.split("; ").map((text) => el("div", { text: held(text) }))) : null))));
}

function showRemarks(main) {
  for (const r of data.remarks || []) main.append(figure(r.title, r.text));
}

function showEffects() {
  if (!data.effects?.length) return;
  const body = section("effects", "Simulated effects", "Each effect can be simulated or left out; the program decides by a number, unless the case does. On: simulated. Off: left out.");
  const on = data.effects.filter((e) => e.value !== "off").length;
  const rows = data.effects.map((e) => [e.name.replace(/_/g, " "), e.value, e.about, e.reason]);
  body.append(figure(null, `${on} of ${data.effects.length} are on.`, sortable(["effect", "choice", "what it is", "why"], rows, { label: "Effects", dim: (r) => r[1] === "off" })));
}

function showWork() {
  const work = data.work;
  if (!work) return;
  const body = section("work", "Solver and cost", null);
  work.sentences.forEach((text) => body.append(el("p", { class: "lead", text })));
  const strip = el("div", { class: "shares", role: "img", "aria-label": work.parts.map((p) => `${p.words} ${Math.round(100 * p.share)} %`).join(", ") });
  const list = el("ul", { class: "legend" });
  drawn(() => {
    const tone = (k) => (k === work.parts.length - 1 ? css("--line") : named(k));
    strip.replaceChildren(...work.parts.map((p, k) => el("i", { style: `flex:${Math.max(p.share, 0.001)} 1 0;background:${tone(k)}` })));
    list.replaceChildren(...work.parts.map((p, k) => el("li", {}, svg("svg", { viewBox: "0 0 26 14" }, svg("rect", { width: 26, height: 14, rx: 4, style: `fill:${tone(k)}` })), el("span", {}, el("b", { text: p.words }), ` ${p.text}, ${(100 * p.share).toFixed(0)} %`))));
  });
  const orders = work.orders || [];
  const most = Math.max(...orders, 1);
  const total = orders.reduce((s, x) => s + x, 0);
  const histogram = el("div", { class: "orders", role: "img", "aria-label": `Steps by order: ${orders.map((n, k) => `order ${k + 1}: ${n}`).join(", ")}` },
    orders.map((n, k) => el("div", {}, count(n), el("i", { style: `height:${Math.round((62 * n) / most)}px` }), `order ${k + 1}`)));
  body.append(el("div", { class: "grid2" },
    figure("Where the time went", `${work.total} in all.`, strip, list),
    total ? figure("Steps by order", "Higher orders take longer steps where the motion is smooth.", histogram) : null));
}

function showCase() {
  if (!data.parameters?.length && !data.case_text) return;
  const body = section("case", "The case, and how to repeat it", "Everything that was given, with every default filled in.");
  if (data.command) {
    body.append(figure("Repeat it", data.elsewhere ? "In a terminal, within the folder of the result." : "In a terminal, within the folder of this page.", el("div", { class: "command" }, el("code", { text: data.command }), copyButton("Copy", data.command))));
  }
  const groups = new Map();
  for (const row of data.parameters || []) groups.set(row.group, [...(groups.get(row.group) || []), row]);
  const value = (text) => (text === "[]" || text === "{}" ? "none" : /^[[{]/.test(text) ? el("code", { text }) : text);
  const row = (about, shown, name) => el("tr", {}, el("td", { class: "why" }, about, el("code", { class: "key", text: name })), el("td", {}, shown));
  const rows = [...groups].flatMap(([group, list]) => [
    el("tr", { class: "group" }, el("td", { colspan: 2, text: group.replace(/_/g, " ") })),
    ...list.map((r) => row(r.about || r.pointer.split("/").pop().replace(/_/g, " "), value(r.value), r.pointer)),
  ]);
  const numbers = (data.characteristic || []).map((c) => row(c.about || c.name.replace(/_/g, " "), c.value, c.name));
  const fold = (title, label, list) => el("details", { class: "fold" }, el("summary", { text: title }),
    el("div", { class: "scroll", tabindex: "0", role: "region", "aria-label": label, "data-keys": "" }, el("table", { class: "pairs" }, el("tbody", {}, list))));
  const folds = [
    rows.length ? fold(`All ${(data.parameters || []).length} parameters`, "Parameters", rows) : null,
    numbers.length ? fold(`${numbers.length} characteristic numbers: what the parameters mean together`, "Characteristic numbers", numbers) : null,
    data.case_text ? el("details", { class: "fold" }, el("summary", { text: "case.json as it is" }), el("div", { class: "toolbar" }, copyButton("Copy", data.case_text)), el("pre", { class: "raw", tabindex: "0", "data-keys": "", text: data.case_text })) : null,
  ].filter(Boolean);
  if (folds.length) body.append(figure(null, null, ...folds));
}

function showFoot() {
  const files = data.files || [];
  if (files.length) {
    const [title, lead] = data.elsewhere
      ? ["Files of the result", "They lie in the folder of the result; this page was put elsewhere."]
      : ["Files beside this page", "Open them with any tool; the links work as long as the page stays in its folder."];
    const body = section("files", title, lead);
    body.append(el("ul", { class: "files" }, files.map((f) => el("li", {}, fileLink(f)))));
  }
  const made = data.made ? `${data.made} ` : "";
  document.getElementById("foot").append(el("p", { text: `${made}The page was made by slcbeam ${data.version} and needs nothing but itself.` }));
}

function showContents() {
  if (contents.length < 3) return;
  const nav = el("nav", { class: "contents", "aria-label": "Contents" }, contents.map(([id, title]) => el("a", { href: `#${id}`, text: title })));
  document.querySelector("main > section").before(nav);
}
