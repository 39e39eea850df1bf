"""Simulation from one control instant to the next."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Union

import numpy as np

from . import _slcbeam
from ._case import CaseLike, load, numbers
from ._errors import UsageError
from ._result import frozen
from ._slcbeam import State as State

#: Values of the inputs: in their order, or some of them by pointer.
Values = Union[None, float, Sequence[float], np.ndarray, Mapping[str, float]]


class Simulator:
    """A case that is simulated piece by piece, with loads, pressures, flows and openings that are held in between.

    :param case: a :class:`Case`, or what :func:`load` takes. ``/time/end_s`` is how far it can be simulated.
    :param inputs: by the JSON pointer of a signal the smallest and the largest value that it will be given, in the unit of its key; what the
        scene calls for, and the sizes of the unknowns, follow from these. They begin as the case has them at its start.
    :raises UsageError: there is no such signal, or one that must not jump (a motion, a volume).

    >>> import slcbeam
    >>> inlet = "/network/chains/0/ends/0/pressure_pa"
    >>> sim = slcbeam.Simulator("tour-actuator", {inlet: (0, 40e3)})
    >>> row = sim.step(0.01, 20e3)
    >>> sim.t, sim.units["tip_u1"], bool(sim["tip_u1"] == row[sim.columns.index("tip_u1")])
    (0.01, 'm', True)
    """

    def __init__(self, case: CaseLike, inputs: Mapping[str, tuple[float, float]]) -> None:
        #: The case.
        self.case = load(case)
        #: Pointers of the inputs, in their order.
        self.inputs = list(inputs)
        try:
            if not all(isinstance(pointer, str) for pointer in self.inputs):
                raise TypeError
            ranges = numbers([inputs[pointer] for pointer in self.inputs]).reshape(len(self.inputs), 2)
        except (TypeError, ValueError):
            raise UsageError("inputs are a dict of (smallest, largest) by JSON pointer") from None
        #: Smallest and largest values of the inputs: an array of shape (inputs, 2).
        self.ranges = frozen(ranges)
        self._own = _slcbeam.Simulator(self.case._own, [(one, *range_) for one, range_ in zip(self.inputs, ranges.tolist())])
        columns = self._own.columns()
        #: Names of the columns of :attr:`row`.
        self.columns = [name for name, _, _ in columns]
        #: Their units, by name.
        self.units = {name: unit for name, unit, _ in columns}
        #: What they are, by name.
        self.about = {name: about for name, _, about in columns}
        self._place = {name: k for k, name in enumerate(self.columns)}

    def step(self, duration: float, values: Values = None) -> np.ndarray:
        """Holds the inputs at these values from now on and simulates for a time [s]; returns :attr:`row` at its end.

        :param values: one for each input, in their order; a number where there is one input; some by pointer; none: as they are.
        :raises UsageError: a value outside of its range, a time beyond the end of the case.
        :raises SolverError: it could not go on; :attr:`t` tells where it stands, and :meth:`restore` leads back; its ``result`` is
            ``None``, since :attr:`row` and :attr:`warnings` have what there is. Where the model ends, that is at its limit.
        :raises KeyboardInterrupt: after the step in which it came; :attr:`t` tells where it stands.
        """
        return self._step(duration, True, values)

    def step_to(self, t: float, values: Values = None) -> np.ndarray:
        """The same until a time [s]."""
        return self._step(t, False, values)

    def _step(self, time: float, further: bool, values: Values) -> np.ndarray:
        try:
            time = float(numbers(time))
            if np.isnan(time):
                raise ValueError
        except (TypeError, ValueError):
            raise UsageError("times are numbers [s]") from None
        row, stopped = self._own.step(time, further, self._given(values))
        if stopped:
            raise KeyboardInterrupt
        row.flags.writeable = False
        return row

    def _given(self, values: Values) -> np.ndarray | None:
        if values is None:
            return None
        if isinstance(values, Mapping):
            given = self._own.values()
            for pointer, value in values.items():
                if pointer not in self.inputs:
                    raise UsageError(f"{pointer} is no input; inputs are {', '.join(self.inputs)}")
                try:
                    given[self.inputs.index(pointer)] = float(numbers(value))
                except (TypeError, ValueError):
                    raise UsageError(f"{pointer}: a number is wanted") from None
            return given
        try:
            given = np.atleast_1d(numbers(values))
        except (TypeError, ValueError):
            given = np.empty((0, 0))
        if given.ndim != 1:
            raise UsageError("values of the inputs are a number, a list of numbers, or a dict by pointer")
        return np.ascontiguousarray(given)

    @property
    def t(self) -> float:
        """Simulated time [s]."""
        return self._own.t

    @property
    def end(self) -> float:
        """Time up to which the case can be simulated, its ``/time/end_s`` [s]."""
        return self._own.end

    @property
    def steps(self) -> int:
        """Steps that the integrator has taken."""
        return self._own.steps

    @property
    def wall_s(self) -> dict[str, float]:
        """Wall time of all steps so far [s]: ``integration``; ``jumps``, for consistent values behind changed inputs; ``watching``, for
        limits of the model, balances and the row."""
        return dict(zip(("integration", "jumps", "watching"), self._own.spent()))

    @property
    def values(self) -> np.ndarray:
        """Values of the inputs, in their order."""
        return self._own.values()

    @property
    def row(self) -> np.ndarray:
        """The history's columns at the present time: an array of shape (columns,), in :attr:`units`."""
        return self._own.row()

    def __getitem__(self, column: str) -> float:
        """One of them by its name."""
        return float(self.row[self._place[column]])

    @property
    def warnings(self) -> list[str]:
        """What to know of what has been simulated: balances that do not close, a range that was left, and what
        the mesh does not resolve of inputs as they have been."""
        return self._own.warnings()

    def save(self) -> State:
        """The present state; it can be pickled. The simulator goes on from it exactly as one that restores it does."""
        return self._own.save()

    def restore(self, state: State) -> None:
        """Goes to a state that a simulator of the same case and inputs was in.

        :raises UsageError: a state of another case.
        """
        self._own.restore(state)

    def __repr__(self) -> str:
        return f"<slcbeam.Simulator of {self.case.name!r} at t = {self.t:g} s: {len(self.inputs)} inputs, {len(self.columns)} columns>"
