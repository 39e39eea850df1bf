"""Simulation over time."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterable, Sequence

from . import _slcbeam
from ._case import CaseLike, load, numbers
from ._errors import FileError, SolverError, UsageError
from ._result import Result, place

#: Called about 20 times a second with the simulated time [s], the end time [s] and the number of steps so far.
Progress = Callable[[float, float, int], None]


def _bar(t: float, end: float, steps: int) -> None:
    share = t / end if end > 0 else 1.0
    full = int(30 * share)
    sys.stderr.write(f"\r[{'#' * full}{'.' * (30 - full)}] {100 * share:3.0f} %  t = {t:.6g} of {end:.6g} s, {steps} steps ")
    sys.stderr.flush()


def _accuracy(accuracy: float) -> float:
    try:
        return float(numbers(accuracy))
    except (TypeError, ValueError):
        raise UsageError(f"accuracy {accuracy!r}: a number is wanted, such as 0.01") from None


def run(
    case: CaseLike,
    accuracy: float | None = None,
    sensitivity: Sequence[str] = (),
    progress: bool | Progress = False,
    out: str | os.PathLike[str] | None = None,
) -> Result:
    """Simulates a case over time.

    :param case: a :class:`Case`, or an argument of :func:`load`.
    :param accuracy: required relative error of every figure; mesh and tolerances are then chosen automatically.
    :param sensitivity: JSON pointers of numbers; figures and history are differentiated with respect to them.
    :param progress: ``True`` for a bar on standard error, or a function ``f(t, end, steps)``; an exception in it ends the run.
    :param out: a folder for the result, written at the end of the run. A folder with other files is rejected before the run.
    :returns: the result. After a KeyboardInterrupt it is ``interrupted`` and its ``status`` is ``stopped``; with an accuracy, it is the
        last candidate that finished, if there is one.
    :raises SolverError: if the run fails; its ``result`` is the partial result.
    :raises FileError: if ``out`` cannot be written; its ``result`` is that of the run, if the run is complete.

    A run releases the global interpreter lock, so that other threads continue.

    >>> import slcbeam
    >>> result = slcbeam.run(slcbeam.load("bend-wet", set={"/time/end_s": 0.01}))
    >>> result.status, result.history["t"][-1]
    ('finished', np.float64(0.01))
    """
    if not isinstance(sensitivity, Iterable):
        raise UsageError("sensitivity takes JSON pointers")
    sensitivity = [sensitivity] if isinstance(sensitivity, str) else list(sensitivity)
    if accuracy is not None and sensitivity:
        raise UsageError("accuracy and sensitivity do not go together; take the mesh and tolerance that an accuracy led to from the summary")
    if not all(isinstance(pointer, str) for pointer in sensitivity):
        raise UsageError("sensitivity takes JSON pointers")
    accuracy = None if accuracy is None else _accuracy(accuracy)
    asked = load(case)
    if out is not None:
        _slcbeam.claimable(place(out))
    told = _bar if progress is True else (progress or None)
    recorded, arrays = _slcbeam.run(asked._own, accuracy, sensitivity, told)
    result = Result(asked, recorded, arrays)
    if progress is True:
        if result.status == "finished":
            _bar(result.summary["time_s"], result.summary["time_s"], result.summary["solver"]["steps"])
        sys.stderr.write("\n")
    if out is not None:
        try:
            result.save(out)
        except FileError as error:
            # keep a result that may have taken hours
            error.result = result
            raise
    fault = recorded.fault()
    if fault is not None:
        raise SolverError(*fault, result=result)
    return result
