"""Fig. A.9: the filled beam with the upper row joined: axial pull, bending, transverse shaking."""
from .common import Result, over_network, over_time, panel, plt, power_of_ten, rounded, shipped, wired
from .steps import RISE

CASES = [("I", "stretch-wet", "3000 N/m · S(t) along"), ("II", "bend-wet", "100 N/m · S(t) across"), ("III", "shake-wet", "root $U_1$ = 0.02 sin 2π 8 t")]
NEEDS = shipped(*(case for _, case, _ in CASES))


def draw():
    figure, axes = plt.subplots(4, 3, figsize=(10.5, 9.5), height_ratios=[0.5, 1, 1, 1])
    numbers = {}
    for column, (name, case, what) in enumerate(CASES):
        result = Result(case)
        wired(axes[0, column], result.case)
        axes[0, column].text(5, -1.65, what, ha="center", va="top")
        instants = result.last_cycle(8, 22) if case == "shake-wet" else result.instants(0, RISE, 22)
        for row, component in ((1, 1), (2, 3)):
            ax = axes[row, column]
            scale, label = power_of_ten(result.u(component)[instants], f"U_{component}")
            over_time(ax, result.theta, scale * result.u(component), instants)
            ax.set(xlabel="Θ", ylabel=label, xlim=(0, 1))
        pressure = result.pressure()
        scale, label = power_of_ten(pressure[instants], "P")
        over_network(axes[3, column], result, scale * pressure, instants)
        axes[3, column].set(xlabel="$X_f$", ylabel=label)
        for letter, ax in zip("abcd", axes[:, column]):
            panel(ax, f"{letter} {name}", 14 if letter == "d" else 6)
        drawn = slice(instants[0], instants[-1] + 1)
        numbers[name] = {
            "f_u": rounded(result.summary["characteristic"].get("f_u", 0), 3),
            "shown_from_s": rounded(result.t[instants[0]]), "shown_to_s": rounded(result.t[instants[-1]]),
            "largest_u1": rounded(abs(result.u(1)[drawn]).max()), "largest_u3": rounded(abs(result.u(3)[drawn]).max()),
            "largest_p": rounded(pressure[drawn].max()), "smallest_p": rounded(pressure[drawn].min()),
            "tip_u1_at_end": rounded(result.u(1)[-1, -1]), "tip_u3_at_end": rounded(result.u(3)[-1, -1]),
        }
    return figure, numbers
