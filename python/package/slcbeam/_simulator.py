"""Stepwise simulation with inputs that change between the steps."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Union

import numpy as np

from . import _slcbeam
from ._case import CaseLike, load, numbers
from ._errors import UsageError
from ._result import frozen
from ._slcbeam import State as State

#: Values of all inputs in their order, or of some inputs by pointer.
Values = Union[None, float, Sequence[float], np.ndarray, Mapping[str, float]]


class Simulator:
    """Simulates a case step by step. Inputs (loads, pressures, flows, openings) are constant during a step. Volumes and motions of ends
    reach their value at the end of the step, by a cubic.

    :param case: a :class:`Case`, or an argument of :func:`load`. ``/time/end_s`` limits the simulated time.
    :param inputs: smallest and largest value of each input, by the JSON pointer of its signal in the unit of its key. They determine the
        effects of the model and the scales of the unknowns. The initial values are those of the case at its start.
    :raises UsageError: if a signal does not exist.

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
        #: Units of the columns, by name.
        self.units = {name: unit for name, unit, _ in columns}
        #: Descriptions of the columns, by name.
        self.about = {name: about for name, _, about in columns}
        self._place = {name: k for k, name in enumerate(self.columns)}

    def step(self, duration: float, values: Values = None) -> np.ndarray:
        """Sets the inputs and simulates for a duration [s]; returns :attr:`row` at the end.

        :param values: a value for each input in their order; a number if there is one input; a dict of some values by pointer; ``None`` to
            keep all values.
        :raises UsageError: if a value is outside its range, or the time is after the end of the case.
        :raises SolverError: if the simulation fails or reaches a limit of the model. :attr:`t` is the time reached; :meth:`restore`
            returns to a saved state. ``result`` of the error is ``None``; :attr:`row` and :attr:`warnings` remain available.
        :raises KeyboardInterrupt: after the current step of the integrator; :attr:`t` is the time reached.
        """
        return self._step(duration, True, values)

    def step_to(self, t: float, values: Values = None) -> np.ndarray:
        """Sets the inputs and simulates until a time [s]; otherwise like :meth:`step`."""
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
        """Last time that can be simulated [s]: ``/time/end_s`` of the case."""
        return self._own.end

    @property
    def steps(self) -> int:
        """Number of steps of the integrator so far."""
        return self._own.steps

    @property
    def wall_s(self) -> dict[str, float]:
        """Wall time of all steps so far [s]: ``integration``; ``jumps``, consistent values after changes of inputs; ``watching``, limits of
        the model, balances and the row."""
        return dict(zip(("integration", "jumps", "watching"), self._own.spent()))

    @property
    def values(self) -> np.ndarray:
        """Values of the inputs, in their order."""
        return self._own.values()

    @property
    def row(self) -> np.ndarray:
        """Columns of the history at the current time: an array of shape (columns,), in :attr:`units`."""
        return self._own.row()

    def __getitem__(self, column: str) -> float:
        """The current value of a column."""
        return float(self.row[self._place[column]])

    @property
    def warnings(self) -> list[str]:
        """Warnings so far: balances that do not close, validity ranges that were left, and input changes that the mesh does not
        resolve."""
        return self._own.warnings()

    def save(self) -> State:
        """Returns the current state, which can be pickled. A simulator that restores it continues exactly like this one."""
        return self._own.save()

    def restore(self, state: State) -> None:
        """Returns to a state saved by a simulator of the same case and inputs.

        :raises UsageError: if the state is of another case.
        """
        self._own.restore(state)

    def __repr__(self) -> str:
        return f"<slcbeam.Simulator of {self.case.name!r} at t = {self.t:g} s: {len(self.inputs)} inputs, {len(self.columns)} columns>"
