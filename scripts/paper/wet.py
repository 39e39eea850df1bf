"""Fig. A.9: the filled beam with the upper row joined: pulled along, bent, shaken across."""
import numpy as np

from .common import Result, over_network, over_time, panel, plt, rounded, shipped, wired

CASES = [("I", "stretch-wet", "3000 N/m · S(t) along"), ("II", "bend-wet", "100 N/m · S(t) across"), ("III", "shake-wet", "root $U_1$ = 0.02 sin 2π 8 t")]
NEEDS = shipped(*(case for _, case, _ in CASES))


def draw():
    figure, axes = plt.subplots(4, 3, figsize=(10.5, 9.5), height_ratios=[0.75, 1, 1, 1])
    numbers = {}
    for column, (name, case, what) in enumerate(CASES):
        result = Result(case)
        wired(axes[0, column], result.case)
        axes[0, column].text(5, -1.65, what, ha="center", va="top")
        instants = result.last_cycle(8) if case == "shake-wet" else result.instants(0, result.t[-1], 26)
        for row, component in ((1, 1), (2, 3)):
            ax = axes[row, column]
            over_time(ax, result.theta, result.u(component), instants)
            ax.set(xlabel="Θ", ylabel=f"$U_{component}$", xlim=(0, 1))
            ax.ticklabel_format(axis="y", scilimits=(-2, 3))
            if abs(result.u(component)).max() < 1e-12:
                ax.set_ylim(-1, 1)
                ax.text(0.5, 0.2, "zero", ha="center")
        pressure = result.pressure()
        over_network(axes[3, column], result, pressure, instants)
        axes[3, column].set(xlabel="$X_f$", ylabel="P")
        axes[3, column].ticklabel_format(axis="y", scilimits=(-2, 3))
        for letter, ax in zip("abcd", axes[:, column]):
            panel(ax, f"{letter} {name}")
        drawn = slice(instants[0], instants[-1] + 1)
        numbers[name] = {
            "shown_from_s": rounded(result.t[instants[0]]), "shown_to_s": rounded(result.t[instants[-1]]),
            "largest_u1": rounded(abs(result.u(1)[drawn]).max()), "largest_u3": rounded(abs(result.u(3)[drawn]).max()),
            "largest_p": rounded(pressure[drawn].max()), "smallest_p": rounded(pressure[drawn].min()),
            "tip_u1_at_end": rounded(result.u(1)[-1, -1]), "tip_u3_at_end": rounded(result.u(3)[-1, -1]),
        }
    return figure, numbers
