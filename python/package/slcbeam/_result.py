"""Results of runs."""

from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _page, _slcbeam
from ._case import Case
from ._errors import UnknownError, UsageError
from ._page import Report

if TYPE_CHECKING:
    import pandas
    import polars
    import xarray


def frozen(array: np.ndarray) -> np.ndarray:
    """A read-only view of an array that cannot be made writable again."""
    whole: Any = array
    while isinstance(whole, np.ndarray):
        whole.flags.writeable = False
        whole = whole.base
    if array.size == 0:
        return array
    flat = np.ascontiguousarray(array).reshape(-1).view(np.uint8)
    return np.frombuffer(flat.data.toreadonly(), dtype=array.dtype).reshape(array.shape)


def unknown(name: object, names: Iterable[str]) -> UnknownError:
    """The error of an unknown name, with the nearest known one."""
    import difflib

    names = list(names)
    # a name may be missing only its unit
    begins = [own for own in names if own.startswith(f"{name}_")]
    near = begins or difflib.get_close_matches(str(name), names, 1)
    return UnknownError(f"{name}; did you mean {near[0]!r}?" if near else str(name))


def place(dir: Any) -> Path:
    """The path of a file or folder.

    :raises UsageError: if it is no path.
    """
    if not isinstance(dir, (str, os.PathLike)) or "\0" in os.fspath(dir):
        raise UsageError(f"{dir!r} is no path of a file or folder")
    return Path(dir)


class Named(dict[str, Any]):
    """Figures by name. The error of an unknown name suggests the nearest known one."""

    def __missing__(self, name: str) -> Any:
        raise unknown(name, self)


class Table(Mapping[str, np.ndarray]):
    """Columns of equal length by name; each is read-only, of shape (rows,), in the unit given by :attr:`units`. Columns are not copied.

    >>> import slcbeam
    >>> history = slcbeam.run("bend-wet").history
    >>> history["tip_u1"].shape, history.units["tip_u1"], history.about["tip_u1"]
    ((1001,), 'm', 'transverse displacement of the tip')
    """

    def __init__(self, names: list[str], units: list[str], rows: np.ndarray, about: list[str] | None = None) -> None:
        #: Names of the columns, without units.
        self.names = list(names)
        #: Unit of each column by its name; ``"1"`` for dimensionless columns.
        self.units = dict(zip(names, units))
        #: Description of each column by its name.
        self.about = dict(zip(names, about or [""] * len(names)))
        #: All values, of shape (rows, columns), read-only.
        self.values_2d = frozen(rows)
        self._place = {name: k for k, name in enumerate(self.names)}

    def __getitem__(self, name: str) -> np.ndarray:
        try:
            return self.values_2d[:, self._place[name]]
        except KeyError:
            raise unknown(name, self.names) from None

    def __iter__(self) -> Iterator[str]:
        return iter(self.names)

    def __len__(self) -> int:
        return len(self.names)

    def to_pandas(self) -> pandas.DataFrame:
        """Returns a data frame with one column per name, indexed by time if there is a column ``t``. Needs pandas."""
        import pandas

        frame = pandas.DataFrame(self.values_2d, columns=self.names)
        return frame.set_index("t") if "t" in self._place else frame

    def to_polars(self) -> polars.DataFrame:
        """Returns a polars data frame with one column per name. Needs polars."""
        import polars

        return polars.DataFrame({name: np.ascontiguousarray(self[name]) for name in self.names})

    def _repr_html_(self) -> str:
        return _page.columns(repr(self), self.names, [self.units[name] for name in self.names], self.values_2d.tolist())

    def __repr__(self) -> str:
        return f"<{len(self)} columns of {len(self.values_2d)} rows: {', '.join(self.names[:6])}{', ..' if len(self) > 6 else ''}>"


