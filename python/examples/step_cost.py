"""What a control step of the actuator of the tour costs, by parts: python python/examples/step_cost.py"""

import time

import numpy as np

import slcbeam

INLET = "/network/chains/0/ends/0/pressure_pa"
PARTS = ("integration", "jumps", "watching")


def cost(change: float, steps: int = 500, duration: float = 1e-3) -> dict[str, float]:
    """Of a step [us]: in all, and the parts of that; a tenth of the steps took less, which is what they cost when nothing else disturbs
    them. ``change`` is that of the inlet's pressure from step to step [Pa]."""
    case = slcbeam.load("tour-actuator", set={"/solver/method": "esdirk46", "/time/end_s": 100})
    sim = slcbeam.Simulator(case, {INLET: (0.0, 60e3)})
    rows, taken = [], 0
    for k in range(steps + 200):
        if k == 200:
            taken = sim.steps
        before, begin = sim.wall_s, time.perf_counter()
        sim.step(duration, 20e3 + change * (k % 7))
        whole, after = time.perf_counter() - begin, sim.wall_s
        own = [after[part] - before[part] for part in PARTS]
        rows.append([whole, *own, whole - sum(own), whole - own[0]])
    found = 1e6 * np.quantile(rows[200:], 0.1, axis=0)
    return {"steps": (sim.steps - taken) / steps, **dict(zip(("all", *PARTS, "call", "rest"), found))}


def main() -> None:
    for what, change in (("unchanged", 0.0), ("changed", 100.0)):
        found = cost(change)
        rest = found["rest"]
        parts = ", ".join(f"{part} {found[part]:.0f}" for part in ("jumps", "watching", "call"))
        print(f"{what}: {found['steps']:.2f} steps of the integrator, {found['integration']:.0f} us; besides {rest:.0f} us ({parts})")


if __name__ == "__main__":
    main()
