"""What a control step of the actuator of the tour costs, by parts: python python/examples/step_cost.py"""

import time

import slcbeam

INLET = "/network/chains/0/ends/0/pressure_pa"


def cost(change: float, steps: int = 500, duration: float = 1e-3) -> dict[str, float]:
    """Microseconds of a step [us]: in all, and of these the integration; ``change`` is that of the inlet's pressure from step to step [Pa]."""
    case = slcbeam.load("tour-actuator", set={"/solver/method": "esdirk46", "/time/end_s": 100})
    sim = slcbeam.Simulator(case, {INLET: (0.0, 60e3)})

    def go(count: int) -> None:
        for k in range(count):
            sim.step(duration, 20e3 + change * (k % 7))

    go(200)
    before, taken, begin = sim.wall_s, sim.steps, time.perf_counter()
    go(steps)
    whole = time.perf_counter() - begin
    spent = {part: 1e6 * (now - before[part]) / steps for part, now in sim.wall_s.items()}
    whole *= 1e6 / steps
    return {"steps": (sim.steps - taken) / steps, "all": whole, **spent, "call": whole - sum(spent.values())}


def main() -> None:
    for what, change in (("unchanged", 0.0), ("changed", 100.0)):
        found = cost(change)
        rest = found["all"] - found["integration"]
        parts = ", ".join(f"{part} {found[part]:.0f}" for part in ("jumps", "watching", "call"))
        print(f"{what}: {found['steps']:.2f} steps of the integrator, {found['integration']:.0f} us; besides {rest:.0f} us ({parts})")


if __name__ == "__main__":
    main()
