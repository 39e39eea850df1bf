"""HTML output in notebooks."""

from __future__ import annotations

import html
import os
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

#: Largest numbers of rows and columns shown of a table; half of the rows are its first, half its last.
ROWS, COLUMNS = 10, 9


class Report:
    """A page of HTML. Notebooks display it; :meth:`save` writes it."""

    def __init__(self, text: str) -> None:
        #: The page as self-contained HTML.
        self.html = text

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the page."""
        Path(path).write_text(self.html, encoding="utf-8")

    def _repr_html_(self) -> str:
        return f'<iframe srcdoc="{html.escape(self.html)}" style="width:100%;height:80vh;border:0"></iframe>'

    def __repr__(self) -> str:
        return f"<slcbeam.Report of {len(self.html) // 1000} kB>"


def _cell(value: Any) -> str:
    if value is None or value != value:
        return ""
    return f"{value:.5g}" if isinstance(value, float) else str(value)


def table(heads: Sequence[str], rows: Iterable[Sequence[Any]]) -> str:
    """HTML table with headings and rows of texts and numbers."""
    lines = ["".join(f"<th>{html.escape(head)}</th>" for head in heads)]
    lines += ["".join(f"<td>{html.escape(_cell(value))}</td>" for value in row) for row in rows]
    return "<table>" + "".join(f"<tr>{line}</tr>" for line in lines) + "</table>"


def _cut(row: Sequence[Any]) -> list[Any]:
    return [*row] if len(row) <= COLUMNS else [*row[:COLUMNS], "…"]


def columns(told: str, names: Sequence[str], units: Sequence[str], rows: Sequence[Sequence[Any]]) -> str:
    """HTML of the first and last rows of a table with units, below its description."""
    heads = _cut([f"{name} [{unit}]" if unit else name for name, unit in zip(names, units)])
    half = ROWS // 2
    shown = [_cut(row) for row in (rows if len(rows) <= ROWS else [*rows[:half], *rows[-half:]])]
    if len(rows) > ROWS:
        shown.insert(half, ["…"] * len(heads))
    return f"<p>{html.escape(told)}</p>" + table(heads, shown)


def summary(told: str, warnings: Sequence[str], figures: str = "") -> str:
    """HTML of description, warnings and figures."""
    listed = "".join(f"<li>{html.escape(one)}</li>" for one in warnings)
    return f"<p>{html.escape(told)}</p>" + (f"<ul>{listed}</ul>" if listed else "") + figures
