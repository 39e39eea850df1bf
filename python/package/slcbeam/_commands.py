"""Commands other than runs. Options are those of the command line, with underscores in their names: ``load_factor=0.5`` for
``--load-factor 0.5``. ``True`` stands for an option without a value, a list or a dict for a repeated option."""

from __future__ import annotations

import csv
import json
import os
import tempfile
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, Union

import numpy as np

from . import _slcbeam
from ._answer import Answer
from ._case import Case, CaseLike, as_json, load, numbers
from ._errors import SolverError, UsageError
from ._result import place

#: Folder of a result.
Place = Union[str, "os.PathLike[str]", None]
#: Measured data: a CSV file, a dict of columns, or a frame of pandas.
Data = Union[str, "os.PathLike[str]", Mapping[str, Any], Any]


def _text(value: Any) -> str:
    if isinstance(value, os.PathLike):
        return str(os.fspath(value))
    return value if isinstance(value, str) else as_json(value, "value of an option")


def _words(options: Mapping[str, Any]) -> list[str]:
    """Converts options to arguments of the command line."""
    words = []
    for name, value in options.items():
        option = "--" + name.rstrip("_").replace("_", "-")
        if value is None or value is False:
            continue
        if value is True:
            words.append(option)
        elif isinstance(value, Mapping):
            words += [f"{option}={key}={_text(of)}" for key, of in value.items()]
        elif isinstance(value, str) or not isinstance(value, Iterable):
            words.append(f"{option}={_text(value)}")
        else:
            words += [f"{option}={_text(one)}" for one in value]
    return words


def _file(case: Case, folder: Path) -> str:
    """Path of a file that contains the case without later changes."""
    path = Path(case._path)
    if path.is_file() and path.read_text(encoding="utf-8") == case._text:
        return str(path)
    folder.mkdir(exist_ok=True)
    path = folder / f"case-{len(list(folder.iterdir()))}.json"
    path.write_text(case._text, encoding="utf-8")
    return str(path)


def _table(data: Data, folder: Path, name: str = "data.csv") -> str:
    """Path of a file that contains a table of numbers."""
    if isinstance(data, (str, os.PathLike)):
        return str(place(data))
    columns: dict[str, list[float]] = {}
    try:
        # iterating a polars data frame yields its columns, not their names
        for heading in getattr(data, "columns", data):
            column = np.atleast_1d(numbers(data[heading]))
            if column.ndim > 1:
                raise UsageError("a list of numbers is wanted")
            if str(heading) in columns:
                raise UsageError("a second column of this name")
            columns[str(heading)] = column.tolist()
        rows = list(zip(*columns.values(), strict=True))
    except UsageError as error:
        raise UsageError(f"column {heading!r}: {error}") from None
    except (TypeError, ValueError, IndexError, KeyError) as error:
        raise UsageError(f"a table is a CSV file, or columns of numbers of equal length by heading: {error}") from None
    folder.mkdir(exist_ok=True)
    path = folder / name
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(columns)
        writer.writerows(["" if one != one else repr(one) for one in row] for row in rows)
    return str(path)


def _do(
    command: str,
    cases: Sequence[CaseLike],
    data: Data | None = None,
    *,
    out: Place = None,
    writes: bool = True,
    progress: bool = False,
    options: Mapping[str, Any],
) -> Answer:
    kept: tempfile.TemporaryDirectory[str] | None
    kept = temporary = tempfile.TemporaryDirectory(prefix="slcbeam-")
    given = Path(temporary.name) / "given"
    loaded = [load(case) for case in cases]
    words = [command, *(_file(case, given) for case in loaded)]
    if data is not None:
        words.append(_table(data, given))
    sets = loaded[0]._sets
    if any(case._sets != sets for case in loaded):
        raise UsageError("what is set must be the same in all cases of a sweep; give these as dicts or files")
    words += [f"--set={change}" for change in sets]
    words += _words(options)
    folder = None
    if writes:
        folder = place(out) if out is not None else Path(temporary.name) / "result"
        words.append(f"--out={folder}")
        if not progress:
            words.append("--quiet")
    printed, fault, interrupted = _slcbeam.command([*words, "--json"])
    if out is not None or not writes:
        kept = None
    answer = Answer(json.loads(printed) if printed.strip() else {}, folder, interrupted=interrupted, kept=kept)
    if fault is not None:
        raise SolverError(*fault, result=answer)
    return answer


