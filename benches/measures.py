"""Measurements: peers in alternating runs, peers with their own discretization, the program, single operations, large systems."""

import csv
import json
import math
import os
import re
import statistics
import subprocess
import sys
import time

from workers import ACCURACIES, BUILT, LONG, PEER_GROUPS, PEERS, ROOT, ROUNDS, SCENES, TOLERANCES, error, peers, run, shown, timed


# time limit of a run [s]; beyond it, the method is not run at tighter tolerances either
STUCK = 8.0


def groups(python):
    return {name: group for name, group in PEER_GROUPS.items() if python or group[0] != "python"}


def explore(all, scene, reference, python):
    """Measures points (method, tolerance, error, seconds, steps) of every group."""
    points = {}
    for name, (worker, methods) in groups(python).items():
        points[name] = []
        for method in methods:
            run(all[worker], f"{scene}@0.002", method, 1e-2)  # compiles
            run(all[worker], scene, "none", 1e-2)  # opens
            for rtol in TOLERANCES:
                begin = time.monotonic()
                ran = run(all[worker], scene, method, rtol, STUCK)
                if ran is None:
                    if time.monotonic() - begin > STUCK:
                        break
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
            points[name] += between(all[worker], scene, reference, method, [p for p in points[name] if p["method"] == method])
    return points


def between(worker, scene, reference, method, points):
    """Adds, for each accuracy, the tolerance halfway to the next looser one: half decades are coarse for methods of high order."""
    found = []
    for accuracy in ACCURACIES:
        for looser, tighter in zip(points, points[1:]):
            if looser["error"] > accuracy >= tighter["error"] and tighter["seconds"] < LONG:
                rtol = math.sqrt(looser["rtol"] * tighter["rtol"])
                rans = [ran for ran in (run(worker, scene, method, rtol, STUCK) for _ in range(3)) if ran]
                if rans:
                    e = error(rans[0]["histories"], reference)
                    seconds = min(ran["seconds"] for ran in rans)
                    found.append({"method": method, "rtol": rtol, "error": e, "seconds": seconds, "steps": rans[0]["steps"]})
    return found


def cheapest(points, accuracy):
    reached = [p for p in points if p["error"] <= accuracy]
    return min(reached, key=lambda p: p["seconds"]) if reached else None


def compare(all, scene, points, python):
    """Measures the cheapest setting of each group at each accuracy again, in alternating runs: medians and ratios to slcbeam."""
    chosen = {name: [cheapest(points[name], a) for a in ACCURACIES] for name in points}
    settings = {(name, p["method"], p["rtol"]): [] for name in chosen for p in chosen[name] if p}
    long = {key for key in settings for p in points[key[0]] if (p["method"], p["rtol"]) == key[1:] and p["seconds"] > LONG}
    for turn in range(ROUNDS):
        for key in settings:
            if turn > 0 and key in long:
                settings[key].append(settings[key][0])
                continue
            name, method, rtol = key
            ran = timed(all[PEER_GROUPS[name][0]], scene, method, rtol)
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
        table = compare(all, scene, points, python)
        results[scene] = {
            "reference_differs": error(other, reference), "points": points, "table": table,
            "profile": [p and peers("profile", scene, p["method"], p["rtol"]) for p in table["slcbeam"]],
        }
        print(f"{scene}: measured in {time.monotonic() - begin:.0f} s", file=sys.stderr)
    return results


# Beams with the peers' own discretization: scene, peer, elements, steps per output interval, accuracies, required ratio of times.
RODS = {
    "PyElastica": (
        "dry-cantilever-sheared", "elastica", [10, 14, 20, 28, 40, 56, 80, 113, 160], [4, 8, 16, 32, 64], [1e-2, 3e-3, 1e-3], 100.0,
    ),
    "Exudyn": ("swing", "exudyn", [2, 3, 4, 6, 8, 12, 16], [1, 2, 4, 8, 16], ACCURACIES, None),
}
# Cells of slcbeam's meshes: of second order, of fourth order, and of the pair that gives the reference.
OWN_CELLS, OWN_FOURTH, LIMIT = [10, 20, 40, 80, 160], [10, 14, 20, 28, 40, 56, 80], [160, 320]


