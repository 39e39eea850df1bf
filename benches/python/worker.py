"""Runs the Python peers on requests SCENE METHOD RTOL; times exclude compilation. `worker.py PEERS --check SCENE..` compares equations."""

import sys
import time

import numpy as np
import scipy.integrate
import sksundae

from asked import exported, serve
from beam import Beam

PEERS = sys.argv[1]
METHODS = ["sundae-default", "sundae-sparse2", "sundae-sparse5", "scipy-radau", "scipy-bdf"]


def sundae(beam, method, rtol):
    def residual(t, y, yp, out):
        beam.residual(t, y, yp, out)

    careful = {}
    if method != "sundae-default":
        careful = dict(
            linsolver="sparse", sparsity=beam.pattern, jacfn=beam.jacobian, max_order=int(method[-1]),
            max_num_steps=10_000_000,
        )
    begin = time.perf_counter()
    solver = sksundae.ida.IDA(
        residual, rtol=rtol, atol=rtol, algebraic_idx=beam.algebraic or None,
        **({"max_num_steps": 10_000_000} | careful),
    )
    solution = solver.solve(np.concatenate(([0.0], beam.times)), beam.y0, beam.yp0)
    seconds = time.perf_counter() - begin
    if not solution.success:
        raise RuntimeError(solution.message)
    return seconds, 0, solution.y[1:]


def scipys(beam, method, rtol):
    z0 = beam.y0[beam.differential]
    beam.mm[:], beam.nn[:] = 0.0, 0.0
    begin = time.perf_counter()
    solution = scipy.integrate.solve_ivp(
        beam.rates, (0.0, beam.times[-1]), z0, method={"scipy-radau": "Radau", "scipy-bdf": "BDF"}[method],
        t_eval=beam.times, rtol=max(rtol, 1e-12), atol=rtol, jac=beam.rate_jacobian,
    )
    seconds = time.perf_counter() - begin
    if not solution.success:
        raise RuntimeError(solution.message)
    return seconds, solution.nfev, [beam.complete(t, z) for t, z in zip(solution.t, solution.y.T)]


def check(names):
    """Compares equations at random states, relative to the largest residual of the state; exit code 1 if they differ."""
    worst = 0.0
    for name in names:
        scene = exported(PEERS, name)
        beam = Beam(scene)
        n = beam.n
        for state in scene["states"]:
            y, yp, wanted = (np.array(state[k]) for k in ("y", "yp", "residual"))
            out = np.zeros(n)
            beam.residual(state["t"], y, yp, out)
            # difference of each equation, relative to the largest of its block
            size = np.maximum(np.abs(wanted), 1e-3 * np.abs(wanted).max())
            worst = max(worst, float(np.max(np.abs(out - wanted) / size)))
            # z' of the reduced form makes the residual zero
            d = beam.differential
            z = beam.y0[d] + 1e-2 * y[d]
            full, rate = beam.complete(state["t"], z), np.zeros(n)
            rate[d] = beam.rates(state["t"], z)
            beam.residual(state["t"], full, rate, out)
            own = np.zeros(n)
            beam.residual(state["t"], full, 0 * rate, own)
            worst = max(worst, float(np.abs(out).max() / np.abs(own).max()))
        print(f"{name}: {n} unknowns, equations in Python and in slcbeam agree to {worst:.1e}")
    return int(not worst < 1e-10)


def main():
    if "--check" in sys.argv:
        sys.exit(check(sys.argv[3:]))
    beams = {}

    def solve(name, method, rtol):
        if name not in beams:
            beams[name] = Beam(exported(PEERS, name))
            beams[name].warm_up()
        if method not in METHODS:
            raise RuntimeError(f"no method {method}")
        beam = beams[name]
        seconds, steps, states = (sundae if method.startswith("sundae") else scipys)(beam, method, rtol)
        tips, pressures = zip(*map(beam.readings, states))
        return seconds, steps, tips, pressures

    serve(solve)


main()
