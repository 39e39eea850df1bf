"""What scripts/bench does once everything is built: asks the workers for runs, measures, prints, and fills docs/performance.md.

Workers (benches/peers, benches/c, benches/python) take lines `SCENE METHOD RTOL` and answer `seconds steps tip.. pressure..`, so that
runs of all of them alternate on one machine and errors are measured in one place.
"""

import json
import math
import os
import re
import select
import statistics
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
BUILT = ROOT / "benches/peers/target"
PEERS = str(BUILT / "release/peers")
PYTHON = str(BUILT / "python/bin/python")
RESULTS = BUILT / "bench.json"
PAGE = ROOT / "docs/performance.md"

SCENES = ["shaken-sealed", "wiring-2", "dry-cantilever"]
ACCURACIES = [1e-2, 1e-3, 1e-4]
TOLERANCES = [10 ** (-k / 2) for k in range(4, 14)]
# who is compared: worker, methods
PEER_GROUPS = {
    "slcbeam": ("peers", ["ida2", "trbdf2", "esdirk34", "esdirk46", "esdirk57"]),
    "diffsol": ("peers", [f"diffsol-{m}-{s}" for m in ("bdf", "trbdf2", "esdirk34") for s in ("klu", "faer")]),
    "Radau IIA of order 5, modelled": ("peers", ["radau"]),
    "SUNDIALS in C": ("c", ["ida2", "ida5"]),
    "scikit-sundae": ("python", ["sundae-sparse2", "sundae-sparse5"]),
    "scikit-sundae, default settings": ("python", ["sundae-default"]),
    "scipy": ("python", ["scipy-radau", "scipy-bdf"]),
}
# what must hold: the fastest of some peers over slcbeam's time
REQUIRED = {"diffsol": 4.0, "Python": 15.0}
PYTHONS = ["scikit-sundae", "scikit-sundae, default settings", "scipy"]
ROUNDS = 5
# a run longer than this is measured once [s], and no tighter tolerance is asked of that method
LONG = 1.5


class Worker:
    """A process that answers lines."""

    def __init__(self, command):
        self.command, self.process = command, None

    def ask(self, line, timeout=60.0):
        """Words of the answer; nothing when there is none in time."""
        if self.process is None:
            self.process = subprocess.Popen(
                self.command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, cwd=ROOT
            )
            self.rest = b""
        self.process.stdin.write((line + "\n").encode())
        self.process.stdin.flush()
        end = time.monotonic() + timeout
        while b"\n" not in self.rest:
            ready, _, _ = select.select([self.process.stdout], [], [], max(0.0, end - time.monotonic()))
            more = os.read(self.process.stdout.fileno(), 1 << 20) if ready else b""
            if not more:
                self.close()
                return None
            self.rest += more
        answer, self.rest = self.rest.split(b"\n", 1)
        return answer.decode().split(" ")

    def close(self):
        if self.process is not None:
            self.process.kill()
            self.process.wait()
            self.process = None


def workers(python):
    all = {"peers": Worker([PEERS, "serve"]), "c": Worker([str(BUILT / "ida")])}
    if python:
        all["python"] = Worker([PYTHON, "benches/python/worker.py", PEERS])
        all["rods"] = Worker([PYTHON, "benches/python/rods.py", PEERS])
    return all


def run(worker, scene, method, rtol, timeout=60.0):
    """Seconds, steps, histories of tip and pressure; nothing when it failed."""
    words = worker.ask(f"{scene} {method} {rtol:.3e}", timeout)
    if words is None or words[0] == "failed":
        return None
    numbers = [float(word) for word in words[2:]]
    half = len(numbers) // 2
    if not all(map(math.isfinite, numbers)):
        return None
    return {"seconds": float(words[0]), "steps": int(words[1]), "histories": [numbers[:half], numbers[half:]]}