def measure_rods(all):
    """Measures errors in space and time against the extrapolated limit of slcbeam's finest meshes."""
    out = {"points": {}, "ratios": [], "rows": [["beam", "error", "slcbeam", "peer", "peer / slcbeam"]], "limits": []}
    for name, (scene, peer, elements, steps, accuracies, wanted) in RODS.items():
        fine = [run(all["peers"], f"{scene}*{cells}", "esdirk57", 1e-7, 120.0)["histories"][0] for cells in LIMIT]
        limit = [[b + (b - a) / 3.0 for a, b in zip(*fine)], [0.0]]
        own, theirs = [], []
        for mesh in [f"{scene}*{cells}" for cells in OWN_CELLS] + [f"{scene}*{cells}/4" for cells in OWN_FOURTH]:
            for method in PEER_GROUPS["slcbeam"][1]:
                for rtol in TOLERANCES[:9]:
                    ran = run(all["peers"], mesh, method, rtol)
                    if ran:
                        e = error(ran["histories"], limit, (0,))
                        own.append(dict(scene=mesh, method=method, rtol=rtol, error=e, seconds=ran["seconds"]))
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
                    # stability limits explicit steps anyway; a smaller step does not change the error
                    if ran["seconds"] > LONG or (peer == "elastica" and more > 1):
                        break
        best = min(p["error"] for p in theirs)
        out["points"][name] = {"slcbeam": own, name: theirs}
        out["limits"].append(f"{name} comes to {best:.1e} of the limit of slcbeam's meshes")
        ratios = []
        for accuracy in accuracies:
            pair = [cheapest(own, accuracy), cheapest(theirs, accuracy)]
            cells = ["not reached", "not reached"]
            times = [[], []]
            if None not in pair:
                for _ in range(ROUNDS):
                    for k, (p, worker) in enumerate(zip(pair, ("peers", "rods"))):
                        times[k].append(timed(all[worker], p["scene"], p["method"], p["rtol"])["seconds"])
                ratios.append(statistics.median(b / a for a, b in zip(*times)))
            for k, p in enumerate(pair):
                if p:
                    seconds = statistics.median(times[k]) if times[k] else p["seconds"]
                    count, _, order = p["scene"].partition("*")[2].partition("/")
                    mesh = count and f"{count} cells{order and ' of fourth order'}, "
                    cells[k] = f"{shown(seconds)} `{p['method']}`, {mesh}{p['rtol']:.0e}"
            ratio = f"{ratios[-1]:.3g}" if None not in pair else "–"
            out["rows"].append([f"{name}, `{scene}`", f"{accuracy:.0e}", *cells, ratio])
        if wanted and ratios:
            texts = ", ".join(f"{r:.3g}" for r in ratios)
            out["ratios"].append([f"{wanted:.0f} times {name} at equal error", texts, min(ratios) >= wanted])
    return out


BINARY = os.environ.get("CARGO_TARGET_DIR", str(ROOT / "target")) + "/release/slcbeam"


