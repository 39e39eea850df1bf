"""Tables, diagram and page of the results."""

import math
import re

from measures import RODS
from workers import ACCURACIES, ROOT, aligned, shown

PAGE = ROOT / "docs/performance.md"
# required ratio of the time of the fastest of some peers to slcbeam's time
REQUIRED = {"diffsol": 4.0, "Python": 15.0}
PYTHONS = ["scikit-sundae", "scikit-sundae, default settings", "scipy"]


def cell(p):
    if p is None:
        return "not reached"
    ratio = "" if p["ratio"] is None else f" ({p['ratio']:.2g})"
    return f"{shown(p['median'])}{ratio} `{p['method']}` {p['rtol']:.0e}"


def tables_of_runs(runs):
    out = {}
    for scene, result in runs.items():
        rows = [["", "1e-2", "1e-3", "1e-4"]]
        rows += [[name] + [cell(p) for p in row] for name, row in result["table"].items()]
        out[f"runs-{scene}"] = aligned(rows)
    rows = [["", "error", "steps", "rejected", "iterations a step", "Jacobians", "factors", "residuals", "Jacobians", "factors and solutions", "rest"]]
    for scene, result in runs.items():
        for accuracy, point, p in zip(ACCURACIES, result["table"]["slcbeam"], result.get("profile", [])):
            if p is None:
                continue
            shares = [p["residual"], p["jacobian"], p["linear"]]
            shares.append(1.0 - sum(shares))
            rows.append([
                f"`{scene}`, `{point['method']}`", f"{accuracy:.0e}", p["steps"], p["rejected"] + p["not_converged"],
                f"{p['iterations'] / p['steps']:.1f}", p["jacobians"], p["factorizations"], *(f"{100 * x:.0f} %" for x in shares),
            ])
    if len(rows) > 1:
        out["profile"] = aligned(rows)
    return out


def best_ratio(table, names, k):
    ratios = [table[name][k]["ratio"] for name in names if name in table and table[name][k] and table[name][k]["ratio"]]
    return min(ratios) if ratios else None


def held(results):
    """Rows of the table of requirements."""
    rows = [["what must hold", "measured", "holds"]]

    def add(what, value, holds):
        rows.append([what, value, "yes" if holds else "**no**"])

    for what, names in (("diffsol", ["diffsol"]), ("Python", PYTHONS)):
        for scene, result in results.get("runs", {}).items():
            ratios = [best_ratio(result["table"], names, k) for k in range(len(ACCURACIES))]
            if all(r is None for r in ratios):
                continue
            texts = ", ".join("not reached" if r is None else f"{r:.2g}" for r in ratios)
            least = min(r for r in ratios if r is not None)
            add(f"{REQUIRED[what]:.0f} times the best of {what}, `{scene}`", texts, least >= REQUIRED[what])
    for row in results.get("rods", {}).get("ratios", []):
        add(*row)
    for part in ("program", "ensemble"):
        for row in results.get(part, {}).get("held", []):
            add(*row)
    for row in results.get("large", {}).get("held", []):
        add(*row)
    return aligned(rows) if len(rows) > 1 else ""


def tables(results):
    out = tables_of_runs(results.get("runs", {}))
    rods, prices, large = (results.get(part, {}) for part in ("rods", "prices", "large"))
    for name, rows in (
        ("rods", rods.get("rows")), ("program", results.get("program", {}).get("rows")), ("ensemble", results.get("ensemble", {}).get("rows")), ("prices", prices.get("rows")),
        ("instructions", prices.get("counted")), ("floor", large.get("floor")), ("scale", large.get("scale")),
        ("exponents", large.get("exponents")),
    ):
        if rows:
            out[name] = aligned(rows)
    notes = [f"`{s}`: reference differs from one by another order by {r['reference_differs']:.0e}" for s, r in results.get("runs", {}).items()]
    notes += rods.get("limits", [])
    if notes:
        out["references"] = "\n".join(f"- {note}" for note in notes)
    held_rows = held(results)
    if held_rows:
        out["held"] = held_rows
    return out


def write_page(results):
    text = PAGE.read_text()
    for name, table in tables(results).items():
        begin, end = f"<!-- {name} -->\n", f"<!-- end of {name} -->"
        pattern = re.compile(re.escape(begin) + ".*?" + re.escape(end), re.S)
        if not pattern.search(text):
            raise SystemExit(f"{PAGE} has no place for {name}")
        text = pattern.sub(lambda _: f"{begin}\n{table}\n\n{end}", text)
    PAGE.write_text(text)


COLOURS = {
    "slcbeam": "#1b5e9b", "diffsol": "#d1662a", "Radau IIA of order 5, modelled": "#888888", "SUNDIALS in C": "#4c8c4a", "scikit-sundae": "#8a5aa8",
    "scikit-sundae, default settings": "#b79ccb", "scipy": "#a8893a", "PyElastica": "#b0444f", "Exudyn": "#3a9c98",
}


def front(points):
    """Pareto front of error and time, sorted by error."""
    out = []
    for p in sorted(points, key=lambda p: (p["error"], p["seconds"])):
        if not out or p["seconds"] < out[-1]["seconds"]:
            out.append(p)
    return out


def draw(results):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    panels = [(scene, result["points"]) for scene, result in results["runs"].items()]
    panels += [(RODS[name][0] + ", to the limit of meshes", points) for name, points in results.get("rods", {}).get("points", {}).items()]
    plt.rcParams.update({"font.size": 9, "svg.fonttype": "none", "svg.hashsalt": "slcbeam", "axes.spines.top": False, "axes.spines.right": False})
    columns = 3 if len(panels) > 2 else len(panels)
    rows = math.ceil((len(panels) + 1) / columns)
    figure, axes = plt.subplots(rows, columns, figsize=(4.2 * columns, 3.6 * rows), squeeze=False, layout="constrained")
    seen = {}
    for axis, (title, points) in zip(axes.flat, panels):
        for name, own in points.items():
            own = [p for p in own if 1e-6 < p["error"] < 1.0]
            colour = COLOURS[name]
            axis.plot([p["error"] for p in own], [p["seconds"] for p in own], ".", color=colour, alpha=0.25, markersize=4)
            best = front(own)
            (line,) = axis.plot([p["error"] for p in best], [p["seconds"] for p in best], "-o", color=colour, markersize=3.5, linewidth=1.6)
            seen.setdefault(name, line)
        axis.set(xscale="log", yscale="log", title=title, xlabel="error", ylabel="time [s]", xlim=(1.0, 1e-5))
        axis.grid(True, which="major", alpha=0.25)
    rest = axes.flat[len(panels) :]
    for axis in rest:
        axis.axis("off")
    rest[0].legend(seen.values(), seen.keys(), loc="center left", frameon=False, title="fastest settings; dots: all others")
    figure.savefig(PAGE.with_suffix(".svg"), metadata={"Date": None})