def check(case: CaseLike, **options: Any) -> Answer:
    """Returns characteristic numbers, an audit of the coupling, and the chosen effects with reasons (``slcbeam check``).

    >>> import slcbeam
    >>> slcbeam.check("bend-wet")["effects"]["shear"]
    {'value': 'off', 'reason': 'the published form has no shear'}
    """
    return _do("check", [case], writes=False, options=options)


def equilibrium(case: CaseLike, *, out: Place = None, progress: bool = False, **options: Any) -> Answer:
    """Computes the path of static equilibria from rest to the full load (``slcbeam equilibrium``).

    :param case: a :class:`Case`, or an argument of :func:`load`.
    :param out: a folder for the result.
    :param options: ``at=SECONDS``, ``via``, ``load_factor``, ``points``, ``keep_branch=True``, ``sensitivity=[POINTER, ...]``,
        ``accuracy``, ``uncertain={POINTER: "normal:MEAN:SD"}``, ..
    :returns: ``equilibrium.json``; ``tables["path"]``, ``tables["shapes"]``.

    >>> import slcbeam
    >>> found = slcbeam.equilibrium("bend-wet", load_factor=0.5)
    >>> found["status"], found.tables["path"].units["tip_u1"]
    ('finished', 'm')
    """
    return _do("equilibrium", [case], out=out, progress=progress, options=options)


def modes(case: CaseLike, *, out: Place = None, progress: bool = False, **options: Any) -> Answer:
    """Computes frequencies, damping, shapes and stability of small motions (``slcbeam modes``).

    :param options: ``count``, ``near=HZ``, ``at=SECONDS``, ``sensitivity=[POINTER, ...]``, ``accuracy``, ``uncertain={..}``, ..
    :returns: ``modes.json``; ``tables["modes"]``; shapes in ``arrays``.

    >>> import slcbeam
    >>> found = slcbeam.modes("bend-dry", count=1)
    >>> round(found["modes"][0]["frequency_hz"], 1)
    17.7
    """
    return _do("modes", [case], out=out, progress=progress, options=options)


def response(
    case: CaseLike, input: str, output: str | Iterable[str], *, out: Place = None, progress: bool = False, **options: Any
) -> Answer:
    """Computes the frequency response of small motions (``slcbeam response``).

    :param input: JSON pointer of a signal of the case.
    :param output: one or several quantities or probes.
    :param options: ``from_=HZ``, ``to=HZ``, ``points``, ``at=SECONDS``, ``about_cycle=True``, ``harmonics=K``, ``power=True``,
        ``frequency=[HZ, ...]``, ``sensitivity=[POINTER, ...]``, ..
    :returns: ``response.json``; ``tables["response"]``.

    >>> import slcbeam
    >>> found = slcbeam.response("wiring-3", "/ends/root/clamped/u3_m", "tip_u3", to=110)
    >>> round(found["poles"][0]["frequency_hz"], 3)
    12.165
    """
    outputs = [output] if isinstance(output, str) else list(output)
    options = {"input": input, "output": outputs, **options}
    return _do("response", [case], out=out, progress=progress, options=options)


def bands(case: CaseLike, *, out: Place = None, progress: bool = False, **options: Any) -> Answer:
    """Computes waves of a beam whose cells repeat: wave numbers, attenuation and gaps (``slcbeam bands``).

    :param options: ``from_=HZ``, ``to=HZ``, ``points``, ..
    :returns: ``bands.json``; ``tables["bands"]``.

    >>> import slcbeam
    >>> found = slcbeam.bands("metamaterial", from_=20, to=50)
    >>> round(found["gaps"][0]["from_hz"], 1)
    29.3
    """
    return _do("bands", [case], out=out, progress=progress, options=options)