def error(histories, reference, what=(0, 1)):
    """Largest difference over the output times, relative to the largest value; the worst of tip and pressure."""
    worst = 0.0
    for k in what:
        size = max(map(abs, reference[k]))
        if size > 0.0:
            if len(histories[k]) != len(reference[k]):
                return math.inf
            worst = max(worst, max(abs(a - b) for a, b in zip(histories[k], reference[k])) / size)
    return worst


def groups(python):
    return {name: group for name, group in PEER_GROUPS.items() if python or group[0] != "python"}


def explore(all, scene, reference, python):
    """Points (method, tolerance, error, seconds, steps) of every group."""
    points = {}
    for name, (worker, methods) in groups(python).items():
        points[name] = []
        for method in methods:
            run(all[worker], scene, method, 1e-2)  # compiles, opens
            for rtol in TOLERANCES:
                ran = run(all[worker], scene, method, rtol)
                if ran is None:
                    continue
                seconds = [ran["seconds"]]
                if ran["seconds"] < 0.1:
                    seconds += [run(all[worker], scene, method, rtol)["seconds"] for _ in range(2)]
                e = error(ran["histories"], reference)
                points[name].append(
                    {"method": method, "rtol": rtol, "error": e, "seconds": min(seconds), "steps": ran["steps"]}
                )
                if ran["seconds"] > LONG or e < 0.3 * ACCURACIES[-1]:
                    break
    return points


def cheapest(points, accuracy):
    reached = [p for p in points if p["error"] <= accuracy]
    return min(reached, key=lambda p: p["seconds"]) if reached else None


def compare(all, scene, points, python):
    """The cheapest setting of each group at each accuracy, measured again in alternating runs: medians and ratios to slcbeam."""
    chosen = {name: [cheapest(points[name], a) for a in ACCURACIES] for name in points}
    settings = {(name, p["method"], p["rtol"]): [] for name in chosen for p in chosen[name] if p}
    long = {key for key in settings for p in points[key[0]] if (p["method"], p["rtol"]) == key[1:] and p["seconds"] > LONG}
    for turn in range(ROUNDS):
        for key in settings:
            if turn > 0 and key in long:
                settings[key].append(settings[key][0])
                continue
            name, method, rtol = key
            ran = run(all[PEER_GROUPS[name][0]], scene, method, rtol)
            settings[key].append(ran["seconds"] if ran else math.nan)
    table = {}
    for name, row in chosen.items():
        table[name] = []
        for own, p in zip(chosen["slcbeam"], row):
            if p is None:
                table[name].append(None)
                continue
            times = settings[name, p["method"], p["rtol"]]
            ratio = None
            if own is not None:
                base = settings["slcbeam", own["method"], own["rtol"]]
                ratio = statistics.median(t / b for t, b in zip(times, base))
            table[name].append(p | {"median": statistics.median(times), "ratio": ratio})
    return table


def measure_runs(all, python):
    results = {}
    for scene in SCENES:
        begin = time.monotonic()
        reference = run(all["peers"], scene, "esdirk57", 1e-9, 120.0)["histories"]
        other = run(all["peers"], scene, "esdirk46", 1e-8, 120.0)["histories"]
        points = explore(all, scene, reference, python)
        results[scene] = {
            "reference_differs": error(other, reference), "points": points, "table": compare(all, scene, points, python)
        }
        print(f"{scene}: measured in {time.monotonic() - begin:.0f} s", file=sys.stderr)
    return results


def shown(seconds):
    return f"{1e3 * seconds:.3g} ms" if seconds < 1.0 else f"{seconds:.3g} s"


def aligned(rows):
    widths = [max(len(str(row[k])) for row in rows) for k in range(len(rows[0]))]
    lines = ["| " + " | ".join(str(cell).ljust(w) for cell, w in zip(row, widths)) + " |" for row in rows]
    return "\n".join([lines[0], "|" + "|".join("-" * (w + 2) for w in widths) + "|"] + lines[1:])


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
    return out


