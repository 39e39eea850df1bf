"""Runs: the same as those of the command line, arrays in memory, others beside them."""

import html
import json
import multiprocessing
import os
import pickle
import signal
import threading
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor

import numpy as np
import pandas
import pytest

import slcbeam

SETS = {"/time/end_s": 0.1, "/time/output_interval_s": 0.001}


def told(folder):
    """The summary without wall times and what tells of the program."""
    summary = json.loads((folder / "summary.json").read_text())
    for key in ("wall_s", "provenance", "program", "written"):
        summary.pop(key, None)
    summary.get("companion", {}).pop("wall_s", None)
    return summary


def commanded(program, folder, *more, sets=SETS):
    changes = [word for pointer, value in sets.items() for word in ("--set", f"{pointer}={json.dumps(value)}")]
    program("run", slcbeam._case.CASES / "bend-wet.json", "--out", folder, "--quiet", *changes, *more)
    return folder


@pytest.mark.parametrize("more", [{}, {"/time/history": {"every": 5}}])
def test_arrays_and_folders_are_those_of_the_command_line(program, quick, tmp_path, more):
    theirs = commanded(program, tmp_path / "theirs", sets=SETS | more)
    result = slcbeam.run(quick.set(more), out=tmp_path / "ours")
    ours = tmp_path / "ours"
    # the program alone says of which file of a case a result is
    assert sorted(p.name for p in ours.iterdir()) == sorted(p.name for p in theirs.iterdir() if p.name != ".slcbeam.case")
    for name in ("history.csv", "case.json", "history.svg", "deflection.svg"):
        assert (ours / name).read_bytes() == (theirs / name).read_bytes(), name
    assert told(ours) == told(theirs)
    table = np.loadtxt(theirs / "history.csv", delimiter=",", skiprows=1)
    np.testing.assert_array_equal(table, result.history.values_2d)
    heads = (theirs / "history.csv").read_text().splitlines()[0].split(",")
    assert [head.strip('"') for head in heads] == [f"{n} [{result.history.units[n]}]" for n in result.history]
    with np.load(theirs / "fields.npz") as fields:
        for name in fields:
            own = result.fields.t if name == "t_fields_s" else result.fields[name]
            np.testing.assert_array_equal(fields[name], own)
        assert set(result.fields) | set(result.fields.coordinates) <= set(fields)


def test_what_an_accuracy_leads_to_is_that_of_the_command_line(program, quick, tmp_path):
    theirs = commanded(program, tmp_path / "theirs", "--accuracy", 0.05)
    result = slcbeam.run(quick, accuracy=0.05)
    ours = result.save(tmp_path / "ours")
    summaries = [told(folder) for folder in (ours, theirs)]
    for summary in summaries:
        for pilot in summary["accuracy"]["pilots"]:
            pilot.pop("wall_s")
    assert summaries[0] == summaries[1]
    for name in ("history.csv", "case.json"):
        assert (ours / name).read_bytes() == (theirs / name).read_bytes(), name
    assert result.quantities["tip_u1_m"]["error"] <= 0.05


def test_every_figure_has_an_error_unless_the_companion_is_off(quick):
    result = slcbeam.run(quick)
    tip = result.quantities["tip_u1_m"]
    errors = result.errors["tip_u1_m"]
    assert set(errors) >= {"final", "max_abs", "window_rms"} and all(error > 0 for error in errors.values())
    assert tip["error"] == max(errors.values()) / max(abs(tip[kind]) for kind in ("final", "max_abs", "window_max_abs", "window_rms"))
    alone = slcbeam.run(quick.set({"/companion": "off"}))
    assert alone.errors == {} and alone.quantities["tip_u1_m"]["error"] is None
    assert alone.quantities["tip_u1_m"]["final"] == tip["final"]


def test_derivatives_are_those_of_the_command_line(program, quick, tmp_path):
    pointer = "/beam/young_modulus_pa"
    theirs = commanded(program, tmp_path / "theirs", "--sensitivity", pointer)
    result = slcbeam.run(quick, sensitivity=[pointer])
    table = np.loadtxt(theirs / "sensitivities.csv", delimiter=",", skiprows=1)
    np.testing.assert_array_equal(table, result.derivatives.values_2d)
    slope = result.derivatives[f"d tip_u1/d {pointer}"]
    assert slope[-1] == result.sensitivities[pointer]["quantities"]["tip_u1_m"]["final"]
    with pytest.raises(slcbeam.UsageError, match="young_modulus_pa"):
        slcbeam.run(quick, sensitivity=["/beam/young_modulus"])
    with pytest.raises(slcbeam.UsageError):
        slcbeam.run(quick, sensitivity=[pointer], accuracy=0.1)