def periodic(case: CaseLike, *, out: Place = None, progress: bool = False, **options: Any) -> Answer:
    """Computes the steady cycle of a periodically driven case without the transient (``slcbeam periodic``).

    :param options: ``periods``, ``sweep="POINTER=FROM:TO:COUNT[:log]"``, ``accuracy``, ``uncertain={..}``, ..
    :returns: ``cycle.json``, or ``sweep.json``; ``tables["history"]`` over a cycle, fields in ``arrays``.
    """
    return _do("periodic", [case], out=out, progress=progress, options=options)


def floquet(case: CaseLike, *, out: Place = None, progress: bool = False, **options: Any) -> Answer:
    """Computes the steady cycle and its stability, or a stability map of axial shaking (``slcbeam floquet``).

    :param options: ``count``, ``period``, ``map="frequency,amplitude"``, ``range``, ``points``, ``permeability``, ``accuracy``,
        ``uncertain={..}``, ..
    :returns: ``floquet.json`` or ``map.json``; ``tables``.
    """
    return _do("floquet", [case], out=out, progress=progress, options=options)


def study(case: CaseLike, *, out: Place = None, progress: bool = False, **options: Any) -> Answer:
    """Measures the cost of accuracy: time against error over tolerances, meshes and orders (``slcbeam study``).

    :param options: ``budget="60s"``, ``rtol=[1e-3, 1e-5]``, ``cells=[1, 2, 4]``, ``methods=[..]``, ``measure``, ..
    """
    return _do("study", [case], out=out, progress=progress, options=options)


def effects(case: CaseLike, *, out: Place = None, progress: bool = False, **options: Any) -> Answer:
    """Measures the influence of each effect of the model, and the time saved without it (``slcbeam effects``).

    :param options: ``budget="60s"``, ``repeats``, ``measure``.
    """
    return _do("effects", [case], out=out, progress=progress, options=options)


def sweep(
    case: CaseLike | Sequence[CaseLike],
    vary: Mapping[str, Any] | None = None,
    *,
    designs: Data | None = None,
    out: Place = None,
    progress: bool = False,
    **options: Any,
) -> Answer:
    """Computes many designs in parallel into one table (``slcbeam sweep``). The same call and ``out`` resume an interrupted sweep.

    :param case: one case, or several to compare in every design.
    :param vary: by JSON pointer a list of values, or a text such as ``"log:0.01:1:25"``, ``"uniform:LOW:HIGH"``.
    :param designs: instead of ``vary``, a table with a row per design and JSON pointers as headings: a dict of columns, a data frame or a
        CSV file.
    :param options: ``command="run"|"periodic"|"equilibrium"|"modes"|"bands"|"response"``, ``design="sobol:64"``, ``jobs``, ``lean=True``,
        ``accuracy``, ..
    :returns: ``sweep.json``; ``tables["sweep"]`` with a row per design.

    >>> import slcbeam
    >>> table = slcbeam.sweep("bend-wet", {"/beam/length_m": [0.1, 0.11]}, command="equilibrium", lean=True).tables["sweep"]
    >>> table["status"].tolist(), bool(table["tip_u1_m"][1] > table["tip_u1_m"][0] > 0)
    (['finished', 'finished'], True)
    """
    cases = [case] if isinstance(case, (str, os.PathLike, Mapping, Case)) else list(case)
    specs = {pointer: values if isinstance(values, str) else ",".join(_listed(values)) for pointer, values in (vary or {}).items()}
    with tempfile.TemporaryDirectory(prefix="slcbeam-") as folder:
        listed = None if designs is None else _table(designs, Path(folder), "designs.csv")
        return _do("sweep", cases, out=out, progress=progress, options={"vary": specs, "designs": listed, **options})


