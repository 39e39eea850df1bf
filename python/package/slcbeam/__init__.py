"""Elastic beams with rows of fluid-filled bladders joined by slender tubes.

>>> import slcbeam
>>> result = slcbeam.run("bend-wet")
>>> tip = result.history["tip_u1"]    # [m], one value an output time

Numbers are in SI units; names of figures and fields end in their unit. ``slcbeam schema`` describes the format of a case.
"""

try:
    from . import _slcbeam
except ImportError as error:
    if any(library in str(error) for library in ("libsundials", "libklu", "libamd", "libcolamd", "libbtf", "libsuitesparse")):
        raise ImportError(
            f"{error}\nThis build of slcbeam needs SUNDIALS 6 and KLU of SuiteSparse on the system. Debian 12 brings them by\n"
            "    apt-get install libsundials-idas5 libsundials-kinsol6 libsundials-nvecserial6 libklu1\n"
            "A wheel that carries them is built by scripts/package, see docs/install.md."
        ) from error
    raise

from importlib import metadata as _metadata

from ._answer import Answer, Columns, read
from ._case import Case, load, shipped
from ._commands import (
    bands,
    check,
    coefficients,
    compare,
    effects,
    equilibrium,
    explain,
    export,
    fit,
    floquet,
    measure,
    merge,
    modes,
    optimize,
    periodic,
    plot,
    response,
    sense,
    study,
    sweep,
)
from ._errors import CaseError, Error, Fault, FileError, SolverError, UnknownError, UsageError
from ._page import Report
from ._result import Fields, Result, Table
from ._run import run
from ._simulator import Simulator, State

try:
    __version__ = _metadata.version("slcbeam")
except _metadata.PackageNotFoundError:
    # imported from the path, not installed
    __version__ = "unknown"

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
    "UnknownError",
    "UsageError",
    "bands",
    "check",
    "coefficients",
    "compare",
    "effects",
    "equilibrium",
    "explain",
    "export",
    "fit",
    "floquet",
    "load",
    "measure",
    "merge",
    "modes",
    "optimize",
    "periodic",
    "plot",
    "read",
    "response",
    "run",
    "sense",
    "shipped",
    "study",
    "sweep",
]
