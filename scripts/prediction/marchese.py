"""Three bending actuators of Marchese, Katzschmann and Rus 2015: cylindrical, ribbed and pleated channels."""
import math

from .program import section
from .samples import Row, between, draw, halton, interval
from .tube import Tube, reached

EXPERIMENT = "Marchese et al. 2015"
# largest published pressure [kPa]: free bending, blocked tip
PUBLISHED = {"cylindrical": (55, 50), "ribbed": (32, 36), "pleated": (62, 88)}
# Yeoh's second and third constant over the first: EPFL's tension fit as printed, Marechal's without the third, which holds to a stretch of 3
LAWS = ((-0.010765, 0.0015213), (0.017993, 0.0))
# geometries of ribs and pleats by finite elements, of the tube, and samples of the other numbers for each geometry
CELLS, PLEATS, TUBES, EACH = 12, 16, 128, 64
# pressures over Young's modulus at which a cell is solved, and that modulus [Pa]
STEPS, REFERENCE = [0.05 * k for k in range(1, 16)], 1e5


def pressures(specimen, blocked):
    """Pressures of a table [kPa]: every 5, and the last published one."""
    most = PUBLISHED[specimen][blocked]
    return sorted({*range(5, most + 1, 5), most})


def others():
    """Numbers beside those of the geometry, as shares: E, bow, arm, discrepancy, start, line, growth, volume."""
    return halton(EACH, 8, skip=100)


def moved_gas(pressure, grown, cavity, share):
    """Displacement of the piston [m^3], by a gauge pressure and the growth of the cavity: isothermal air of cylinder, line and cavity.
    None beyond the end of the stroke."""
    ambient = draw("all", "ambient_pressure")
    stroke = draw("cylinder", "free_volume") * draw("cylinder", "start_share", share[0])
    closed = stroke + draw("line", "volume", share[1]) + cavity
    moved = closed * pressure / (ambient + pressure) + grown
    return moved if moved <= stroke else None


def tip_force(specimen, moment, share, active):
    """Force [N] on a load cell that holds the tip, by the blocked moment [N m] of the active part of the length."""
    arm = draw(specimen, "length") * draw("all", "arm_share", share[2])
    return moment * active * draw("all", "bow_factor", share[1]) / arm


def growths(inflation, pressure):
    """Growths over the linear law by the pressure over a given one, from 1 at rest."""
    keys = {"curvature": "curvature_growth", "volume": "volume_growth", "moment": "blocked_moment_growth"}
    at = lambda key: [(s["pressure_pa"] / pressure, s[key]) for s in inflation["states"] if s[key] is not None]
    return {name: [(0.0, 1.0), *at(key)] for name, key in keys.items()}


def shapes():
    """Growths by the share of the limit pressure, of the ribbed cell as shipped."""
    law = {"yeoh": {"second": LAWS[0][0], "third": LAWS[0][1]}}
    values = {"/section/material/young_modulus_pa": REFERENCE, "/section/material/law": law}
    found = section("ribbed", values, [REFERENCE * step for step in STEPS])["inflation"]
    free, held = (found[key] or REFERENCE * STEPS[-1] for key in ("limit_pressure_pa", "blocked_limit_pressure_pa"))
    result = growths(found, free) | {"moment": growths(found, held)["moment"]}
    # the last state before the limit stands for the limit
    return {name: [*points, (1.01, points[-1][1])] for name, points in result.items()}


def cylindrical():
    """Samples by (quantity, pressure), from closed forms."""
    fixed = lambda name: draw("cylindrical", name)
    area, length, half = fixed("channel_area"), fixed("channel_length"), fixed("height") / 2
    inner = math.sqrt(area / math.pi)
    for number, share in enumerate(halton(TUBES, 5)):
        place = lambda name, k: draw("cylindrical", name, share[k])
        constraint = place("constraint_thickness", 0) / 2
        center = constraint + place("floor", 1) + math.sqrt(area) / 2
        nearest, widest = half - center, math.sqrt(fixed("width") * half / math.pi)
        outer = nearest + place("spread", 2) * (widest - nearest)
        layers = [(-half, -constraint, 1), (-constraint, constraint, place("constraint_ratio", 3)), (constraint, half, 1)]
        tube = Tube(inner, outer, center, layers, fixed("width"), LAWS[number % 2])
        free, held = tube.path(False), tube.path(True)
        active = min(1.0, length / fixed("length"))

        def respond(pressure, modulus, blocked, slow):
            at = reached(held if blocked else free, pressure / (modulus / 3))
            if at is None:
                return None
            return (at[0] * modulus / 3 if blocked else at[0] * length), at[1] * length
        yield respond, area * length, active