def merge(parts: Iterable[str | os.PathLike[str]], *, out: str | os.PathLike[str]) -> Answer:
    """Joins separately computed parts of a sweep, ``shard="1/8"``, into one folder (``slcbeam merge``).

    :param parts: folders of the parts.
    :returns: the result of :func:`sweep`. If parts are missing, ``complete`` is false, ``missing`` lists them, and standard error shows the
        commands that compute them.
    :raises UsageError: if the parts belong to different sweeps.
    """
    if isinstance(parts, (str, os.PathLike)):
        parts = [parts]
    printed, _, interrupted = _slcbeam.command(["merge", *(str(place(part)) for part in parts), f"--out={place(out)}", "--json"])
    return Answer(json.loads(printed), Path(out), interrupted=interrupted)


def _listed(values: Any) -> list[str]:
    each = values if isinstance(values, Iterable) else [values]
    return [as_json(one) for one in each]


def _spans(vary: Mapping[str, tuple[float, float]]) -> dict[str, str]:
    try:
        return {pointer: f"{_text(low)}:{_text(high)}" for pointer, (low, high) in vary.items()}
    except (AttributeError, TypeError, ValueError):
        raise UsageError("vary is a dict of (low, high) by JSON pointer") from None


def fit(
    case: CaseLike,
    data: Data,
    vary: Mapping[str, tuple[float, float]],
    match: Mapping[str, str],
    *,
    out: Place = None,
    progress: bool = False,
    **options: Any,
) -> Answer:
    """Fits parameters of a case to measured data (``slcbeam fit``).

    :param data: a CSV file, a dict of columns, or a data frame; headings with units: ``angle_deg``.
    :param vary: bounds by JSON pointer.
    :param match: measured quantity of each column: ``{"angle_deg": "tip_angle"}``.
    :param options: ``drive={"p_kpa": POINTER}``, ``input=POINTER`` of a response, ``noise={COLUMN: SIGMA}``,
        ``robust="huber"``, ``starts``, ``time``, ``jobs``.
    :returns: ``fit.json``.
    """
    return _do("fit", [case], data, out=out, progress=progress, options={"vary": _spans(vary), "match": match, **options})


def optimize(
    case: CaseLike,
    vary: Mapping[str, tuple[float, float]] | None = None,
    *,
    maximize: str | None = None,
    minimize: str | None = None,
    subject_to: Sequence[str] = (),
    out: Place = None,
    progress: bool = False,
    **options: Any,
) -> Answer:
    """Finds the parameters of a case that maximize or minimize a figure (``slcbeam optimize``).

    :param vary: bounds by JSON pointer.
    :param maximize: the objective, a figure with its name in the table of a sweep: ``harvested_power_w``, ``tip_u1_m.max_abs``.
    :param minimize: the objective to minimize; give either this or ``maximize``.
    :param subject_to: limits of figures: ``["max_pressure_pa<=5e4"]``.
    :param options: ``command="run"|"periodic"|"equilibrium"|"modes"|"bands"|"response"``, ``starts``, ``crossovers``,
        ``choose=[..]``, ``jobs``.
    :returns: ``optimum.json``; ``tables["designs"]``; the best case is ``optimum-case.json`` in ``folder``.
    """
    asked = {"maximize": maximize, "minimize": minimize, "subject_to": [subject_to] if isinstance(subject_to, str) else list(subject_to)}
    return _do("optimize", [case], out=out, progress=progress, options={"vary": _spans(vary or {}), **asked, **options})


def sense(
    case: CaseLike,
    pressures: Data | None = None,
    load: Sequence[str] = (),
    *,
    out: Place = None,
    progress: bool = False,
    **options: Any,
) -> Answer:
    """Estimates loads from measured bladder pressures, at rest or over time, with 95 % bands (``slcbeam sense``).

    :param pressures: a CSV file, a dict of columns, or a data frame: ``pressure_3_pa``. A row is a measurement at rest or, with
        ``dynamic=True``, an instant ``t_s``. Without it, only the observability of the loads.
    :param load: loads to estimate: ``tip-force``, ``tip-moment``, ``uniform``, ``point:0.5``, ``profile:8``, ..
    :param options: ``noise=PA``, ``smoothing``, ``dynamic=True``, ``knots``, ``at=SECONDS``, ``choose="variances"``.
    :returns: ``sense.json``; ``tables``.
    """
    return _do("sense", [case], pressures, out=out, progress=progress, options={"load": [load] if isinstance(load, str) else list(load), **options})


