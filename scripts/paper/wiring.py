"""Fig. 5: three wirings of a beam shaken along its axis, 0.12 l_s at 20 Hz."""
import numpy as np

from .common import BLUE, RED, Result, over_network, over_time, panel, plt, rounded, shipped, wired

CASES = [("I", "wiring-1"), ("II", "wiring-2"), ("III", "wiring-3")]
NEEDS = shipped(*(case for _, case in CASES))
FREQUENCY, U1_MAX, P_MAX = 20, 0.137e-3, 7.3e-3


def draw():
    figure, axes = plt.subplots(4, 3, figsize=(10.5, 9), height_ratios=[0.5, 1, 1, 0.8])
    numbers = {"printed": {"u1_max": U1_MAX, "p_max": P_MAX}}
    for column, (name, case) in enumerate(CASES):
        result = Result(case)
        u, p = result.u(1), result.pressure()
        instants = result.last_cycle(FREQUENCY)
        wired(axes[0, column], result.case)
        over_time(axes[1, column], result.theta, u / U1_MAX, instants)
        axes[1, column].set(xlabel="Θ", ylabel="$U_1/U_{1,max}$", xlim=(0, 1), ylim=(-0.62, 0.62))
        over_network(axes[2, column], result, p / P_MAX, instants)
        axes[2, column].set(xlabel="$X_f$", ylabel="$P/P_{max}$", ylim=(-0.3, 0.42))
        cycles = np.arange(1, round(result.t[-1] * FREQUENCY) + 1)
        most = lambda field: np.array([abs(field[within(result, n)]).max() for n in cycles])
        ax = axes[3, column]
        ax.plot(cycles, most(u) / U1_MAX, "o-", color=BLUE, ms=3, label="$|U_1|/U_{1,max}$")
        ax.plot(cycles, most(p) / P_MAX, "s-", color=RED, ms=3, label="$|P|/P_{max}$")
        ax.axhline(1, color="k", lw=0.5, ls="--")
        ax.set(xlabel="cycle", ylabel="largest in the cycle", ylim=(-0.05, 2), xticks=cycles)
        if column == 0:
            ax.legend(loc="upper right")
        for letter, ax in zip(("a", "b", "c", "d′"), axes[:, column]):
            panel(ax, f"{letter} {name}", 14 if letter == "c" else 6)
        numbers[name] = {
            "f_u": rounded(result.summary["characteristic"]["f_u"], 3),
            "largest_u1": rounded(abs(u).max()), "largest_p": rounded(abs(p).max()),
            "last_cycle_u1": rounded(most(u)[-1]), "last_cycle_p": rounded(most(p)[-1]),
            "u1_over_printed": rounded(abs(u).max() / U1_MAX), "p_over_printed": rounded(abs(p).max() / P_MAX),
            "cycle_2_p": rounded(most(p)[1]), "cycle_3_p": rounded(most(p)[2]),
        }
    return figure, numbers


def within(result, cycle):
    return (result.t >= (cycle - 1) / FREQUENCY - 1e-9) & (result.t <= cycle / FREQUENCY + 1e-9)
