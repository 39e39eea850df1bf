"""Results of commands other than runs."""

from __future__ import annotations

import csv
import io
import json
import shutil
import tempfile
import zlib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _page
from ._errors import FileError, UsageError
from ._page import Report
from ._result import Named, frozen, place, split, unknown

if TYPE_CHECKING:
    import os

    import pandas
    import polars


class Columns(Mapping[str, np.ndarray]):
    """Columns of a table by name: arrays of shape (rows,). Floats if every cell is a number or empty (nan), else texts."""

    def __init__(self, headings: list[str], rows: list[list[str]]) -> None:
        #: Names of the columns, without units.
        self.names, units = split(headings)
        #: Unit of each column by its name; ``""`` if its heading has none.
        self.units = dict(zip(self.names, units))
        self._columns = {name: _column([row[k] for row in rows]) for k, name in enumerate(self.names)}
        self._rows = len(rows)

    def __getitem__(self, name: str) -> np.ndarray:
        if name not in self._columns:
            raise unknown(name, self._columns)
        return self._columns[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

    def to_pandas(self) -> pandas.DataFrame:
        """Returns a data frame with one column per name. Needs pandas."""
        import pandas

        return pandas.DataFrame(self._columns)

    def to_polars(self) -> polars.DataFrame:
        """Returns a polars data frame with one column per name. Needs polars."""
        import polars

        return polars.DataFrame(self._columns)

    def _repr_html_(self) -> str:
        rows = list(zip(*(column.tolist() for column in self._columns.values())))
        return _page.columns(repr(self), self.names, [self.units[name] for name in self.names], rows)

    def __repr__(self) -> str:
        return f"<{len(self)} columns of {self._rows} rows: {', '.join(self.names[:6])}{', ..' if len(self) > 6 else ''}>"


def _column(cells: list[str]) -> np.ndarray:
    try:
        column = np.array([float(cell) if cell else np.nan for cell in cells])
    except ValueError:
        column = np.array(cells)
    return frozen(column)


class Answer(Mapping[str, Any]):
    """Result of a command: values of its JSON file by key, ``answer["quantities"]``, and tables and arrays of its folder.

    Without ``out`` the folder is temporary and is deleted with the answer.
    """

    def __init__(self, told: dict[str, Any], folder: Path | None, *, interrupted: bool = False, kept: Any = None) -> None:
        self._told, self._kept = told, kept
        #: Folder of the result; ``None`` for a command that writes none.
        self.folder = folder
        #: True if Ctrl-C ended the command before its result was complete.
        self.interrupted = interrupted

    def __getitem__(self, key: str) -> Any:
        if key not in self._told:
            raise unknown(key, self._told)
        return self._told[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self._told)

    def __len__(self) -> int:
        return len(self._told)

    @property
    def warnings(self) -> list[str]:
        """Warnings of the command."""
        warnings: list[str] = self._told.get("warnings", [])
        return warnings

    @property
    def bands(self) -> dict[str, dict[str, Any]]:
        """Uncertainty of each figure due to ``uncertain`` numbers, in the unit of the figure: ``value``, ``numerical_error`` if known,
        ``sd``, ``low``, ``high``, and the number of ``samples`` of those ``drawn``. Empty without uncertain numbers. Figures of modes are named
        ``mode_1.frequency_hz``, with the lowest oscillating mode first; each mode has its own bands, too:
        ``answer["modes"][0]["bands"]``.

        >>> import slcbeam
        >>> coarse = slcbeam.load("bend-dry", set={"/mesh/cells_per_segment": 1})
        >>> modulus = {"/beam/young_modulus_pa": "normal:2e6:1e5"}
        >>> tip = slcbeam.equilibrium(coarse, uncertain=modulus, samples=16).bands["tip_u1_m"]
        >>> tip["low"] < tip["value"] < tip["high"], tip["numerical_error"] < tip["sd"]
        (True, True)
        """
        told = self._told.get("bands")
        path = None if self.folder is None else self.folder / "uncertainty.json"
        if told is None and path is not None and path.is_file():
            kept = ("value", "numerical_error", "sd", "low", "high", "samples")
            found = json.loads(path.read_text(encoding="utf-8"))
            drawn = {"drawn": found["samples"]}
            told = {name: {key: one[key] for key in kept if key in one} | drawn for name, one in found["figures"].items()}
        return Named(told or {})

    @property
    def tables(self) -> dict[str, Columns]:
        """Tables of the folder by file name: ``tables["path"]`` is ``path.csv``. Every access reads the files again."""
        found: dict[str, Columns] = Named()
        sums = self._checksums()
        for path in sorted(self._folder().glob("*.csv")):
            try:
                content = path.read_bytes()
                if path.name in sums and zlib.crc32(content) != sums[path.name]:
                    raise FileError(f"cannot read {path}: it was changed or cut short, its checksum is not that in summary.json")
                headings, *rows = csv.reader(io.StringIO(content.decode("utf-8"), newline=""), strict=True)
                if any(len(row) != len(headings) for row in rows):
                    raise ValueError(f"its rows do not have {len(headings)} cells each")
            except (OSError, ValueError, csv.Error) as error:
                raise FileError(f"cannot read {path}: {error}") from None
            table = found[path.stem] = Columns(headings, rows)
            about = path.with_suffix(".json")
            if path.stem == "sweep" and about.is_file():
                # headings of figures in this table have no units
                table.units |= {one["name"]: one["unit"] for one in json.loads(about.read_text(encoding="utf-8"))["columns"]}
        return found

    def _checksums(self) -> dict[str, int]:
        """Checksums of tables by file name; only runs and cycles have them."""
        path = self._folder() / "summary.json"
        try:
            return json.loads(path.read_text(encoding="utf-8")).get("tables_crc32", {}) if path.is_file() else {}
        except (OSError, ValueError, AttributeError) as error:
            raise FileError(f"cannot read {path}: {error}") from None

    @property
    def arrays(self) -> dict[str, np.ndarray]:
        """Arrays of the NPZ files of the folder by name, with units in the names. Every access reads the files again."""
        found: dict[str, np.ndarray] = {}
        for path in sorted(self._folder().glob("*.npz")):
            with np.load(path) as arrays:
                found |= {name: frozen(arrays[name]) for name in arrays.files}
        return found

    def save(self, dir: str | os.PathLike[str]) -> Path:
        """Copies the folder to a path that does not exist yet; returns that path."""
        target = place(dir)
        try:
            shutil.copytree(self._folder(), target)
        except OSError as error:
            raise FileError(f"cannot copy to {target}: {error.strerror or error}") from None
        return target

    def report(self) -> Report:
        """Returns the page of the answer; with ``lean`` there is none."""
        if not (self._folder() / "report.html").is_file():
            raise UsageError("this answer has no page: ask for it without lean")
        return Report((self._folder() / "report.html").read_text(encoding="utf-8"))

    def _folder(self) -> Path:
        if self.folder is None:
            raise UsageError("this command writes no folder")
        if not self.folder.is_dir():
            raise FileError(f"{self.folder} is no longer there")
        return self.folder

    def _repr_html_(self) -> str:
        return _page.summary(repr(self), self.warnings)

    def __repr__(self) -> str:
        case = self._told.get("case") or self._told.get("name")
        of = f" of {case!r}" if isinstance(case, str) else ""
        return f"<slcbeam.Answer{of}: {', '.join(list(self)[:8])}{', ..' if len(self) > 8 else ''}>"

    def __reduce__(self) -> tuple[Any, ...]:
        files = None
        if self.folder is not None and self._kept is not None:
            files = {str(p.relative_to(self.folder)): p.read_bytes() for p in self.folder.rglob("*") if p.is_file()}
        return (_again, (self._told, None if files is not None else self.folder, self.interrupted, files))


#: Main result files of the commands; a file comes before those that may be beside it in a folder.
MAIN = ("cycle", "sweep", "summary", "equilibrium", "modes", "study", "effects", "floquet", "map", "fit", "sense", "optimum", "response", "bands")


def read(dir: str | os.PathLike[str]) -> Answer:
    """Reads a result folder of any command: values of its JSON file, tables, arrays, page.

    For a run these are ``summary.json``, ``tables["history"]`` and the ``arrays`` of ``fields.npz``.

    :raises FileError: if the folder contains no result.
    """
    folder = place(dir)
    found = [path for path in (folder / f"{name}.json" for name in MAIN) if path.is_file()]
    if not found:
        raise FileError(f"{folder} holds no result: none of {', '.join(f'{name}.json' for name in MAIN)}")
    try:
        told = json.loads(found[0].read_text(encoding="utf-8"))
        if not isinstance(told, dict):
            raise ValueError("it is no JSON object")
        return Answer(told, folder)
    except (OSError, ValueError, RecursionError) as error:
        raise FileError(f"cannot read {found[0]}: {error}") from None


def _again(told: dict[str, Any], folder: Path | None, interrupted: bool, files: dict[str, bytes] | None) -> Answer:
    kept = None
    if files is not None:
        kept = tempfile.TemporaryDirectory(prefix="slcbeam-")
        folder = Path(kept.name)
        for name, content in files.items():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / name).write_bytes(content)
    return Answer(told, folder, interrupted=interrupted, kept=kept)
