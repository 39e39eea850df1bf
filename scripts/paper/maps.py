"""Fig. A.4 and A.5: the maps between the beam's and the network's coordinate, from `slcbeam mapping`."""
import csv
import subprocess

from .common import PROGRAM, ROOT, panel, plt

WIRINGS = [
    ("a", "upper serpentine", "valves-open", "upper-serpentine"),
    ("b", "parallel serpentine", "wiring-1", "parallel-serpentine"),
    ("c", "crossover", "wiring-3", "crossover"),
]


def theta_to_xf():
    return draw("theta-to-xf", "Θ · R", "$X_f(Θ)$")


def xf_to_theta():
    return draw("xf-to-theta", "$X_f$", "Θ$(X_f)$")


def draw(table, x_label, y_label):
    figure, axes = plt.subplots(1, 3, figsize=(10, 3.2))
    numbers = {}
    for ax, (letter, name, case, printed) in zip(axes, WIRINGS):
        command = [PROGRAM, "mapping", ROOT / f"cases/{case}.json", "--table", table]
        text = subprocess.run(command, check=True, capture_output=True, text=True).stdout
        rows = [[float(x) for x in row] for row in list(csv.reader(text.splitlines()))[1:]]
        if table == "xf-to-theta":
            rows.sort()
        x, y = [r[0] for r in rows], [r[1] for r in rows]
        ax.plot(x, y, "k-", lw=0.8)
        ax.plot(x, y, "o", color="#1f4fd8", ms=2.6)
        ax.set(xlabel=x_label, ylabel=y_label, title=name)
        ax.grid(lw=0.3)
        panel(ax, letter)
        reference = (ROOT / f"tests/data/mapping/{table}-{printed}.csv").read_text()
        numbers[letter] = {"rows": len(rows), "equal_to_the_printed_table": text == reference}
    return figure, numbers