def best_ratio(table, names, k):
    ratios = [table[name][k]["ratio"] for name in names if name in table and table[name][k] and table[name][k]["ratio"]]
    return min(ratios) if ratios else None


def held(results):
    """Rows of the table of what must hold."""
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
    for row in results.get("program", {}).get("held", []):
        add(*row)
    for row in results.get("large", {}).get("held", []):
        add(*row)
    return aligned(rows) if len(rows) > 1 else ""


def peers(*arguments):
    answer = subprocess.run([PEERS, *map(str, arguments)], check=True, capture_output=True, text=True, cwd=ROOT)
    return json.loads(answer.stdout)


# Beams on which peers have a discretisation of their own: scene, its peer, elements, steps an output interval, times wanted.
RODS = {
    "PyElastica": ("dry-cantilever-sheared", "elastica", [10, 20, 40, 80], [4, 8, 16, 32, 64, 128], 100.0),
    "Exudyn": ("swing", "exudyn", [2, 4, 8, 16], [1, 2, 4, 8, 16], None),
}
OWN_CELLS = [1, 2, 4, 8, 16]


def measure_rods(all):
    """Error in space and time against the limit to which slcbeam's finest meshes point."""
    out = {"points": {}, "ratios": [], "rows": [["beam", "error", "slcbeam", "peer", "peer / slcbeam"]], "limits": []}
    for name, (scene, peer, elements, steps, wanted) in RODS.items():
        fine = [run(all["peers"], f"{scene}:{k}", "esdirk57", 1e-7, 120.0)["histories"][0] for k in (16, 32)]
        limit = [[b + (b - a) / 3.0 for a, b in zip(*fine)], [0.0]]
        own, theirs = [], []
        for k in OWN_CELLS:
            for method in ("esdirk34", "esdirk46", "ida2"):
                for rtol in (1e-1, 10**-1.5, 1e-2, 10**-2.5, 1e-3, 1e-4, 1e-5):
                    ran = run(all["peers"], f"{scene}:{k}", method, rtol)
                    if ran:
                        e = error(ran["histories"], limit, (0,))
                        own.append(dict(scene=f"{scene}:{k}", method=method, rtol=rtol, error=e, seconds=ran["seconds"]))
                        if ran["seconds"] > 0.3:
                            break
        for n in elements:
            more = 0
            for step in steps:
                ran = run(all["rods"], scene, f"{peer}-{n}", step, 30.0)
                if ran:
                    e = error(ran["histories"], limit, (0,))
                    theirs.append(dict(scene=scene, method=f"{peer}-{n}", rtol=step, error=e, seconds=ran["seconds"]))
                    more += 1
                    # explicit steps are short of what stability asks for, more of them change nothing
                    if ran["seconds"] > LONG or (peer == "elastica" and more > 1):
                        break
        best = min(p["error"] for p in theirs)
        out["points"][name] = {"slcbeam": own, name: theirs}
        out["limits"].append(f"{name} comes to {best:.1e} of the limit of slcbeam's meshes")
        ratios = []
        for accuracy in ACCURACIES:
            pair = [cheapest(own, accuracy), cheapest(theirs, accuracy)]
            cells = ["not reached", "not reached"]
            times = [[], []]
            if all_there(pair):
                for _ in range(ROUNDS):
                    for k, (p, worker) in enumerate(zip(pair, ("peers", "rods"))):
                        times[k].append(run(all[worker], p["scene"], p["method"], p["rtol"])["seconds"])
                ratios.append(statistics.median(b / a for a, b in zip(*times)))
            for k, p in enumerate(pair):
                if p:
                    seconds = statistics.median(times[k]) if times[k] else p["seconds"]
                    mesh = p["scene"].partition(":")[2]
                    cells[k] = f"{shown(seconds)} `{p['method']}`, {mesh + ' cells a segment, ' if mesh else ''}{p['rtol']:.0e}"
            ratio = f"{ratios[-1]:.3g}" if all_there(pair) else "–"
            out["rows"].append([f"{name}, `{scene}`", f"{accuracy:.0e}", *cells, ratio])
        if wanted and ratios:
            texts = ", ".join(f"{r:.3g}" for r in ratios)
            out["ratios"].append([f"{wanted:.0f} times {name} at equal error", texts, min(ratios) >= wanted])
    return out


