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