def program(order, cells, fluid, rtol):
    """Runs the program once: wall time of the process, `wall_s`, figures, and number of rows of the history."""
    folder = BUILT / "run"
    sets = {
        "/ends/root/clamped/u3_m/sine/ramp_cycles": 1, "/mesh/order": order, "/mesh/cells_per_segment": cells,
        "/mesh/cells_per_bladder": fluid, "/solver/rtol": rtol,
    }
    command = [BINARY, "run", "cases/wiring-2.json", "--quiet", "--out", str(folder)]
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
    """Measures the program on wiring-2 with a smooth start: time of the whole process against the error of its figures."""
    coarse, fine = (program(2, k, k // 2, 1e-6)["figures"] for k in (16, 32))
    limit = [b + (b - a) / 3.0 for a, b in zip(coarse, fine)]
    rows = [
        ["order", "cells a segment", "rtol", "error, over the run", "in the window", "process", "`total` of `wall_s`", "output", "output a row"]
    ]
    points, out = [], {"held": []}
    meshes = [(2, cells) for cells in (2, 4, 6, 8, 12, 16)] + [(4, cells) for cells in (1, 2, 3, 4, 6, 8)]
    for order, cells in meshes:
        for rtol in (1e-2, 1e-3, 1e-4, 1e-5):
            runs = [program(order, cells, max(1, cells // 2), rtol) for _ in range(ROUNDS)]
            errors = [abs(a - b) / abs(b) for a, b in zip(runs[0]["figures"], limit)]
            run_error, window_error = max(errors[0::2]), max(errors[1::2])
            middle = sorted(runs, key=lambda r: r["seconds"])[len(runs) // 2]
            points.append({"errors": [run_error, max(errors)], "seconds": middle["seconds"], "order": order, "cells": cells, "rtol": rtol})
            wall, simulated = middle["wall_s"], middle["time_s"]
            a_row = f"{1e6 * wall['output'] / middle['rows']:.1f} us"
            rows.append([
                order, cells, f"{rtol:.0e}", f"{run_error:.1e}", f"{window_error:.1e}", shown(middle["seconds"]), shown(wall["total"]),
                shown(wall["output"]), a_row,
            ])
    for accuracy, part in ((1e-2, 30.0), (1e-3, 5.0)):
        for k, where in enumerate(("over the run", "over the run and in the window")):
            p = cheapest([p | {"error": p["errors"][k]} for p in points], accuracy)
            text = "not reached" if p is None else f"1/{simulated / p['seconds']:.3g} ({shown(p['seconds'])})"
            what = f"{100 * accuracy:g} % of `wiring-2`, {where}, in 1/{part:.0f} of the simulated time"
            out["held"].append([what, text, p is not None and p["seconds"] * part <= simulated])
    return out | {"points": points, "rows": rows}


SMOOTH = "/ends/root/clamped/u3_m/sine/ramp_cycles=1"
# scene, its changes, designs a second and core that must be reached
ENSEMBLES = [("shaken-sealed", [], 250.0), ("wiring-2", [SMOOTH], 400.0)]


def swept(scene, changes, designs, rtol):
    """Sweeps Young's modulus by 10 % on one core: wall time, and the figures of each design."""
    folder = BUILT / "sweep"
    sets = [f"/solver/rtol={rtol}", '/companion="off"', *changes]
    command = [BINARY, "sweep", f"cases/{scene}.json", "--vary", f"/beam/young_modulus_pa=lin:1.9e6:2.1e6:{designs}", "--jobs", "1"]
    command += ["--lean", "--quiet", "--restart", "--out", str(folder)] + [word for one in sets for word in ("--set", one)]
    begin = time.perf_counter()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, cwd=ROOT)
    seconds = time.perf_counter() - begin
    with open(folder / "sweep.csv") as lines:
        rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    columns = [name for name in rows[0] if name.split(" ")[0] in ("tip_u1_m.max_abs", "max_pressure_pa.max_abs")]
    return seconds, [[float(row[name]) for name in columns] for row in rows]


def measure_ensemble():
    """Measures sweeps: designs a second and core, all of which are within 1 % in time."""
    rows, out = [["scene", "designs", "rtol", "largest error of a design", "designs a second and core", "a design"]], {"held": []}
    for scene, changes, wanted in ENSEMBLES:
        few, many = 64, 256
        exact = swept(scene, changes, few, 1e-7)[1]
        points = []
        for rtol in (1e-1, 3e-2, 1e-2, 3e-3, 1e-3, 3e-4):
            found = swept(scene, changes, few, rtol)[1]
            worst = max(abs(a - b) / abs(b) for own, theirs in zip(found, exact) for a, b in zip(own, theirs))
            if worst <= 1e-2:
                seconds = statistics.median(swept(scene, changes, many, rtol)[0] for _ in range(ROUNDS))
                points.append((many / seconds, rtol, worst))
                rows.append([f"`{scene}`", many, f"{rtol:.0e}", f"{worst:.1e}", f"{many / seconds:.0f}", shown(seconds / many)])
        best = max(points, default=None)
        text = "not reached" if best is None else f"{best[0]:.0f}"
        out["held"].append([f"{wanted:.0f} designs of `{scene}` a second and core within 1 %", text, best is not None and best[0] >= wanted])
    return out | {"rows": rows}


def instructions(scene, what):
    """Instructions of one operation, from callgrind's counts of two runs; None without valgrind."""
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


def measure_prices():
    rows = [["scene", "unknowns"] + [f"{what} [us]" for what in OPERATIONS] + ["residuals a Jacobian"]]
    counted = [["scene"] + [f"{what} [1000 instructions]" for what in OPERATIONS]]
    for scene in SCENES:
        p = peers("prices", scene)
        us = [1e6 * p[what] for what in OPERATIONS]
        rows.append([f"`{scene}`", p["unknowns"], *(f"{x:.2f}" for x in us), f"{us[1] / us[0]:.1f}"])
        numbers = [instructions(scene, what) for what in OPERATIONS]
        counted.append([f"`{scene}`", *("–" if n is None else f"{n / 1e3:.1f}" for n in numbers)])
    return {"rows": rows, "counted": counted}


def exponent(pairs):
    """Exponent of a power law: slope of the regression line through the logarithms."""
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
        f"{p['bytes'] / p['unknowns']:.0f}", f"{1e-9 / p['reading']:.0f} GB/s",
    ]


LARGE = [
    "wiring", "unknowns", "set-up", "step", "iterations a step", "time over floor", "residual [ns/unknown]", "solution", "factors",
    "Jacobian", "memory", "bytes an iteration [B/unknown]", "so many are read at",
]


def without_waiting(p, smallest):
    """Seconds per iteration, minus the extra time of reading its bytes from memory instead of the caches."""
    return p["seconds"] / p["iterations"] - p["bytes"] * (p["reading"] - smallest["reading"])


def measure_large():
    """Measures chains, and other wirings at 100 and 1000 bladders per row. Each runs in its own process, so that memory is counted apart."""
    chains = [peers("large", "chain", n) for n in (10, 100, 1000, 10000, 100000)]
    floor = [LARGE] + [large_row(p, f"{p['case']}") for p in chains]
    # the number of iterations per step depends on the motion, so the exponent is per iteration
    an_iteration = [(p["unknowns"], p["seconds"] / p["iterations"]) for p in chains]
    exponents = {"an iteration": exponent(an_iteration)}
    exponents["an iteration, to 20 000 unknowns"] = exponent(an_iteration[:3])
    rest = [(p["unknowns"], without_waiting(p, chains[0])) for p in chains]
    exponents["an iteration, less its waiting for memory"] = exponent(rest)
    for what in ("residual", "solve", "factor", "jacobian", "memory"):
        exponents[what] = exponent([(p["unknowns"], p[what]) for p in chains if p[what]])
    scale = [LARGE]
    for wiring in ("ring", "ladder", "tree", "random"):
        pair = [peers("large", wiring, n) for n in (100, 1000)]
        scale += [large_row(p, p["case"]) for p in pair]
        exponents[wiring] = exponent([(p["unknowns"], p["seconds"] / p["iterations"]) for p in pair])
    value, own = exponents["an iteration"], exponents["an iteration, less its waiting for memory"]
    largest = chains[-1]
    set_up, memory = largest["start"] + largest["set_up"], largest["memory"] or 0
    fits = set_up < 30 and memory < 20 * 2**30
    what = f"{largest['unknowns'] / 1e6:.1f} million unknowns, 200 000 bladders, set up in 30 s, run within 20 GiB"
    held = [[what, f"{set_up:.1f} s, {memory / 2**30:.1f} GiB", fits]]
    beyond = f"{value:.2f}, {own:.2f} without what memory explains"
    held += [["exponent of time an iteration over unknowns at most 1.08 beyond memory's bandwidth, chains", beyond, own <= 1.08]]
    rows = [["exponent of time over unknowns", ""]] + [[key, f"{value:.2f}"] for key, value in exponents.items()]
    return {"floor": floor, "scale": scale, "exponents": rows, "held": held}
