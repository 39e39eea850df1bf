"""The published cell: ratio of its coefficients to the printed values, from `slcbeam verify --paper`."""
import json
import subprocess

from .common import BLUE, GREY, PROGRAM, RED, plt, rounded

NAMES = ["f_e", "f_i", "a_p", "a_M", "a_N", "psi", "zeta", "q1"]
LABELS = ["$f_e$", "$f_i$", "$a_p$", "$a_M$", "$a_N$", "$ψ'$", "$ζ'$", "$q_{1b}$"]


def draw():
    text = subprocess.run([PROGRAM, "verify", "--paper", "--json"], check=True, capture_output=True, text=True).stdout
    found = json.loads(text)
    printed, computed = found["printed"], found["computed"]
    variants, best = computed["variants"], computed["variants"][computed["best"]]
    middles = [(p["low"] * p["high"]) ** 0.5 for p in printed]
    figure, ax = plt.subplots(figsize=(7, 3.4))
    places = range(len(NAMES))
    for variant in variants:
        sharp = variant["fillet_m"] == 0
        ratios = [c / m for c, m in zip(variant["computed"], middles)]
        ax.plot([k + (0.12 if sharp else -0.12) for k in places], ratios, "o", ms=3, color=RED if sharp else BLUE, alpha=0.4)
    ax.plot(places, [c / m for c, m in zip(best["computed"], middles)], "k_", ms=16, mew=1.6)
    ax.plot(places[:7], [c / m for c, m in zip(computed["spatial"], middles)], "kx", ms=5)
    for k, p in enumerate(printed):
        ax.fill_between([k - 0.3, k + 0.3], p["low"] / middles[k], p["high"] / middles[k], color=GREY, alpha=0.4, lw=0)
    ax.axhline(1, color=GREY, lw=0.8)
    ax.set(yscale="log", ylabel="computed over printed", title="red sharp corners, blue fillets; bar: best fit, cross: the same in 3-D; grey: as printed")
    ax.set_xticks(places, LABELS)
    ax.grid(lw=0.3, axis="y")
    numbers = {
        "best": {"nu": best["poisson_ratio"], "fillet_mm": rounded(1e3 * best["fillet_m"]),
                 "centre_mm": rounded(1e3 * best["center_m"]), "misfit": rounded(best["misfit"])},
        "in 3-D": dict(zip(NAMES, map(rounded, computed["spatial"]))),
        "tube_radius_mm": rounded(1e3 * computed["tube_radius_m"]),
        "square_side_mm": rounded(1e3 * computed["square_side_m"]),
    }
    for v in variants:
        place = numbers.setdefault(f"nu {v['poisson_ratio']}", {}).setdefault(f"fillet {rounded(1e3 * v['fillet_m'], 2):g}", {})
        place[f"centre {rounded(1e3 * v['center_m'], 2):g}"] = dict(zip(NAMES, map(rounded, v["computed"])))
    return figure, numbers
