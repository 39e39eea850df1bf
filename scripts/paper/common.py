"""Reading of results, and common parts of the figures: time colors, wiring diagrams, pressure over X_f."""
import csv
import json
import os
import pathlib

import matplotlib
import numpy as np

matplotlib.use("Agg")
from matplotlib import pyplot as plt  # noqa: E402
from matplotlib.colors import LinearSegmentedColormap  # noqa: E402
from matplotlib.patches import FancyBboxPatch, Rectangle  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("SLCBEAM", ROOT / "target/release/slcbeam")
RESULTS = pathlib.Path(os.environ.get("SLCBEAM_RESULTS", ROOT / "out"))
plt.rcParams.update({
    "svg.hashsalt": "slcbeam", "font.size": 9, "axes.titlesize": 9, "legend.fontsize": 8, "legend.frameon": False,
    "axes.spines.top": False, "axes.spines.right": False, "axes.titlelocation": "center", "lines.linewidth": 0.9, "figure.constrained_layout.use": True,
})
TIME = LinearSegmentedColormap.from_list("time", ["#1f4fd8", "#7b3fa0", "#d8231f"])
BLUE, RED, GREY = "#1f4fd8", "#d8231f", "#9a9a9a"


def shipped(*cases):
    """NEEDS entries of runs of unchanged shipped cases."""
    return [(case, case, [], ["run"]) for case in cases]


class Result:
    """A result folder: arrays by name, history columns by name with unit, summary, case."""

    def __init__(self, folder):
        at = RESULTS / folder
        self.fields = np.load(at / "fields.npz")
        with open(at / "history.csv") as file:
            rows = list(csv.reader(file))
        self.history = dict(zip(rows[0], np.array(rows[1:], float).T))
        self.case = json.loads((at / "case.json").read_text())
        self.summary = json.loads((at / "summary.json").read_text())
        self.t, beam = self.fields["t_fields_s"], self.case["beam"]
        self.length, self.modulus = beam["length_m"], beam["young_modulus_pa"]
        self.theta = self.fields["theta_node_m"] / self.length

    def u(self, component):
        """Displacement over the beam's length, time by node."""
        return self.fields[f"u{component}_m"] / self.length

    def pressure(self):
        """Pressure over Young's modulus, time by cell."""
        return self.fields["pressure_pa"] / self.modulus

    def instants(self, start, end, count):
        """Indices of about `count` evenly spaced instants from start to end [s]."""
        within = np.flatnonzero((self.t >= start - 1e-9) & (self.t <= end + 1e-9))
        return within[np.unique(np.linspace(0, len(within) - 1, count).round().astype(int))]

    def last_cycle(self, frequency, count=24):
        """Indices of instants of the last whole cycle."""
        return self.instants(self.t[-1] - 1 / frequency, self.t[-1], count)


def over_time(ax, x, rows, instants, **style):
    """Plots one curve per instant, from blue to red."""
    for n, k in enumerate(instants):
        ax.plot(x, rows[k], color=TIME(n / max(1, len(instants) - 1)), **style)


def over_network(ax, result, rows, instants):
    """Plots pressure over X_f, with gaps between arrays of bladders and the ranges of bladder indices in brackets."""
    x, array, bladder = (result.fields[name] for name in ("x_f", "array", "bladder"))
    breaks = np.flatnonzero(np.diff(array)) + 1
    over_time(ax, np.insert(x, breaks, np.nan), np.insert(rows, breaks, np.nan, axis=1), instants)
    for first, last, where in ranges(bladder):
        label = f"[{first} … {last}]" if first != last else f"[{first}]"
        ax.annotate(label, (x[where].mean(), 1.0), xycoords=("data", "axes fraction"), ha="center", va="bottom", fontsize=7)
        if where[0] > 0:
            ax.axvline(x[where[0] - 1 : where[0] + 1].mean(), color=GREY, lw=0.5, ls=":")
    ax.set_xlim(0, 1.01)


def ranges(bladder):
    """Yields each contiguous range of bladders of one row along X_f: first index, last index, cells."""
    cuts = [0, *(np.flatnonzero(np.diff(np.sign(bladder))) + 1), len(bladder)]
    # A jump of the indices within a row starts a new range.
    cuts = sorted({*cuts, *(k + 1 for k in np.flatnonzero(np.abs(np.diff(bladder)) > 1))})
    for a, b in zip(cuts, cuts[1:]):
        yield int(bladder[a]), int(bladder[b - 1]), np.arange(a, b)


def wired(ax, case, turbine=False):
    """Draws a side view of the beam: bladders with indices, tubes of the first chain blue, of the second red."""
    count, chains = case["bladders"]["per_row"], case["network"]["chains"]
    colour = {b: c for chain, c in zip(chains, (BLUE, RED)) for b in chain["bladders"]}
    ax.add_patch(FancyBboxPatch((0, -1.08), count, 2.16, boxstyle="round,pad=0,rounding_size=0.12", fc="#efece4", ec="k", lw=0.7))
    centre = lambda b: (abs(b) - 0.5, 0.5 if b > 0 else -0.5)
    for b in [*range(1, count + 1), *range(-count, 0)]:
        x, y = centre(b)
        ax.add_patch(Rectangle((x - 0.39, y - 0.39), 0.78, 0.78, fc="white", ec=colour.get(b, GREY), lw=1))
        ax.text(x, y, b, ha="center", va="center", fontsize=6, color=colour.get(b, "k"))
    for chain, c in zip(chains, (BLUE, RED)):
        for a, b in zip(chain["bladders"], chain["bladders"][1:]):
            (xa, ya), (xb, yb) = centre(a), centre(b)
            side = 0.39 if xb > xa else -0.39
            ax.plot([xa + side, xb - side], [ya, yb] if ya == yb else [0.6 * ya, 0.6 * yb], color=c, lw=2)
        for b, end in zip((chain["bladders"][0], chain["bladders"][-1]), chain["ends"]):
            if isinstance(end, dict) and "pressure_pa" in end:
                (x, y), out = centre(b), 1 if b > 0 else -1
                ax.plot([x, x], [y + 0.39 * out, y + 0.85 * out], color=c, lw=1.4)
                ax.plot(x, y + 0.95 * out, "o", mfc="white", mec=c, ms=3.5)
    if turbine:
        ax.plot([-0.7, 0.11], [0, 0.5], color=BLUE, lw=1.4)
        ax.plot([-0.7, 0.11], [0, -0.5], color=RED, lw=1.4)
        ax.plot(-0.7, 0, "o", mfc="#ffd24d", mec="k", ms=9)
    ax.plot([0, 0], [-1.5, 1.5], "k", lw=2.5)
    ax.set(xlim=(-1.1, count + 0.3), ylim=(-1.8, 1.8), aspect="equal")
    ax.axis("off")


def power_of_ten(rows, symbol):
    """Power of ten that scales small numbers to about one, and the axis label with it."""
    largest = np.nanmax(abs(rows))
    power = 0 if largest == 0 or largest > 0.1 else int(np.ceil(-np.log10(largest)))
    return 10.0**power, f"$10^{{{power}}}\\ {symbol}$" if power else f"${symbol}$"


def panel(ax, label, pad=6):
    """Sets the letter of a panel as in the paper; panels that are not in the paper have a prime."""
    ax.set_title(f"({label})", loc="left", fontweight="bold", pad=pad)


def rounded(value, digits=4):
    """Rounds a number for the page."""
    return float(f"{value:.{digits - 1}e}")