class Fields(Mapping[str, np.ndarray]):
    """Arrays over time and position by name, of shape (times, positions), in the unit of the name. Coordinates are available by name, too.

    >>> import slcbeam
    >>> fields = slcbeam.run("bend-wet").fields
    >>> fields["u1_m"].shape == (len(fields.t), len(fields["theta_node_m"]))
    True
    >>> fields.axis["u1_m"], fields.axis["pressure_pa"], fields.units["pressure_pa"]
    ('theta_node_m', 'x_f', 'Pa')
    """

    def __init__(
        self,
        times: np.ndarray,
        axes: list[tuple[str, str, str, np.ndarray]],
        fields: list[tuple[str, str, str, str]],
        arrays: list[np.ndarray],
    ) -> None:
        #: Times of the arrays [s], of shape (times,).
        self.t = frozen(times)
        #: Coordinates by name, unit included: ``theta_node_m``.
        self.coordinates: dict[str, np.ndarray] = {name: frozen(values) for name, _, _, values in axes}
        #: Name of the coordinate of each field, by the name of the field.
        self.axis = {name: axis for name, _, axis, _ in fields}
        #: Units by name, of fields and coordinates.
        self.units = {name: unit for name, unit, *_ in [*axes, *fields]} | {"t": "s"}
        #: Descriptions by name, of fields and coordinates.
        self.about = {name: about for name, _, about, _ in axes} | {name: about for name, *_, about in fields}
        self._arrays = {field[0]: frozen(array) for field, array in zip(fields, arrays)}

    def __getitem__(self, name: str) -> np.ndarray:
        found = self.coordinates.get(name, self._arrays.get(name))
        if found is None:
            raise unknown(name, [*self._arrays, *self.coordinates])
        return found

    def __iter__(self) -> Iterator[str]:
        return iter(self._arrays)

    def __len__(self) -> int:
        return len(self._arrays)

    def to_xarray(self) -> xarray.Dataset:
        """Returns a dataset with all coordinates, units and descriptions. Needs xarray."""
        import xarray

        def attributes(name: str) -> dict[str, str]:
            return {"units": self.units[name], "long_name": self.about.get(name, "")}

        arrays = {name: (("t", self.axis[name]), array, attributes(name)) for name, array in self._arrays.items()}
        axes = {name: (name, values, attributes(name)) for name, values in self.coordinates.items()}
        return xarray.Dataset(arrays, coords={"t": ("t", self.t, {"units": "s"}), **axes})

    def __repr__(self) -> str:
        return f"<{len(self)} fields at {len(self.t)} times: {', '.join(self)}>"


def split(names: list[str]) -> tuple[list[str], list[str]]:
    """Splits headings such as ``tip_u1 [m]`` into names and units; a missing unit is empty."""
    parts = [name[:-1].partition(" [") if name.endswith("]") else (name, "", "") for name in names]
    return [head for head, _, _ in parts], [unit for *_, unit in parts]