def all_there(pair):
    return all(p is not None for p in pair)


def program(cells, fluid, rtol):
    """Wall time of the whole process, `wall_s`, figures, and rows of the history of one run of the program."""
    folder = BUILT / "run"
    binary = os.environ.get("CARGO_TARGET_DIR", str(ROOT / "target")) + "/release/slcbeam"
    sets = {
        "/ends/root/clamped/u3_m/sine/ramp_cycles": 1, "/mesh/cells_per_segment": cells, "/mesh/cells_per_bladder": fluid,
        "/solver/rtol": rtol,
    }
    command = [binary, "run", "cases/wiring-2.json", "--quiet", "--out", str(folder)]
    command += [word for key, value in sets.items() for word in ("--set", f"{key}={value}")]
    begin = time.perf_counter()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, cwd=ROOT)
    seconds = time.perf_counter() - begin
    summary = json.loads((folder / "summary.json").read_text())
    with open(folder / "history.csv") as lines:
        rows = sum(1 for _ in lines) - 1
    quantities = summary["quantities"]
    figures = [quantities[q][f] for q in ("tip_u1_m", "max_pressure_pa") for f in ("max_abs", "window_max_abs")]
    return {"seconds": seconds, "wall_s": summary["wall_s"], "figures": figures, "rows": rows, "time_s": summary["time_s"]}


