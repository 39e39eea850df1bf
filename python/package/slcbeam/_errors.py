"""Exceptions of the package."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any


class Error(Exception):
    """Base class of all errors of the package."""

    #: Default message number, for errors that no command raised.
    _number: str | None = None

    def __init__(self, words: str = "", told: str = "{}") -> None:
        super().__init__(words)
        self._told = told
        #: The error as a dict, as the command line prints it with ``--json``.
        self.told: dict[str, Any] = json.loads(told)
        #: Number of the message; ``slcbeam explain E006`` explains it.
        self.code: str | None = self.told.get("code") or self._number

    def __reduce__(self) -> tuple[Any, ...]:
        return (type(self), (str(self), self._told))


class UsageError(Error, ValueError):
    """An invalid call, such as an unknown case or a pointer without a number."""

    _number = "E030"


class UnknownError(Error, KeyError):
    """A name that does not exist in a table, an answer or a case."""

    _number = "E030"

    def __str__(self) -> str:
        return str(self.args[0]) if self.args else ""


class FileError(Error, OSError):
    """A file or a folder that cannot be read or written."""

    _number = "E050"
    #: Result of a completed run that could not be written into ``out``; ``None`` otherwise.
    result: Any = None

    def __str__(self) -> str:
        return str(self.args[0]) if self.args else ""


@dataclass(frozen=True)
class Fault:
    """One fault of a case."""

    #: Number of the message: ``E006``.
    code: str
    #: JSON pointer of the value, or of the parent of a missing value; ``""`` for the whole case.
    pointer: str
    #: Description of the fault.
    message: str
    #: Allowed values.
    allowed: str | None = None
    #: Nearest known name.
    nearest: str | None = None
    #: Suggested remedy.
    hint: str | None = None
    #: The change that caused it, ``POINTER=JSON``.
    set: str | None = None
    #: Line in the text, from 1.
    line: int | None = None
    #: Column in the line, in characters from 1.
    column: int | None = None


class CaseError(Error, ValueError):
    """An invalid case, with all its faults."""

    def __init__(self, words: str = "", told: str = "{}") -> None:
        super().__init__(words, told)
        #: Every :class:`Fault`, in the order of the text.
        self.faults: list[Fault] = [
            Fault(**{("message" if key == "what" else key): value for key, value in fault.items()})
            for fault in self.told.get("faults", [])
        ]


class SolverError(Error, RuntimeError):
    """A computation that failed."""

    def __init__(self, words: str = "", told: str = "{}", result: Any = None) -> None:
        super().__init__(words, told)
        #: The partial result, or ``None``.
        self.result = result
        #: Simulated time reached by the result [s].
        self.time_s: float | None = self.told.get("time_s")
        #: Unknown with the largest residual or error.
        self.unknown: str | None = self.told.get("unknown")
        #: Likely cause.
        self.cause: str | None = self.told.get("cause")
        #: Suggested remedy.
        self.hint: str | None = self.told.get("hint")

    def __reduce__(self) -> tuple[Any, ...]:
        return (type(self), (str(self), self._told, self.result))