def ribbed():
    """As `cylindrical`, from the cell in three dimensions and its growth at finite strain."""
    length, wide = draw("ribbed", "length"), draw("ribbed", "channels")
    for number, share in enumerate(halton(CELLS, 3)):
        pitch = draw("ribbed", "pitch", share[0])
        values = {
            "/section/pitch_m": pitch,
            "/beam/length_m": wide * pitch,
            "/section/bladders/upper/center_m": 5e-5 + draw("ribbed", "floor", share[1]) + 0.00155,
            "/section/material/young_modulus_pa": REFERENCE,
            "/section/material/law": {"yeoh": {"second": LAWS[number % 2][0], "third": LAWS[number % 2][1]}},
        }
        found = section("ribbed", values, [REFERENCE * step for step in STEPS])
        film = draw("ribbed", "film_modulus") * 0.032 * (draw("ribbed", "film_thickness", share[2]) ** 3 - 1e-12) / 12
        grow, c = growths(found["inflation"], REFERENCE), found["compliance"]
        own = found["bending_stiffness_n_m2"] / REFERENCE

        def respond(pressure, modulus, blocked, slow):
            q = slow * pressure / modulus
            if blocked:
                growth = between(grow["moment"], q)
                return None if growth is None else (pressure * c[1][2] / c[1][1] * growth, 0.0)
            bent, swollen = between(grow["curvature"], q), between(grow["volume"], q)
            if bent is None or swollen is None:
                return None
            softer = pressure * REFERENCE / modulus * wide * pitch
            return softer * c[1][2] * bent * own * modulus / (own * modulus + film), softer * c[2][2] * swollen
        yield respond, draw("ribbed", "cavity"), wide * pitch / length


def pleated(shape):
    """As `ribbed`, from the linear cell in three dimensions. `shape` is the growth of curvature and volume over the share of the limit."""
    length, count = draw("pleated", "length"), draw("pleated", "channels")
    for share in halton(PLEATS, 8):
        place = lambda name, k: draw("pleated", name, share[k])
        pitch, gap, width = place("pitch", 0), place("gap", 2), place("pleat_width", 3)
        center = 0.0127 - place("roof", 1) - 0.00615
        floor = center - 0.00615
        ratio = place("constraint_ratio", 5) * 0.0444 / width
        space = lambda low, high: {
            "shape": {"rectangle": {"along_m": [low, high], "high_m": [floor, 0.0127]}},
            "material": {"young_modulus_pa": place("contact_ratio", 7) * REFERENCE, "poisson_ratio": 0.3, "density_kg_m3": 10},
        }
        constraint = {
            "shape": {"layer": {"high_m": [-0.0127, -0.0127 + min(place("constraint_thickness", 4), floor + 0.0122)]}},
            "material": {"young_modulus_pa": ratio * REFERENCE, "poisson_ratio": 0.4999, "density_kg_m3": 1180},
        }
        values = {
            "/section/pitch_m": pitch,
            "/beam/length_m": count * pitch,
            "/section/width_m": width,
            "/section/bladders/upper/center_m": center,
            "/section/material/young_modulus_pa": REFERENCE,
            "/section/regions": [constraint, space(-pitch / 2, (gap - pitch) / 2), space((pitch - gap) / 2, pitch / 2)],
        }
        c = section("pleated", values)["compliance"]
        # both shapes begin at 1
        limit = draw("pleated", "limit_share", share[6])

        def respond(pressure, modulus, blocked, slow):
            part = pressure / (1e3 * PUBLISHED["pleated"][blocked] * limit)
            if blocked:
                return pressure * c[1][2] / c[1][1] * between(shape["moment"], part), 0.0
            softer = pressure * REFERENCE / modulus * count * pitch
            return softer * c[1][2] * between(shape["curvature"], part), softer * c[2][2] * between(shape["volume"], part)
        yield respond, draw("pleated", "cavity"), min(1.0, count * pitch / length)


MODELS = {"cylindrical": cylindrical, "ribbed": ribbed, "pleated": lambda: pleated(shapes())}


def rows(specimen):
    """All rows of a specimen, and the share of samples that have no state, or exceed the stroke, at the largest published pressure."""
    of_cell = specimen == "ribbed"
    discrepancy = ("all", "cell_discrepancy") if of_cell else (specimen, "model_discrepancy")
    samples, counts = {}, {False: [0, 0], True: [0, 0]}

    def keep(quantity, unit, kpa, value):
        samples.setdefault((quantity, unit, kpa), []).append(value)

    for respond, cavity, active in MODELS[specimen]():
        for share in others():
            modulus, off = draw("all", "young_modulus", share[0]), draw(*discrepancy, share[3])
            slow = draw("all", "growth_share", share[6])
            # pleats that touch limit their volume, not their angle: the model errs in both independently
            swollen = draw("pleated", "volume_discrepancy", share[7]) if specimen == "pleated" else off
            for blocked in (False, True):
                counts[blocked][0] += 1
                # the actuator of the paper, and its cylinder, reached this pressure
                most = 1e3 * PUBLISHED[specimen][blocked]
                last = respond(most, modulus, blocked, slow)
                if last is None or (not blocked and moved_gas(most, last[1] * swollen, cavity, share[4:6]) is None):
                    counts[blocked][1] += 1
                    continue
                for kpa in pressures(specimen, blocked):
                    value, volume = respond(1e3 * kpa, modulus, blocked, slow)
                    if blocked:
                        keep("tip force", "N", kpa, tip_force(specimen, value * off, share, active))
                        continue
                    keep("angle", "rad", kpa, value * off)
                    keep("piston volume", "ml", kpa, 1e6 * moved_gas(1e3 * kpa, volume * swollen, cavity, share[4:6]))
    ordered = sorted(samples.items(), key=lambda item: (item[0][0], item[0][2]))
    left_out = {(specimen, name): lost / all_ for name, (all_, lost) in zip(("free", "blocked"), counts.values())}
    return [Row(EXPERIMENT, specimen, *key, *interval(values)) for key, values in ordered], left_out