def measure_program():
    """The program on wiring-2, smooth start: time of the whole process against the error of its figures."""
    coarse, fine = (program(k, k // 2, 1e-6)["figures"] for k in (16, 32))
    limit = [b + (b - a) / 3.0 for a, b in zip(coarse, fine)]
    rows = [["cells a segment", "rtol", "error of figures", "process", "`total` of `wall_s`", "output", "output a row"]]
    points, out = [], {"held": []}
    for cells in (2, 4, 8, 16):
        for rtol in (1e-2, 1e-3, 1e-4, 1e-5):
            runs = [program(cells, max(1, cells // 2), rtol) for _ in range(ROUNDS if cells < 16 else 3)]
            e = max(abs(a - b) / abs(b) for a, b in zip(runs[0]["figures"], limit))
            middle = sorted(runs, key=lambda r: r["seconds"])[len(runs) // 2]
            points.append({"error": e, "seconds": middle["seconds"], "cells": cells, "rtol": rtol})
            wall = middle["wall_s"]
            a_row = f"{1e6 * wall['output'] / middle['rows']:.1f} us"
            rows.append(
                [cells, f"{rtol:.0e}", f"{e:.1e}", shown(middle["seconds"]), shown(wall["total"]), shown(wall["output"]), a_row]
            )
            simulated = middle["time_s"]
    for accuracy, part in ((1e-2, 30.0), (1e-3, 5.0)):
        p = cheapest(points, accuracy)
        text = "not reached" if p is None else f"1/{simulated / p['seconds']:.3g} ({shown(p['seconds'])})"
        holds = p is not None and p["seconds"] * part <= simulated
        out["held"].append([f"{100 * accuracy:g} % of `wiring-2` in 1/{part:.0f} of the simulated time", text, holds])
    return out | {"points": points, "rows": rows}


def instructions(scene, what):
    """Instructions of one operation, from callgrind's counts of two runs; nothing where valgrind is missing."""
    counts = []
    for times in (2, 22):
        command = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", PEERS, "work", scene, what, str(times)]
        try:
            answer = subprocess.run(command, capture_output=True, text=True, cwd=ROOT)
        except FileNotFoundError:
            return None
        found = re.search(r"Collected : (\d+)", answer.stderr)
        if not found:
            return None
        counts.append(int(found.group(1)))
    return (counts[1] - counts[0]) / 20


OPERATIONS = ["residual", "jacobian", "factor", "solve"]


def measure_prices(count=True):
    rows = [["scene", "unknowns"] + [f"{what} [us]" for what in OPERATIONS] + ["residuals a Jacobian"]]
    counted = [["scene"] + [f"{what} [1000 instructions]" for what in OPERATIONS]]
    for scene in SCENES:
        p = peers("prices", scene)
        us = [1e6 * p[what] for what in OPERATIONS]
        rows.append([f"`{scene}`", p["unknowns"], *(f"{x:.2f}" for x in us), f"{us[1] / us[0]:.1f}"])
        if count:
            numbers = [instructions(scene, what) for what in OPERATIONS]
            counted.append([f"`{scene}`", *("–" if n is None else f"{n / 1e3:.1f}" for n in numbers)])
    return {"rows": rows, "counted": counted if count else []}


def exponent(pairs):
    """Slope of a line through logarithms."""
    logs = [(math.log(n), math.log(t)) for n, t in pairs]
    x, y = (statistics.mean(v) for v in zip(*logs))
    return sum((a - x) * (b - y) for a, b in logs) / sum((a - x) ** 2 for a, _ in logs)


def large_row(p, name):
    us = 1e6 / p["unknowns"]
    memory = "–" if p["memory"] is None else f"{p['memory'] / 2**20:.0f} MiB"
    return [
        name, p["unknowns"], shown(p["start"] + p["set_up"]), shown(p["seconds"] / p["steps"]),
        f"{p['iterations'] / p['steps']:.1f}", f"{p['seconds'] / p['floor']:.2f}", f"{1e3 * us * p['residual']:.1f}",
        f"{1e3 * us * p['solve']:.1f}", f"{1e3 * us * p['factor']:.0f}", f"{1e3 * us * p['jacobian']:.0f}", memory,
    ]


LARGE = [
    "wiring", "unknowns", "set-up", "step", "iterations a step", "time over floor", "residual [ns/unknown]", "solution", "factors",
    "Jacobian", "memory",
]


def measure_large():
    """Chains, and other wirings at 100 and 1000 bladders a row; a process each, so that memory is its own."""
    chains = [peers("large", "chain", n) for n in (10, 100, 1000, 10000)]
    floor = [LARGE] + [large_row(p, f"{p['case']}") for p in chains]
    # a step's own iterations depend on the motion, so the exponent is that of an iteration
    an_iteration = [(p["unknowns"], p["seconds"] / p["iterations"]) for p in chains]
    exponents = {"an iteration": exponent(an_iteration)}
    exponents["an iteration, to 20 000 unknowns"] = exponent(an_iteration[:3])
    for what in ("residual", "solve", "factor", "jacobian", "memory"):
        exponents[what] = exponent([(p["unknowns"], p[what]) for p in chains if p[what]])
    scale = [LARGE]
    for wiring in ("ring", "ladder", "tree", "random"):
        pair = [peers("large", wiring, n) for n in (100, 1000)]
        scale += [large_row(p, p["case"]) for p in pair]
        exponents[wiring] = exponent([(p["unknowns"], p["seconds"] / p["iterations"]) for p in pair])
    value = exponents["an iteration"]
    held = [["exponent of time an iteration over unknowns at most 1.08, chains", f"{value:.2f}", value <= 1.08]]
    rows = [["exponent of time over unknowns", ""]] + [[key, f"{value:.2f}"] for key, value in exponents.items()]
    return {"floor": floor, "scale": scale, "exponents": rows, "held": held}


def tables(results):
    out = tables_of_runs(results.get("runs", {}))
    rods, prices, large = (results.get(part, {}) for part in ("rods", "prices", "large"))
    for name, rows in (
        ("rods", rods.get("rows")), ("program", results.get("program", {}).get("rows")), ("prices", prices.get("rows")),
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
    """Points that no other beats in both error and time, by error."""
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
    plt.rcParams.update({"font.size": 9, "svg.fonttype": "path", "svg.hashsalt": "slcbeam", "axes.spines.top": False, "axes.spines.right": False})
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
    metadata = {"Date": None}
    figure.savefig(PAGE.with_suffix(".svg"), metadata=metadata)
    figure.savefig(PAGE.with_suffix(".png"), dpi=110)


def check(python):
    """Compares equations to round-off; ends the script where they differ."""
    if not python:
        return
    answer = subprocess.run([PYTHON, "benches/python/worker.py", PEERS, "--check", *SCENES], cwd=ROOT)
    if answer.returncode != 0:
        raise SystemExit("equations differ: nothing is compared")


def quick(python):
    """Each peer once, coarsely; what fails ends the script."""
    check(python)
    all = workers(python)
    failed = []
    for name, (worker, methods) in groups(python).items():
        for method in methods:
            for scene in ("shaken-sealed@0.005", "dry-cantilever@0.002"):
                ran = run(all[worker], scene, method, 1e-2)
                print(f"{name}, {method}, {scene}: {'failed' if ran is None else str(ran['steps']) + ' steps'}")
                failed += [f"{method} on {scene}"] if ran is None else []
    reference = run(all["peers"], "dry-cantilever@0.002", "esdirk57", 1e-6)["histories"]
    for worker, method in (("peers", "radau"), ("peers", "diffsol-bdf-klu"), ("c", "ida2")) + ((("python", "sundae-sparse2"),) if python else ()):
        e = error(run(all[worker], "dry-cantilever@0.002", method, 1e-6)["histories"], reference)
        print(f"{worker}, {method}: error {e:.1e} at rtol 1e-6")
        failed += [f"{method} is wrong by {e}"] if not e < 1e-4 else []
    if python:
        for scene, method, steps in (("dry-cantilever-sheared", "elastica-10", 16), ("swing", "exudyn-4", 1)):
            ran = run(all["rods"], scene, method, steps)
            print(f"{method}: {'failed' if ran is None else str(ran['steps']) + ' steps'}")
            failed += [] if ran else [method]
    for scene in SCENES:
        for what in OPERATIONS:
            subprocess.run([PEERS, "work", scene, what, "1"], check=True, cwd=ROOT)
    for wiring in ("chain", "ring", "ladder", "tree", "random"):
        print(f"{wiring}: {peers('large', wiring, 10)['unknowns']} unknowns")
    for worker in all.values():
        worker.close()
    if failed:
        raise SystemExit("failed: " + ", ".join(failed))


def main(arguments):
    python = "--rust" not in arguments
    if "--quick" in arguments:
        return quick(python)
    if "--draw" in arguments:
        results = json.loads(RESULTS.read_text())
        draw(results)
        return write_page(results)
    parts = ["runs", "rods", "prices", "program", "large"]
    if "--only" in arguments:
        parts = arguments[arguments.index("--only") + 1].split(",")
    begin = time.monotonic()
    check(python)
    all = workers(python)
    results = json.loads(RESULTS.read_text()) if "--only" in arguments and RESULTS.exists() else {}
    measure = {
        "runs": lambda: measure_runs(all, python), "rods": lambda: measure_rods(all) if python else {}, "prices": measure_prices,
        "program": measure_program, "large": measure_large,
    }
    for part in parts:
        results[part] = measure[part]()
        print(f"{part}: {time.monotonic() - begin:.0f} s so far", file=sys.stderr)
        RESULTS.write_text(json.dumps(results, indent=1))
    for worker in all.values():
        worker.close()
    for name, table in tables(results).items():
        print(f"\n{name}\n\n{table}")
    print(f"\nresults in {RESULTS.relative_to(ROOT)}, after {time.monotonic() - begin:.0f} s")
    if "--page" in arguments:
        draw(results)
        write_page(results)


if __name__ == "__main__":
    main(sys.argv[1:])
