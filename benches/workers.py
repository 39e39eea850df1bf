"""Worker processes that run settings on request, and the errors and times of the runs.

Workers (benches/peers, benches/c, benches/python) read lines `SCENE METHOD RTOL` and answer `seconds steps tip.. pressure..`. Runs
of all workers alternate on one machine, and one function measures all errors.
"""

import json
import math
import os
import select
import subprocess
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
BUILT = ROOT / "benches/peers/target"
PEERS = str(BUILT / "release/peers")
PYTHON = str(BUILT / "python/bin/python")

SCENES = ["shaken-sealed", "wiring-2", "dry-cantilever"]
ACCURACIES = [1e-2, 1e-3, 1e-4]
TOLERANCES = [10 ** (-k / 2) for k in range(2, 14)]
# compared groups: worker, methods
PEER_GROUPS = {
    "slcbeam": ("peers", ["ida2", "trbdf2", "esdirk34", "esdirk46", "esdirk57"]),
    "diffsol": ("peers", [f"diffsol-{m}-{s}" for m in ("bdf", "trbdf2", "esdirk34") for s in ("klu", "faer")]),
    "Radau IIA of order 5, modelled": ("peers", ["radau"]),
    "SUNDIALS in C": ("c", ["ida2", "ida5"]),
    "scikit-sundae": ("python", ["sundae-sparse2", "sundae-sparse5"]),
    "scikit-sundae, default settings": ("python", ["sundae-default"]),
    "scipy": ("python", ["scipy-radau", "scipy-bdf"]),
}
ROUNDS = 5
# a longer run [s] is measured once, and the method is not run at tighter tolerances
LONG = 1.5


class Worker:
    """A process that answers requests line by line."""

    def __init__(self, command):
        self.command, self.process = command, None

    def ask(self, line, timeout=60.0):
        """Returns the words of the answer; None after the timeout."""
        if self.process is None:
            # on a shared machine, several threads would wait for each other
            own = os.environ | dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"), "1")
            self.process = subprocess.Popen(
                self.command, env=own, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                cwd=ROOT,
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
    """Returns seconds, steps, and histories of tip and pressure; None if the run failed."""
    words = worker.ask(f"{scene} {method} {rtol:.3e}", timeout)
    if words is None or words[0] == "failed":
        return None
    numbers = [float(word) for word in words[2:]]
    half = len(numbers) // 2
    if not all(map(math.isfinite, numbers)):
        return None
    return {"seconds": float(words[0]), "steps": int(words[1]), "histories": [numbers[:half], numbers[half:]]}


def timed(worker, scene, method, rtol):
    """Runs a setting twice and returns the second, warm run; a run above 0.3 s is not repeated."""
    ran = run(worker, scene, method, rtol)
    return run(worker, scene, method, rtol) if ran and ran["seconds"] < 0.3 else ran


def error(histories, reference, what=(0, 1)):
    """Largest difference over the output times, relative to the largest value; the larger one of tip and pressure."""
    worst = 0.0
    for k in what:
        size = max(map(abs, reference[k]))
        if size > 0.0:
            if len(histories[k]) != len(reference[k]):
                return math.inf
            worst = max(worst, max(abs(a - b) for a, b in zip(histories[k], reference[k])) / size)
    return worst


def peers(*arguments):
    answer = subprocess.run([PEERS, *map(str, arguments)], check=True, capture_output=True, text=True, cwd=ROOT)
    return json.loads(answer.stdout)


def shown(seconds):
    return f"{1e3 * seconds:.3g} ms" if seconds < 1.0 else f"{seconds:.3g} s"


def aligned(rows):
    widths = [max(len(str(row[k])) for row in rows) for k in range(len(rows[0]))]
    lines = ["| " + " | ".join(str(cell).ljust(w) for cell, w in zip(row, widths)) + " |" for row in rows]
    return "\n".join([lines[0], "|" + "|".join("-" * (w + 2) for w in widths) + "|"] + lines[1:])
