"""Cases: descriptions of the simulated systems."""

from __future__ import annotations

import difflib
import json
import os
from collections.abc import Iterator, Mapping
from decimal import Decimal
from numbers import Real
from pathlib import Path
from typing import Any, Union

import numpy as np

from . import _slcbeam
from ._errors import UnknownError, UsageError

#: Folder of the cases shipped with the package.
CASES = Path(__file__).parent / "cases"

#: Types accepted as a case.
CaseLike = Union["Case", str, "os.PathLike[str]", Mapping[str, Any]]


def plain(value: Any) -> Any:
    """Converts numbers and arrays of numpy to plain Python values."""
    if hasattr(value, "tolist"):
        return value.tolist()
    raise TypeError(f"{type(value).__name__} has no form in JSON")


def as_json(value: Any, what: str = "value of a case", **how: Any) -> str:
    """Returns a value as JSON text.

    :raises UsageError: if the value has no JSON form.
    """
    try:
        return json.dumps(value, default=plain, **how)
    except (TypeError, ValueError, RecursionError) as error:
        raise UsageError(f"no {what}: {error}") from None


def numbers(values: Any) -> np.ndarray:
    """Returns an array of floats; ``None`` becomes nan.

    :raises UsageError: if a value is no real number, such as a text, a date or a complex number.
    """
    try:
        given = np.asarray(values)
        if given.dtype.kind == "O" and all(one is None or isinstance(one, (Real, Decimal)) for one in given.flat):
            given = given.astype(float)
    except (TypeError, ValueError, OverflowError) as error:
        raise UsageError(f"no numbers: {error}") from None
    if given.dtype.kind not in "biuf":
        kinds = {"c": "complex numbers", "M": "dates", "m": "durations without a unit", "U": "text", "S": "text"}
        raise UsageError(f"real numbers are wanted, not {kinds.get(given.dtype.kind, f'values of type {given.dtype}')}")
    return given.astype(float, copy=False)


class Case:
    """A checked, immutable case; :meth:`set` returns a changed copy.

    >>> import slcbeam
    >>> case = slcbeam.load("bend-wet")
    >>> case.name
    'bend-wet'
    >>> case["/beam/length_m"]
    0.1
    >>> shorter = case.set("/beam/length_m", 0.08)
    >>> shorter["/beam/length_m"], case["/beam/length_m"]
    (0.08, 0.1)
    """

    __slots__ = ("_text", "_path", "_base", "_sets", "_own", "_dict")

    def __init__(self, text: str, path: str, base: str, sets: tuple[str, ...] = ()) -> None:
        self._text, self._path, self._base, self._sets = text, path, base, tuple(sets)
        self._own = _slcbeam.Case.parse(text, path, base, list(self._sets))
        self._dict: dict[str, Any] | None = None
        if '"csv"' in text:
            # read tables now, so that later changes of their files have no effect
            self._text = json.dumps(_within(json.loads(text), self.to_dict()), indent=2)

    @property
    def name(self) -> str:
        """Name of the case."""
        return self._own.name

    def set(self, pointer: str | Mapping[str, Any], value: Any = ...) -> Case:
        """Returns a copy with another value at a JSON pointer, or with several: ``case.set({"/a": 1, "/b": 2})``.

        ``None`` removes an optional value. The copy is checked again.
        """
        if isinstance(pointer, Mapping) != (value is ...):
            raise UsageError("case.set takes a pointer and a value, or a dict of values by pointer")
        changes = dict(pointer) if isinstance(pointer, Mapping) else {pointer: value}
        return Case(self._text, self._path, self._base, self._sets + _sets(changes, self._base))

    def to_dict(self) -> dict[str, Any]:
        """Returns a copy of the whole case as a dict, with all defaults filled in."""
        whole: dict[str, Any] = json.loads(self._own.json())
        return whole

    def __getitem__(self, pointer: str) -> Any:
        """Returns the value at a JSON pointer, including defaults."""
        if not isinstance(pointer, str):
            raise UnknownError(f"{pointer!r} is no JSON pointer")
        if self._dict is None:
            self._dict = self.to_dict()
        value: Any = self._dict
        for key in pointer.split("/")[1:] if pointer else []:
            key = key.replace("~1", "/").replace("~0", "~")
            try:
                value = value[int(key)] if isinstance(value, list) else value[key]
            except (KeyError, IndexError, ValueError, TypeError):
                raise UnknownError(pointer) from None
        return value

    def __repr__(self) -> str:
        changed = f", {len(self._sets)} changed" if self._sets else ""
        return f"<slcbeam.Case {self.name!r}{changed}>"

    def __reduce__(self) -> tuple[Any, ...]:
        return (Case, (self._text, self._path, self._base, self._sets))


