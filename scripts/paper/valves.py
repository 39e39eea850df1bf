"""Fig. 4: valves on the tubes of the upper row of a beam shaken along its axis, 0.33 l_s at 18 Hz."""
import csv

import numpy as np

from .common import BLUE, RED, RESULTS, Result, over_network, over_time, panel, plt, rounded, shipped, wired

CASES = [("I", "valves-hundredth", "$Q_1/100$"), ("II", "valves-half", "$Q_1/2$"), ("III", "valves-open", "$Q_1$, open")]
FACTORS = (0.01, 0.03, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.85, 1.0)
FREQUENCY = 18
SWEEP = ["periodic", "--sweep", "/network/permeability_factor=0.01:1:13:log"]
BELOW = "/ends/root/clamped/u3_m/sine/amplitude=0.025"
RECIPROCAL = ['/bladders/coupling="reciprocal"', '/formulation="conservative"']
LONGER, RAMPED = "/time/end_s=1", "/ends/root/clamped/u3_m/sine/ramp_cycles=1"
NEEDS = [
    *shipped(*(case for _, case, _ in CASES)),
    *((f"figures/{case}-longer", case, [LONGER], ["run"]) for _, case, _ in CASES),
    *((f"figures/{case}-ramped", case, [RAMPED], ["run"]) for _, case, _ in CASES),
    *((f"figures/valves-{f}", "valves-open", [f"/network/permeability_factor={f}"], ["run"]) for f in FACTORS),
    ("figures/valves-cycles-published", "valves-open", [BELOW], SWEEP),
    ("figures/valves-cycles-reciprocal", "valves-open", [BELOW, *RECIPROCAL], SWEEP),
]


def draw():
    figure = plt.figure(figsize=(10.5, 9.5))
    top, bottom = figure.subfigures(2, 1, height_ratios=[2.3, 1])
    axes = top.subplots(3, 3, height_ratios=[0.5, 1, 1])
    numbers = {}
    for column, (name, case, what) in enumerate(CASES):
        result = Result(case)
        u, p = result.u(1), result.pressure()
        instants = result.last_cycle(FREQUENCY)
        wired(axes[0, column], result.case)
        axes[0, column].text(5, -1.65, what, ha="center", va="top")
        over_time(axes[1, column], result.theta, 1e3 * u, instants)
        axes[1, column].set(xlabel="Θ", ylabel="$10^3\\ U_1$", xlim=(0, 1), ylim=(-4, 4))
        over_network(axes[2, column], result, p, instants)
        axes[2, column].set(xlabel="$X_f$", ylabel="P", ylim=(-0.032, 0.052))
        for letter, ax in zip("abc", axes[:, column]):
            panel(ax, f"{letter} {name}", 14 if letter == "c" else 6)
        drawn = slice(instants[0], instants[-1] + 1)
        longer, ramped = Result(f"figures/{case}-longer"), Result(f"figures/{case}-ramped")
        numbers[name] = {
            "f_u": rounded(result.summary["characteristic"]["f_u"], 3),
            "largest_u1": rounded(abs(u).max()), "last_cycle_u1": rounded(abs(u[drawn]).max()),
            "last_cycle_p": rounded(p[drawn].max()), "largest_p": rounded(p.max()),
            "largest_u1_ramped": rounded(abs(ramped.u(1)).max()), "largest_u1_in_1_s": rounded(abs(longer.u(1)).max()),
            "growth_from_cycle_9_to_18_per_s": rounded(np.log(cycle(longer, 18) / cycle(longer, 9)) * FREQUENCY / 9, 3),
        }
    left, right = bottom.subplots(1, 2)
    transition(left, numbers)
    cycles(right, numbers)
    return figure, numbers


def cycle(result, number):
    """Largest deflection of the tip in a cycle; cycles count from 1."""
    within = (result.t >= (number - 1) / FREQUENCY) & (result.t <= number / FREQUENCY)
    return abs(result.u(1)[within, -1]).max()


def transition(ax, numbers):
    """Plots the largest deflection of runs of nine cycles, as in the paper."""
    most = [abs(Result(f"figures/valves-{f}").u(1)).max() for f in FACTORS]
    ax.axvspan(0.3, 0.7, color="#eeeeee", label="transition as printed")
    ax.plot(FACTORS, 1e3 * np.array(most), "ko-", ms=3.5, label="run from rest, 0.5 s")
    ax.set(xlabel="$Q_1^b/Q_{1,open}^b$", ylabel="largest $10^3\\ U_1$", xlim=(0, 1.02), ylim=(0, None))
    ax.legend(loc="upper left")
    panel(ax, "d")
    numbers["d"] = {"permeability": FACTORS, "largest_u1": [rounded(m) for m in most]}


def cycles(ax, numbers):
    """Plots steady cycles below the tongue, without growth or transient."""
    found = {}
    for coupling, colour in (("published", BLUE), ("reciprocal", RED)):
        with open(RESULTS / f"figures/valves-cycles-{coupling}/sweep.csv") as file:
            rows = list(csv.DictReader(file))
        factor = np.array([float(r["/network/permeability_factor [as in the case]"]) for r in rows])
        tip = np.array([float(r["largest |tip_u1| [m]"]) for r in rows]) / 0.1
        ax.semilogx(factor, tip / tip[-1], "o-", color=colour, ms=3.5, label=f"{coupling} coupling (open: {tip[-1]:.2e})")
        half = float(np.exp(np.interp((tip[0] + tip[-1]) / 2, tip, np.log(factor))))
        found[coupling] = {"shut": rounded(tip[0], 3), "open": rounded(tip[-1], 3), "half_way_at": rounded(half, 2)}
    ax.axvspan(0.3, 0.7, color="#eeeeee")
    ax.axvline(0.48, color="k", lw=0.6, ls="--")
    ax.text(0.455, 0.04, "ωτ = 1", ha="right", fontsize=8)
    ax.set(xlabel="$Q_1^b/Q_{1,open}^b$", ylabel="$U_1$ of the steady cycle", ylim=(0, 1.3))
    ax.set_title("$U_{3,in}$ = 0.25, over open valves")
    ax.legend(loc="upper left")
    panel(ax, "d′")
    numbers["steady cycles at U3 0.25"] = found