def test_arrays_are_views_and_read_only(quick):
    result = slcbeam.run(quick)
    tip = result.history["tip_u1"]
    assert np.shares_memory(tip, result.history.values_2d) and tip.shape == (101,)
    for array in (tip, result.fields["u1_m"], result.fields.t, result.fields["theta_node_m"]):
        with pytest.raises(ValueError):
            array[0] = 1.0
    assert result.fields["u1_m"].shape == (len(result.fields.t), len(result.fields["theta_node_m"]))
    with pytest.raises(KeyError, match="did you mean 'tip_u1'"):
        result.history["tip_u_1"]
    assert tip[-1] == result.quantities["tip_u1_m"]["final"]


def test_frames_have_the_columns(quick):
    result = slcbeam.run(quick)
    frame, other = result.history.to_pandas(), result.history.to_polars()
    assert isinstance(frame, pandas.DataFrame) and frame.index.name == "t"
    assert list(frame) == other.columns[1:] == result.history.names[1:] and other.columns[0] == "t"
    for name in ("tip_u1", "max_pressure"):
        np.testing.assert_array_equal(frame[name], result.history[name])
        np.testing.assert_array_equal(other[name].to_numpy(), result.history[name])


def test_datasets_have_coordinates_and_units(quick):
    result = slcbeam.run(quick)
    data = result.fields.to_xarray()
    assert data["u1_m"].dims == ("t", "theta_node_m") and data["u1_m"].attrs["units"] == "m"
    tip = data["u1_m"].sel(t=0.1, theta_node_m=0.1, method="nearest")
    assert float(tip) == result.fields["u1_m"][-1, -1]


def test_the_report_is_a_page_for_notebooks(quick, tmp_path):
    report = slcbeam.run(quick).report()
    assert report.html.lstrip().lower().startswith("<!doctype html")
    assert report._repr_html_().startswith("<iframe srcdoc=") and "bend-wet" in report._repr_html_()
    report.save(tmp_path / "page.html")
    assert (tmp_path / "page.html").read_text(encoding="utf-8") == report.html


def test_notebooks_show_figures_warnings_and_tables(quick):
    result = slcbeam.run(quick)
    page = result._repr_html_()
    assert "tip_u1_m" in page and "relative error" in page and all(html.escape(one) in page for one in result.warnings)
    table = result.history._repr_html_()
    assert "<th>tip_u1 [m]</th>" in table and table.count("<tr>") == 12 and "…" in table


def test_folders_of_others_are_left_alone(quick, tmp_path):
    (tmp_path / "mine.txt").write_text("mine")
    result = slcbeam.run(quick)
    with pytest.raises(slcbeam.FileError, match="no slcbeam result"):
        result.save(tmp_path)
    assert [p.name for p in tmp_path.iterdir()] == ["mine.txt"]
    result.save(tmp_path, force=True)
    assert (tmp_path / "mine.txt").read_text() == "mine" and (tmp_path / "summary.json").exists()


def test_ctrl_c_stops_with_what_there_is(endless, tmp_path):
    result = slcbeam.run(endless, progress=lambda *_: os.kill(os.getpid(), signal.SIGINT))
    assert result.status == "stopped" and "interrupted" in result.summary["reason"] and result.interrupted
    assert pickle.loads(pickle.dumps(result)).interrupted
    assert 0.0 < result.summary["time_s"] < 1e4 and len(result.history["t"]) >= 1
    # an accuracy is stopped, too
    stopped = slcbeam.run(endless, accuracy=0.05, progress=lambda *_: os.kill(os.getpid(), signal.SIGINT))
    assert stopped.status == "stopped" and stopped.interrupted
    result.save(tmp_path / "part")
    assert told(tmp_path / "part")["status"] == "stopped"