class Result:
    """Result of a run. Its arrays are read-only and shared with the run, not copied."""

    def __init__(self, case: Case, recorded: Any, arrays: dict[str, Any]) -> None:
        self._asked, self._recorded, self._arrays = case, recorded, arrays
        #: ``summary.json`` as a dict.
        self.summary: dict[str, Any] = json.loads(recorded.summary())
        #: True if Ctrl-C ended the run early. With an accuracy, the result then is the last candidate that finished.
        self.interrupted: bool = recorded.interrupted
        names, units, about = ([*column] for column in zip(*recorded.columns())) if recorded.columns() else ([], [], [])
        #: One row per output time: ``result.history["tip_u1"]``.
        self.history = Table(names, units, arrays["history"], about)
        #: Statistics over the output times that the history omits (``/time/history``); no columns if it omits none.
        self.envelope = Table(*split(recorded.envelope()), arrays["envelope"])
        #: Derivatives of the history's columns: ``result.derivatives["d tip_u1/d /beam/length_m"]``; none without ``sensitivity``.
        self.derivatives = Table(*split(recorded.sensitivities()), arrays["sensitivities"])
        #: Arrays over time and position: ``result.fields["u1_m"]``.
        self.fields = Fields(arrays["times"], recorded.axes(), recorded.fields(), arrays["fields"])

    @property
    def case(self) -> Case:
        """The case that was run."""
        return self._asked

    @property
    def status(self) -> str:
        """``finished``, ``stopped``, ``out_of_range`` or ``failed``."""
        status: str = self.summary["status"]
        return status

    @property
    def quantities(self) -> dict[str, dict[str, Any]]:
        """Figures of every quantity, by name with unit: ``final``, ``max_abs`` at ``max_abs_at_s``, the signed ``extreme``,
        ``window_rms`` .. in that unit. ``error`` is relative: the largest error of the figures over the largest figure, ``None`` if unknown. Columns of
        :attr:`history` have names without units: ``tip_u1``.

        >>> import slcbeam
        >>> tip = slcbeam.run("bend-wet").quantities["tip_u1_m"]
        >>> round(1e3 * tip["final"], 1), tip["error"] < 0.01
        (28.3, True)
        """
        all = self.summary["quantities"] | self.summary.get("probes", {})
        return Named({name: Named(figures | {"error": self._relative_error(name, figures)}) for name, figures in all.items()})

    def _relative_error(self, name: str, figures: dict[str, Any]) -> float | None:
        """Largest error of the figures of a quantity over its largest figure."""
        kinds = ("final", "max_abs", "window_max_abs", "window_rms", "window")
        errors = [self.errors[name][kind] for kind in kinds if kind in self.errors.get(name, {})]
        size = max((abs(figures[kind]) for kind in kinds if figures.get(kind) is not None), default=0.0)
        return max(errors) / size if errors and size > 0.0 else None

    @property
    def errors(self) -> dict[str, dict[str, float]]:
        """Absolute errors of the figures of quantities, probes and ports, each in the unit of its figure. Empty without a companion run.

        >>> import slcbeam
        >>> slcbeam.run("bend-wet").errors["tip_u1_m"]["final"] < 1e-3
        True
        """
        errors: dict[str, dict[str, float]] = self.summary.get("errors", {})
        return errors

    @property
    def sensitivities(self) -> dict[str, dict[str, Any]]:
        """Derivatives of the quantities, by the JSON pointers of the ``sensitivity`` numbers, as in ``summary.json``."""
        told: dict[str, dict[str, Any]] = self.summary.get("sensitivities", {})
        return told

    @property
    def warnings(self) -> list[str]:
        """Warnings of the run."""
        warnings: list[str] = self.summary["warnings"]
        return warnings

    def save(self, dir: str | os.PathLike[str], force: bool = False) -> Path:
        """Writes the same folder as ``slcbeam run --out``, with the page; returns its path.

        :param force: also write into a folder that contains other files.
        """
        folder = place(dir)
        self._recorded.save(folder, force, self._arrays)
        return folder

    def report(self) -> Report:
        """Returns the page of the result: diagrams, figures, animation."""
        with tempfile.TemporaryDirectory() as folder:
            page = self.save(Path(folder) / "result") / "report.html"
            return Report(page.read_text(encoding="utf-8"))

    def _repr_html_(self) -> str:
        kinds = {"final": "at the end", "max_abs": "largest", "window_rms": "rms in the window", "error": "relative error"}
        quantities = self.quantities
        shown = [kind for kind in kinds if any(of.get(kind) is not None for of in quantities.values())]
        rows = [[name, *(of.get(kind) for kind in shown)] for name, of in quantities.items()]
        return _page.summary(repr(self), self.warnings, _page.table(["quantity", *(kinds[kind] for kind in shown)], rows))

    def __repr__(self) -> str:
        warned = f", {len(self.warnings)} warnings" if self.warnings else ""
        return f"<slcbeam.Result of {self.case.name!r}: {self.status} at t = {self.summary['time_s']:g} s{warned}>"

    def __reduce__(self) -> tuple[Any, ...]:
        recorded = self._recorded
        flags = (recorded.began, recorded.interrupted)
        told = (recorded.case().json(), recorded.summary(), recorded.envelope(), recorded.sensitivities(), *flags)
        return (_again, (self._asked, told, self._arrays))


def _again(case: Case, told: tuple[Any, ...], arrays: dict[str, Any]) -> Result:
    resolved, *rest = told
    own = _slcbeam.Case.parse(resolved, "<result>", "", [])
    return Result(case, _slcbeam.again(own, *rest), arrays)
