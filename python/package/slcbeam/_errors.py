"""What can go wrong, as exceptions."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any


class Error(Exception):
    """What every error of the package is."""

    #: Number of its messages, where it is raised before a command could give one.
    _number: str | None = None

    def __init__(self, words: str = "", told: str = "{}") -> None:
        super().__init__(words)
        self._told = told
        #: What scripts read: a dict, as the command line prints it with ``--json``.
        self.told: dict[str, Any] = json.loads(told)
        #: Number of the message; ``slcbeam explain E006`` tells more.
        self.code: str | None = self.told.get("code") or self._number

    def __reduce__(self) -> tuple[Any, ...]:
        return (type(self), (str(self), self._told))


class UsageError(Error, ValueError):
    """A call that makes no sense: no such case, no number at a pointer."""

    _number = "E030"


class UnknownError(Error, KeyError):
    """A name that a table, an answer or a case does not have."""

    _number = "E030"

    def __str__(self) -> str:
        return str(self.args[0]) if self.args else ""


class FileError(Error, OSError):
    """A file or a folder that cannot be read or written."""

    _number = "E050"
    #: The result of a run that had ended but could not be written into ``out``; ``None`` otherwise.
    result: Any = None

    def __str__(self) -> str:
        return str(self.args[0]) if self.args else ""


@dataclass(frozen=True)
class Fault:
    """One fault of a case."""

    #: Number of the message: ``E006``.
    code: str
    #: JSON pointer of the value, or of its parent where something is missing; ``""`` for the whole case.
    pointer: str
    #: What is wrong.
    message: str
    #: What is allowed there.
    allowed: str | None = None
    #: Nearest name that is known.
    nearest: str | None = None
    #: What to do.
    hint: str | None = None
    #: The change it came from, ``POINTER=JSON``.
    set: str | None = None
    #: Where it stands in the text, from 1.
    line: int | None = None
    #: Likewise, in characters.
    column: int | None = None


class CaseError(Error, ValueError):
    """A case that cannot be used, with all its faults."""

    def __init__(self, words: str = "", told: str = "{}") -> None:
        super().__init__(words, told)
        #: Every :class:`Fault`, in the order of the text.
        self.faults: list[Fault] = [
            Fault(**{("message" if key == "what" else key): value for key, value in fault.items()})
            for fault in self.told.get("faults", [])
        ]


class SolverError(Error, RuntimeError):
    """A computation that could not go on."""

    def __init__(self, words: str = "", told: str = "{}", result: Any = None) -> None:
        super().__init__(words, told)
        #: The result as far as it goes; ``None`` where there is none.
        self.result = result
        #: Simulated time up to which results stand [s].
        self.time_s: float | None = self.told.get("time_s")
        #: Unknown that is worst.
        self.unknown: str | None = self.told.get("unknown")
        #: Likely cause.
        self.cause: str | None = self.told.get("cause")
        #: What to try.
        self.hint: str | None = self.told.get("hint")

    def __reduce__(self) -> tuple[Any, ...]:
        return (type(self), (str(self), self._told, self.result))