def test_what_a_progress_function_raises_ends_the_run(endless):
    seen = []

    def progress(t, end, steps):
        seen.append((t, end, steps))
        if len(seen) == 2:
            raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        slcbeam.run(endless, progress=progress)
    assert len(seen) == 2 and seen[1][0] >= seen[0][0] and seen[1][1] == 1e4 and seen[1][2] > seen[0][2]


def test_a_run_that_cannot_go_on_raises_with_what_there_is(quick):
    with pytest.raises(slcbeam.SolverError) as caught:
        slcbeam.run(quick.set("/solver/max_steps", 20))
    error = caught.value
    assert error.code == "E043" and "max_steps" in error.hint and "E043" in str(error)
    assert error.result.status == "failed" and error.result.history["t"][-1] <= error.time_s
    again = pickle.loads(pickle.dumps(error))
    assert str(again) == str(error) and again.result.summary == error.result.summary


def final(viscosity):
    """A figure of a run, for threads and processes."""
    case = slcbeam.load("bend-wet", set=SETS | {"/fluid/viscosity_pa_s": viscosity})
    return slcbeam.run(case)


def test_threads_and_processes_give_the_same(quick):
    values = [0.05, 0.1, 0.2, 0.4]
    alone = [final(value).history.values_2d for value in values]
    with ThreadPoolExecutor(4) as pool:
        threads = list(pool.map(final, values))
    with ProcessPoolExecutor(2, mp_context=multiprocessing.get_context("spawn")) as pool:
        processes = list(pool.map(final, values))
    for one, thread, process in zip(alone, threads, processes):
        np.testing.assert_array_equal(one, thread.history.values_2d)
        np.testing.assert_array_equal(one, process.history.values_2d)
        assert process.fields["u1_m"].flags.writeable is False


def test_other_threads_go_on_during_a_run(endless):
    ticks = []

    def stop(*_):
        # another thread has had the lock since the run began, or the run goes on until it has
        if ticks:
            raise RuntimeError("seen")

    thread = threading.Thread(target=lambda: ticks.append(1))
    threading.Timer(0.1, thread.start).start()
    with pytest.raises(RuntimeError, match="seen"):
        slcbeam.run(endless, progress=stop)


def test_a_result_goes_to_another_process_and_back(quick, tmp_path):
    result = slcbeam.run(quick)
    again = pickle.loads(pickle.dumps(result))
    assert again.summary == result.summary and again.case.to_dict() == quick.to_dict()
    ours, theirs = result.save(tmp_path / "a"), again.save(tmp_path / "b")
    for name in ("history.csv", "case.json"):
        assert (ours / name).read_bytes() == (theirs / name).read_bytes()


def test_a_name_that_is_none_is_told_with_the_nearest(quick):
    result = slcbeam.run(quick)
    for look, nearest in [
        (lambda: result.quantities["tip_u1"], "tip_u1_m"),
        (lambda: result.quantities["tip_u1_m"]["maxabs"], "max_abs"),
        (lambda: result.history["tip_u1_m"], "tip_u1"),
        (lambda: result.fields["u1"], "u1_m"),
    ]:
        with pytest.raises(KeyError, match=f"did you mean '{nearest}'"):
            look()
    assert result.quantities.get("tip_u1") is None
    tip = result.quantities["tip_u1_m"]
    assert abs(tip["extreme"]) == tip["max_abs"]


def test_a_folder_that_is_taken_is_told_before_the_run(tmp_path):
    (tmp_path / "notes.txt").write_text("kept")
    called = []
    with pytest.raises(slcbeam.Error, match="holds files but no slcbeam result"):
        slcbeam.run("bend-wet", out=tmp_path, progress=lambda *where: called.append(where))
    assert not called and (tmp_path / "notes.txt").read_text() == "kept"


def test_a_result_that_cannot_be_written_is_not_lost(tmp_path, monkeypatch):
    (tmp_path / "notes.txt").write_text("kept")
    # as if the file had come while it ran
    monkeypatch.setattr(slcbeam._slcbeam, "claimable", lambda dir: None)
    with pytest.raises(slcbeam.FileError) as told:
        slcbeam.run("bend-wet", out=tmp_path)
    assert told.value.result.status == "finished" and told.value.result.history["t"].size > 10
