"""The three actuators of docs/experiment.md with a blocked tip: force over pressure, and its change while the pressure is held."""
import functools

from .marchese import LAWS, REFERENCE
from .program import coefficients
from .samples import ROOT, Row, between, draw, halton, interval

EXPERIMENT = "EPFL 2015, blocked"
SECTION = ROOT / "cases/sections/ecoflex-actuator.json"
PITCH, CHAMBER, FILM = 0.009, 0.008, 2e-4
SPECIMENS = {"c5-w7": (5, 0.007), "c7-w7": (7, 0.007), "c5-w10": (5, 0.010)}
# pressures [kPa], the last of which the actuators reached, and times at which the held pressure is looked at, over the first second
PRESSURES, DECADES, HELD = (5, 10, 15, 20, 25), (1, 2, 3), 20
STEPS = [0.05 * k for k in range(1, 13)]
EACH = 400


@functools.cache
def cell(wall):
    """Blocked moment over pressure [m^3] of the linear cell in three dimensions, and growths by p/E of both laws, for a wall [m]."""
    bottom = -(CHAMBER + wall + FILM) / 2
    values = {
        "/height_m": CHAMBER + wall + FILM,
        "/width_m": CHAMBER + 2 * wall,
        "/pitch_m": PITCH - 0.007 + wall,
        # a film of the same kind, thicker and softer: a membrane that does not stretch
        "/regions/0/shape/layer/high_m": [bottom, bottom + FILM],
        "/regions/0/material/young_modulus_pa": 4e8,
        "/bladders/upper/center_m": bottom + 1.25 * FILM + CHAMBER / 2,
        "/bladders/upper/shape/rounded_rectangle/high_m": CHAMBER - FILM / 2,
        "/material/young_modulus_pa": REFERENCE,
    }
    found, growths = None, []
    for second, third in LAWS:
        values |= {"/three_d": found is None, "/material/law": {"yeoh": {"second": second, "third": third}}}
        solved = coefficients(SECTION, values, [REFERENCE * step for step in STEPS])
        found = found or solved
        states = [s for s in solved["inflation"]["states"] if s["blocked_moment_growth"] is not None]
        growths.append([(0.0, 1.0)] + [(s["pressure_pa"] / REFERENCE, s["blocked_moment_growth"]) for s in states])
    c = found["compliance"]
    return c[1][2] / c[1][1], growths


def rows():
    """All rows, and the share of samples without a state at the largest pressure."""
    found, left_out = [], {}
    for specimen, (count, wall) in SPECIMENS.items():
        moment, growths = cell(wall)
        pitch = PITCH - 0.007 + wall
        length = count * pitch + wall
        forces = {kpa: [] for kpa in PRESSURES}
        ratios = {decade: [] for decade in DECADES}
        lost = 0
        for number, share in enumerate(halton(EACH, 6)):
            slow = draw("all", "growth_share", share[5])
            growth = lambda q: between(growths[number % 2], slow * q)
            modulus = draw("all", "young_modulus", share[0])
            if growth(1e3 * PRESSURES[-1] / modulus) is None:
                lost += 1
                continue
            arm = length * draw("all", "arm_share", share[2])
            lever = count * pitch / length * draw("all", "bow_factor", share[1]) / arm * draw("all", "cell_discrepancy", share[3])
            for kpa in PRESSURES:
                forces[kpa].append(1e3 * kpa * moment * growth(1e3 * kpa / modulus) * lever)
            q, loss = 1e3 * HELD / modulus, draw("epfl", "relaxation_per_decade", share[4])
            for decade in DECADES:
                later = growth(q / (1 - loss * decade))
                if later is not None:
                    ratios[decade].append(later / growth(q))
        left_out[specimen, "blocked"] = lost / EACH
        found += [Row(EXPERIMENT, specimen, "tip force", "N", kpa, *interval(forces[kpa])) for kpa in PRESSURES]
        for decade in DECADES:
            name = f"force after {10**decade} s over that after 1 s"
            found.append(Row(EXPERIMENT, specimen, name, "1", HELD, *interval(ratios[decade])))
    return found, left_out
