"""Elastic beams with rows of fluid-filled bladders joined by slender tubes.

>>> import slcbeam
>>> result = slcbeam.run("bend-wet")
>>> tip = result.history["tip_u1"]    # [m], one value an output time

Numbers are in SI units, which names of figures and fields carry. A case is what ``slcbeam schema`` describes.
"""

try:
    from . import _slcbeam
except ImportError as error:
    if "libsundials" in str(error) or "libklu" in str(error):
        raise ImportError(
            f"{error}\nslcbeam needs SUNDIALS 6 and KLU of SuiteSparse: "
            "apt-get install libsundials-idas5 libsundials-kinsol6 libklu1"
        ) from error
    raise

from ._answer import Answer, Columns
from ._case import Case, load, shipped
from ._commands import check, effects, equilibrium, fit, floquet, modes, optimize, periodic, sense, study, sweep
from ._errors import CaseError, Error, Fault, FileError, SolverError, UsageError
from ._result import Fields, Report, Result, Table
from ._run import run
from ._simulator import Simulator, State

__all__ = [
    "Answer",
    "Case",
    "CaseError",
    "Columns",
    "Error",
    "Fault",
    "Fields",
    "FileError",
    "Report",
    "Result",
    "Simulator",
    "SolverError",
    "State",
    "Table",
    "UsageError",
    "check",
    "effects",
    "equilibrium",
    "fit",
    "floquet",
    "load",
    "modes",
    "optimize",
    "periodic",
    "run",
    "sense",
    "shipped",
    "study",
    "sweep",
]
