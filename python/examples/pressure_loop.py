r"""A closed pressure loop: a PI controller with a notch, designed on the reduced model of the tour's actuator, then on the nonlinear beam.

    slcbeam new actuator bender.json
    slcbeam export bender.json --set /network/chains/0/ends/0/pressure_pa=0 --state-space model.npz --error 1e-3 \
        --input /network/chains/0/ends/0/pressure_pa --output tip_u1
    python python/examples/pressure_loop.py model.npz

prints rise time and overshoot of a step of 1 mm, predicted and simulated.
"""

import sys

import numpy as np
import scipy.signal as signal

import slcbeam

INLET = "/network/chains/0/ends/0/pressure_pa"
PERIOD, STEPS, GOAL = 0.002, 500, 1e-3  # [s], 1, [m]
CROSSOVER = 2 * np.pi * 2.0  # [rad/s]


def design(model, notched=True):
    """Controller of the deflection in discrete time: loop gain 1 at the crossover, zero at a third of it, notch at the lowest resonance."""
    poles = np.linalg.eigvals(model[0])
    mode = min(poles[poles.imag > 0], key=abs)
    notch = ([1, -2 * mode.real, abs(mode) ** 2], [1, 2 * abs(mode), abs(mode) ** 2]) if notched else ([1], [1])
    above, below = np.polymul(notch[0], [1, CROSSOVER / 3]), np.polymul(notch[1], [1, 0])
    loop = signal.freqresp(model, [CROSSOVER])[1] * signal.freqs(above, below, [CROSSOVER])[1]
    return signal.cont2discrete(signal.tf2ss(above / abs(loop[0]), below), PERIOD, "bilinear")[:4]


class Linear:
    """A state-space model in discrete time, from rest."""

    def __init__(self, A, B, C, D):
        self.A, self.B, self.C, self.D = A, B, C, D
        self.x = np.zeros(len(A))

    def output(self, u):
        return (self.C @ self.x + self.D[:, 0] * u).item()

    def advance(self, u):
        """Output a period later, with the input held."""
        self.x = self.A @ self.x + self.B[:, 0] * u
        return self.output(u)


def closed_loop(controller, plant):
    """Deflection [m] after each control period; the plant returns it for a pressure [Pa]."""
    control, tip = Linear(*controller), [0.0]
    for _ in range(STEPS):
        error = GOAL - tip[-1]
        tip.append(plant(control.output(error)))
        control.advance(error)
    return np.array(tip)


def main(file):
    stored = np.load(file)
    model = [stored[name] for name in "ABCD"]
    controller = design(model)
    linear = Linear(*signal.cont2discrete(model, PERIOD)[:4])
    sim = slcbeam.Simulator(slcbeam.load("tour-actuator", set={INLET: 0}), {INLET: (-60e3, 60e3)})
    start = sim["tip_u1"]

    def beam(pressure):
        sim.step(PERIOD, pressure)
        return sim["tip_u1"] - start

    predicted, simulated = closed_loop(controller, linear.advance), closed_loop(controller, beam)
    for name, tip in (("predicted", predicted), ("simulated", simulated)):
        rise = PERIOD * (np.argmax(tip > 0.9 * GOAL) - np.argmax(tip > 0.1 * GOAL))
        print(f"{name}: rise time {rise:.3f} s, overshoot {100 * (max(tip) / GOAL - 1):.2f} %")
    print(f"largest difference: {100 * max(abs(predicted - simulated)) / GOAL:.3f} % of the step")


if __name__ == "__main__":
    main(sys.argv[1])
