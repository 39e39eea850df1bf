"""Fig. A.6 and A.7: the empty honeycomb pulled along and bent, S(t) = 1/(1 + exp(-68 (t - 1/16)))."""
import json

import numpy as np

from .common import RESULTS, TIME, Result, over_time, panel, plt, rounded, shipped

NEEDS_STRETCH = [*shipped("stretch-dry"), ("figures/stretch-dry-static", "stretch-dry", [], ["equilibrium"])]
NEEDS_BEND = [*shipped("bend-dry"), ("figures/bend-dry-static", "bend-dry", [], ["equilibrium"])]
POINTS = (0.25, 0.5, 0.75, 1.0)
RISE = 0.15  # [s]: S rises from 0.01 to 0.997


def stretch():
    return draw("stretch-dry", "u3", "3000 N/m along the beam")


def bend():
    return draw("bend-dry", "u1", "100 N/m across the beam")


def draw(case, moved, load):
    result = Result(case)
    u1, u3 = (1e3 * result.fields[f"{u}_m"] for u in ("u1", "u3"))
    shown = u3 if moved == "u3" else u1
    theta = result.theta
    static = json.loads((RESULTS / f"figures/{case}-static/equilibrium.json").read_text())["quantities"]
    end = {"u1": 1e3 * static["tip_u1_m"], "u3": 1e3 * static["tip_u3_m"]}
    figure, axes = plt.subplots(2, 2, figsize=(9, 6))
    loaded(axes[0, 0], moved, load)
    for n, point in enumerate(POINTS):
        node = int(np.argmin(abs(theta - point)))
        axes[0, 1].plot(result.t, shown[:, node], color=plt.cm.viridis(0.85 * n / 3), label=f"Θ = {point}")
    axes[0, 1].axhline(end[moved], color="k", lw=0.6, ls="--", label="static, Θ = 1")
    axes[0, 1].set(xlabel="t [s]", ylabel=f"${moved[0]}_{moved[1]}$ [mm]", xlim=(0, result.t[-1]))
    axes[0, 1].set_ylim(None, 1.3 * axes[0, 1].get_ylim()[1])
    axes[0, 1].legend(ncol=3, loc="upper left", fontsize=8)
    instants = result.instants(0, RISE, 26)
    for ax, field, label in ((axes[1, 0], u1, "$u_1$ [mm]"), (axes[1, 1], u3, "$u_3$ [mm]")):
        over_time(ax, theta, field, instants)
        ax.set(xlabel="Θ", ylabel=label, xlim=(0, 1))
        if abs(field).max() < 1e-9:
            ax.set_ylim(-1, 1)
            ax.text(0.5, 0.2, "exactly zero", ha="center", color="k")
    bar = figure.colorbar(plt.cm.ScalarMappable(plt.Normalize(0, RISE), TIME), ax=axes[1, :], aspect=30, pad=0.01)
    bar.set_label("t [s]")
    for ax, letter in zip(axes.flat, "abcd"):
        panel(ax, letter)
    half = result.t >= 0.5 * result.t[-1]
    numbers = {
        "static_tip_u1_mm": rounded(end["u1"]), "static_tip_u3_mm": rounded(end["u3"]),
        "largest_tip_u1_mm": rounded(abs(u1[:, -1]).max()), "largest_tip_u3_mm": rounded(abs(u3[:, -1]).max()),
        "mean_tip_of_second_half_mm": rounded(shown[half, -1].mean()),
    }
    return figure, numbers


def loaded(ax, moved, load):
    """The cantilever with its load and axes."""
    ax.add_patch(plt.Rectangle((0, -0.108), 1, 0.216, fc="#efece4", ec="k", lw=0.7))
    ax.plot([0, 0], [-0.2, 0.2], "k", lw=3)
    for x in np.linspace(0.06, 0.94, 10):
        across, along = ((0, 0.14), (x, 0.13)) if moved == "u1" else ((0.07, 0), (x - 0.035, 0))
        ax.annotate("", (along[0] + across[0], along[1] + across[1]), along, arrowprops={"arrowstyle": "->", "color": "#d8231f", "lw": 1})
    ax.text(0.55, -0.24, f"{load} · S(t)", ha="center")
    for tip, name in (((0.16, -0.36), "z, $u_3$"), ((0.0, -0.2), "x, $u_1$")):
        ax.annotate("", tip, (0.0, -0.36), arrowprops={"arrowstyle": "->", "lw": 0.8})
        ax.text(tip[0] + 0.02, tip[1] - 0.01, name, fontsize=8, va="center")
    ax.set(xlim=(-0.1, 1.1), ylim=(-0.45, 0.4), aspect="equal")
    ax.axis("off")
