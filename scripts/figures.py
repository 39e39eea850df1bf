"""The figures of Matia & Gat from the shipped cases: scripts/figures [NAME..., --list, --out DIR]."""
import argparse
import io
import json
import pathlib
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

try:
    import matplotlib
    import numpy
except ModuleNotFoundError as missing:
    sys.exit(f"{missing.name} is missing: scripts/install python3-numpy python3-matplotlib, then scripts/figures")

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "scripts"))
import paper  # noqa: E402


def run(wanted):
    """Computes one result required by a figure: (folder, case, changes, command)."""
    folder, case, sets, command = wanted
    arguments = [paper.common.PROGRAM, *command, ROOT / f"cases/{case}.json", "--quiet"]
    for change in sets:
        arguments += ["--set", change]
    done = subprocess.run([*arguments, "--out", paper.common.RESULTS / folder], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{folder}: {done.stderr or done.stdout}")
    print(f"ran {folder}", flush=True)


def main():
    asked = argparse.ArgumentParser(prog="scripts/figures", description=__doc__)
    asked.add_argument("names", nargs="*", metavar="NAME", help="figures, such as 5 and A.9; all without")
    asked.add_argument("--list", action="store_true", help="name all figures")
    asked.add_argument("--keep", action="store_true", help="draw from what out/ holds, run nothing")
    asked.add_argument("--out", default=ROOT / "docs/figures", type=pathlib.Path, help="where to; docs/figures without")
    asked = asked.parse_args()
    if asked.list:
        print("\n".join(paper.FIGURES))
        return
    unknown = [name for name in asked.names if name not in paper.FIGURES]
    if unknown:
        sys.exit(f"no figure {', '.join(unknown)}; there are {', '.join(paper.FIGURES)}")
    names = asked.names or list(paper.FIGURES)
    wanted = {} if asked.keep else {w[0]: w for name in names for w in paper.FIGURES[name].needs}
    with ThreadPoolExecutor(2) as pool:
        list(pool.map(run, wanted.values()))
    asked.out.mkdir(parents=True, exist_ok=True)
    path = asked.out / "numbers.json"
    numbers = json.loads(path.read_text()) if path.exists() else {}
    for name in names:
        figure, found = paper.FIGURES[name].draw()
        file = asked.out / f"figure-{name.lower().replace('.', '')}.svg"
        # Reproducible file: coordinates are rounded to a hundredth of a point.
        text = io.StringIO()
        figure.savefig(text, format="svg", metadata={"Date": None, "Creator": None})
        file.write_text(re.sub(r' d="[^"]*"', lambda d: re.sub(r"(\.\d\d)\d+", r"\1", d[0]), text.getvalue()))
        numbers[name] = found
        print(f"{file.name} {file.stat().st_size // 1000} kB", flush=True)
    ordered = {name: numbers[name] for name in paper.FIGURES if name in numbers}
    path.write_text(json.dumps(ordered, indent=1) + "\n")


main()
