"""Fingers on viscous lines, in numbers without dimension: start-up, steady oscillation, and the order of actuation."""
import cmath
import math

from .program import history, response
from .samples import Row, between, draw, halton, interval

LINE, SERIES = "viscous line (Matia et al. 2017)", "fingers in series (Vasios et al. 2020)"
# angular frequencies over 1/tau, tau = t50/ln 2 of the start-up, behind one that is nearly zero
FREQUENCIES = (0.01, 0.3, 1.0, 3.0)
EACH = 400
# samples of the order of actuation, each a run
ORDERS = 6


def first(times, values, level):
    """First time at which values pass a level."""
    pairs = zip(zip(values, times), zip(values[1:], times[1:]))
    for pair in pairs:
        if (pair[0][0] - level) * (pair[1][0] - level) <= 0 and pair[0][0] != pair[1][0]:
            (v0, t0), (v1, t1) = pair
            return t0 + (level - v0) / (v1 - v0) * (t1 - t0)
    return None


def slower(share, factor):
    """Time of a share of the step over R C at its start, where the compliance rises to `factor` times that with pressure."""
    return -(factor - 1) * share - factor * math.log(1 - share)


def line():
    """Start-up and oscillation of one finger behind a line."""
    run = history("viscous-line", {})
    tip = run["tip_angle"]
    half, most = (first(run["t"], tip, part * tip[-1]) for part in (0.5, 0.9))
    tau = half / math.log(2)
    rest, *at = response("viscous-line", 0, "tip_u1", [f / (2 * math.pi * tau) for f in FREQUENCIES])
    ratios, lags, amplitudes = [], [[] for _ in at], [[] for _ in at]
    for share in halton(EACH, 2):
        factor = draw("line", "compliance_factor", share[0])
        changed = slower(0.9, factor) / slower(0.5, factor) / (slower(0.9, 1) / slower(0.5, 1))
        ratios.append(most / half * changed)
        # the small oscillation has another R C than the start-up by which time is measured
        other = factor * draw("line", "resistance_factor", share[1]) ** 0.5
        for k, value in enumerate(at):
            tangent = math.tan(-cmath.phase(value / rest)) * other
            lags[k].append(math.degrees(math.atan(tangent)))
            amplitudes[k].append(abs(value / rest) * math.sqrt((1 + (tangent / other) ** 2) / (1 + tangent**2)))
    rows = [Row(LINE, "finger", "t90/t50 of the start-up", "1", "", *interval(ratios))]
    for name, unit, samples in (("amplitude over that at rest", "1", amplitudes), ("phase lag", "deg", lags)):
        rows += [Row(LINE, "finger", f"{name}, omega tau = {f:g}", unit, "", *interval(s)) for f, s in zip(FREQUENCIES[1:], samples)]
    return rows


def order():
    """Three fingers in series: yes (1) or no (0) in every sample, and the ratio of times."""
    names = ("near", "middle", "far")
    filled, emptied, ratios, ends = [], [], [], []
    for share in halton(ORDERS, 4):
        values = {f"/network/tubes/{k}/cross_section/circle/radius_m": 0.001 * draw("line", "resistance_factor", share[k]) ** -0.25
                  for k in range(3)}
        values["/bladders/area_per_pressure_m2_per_pa"] = 1.75e-10 * draw("line", "compliance_factor", share[3])
        values["/time/end_s"] = 16
        run = history("series-fingers", values)
        turn = min(range(len(run["t"])), key=lambda k: abs(run["t"][k] - 6))
        angles = [run[f"{name}.tip_angle"] for name in names]
        up = [first(run["t"][: turn + 1], a[: turn + 1], a[turn] / 2) for a in angles]
        down = [first(run["t"][turn:], a[turn:], a[turn] / 2) for a in angles]
        filled.append(up[0] < up[1] < up[2])
        emptied.append(down[0] < down[1] < down[2])
        ratios.append(up[2] / up[0])
        ends.append(angles[2][turn] / angles[0][turn])
    yes = lambda answers: [float(all(answers)), float(sum(answers) > len(answers) / 2), float(any(answers))]
    return [
        Row(SERIES, "three fingers", "half of the angle near, middle, far in this order while filling (1 yes)", "1", "", *yes(filled)),
        Row(SERIES, "three fingers", "the same order while emptying (1 yes)", "1", "", *yes(emptied)),
        Row(SERIES, "three fingers", "half time of the far finger over that of the near one", "1", "", *interval(ratios)),
        Row(SERIES, "three fingers", "angle of the far finger over that of the near one in the end", "1", "", *interval(ends)),
    ]


def rows():
    """All rows."""
    return line() + order(), {}