def _sets(changes: Mapping[str, Any], base: str) -> tuple[str, ...]:
    return tuple(f"{pointer}={as_json(_absolute(value, base), allow_nan=False)}" for pointer, value in changes.items())


def _absolute(value: Any, base: str) -> Any:
    """Makes the file names of tables absolute."""
    if isinstance(value, Mapping):
        return {key: os.path.join(base, of) if key == "csv" and isinstance(of, str) else _absolute(of, base) for key, of in value.items()}
    return [_absolute(one, base) for one in value] if isinstance(value, (list, tuple)) else value


def _within(value: Any, resolved: Any) -> Any:
    """Replaces the files of tables in a case by their points."""
    if isinstance(value, dict) and isinstance(resolved, dict):
        if "csv" in value and "csv" not in resolved:
            return resolved
        return {key: _within(of, resolved.get(key)) for key, of in value.items()}
    if isinstance(value, list) and isinstance(resolved, list):
        return [_within(*pair) for pair in zip(value, resolved)]
    return value


def shipped() -> list[str]:
    """Returns the names of the cases shipped with the package.

    >>> "wiring-2" in shipped()
    True
    """
    return sorted(str(path.relative_to(CASES).with_suffix("")) for path in _shipped())


def _shipped() -> Iterator[Path]:
    return (path for path in CASES.rglob("*.json") if path.name != "schema.json" and path.parent.name != "sections")


def load(case: CaseLike, set: Mapping[str, Any] | None = None) -> Case:
    """Reads and checks a case.

    :param case: a file; the name of a shipped case, see :func:`shipped`; a dict; JSON text. An existing file has priority over a name.
        Files of tables are relative to the file of the case, or to the working directory for a dict or text.
    :param set: values by JSON pointer that replace those of the case.
    :raises CaseError: if the case is invalid, with all its faults.
    :raises UsageError: if there is no such case.

    >>> load("wiring-2", set={"/time/end_s": 0.1})
    <slcbeam.Case 'wiring-2', 1 changed>
    """
    if set is not None and not isinstance(set, Mapping):
        raise UsageError(f"set is a dict of values by JSON pointer, not {type(set).__name__}")
    sets = _sets(set or {}, case._base if isinstance(case, Case) else os.getcwd())
    if isinstance(case, Case):
        return Case(case._text, case._path, case._base, case._sets + sets) if sets else case
    if isinstance(case, Mapping):
        return Case(as_json(dict(case), "case", indent=2), "<dict>", os.getcwd(), sets)
    if isinstance(case, str) and case.lstrip().startswith("{"):
        return Case(case, "<text>", os.getcwd(), sets)
    if not isinstance(case, (str, os.PathLike)):
        raise UsageError(f"a case is a file, a name, JSON text, a dict or a Case, not {type(case).__name__}")
    path = Path(os.fsdecode(case))
    try:
        if not path.exists():
            found = CASES / f"{str(case).removesuffix('.json')}.json"
            if found.is_file() and CASES.resolve() in found.resolve().parents:
                path = found
        text = path.read_text(encoding="utf-8")
    except (OSError, ValueError) as error:
        why = error.strerror if isinstance(error, OSError) else str(error)
        near = difflib.get_close_matches(path.stem, shipped(), 1)
        meant = f"; did you mean {near[0]!r}?" if near else ""
        raise UsageError(f"cannot read {path}: {why}; nor is there such a case in the package{meant}") from None
    return Case(text, str(path), str(path.parent.resolve()), sets)
