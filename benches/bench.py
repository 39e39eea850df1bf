"""Main program of scripts/bench after building: measures, prints, and fills docs/performance.md."""

import json
import subprocess
import sys
import time

from measures import OPERATIONS, groups, measure_ensemble, measure_large, measure_prices, measure_program, measure_rods, measure_runs
from page import draw, tables, write_page
from workers import BUILT, PEERS, PYTHON, ROOT, SCENES, error, peers, run, workers

RESULTS = BUILT / "bench.json"


def check(python):
    """Compares the equations of all peers; exits if they differ by more than rounding errors."""
    if not python:
        return
    answer = subprocess.run([PYTHON, "benches/python/worker.py", PEERS, "--check", *SCENES], cwd=ROOT)
    if answer.returncode != 0:
        raise SystemExit("equations differ: nothing is compared")


def quick(python):
    """Runs each peer once with a loose tolerance; exits if one fails."""
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
    parts = ["runs", "rods", "prices", "program", "ensemble", "large"]
    if "--only" in arguments:
        parts = arguments[arguments.index("--only") + 1].split(",")
    begin = time.monotonic()
    check(python)
    all = workers(python)
    results = json.loads(RESULTS.read_text()) if "--only" in arguments and RESULTS.exists() else {}
    measure = {
        "runs": lambda: measure_runs(all, python), "rods": lambda: measure_rods(all) if python else {}, "prices": measure_prices,
        "program": measure_program, "ensemble": measure_ensemble, "large": measure_large,
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
