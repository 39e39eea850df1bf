"""Calls of the program: sections at finite strain, equilibria and runs of the shipped cases."""
import csv
import json
import os
import pathlib
import subprocess
import sys
import tempfile

from .samples import ROOT

PROGRAM = os.environ.get("SLCBEAM", ROOT / "target/release/slcbeam")


def call(arguments):
    """Output of the program; ends the script where it fails."""
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, arguments))}: {done.stderr or done.stdout}")
    return done.stdout


def changes(values):
    """Options that set these values by JSON pointer."""
    return [part for pointer, value in values.items() for part in ("--set", f"{pointer}={json.dumps(value)}")]


def coefficients(path, values, pressures=()):
    """Coefficients of a section, or of that of a case, and its states under pressures."""
    inflate = ["--inflate", ",".join(f"{p:.10g}" for p in pressures)] if pressures else []
    return json.loads(call(["coefficients", path, "--json", *changes(values), *inflate]))


def section(case, values, pressures=()):
    """The same of a case in cases/blind."""
    return coefficients(ROOT / f"cases/blind/{case}.json", values, pressures)


def response(case, port, output, frequencies):
    """Complex responses to the pressure of a port at frequencies [Hz]."""
    asked = ",".join(f"{f:.10g}" for f in frequencies)
    with tempfile.TemporaryDirectory() as folder:
        call(["response", ROOT / f"cases/blind/{case}.json", "--input", f"/network/ports/{port}/pressure_pa", "--output", output,
              "--from", min(frequencies), "--to", max(frequencies), "--frequency", asked, "--quiet", "--out", folder])
        found = json.loads((pathlib.Path(folder) / "response.json").read_text())["at"]
    return [complex(at["real"], at["imag"]) for at in found]


def history(case, values):
    """Columns of the history of a run."""
    with tempfile.TemporaryDirectory() as folder:
        call(["run", ROOT / f"cases/blind/{case}.json", "--quiet", "--out", folder, *changes(values)])
        with open(pathlib.Path(folder) / "history.csv") as file:
            rows = list(csv.reader(file))
    return {name.split(" [")[0]: [float(row[k]) for row in rows[1:]] for k, name in enumerate(rows[0])}