def coefficients(case: CaseLike, **options: Any) -> Answer:
    """Computes the coefficients of a section from its geometry, with errors (``slcbeam coefficients``).

    :param case: a case with ``/section``.
    :param options: ``three_d=True``.
    """
    return _do("coefficients", [case], writes=False, options=options)


def measure(data: Data, of: CaseLike, as_: str, **options: Any) -> Answer:
    """Computes coefficients from measurements of a specimen, with errors (``slcbeam measure``).

    :param data: a CSV file, a dict of columns, or a data frame; headings with units: ``pressure_kpa``, ``volume_ml``.
    :param of: a case with the dimensions, modulus and fluid of the specimen.
    :param as_: kind of measurement: ``"pressure-volume"``, ``"moment-curvature"``, ``"flow-pressure"``, ..
    :param options: ``bladders``, ``through_zero=True``, ``cubic=True``, ``plot=FILE``, ..
    """
    case = load(of)
    with tempfile.TemporaryDirectory(prefix="slcbeam-") as folder:
        given = Path(folder)
        words = ["measure", _table(data, given), f"--of={_file(case, given / 'given')}", f"--as={as_}"]
        words += [f"--set={change}" for change in case._sets] + _words(options)
        printed, _, interrupted = _slcbeam.command([*words, "--json"])
    return Answer(json.loads(printed), None, interrupted=interrupted)


def compare(*results: str | os.PathLike[str], **options: Any) -> Answer:
    """Compares result folders, or one folder and measured data (``slcbeam compare``).

    :param results: two or more folders; or a folder and a CSV file, with ``match``.
    :param options: ``match={COLUMN: QUANTITY}``, ``time=COLUMN``, ``out=FOLDER`` for a page.
    """
    words = ["compare", *(str(place(one)) for one in results), *_words(options)]
    printed, _, interrupted = _slcbeam.command([*words, "--json"])
    return Answer(json.loads(printed), None, interrupted=interrupted)


def export(folder: str | os.PathLike[str], **options: Any) -> None:
    """Writes the folder of a run in other formats: tables (CSV), surfaces for ParaView (VTK). Writes the file of a case as a state-space
    model or as an FMU (``slcbeam export``).

    :param options: ``format="csv"``, ``times="0.1,0.45:0.5"``, ``every=10``, ``out=FOLDER``; for a case ``fmu=FILE``,
        ``input=[POINTER, ..]``, ``output="tip_u1"``.
    """
    _slcbeam.command(["export", str(place(folder)), *_words(options)])


def plot(*results: str | os.PathLike[str], **options: Any) -> dict[str, Any]:
    """Draws quantities of results as SVG or PDF for papers (``slcbeam plot``).

    :param results: folders of one kind.
    :param options: ``quantity="tip_u1,max_pressure"``, ``at="0.1,0.2"``, ``columns=2``, ``out="tip.pdf"``, ``force=True``.
    :return: path, size and panels of the picture.
    """
    words = ["plot", *(str(place(one)) for one in results), *_words(options)]
    printed, _, _ = _slcbeam.command([*words, "--json"])
    drawn: dict[str, Any] = json.loads(printed)
    return drawn


def explain(what: str) -> list[dict[str, Any]]:
    """Explains a message, a key, a column, a figure, a word or a symbol (``slcbeam explain``).

    >>> import slcbeam
    >>> slcbeam.explain("tip_u1")[0]["meaning"]
    'transverse displacement of the tip [m], a column of history.csv'
    """
    if not isinstance(what, str):
        raise UsageError(f"explain takes a text, not {type(what).__name__}")
    printed, _, _ = _slcbeam.command(["explain", what, "--json"])
    told = json.loads(printed)
    return told if isinstance(told, list) else [told]
