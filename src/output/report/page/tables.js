// Tables that sort by a click or a key on a heading.

/** A row of more columns is no block that is read in one go. */
const MOST_OF_A_BLOCK = 14;

/** `headings`: texts; `rows`: arrays of numbers, texts or nulls. Numbers are shown with their significant digits. */
function sortable(headings, rows, options = {}) {
  // A column of round numbers is shown as they are, another with four figures throughout.
  const round = headings.map((_, k) => rows.every((r) => typeof r[k] !== "number" || Number(r[k].toPrecision(3)) === r[k]));
  const text = (x, k) => (Number.isInteger(x) && Math.abs(x) < 1e6 ? count(x).replace("-", "−") : round[k] ? shortest(x) : significant(x, 4));
  const shown = (x, k) => (typeof x === "number" ? text(x, k) : x === null || x === undefined || x === "" ? "–" : String(x));
  const numeric = headings.map((_, k) => rows.some((r) => typeof r[k] === "number") && rows.every((r) => typeof r[k] === "number" || r[k] === null || r[k] === ""));
  const wordy = headings.map((_, k) => rows.some((r) => String(r[k] ?? "").length > 40));
  // On a narrow screen a table with words is a block a row; one of numbers, or of very many columns, scrolls sideways.
  const blocks = headings.length <= MOST_OF_A_BLOCK && headings.some((_, k) => k > 0 && !numeric[k] && rows.some((r) => typeof r[k] === "string" && r[k] !== ""));
  const long = headings.map((h, k) => !numeric[k] && rows.some((r) => String(r[k] ?? "").length > 16));
  const role = (name) => (blocks ? name : null);
  const title = (heading) => (heading.startsWith("/") ? heading : heading.replace(/ \[1\]$/, "").replace(/_/g, " "));
  const body = el("tbody", { role: role("rowgroup") });
  const cell = (x, k) => {
    const of = { role: role(k === 0 ? "rowheader" : "cell"), "data-of": blocks && (k > 0 || numeric[0]) ? title(headings[k]) : null, class: [numeric[k] ? "n" : wordy[k] ? "why" : null, long[k] ? "long" : null, shown(x, k) === "–" ? "none" : null].filter(Boolean).join(" ") || null };
    if (k === 0 && options.leads) return el("td", { ...of, class: "n" }, lead(shown(x, k), options.leads[x]));
    return kinds.has(x) ? el("td", of, el("span", { class: `pill ${x}`, text: x })) : el("td", { ...of, text: shown(x, k) });
  };
  const kinds = new Set(["needed", "on", "off"]);
  const fill = (list) => body.replaceChildren(...list.map((r) => el("tr", { role: role("row"), class: options.dim?.(r) ? "off" : null, id: options.leads ? `design-${r[0]}` : null }, r.map(cell))));
  const cells = headings.map((heading, k) => {
    const cell = el("th", { role: role("columnheader"), scope: "col", class: numeric[k] ? "n" : null, "aria-sort": "none" });
    cell.append(el("button", { type: "button", text: title(heading), on: { click: () => sort(k) } }));
    return cell;
  });
  const sort = (k) => {
    const down = cells[k].getAttribute("aria-sort") === "ascending";
    cells.forEach((c) => c.setAttribute("aria-sort", "none"));
    cells[k].setAttribute("aria-sort", down ? "descending" : "ascending");
    const rank = (a, b) => {
      const [x, y] = [a[k], b[k]];
      if (x === null || x === undefined || x === "") return 1;
      if (y === null || y === undefined || y === "") return -1;
      const order = typeof x === "number" && typeof y === "number" ? x - y : String(x).localeCompare(String(y), "en", { numeric: true });
      return down ? -order : order;
    };
    fill([...rows].sort(rank));
  };
  fill(rows);
  const table = el("table", { role: role("table") }, el("thead", { role: role("rowgroup") }, el("tr", { role: role("row") }, cells)), body);
  return sideways(el("div", { class: blocks ? "scroll blocks" : "scroll", tabindex: "0", role: "region", "aria-label": options.label || "Table", "data-keys": "" }, table), "More columns stand to the right: scroll the table sideways.");
}

/** Content that scrolls sideways, with a note above while part of it is hidden. */
function sideways(scroller, words) {
  const hint = el("p", { class: "hint", text: words, hidden: true });
  new ResizeObserver(() => (hint.hidden = scroller.scrollWidth <= scroller.clientWidth + 1)).observe(scroller);
  return [hint, scroller];
}

/** The number of a design with what it leads to. */
function lead(number, to) {
  if (!to) return [number];
  const copy = copyButton("Copy", to.command);
  copy.title = to.command;
  copy.className = "small";
  copy.setAttribute("aria-label", `Copy the command of design ${number}`);
  const file = to.file && !data.elsewhere;
  return [file ? el("a", { href: to.file.split("/").map(encodeURIComponent).join("/"), text: number }) : number, " ", copy];
}

/** Four figures, without zeros that say nothing. */
function shortest(x) {
  const text = significant(x, 4);
  const [digits, power] = text.split("·");
  return `${digits.includes(".") ? digits.replace(/\.?0+$/, "") : digits}${power ? `·${power}` : ""}`;
}

/** A table of the data with title, sentence and the file that has all of it. */
function tableCard(table) {
  const file = table.file ? el("p", { class: "caption" }, "All of it: ", fileLink(table.file)) : null;
  return figure(table.title, null, table.about ? el("p", { class: "caption", text: table.about }) : null, sortable(table.headings, table.rows, { label: table.title || table.name, leads: table.leads }), table.left_out ? el("p", { class: "caption", text: `${count(table.left_out)} more rows are in the file.` }) : null, file);
}

const DRAWN = new Set(["svg", "g", "a", "title", "rect", "circle", "polyline", "polygon", "text"]);

/** A drawing of the program as a part of the page: its words are text, its points say what they are and lead to their rows. What is no
 * drawing of the program's is shown as an image, which runs nothing. */
function drawing(source, title) {
  const bytes = Uint8Array.from(atob(source.split(",")[1]), (c) => c.charCodeAt(0));
  const svg = new DOMParser().parseFromString(new TextDecoder().decode(bytes), "image/svg+xml").documentElement;
  const plain = (a) => !a.name.startsWith("on") && a.name !== "style" && (!a.name.endsWith("href") || a.value.startsWith("#"));
  const all = [svg, ...svg.querySelectorAll("*")];
  if (!all.every((e) => DRAWN.has(e.localName) && [...e.attributes].every(plain))) return el("img", { src: source, alt: title });
  svg.setAttribute("role", svg.querySelector("a") ? "group" : "img");
  svg.setAttribute("aria-label", title);
  svg.setAttribute("class", "drawing");
  // the width at which its smallest words can be read
  const sizes = [...svg.querySelectorAll("[font-size]")].map((e) => parseFloat(e.getAttribute("font-size")));
  svg.style.setProperty("--least", `${Math.ceil((11 * (svg.viewBox.baseVal.width || 860)) / Math.min(...sizes, 11))}px`);
  return document.importNode(svg, true);
}

/** Function that returns headings and rows of a table of the page. */
function tableOf(table) {
  return table ? () => [table.headings, table.rows] : null;
}

/** A picture made by the program, on white. */
function pictureCard(part) {
  if (!part.picture) return null;
  if (part.picture.file) {
    return figure(part.title, null, el("p", { class: "caption" }, `The picture has ${quantity(part.picture.bytes / 1e6, "MB", 2)} and is left out of the page: `, fileLink(part.picture.file), "."));
  }
  const name = part.title || part.about || "Picture";
  const plate = el("div", { class: "plate", tabindex: "0", role: "region", "aria-label": `${name}, may scroll sideways`, "data-keys": "" }, drawing(part.picture, name));
  // On a narrow screen its words can be read and it scrolls; the whole picture is seen when it is asked for.
  const whole = el("button", { type: "button", class: "whole", text: "Whole picture", "aria-pressed": "false" });
  whole.addEventListener("click", () => whole.setAttribute("aria-pressed", String(plate.classList.toggle("fit"))));
  const table = part.rows || tableOf(part.table || data.table || data.tables?.[0]);
  const own = plate.querySelector("svg") && downloads(part.title || part.about || "Picture", () => plate.querySelector("svg"), table);
  return figure(part.title, part.about, sideways(plate, "The picture is wider than the screen: scroll it sideways."), whole, own);
}
