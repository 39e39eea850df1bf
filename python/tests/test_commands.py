"""Commands beside runs: the same as on the command line."""

import json
import os
import pickle
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pandas
import pytest

import slcbeam

COARSE = {"/mesh/cells_per_segment": 1, "/mesh/cells_per_bladder": 1}


def without(told):
    """Without wall times and what tells of the program."""
    return {key: value for key, value in told.items() if key not in ("wall_s", "provenance", "solver")}


def test_equilibria_are_those_of_the_command_line(program, tmp_path):
    theirs = tmp_path / "theirs"
    told = json.loads(
        program("equilibrium", slcbeam._case.CASES / "bend-wet.json", "--load-factor", 0.5, "--out", theirs, "--json", "--quiet")
    )
    found = slcbeam.equilibrium("bend-wet", load_factor=0.5)
    assert without(dict(found)) == without(told)
    rows = np.genfromtxt(theirs / "path.csv", delimiter=",", names=True, deletechars="")
    path = found.tables["path"]
    assert len(path) == len(rows.dtype.names)
    np.testing.assert_array_equal(path["tip_u1"], rows[next(n for n in rows.dtype.names if n.startswith("tip_u1"))])
    assert path.units["tip_u1"] == "m" and not path["tip_u1"].flags.writeable
    assert found.report().html.startswith("<!")


def test_cases_in_memory_reach_commands(tmp_path):
    case = slcbeam.load("wiring-2").to_dict()
    found = slcbeam.modes(slcbeam.load(case, set=COARSE), count=3)
    assert found["case"] == "wiring-2" and len(found["modes"]) >= 3
    assert len(found.tables["modes"]) > 3 and len(found.arrays) > 3
    again = pickle.loads(pickle.dumps(found))
    assert dict(again) == dict(found) and again.tables["modes"].names == found.tables["modes"].names
    kept = found.save(tmp_path / "kept")
    assert (kept / "modes.json").is_file()
    folder = found.folder
    del found
    assert not folder.exists()


def test_tables_are_found_from_anywhere(tmp_path, monkeypatch):
    where = tmp_path / "there"
    where.mkdir()
    (where / "force.csv").write_text("t,force\n0,0\n0.1,1e-3\n")
    monkeypatch.chdir(where)
    case = json.loads((slcbeam._case.CASES / "bend-dry.json").read_text())
    case["loads"] = [{"force_x_n_m": {"signal": {"table": {"csv": "force.csv", "time_column": "t", "value_column": "force"}}}}]
    loaded = slcbeam.load(case)
    monkeypatch.chdir(tmp_path)
    # a dict's tables are looked for where Python stands when it is loaded, and stay as they were then
    with pytest.raises(slcbeam.CaseError):
        slcbeam.load(case)
    (where / "force.csv").write_text("t,force\n0,0\n0.1,7\n")
    at_first = slcbeam.equilibrium(loaded)["quantities"]["tip_u1_m"]
    for same in (loaded.set("/name", "other"), pickle.loads(pickle.dumps(loaded))):
        assert slcbeam.equilibrium(same)["quantities"]["tip_u1_m"] == at_first
    anew = slcbeam.load("bend-dry", set={"/loads": case["loads"]} | {"/loads/0/force_x_n_m/signal/table/csv": str(where / "force.csv")})
    assert slcbeam.equilibrium(anew)["quantities"]["tip_u1_m"] > 100 * at_first


def test_a_sweep_is_a_table(tmp_path):
    case = slcbeam.load("bend-wet", set=COARSE)
    found = slcbeam.sweep(case, {"/loads/0/force_x_n_m/signal/sigmoid/amplitude": [20, 40, 60]}, command="equilibrium", lean=True)
    table = found.tables["sweep"]
    np.testing.assert_array_equal(table["/loads/0/force_x_n_m/signal/sigmoid/amplitude"], [20, 40, 60])
    assert "" not in table and table.units["tip_u1_m.final" if "tip_u1_m.final" in table else table.names[1]] is not None
    assert list(table.to_pandas().columns) == table.names and len(table.to_pandas()) == 3
    modes = slcbeam.modes(case, count=2).tables["modes"]
    assert "kind" in modes and modes["kind"].dtype.kind == "U"


def test_bands_stand_beside_figures(tmp_path):
    case = slcbeam.load("bend-wet", set=COARSE)
    modulus = {"/beam/young_modulus_pa": "normal:2e6:1e5"}
    found = slcbeam.equilibrium(case, uncertain=modulus, samples=16, out=tmp_path / "out")
    tip = found.bands["tip_u1_m"]
    assert tip["low"] < tip["value"] == found["quantities"]["tip_u1_m"] < tip["high"] and tip["numerical_error"] > 0
    assert slcbeam.read(tmp_path / "out").bands == found.bands
    modes = slcbeam.modes(case, count=30, uncertain=modulus, samples=16)
    swinging = [mode for mode in modes["modes"] if mode["frequency_hz"] is not None]
    lowest = min(swinging, key=lambda mode: mode["frequency_hz"])
    assert modes.bands["mode_1.frequency_hz"] == lowest["bands"]["frequency_hz"]
    assert slcbeam.equilibrium(case).bands == {}
    with pytest.raises(KeyError, match="tip_u1_m"):
        found.bands["tip_u1"]


def test_measured_data_are_columns(tmp_path):
    case = slcbeam.load("bend-wet", set=COARSE | {"/time/end_s": 0.05, "/time/output_interval_s": 0.001})
    run = slcbeam.run(case)
    data = {"t_s": run.history["t"][::5], "tip_m": run.history["tip_u1"][::5]}
    modulus = case["/beam/young_modulus_pa"]
    guess = case.set("/beam/young_modulus_pa", 1.05 * modulus)
    found = slcbeam.fit(guess, data, {"/beam/young_modulus_pa": (0.8 * modulus, 1.2 * modulus)}, {"tip_m": "tip_u1"})
    values = json.dumps(dict(found))
    assert "/beam/young_modulus_pa" in values


def test_a_best_is_found():
    case = slcbeam.load("tour-actuator", set=COARSE)
    pump = "/network/chains/0/ends/0/pressure_pa/ramp/to"
    found = slcbeam.optimize(case, {pump: (1e4, 8e4)}, maximize="tip_u1_m", subject_to="max_pressure_pa<=5e4", command="equilibrium")
    best = slcbeam.load(found.folder / "optimum-case.json")
    assert best[pump] == pytest.approx(5e4, rel=1e-4)
    assert len(found.tables["designs"]) > 2


def test_faults_are_exceptions():
    with pytest.raises(slcbeam.UsageError, match="--count"):
        slcbeam.modes("wiring-2", count=0)
    with pytest.raises(slcbeam.UsageError, match="--cuont"):
        slcbeam.modes("wiring-2", cuont=3)
    with pytest.raises(slcbeam.UsageError, match="optimum-case.json --uncertain"):
        slcbeam.optimize("wiring-2", {"/beam/length_m": (0.1, 0.2)}, maximize="tip_u1_m", uncertain={"/beam/width_m": "normal:0.05:0.001"})
    with pytest.raises(slcbeam.CaseError) as told:
        slcbeam.sweep("wiring-2", {"/beam/colour": [1, 2]})
    assert told.value.faults[0].pointer == "/beam/colour"


def test_calls_that_make_no_sense_are_told():
    case = slcbeam.load("bend-wet")
    for wrong in (lambda: case.set("/loads"), lambda: case.set({"/beam/length_m": 0.2}, 0.3), lambda: slcbeam.load(None)):
        with pytest.raises(slcbeam.UsageError):
            wrong()
    for accuracy in (5, 0, float("nan")):
        with pytest.raises(slcbeam.UsageError, match="1e-6 to 0.5"):
            slcbeam.run(case, accuracy=accuracy)
    with pytest.raises(slcbeam.UsageError, match="of equal length"):
        slcbeam.sense(case, {"pressure_1_pa": [1.0, 2.0], "pressure_2_pa": [1.0]})
    with pytest.raises(slcbeam.UsageError, match="low, high"):
        slcbeam.fit(case, {"t_s": [0.0]}, ["/beam/length_m"], {})
    with pytest.raises(slcbeam.UsageError, match="writes no folder"):
        slcbeam.check(case).report()


def test_ctrl_c_ends_a_sweep_with_what_there_is(tmp_path):
    case = slcbeam.load("bend-wet", set=COARSE | {"/time/end_s": 0.2})
    values = np.linspace(10, 60, 5000)
    rows = tmp_path / "sweep/designs.jsonl"

    def interrupt():
        while not (rows.exists() and rows.stat().st_size):
            time.sleep(0.01)
        os.kill(os.getpid(), signal.SIGINT)

    threading.Thread(target=interrupt, daemon=True).start()
    found = slcbeam.sweep(case, {"/loads/0/force_x_n_m/signal/sigmoid/amplitude": values}, lean=True, out=tmp_path / "sweep")
    assert found.interrupted
    assert 0 < len(next(iter(found.tables["sweep"].values()))) < 5000


def stopped(act, after=0.4):
    """What it answers when Ctrl-C comes meanwhile, nothing where that is raised; ends soon."""
    press = threading.Timer(after, lambda: os.kill(os.getpid(), signal.SIGINT))
    press.start()
    begin = time.monotonic()
    try:
        answer = act()
    except KeyboardInterrupt:
        answer = None
    press.cancel()
    assert time.monotonic() - begin < 20
    return answer


def test_ctrl_c_ends_what_takes_long_with_what_there_is():
    for command in (slcbeam.study, slcbeam.effects):
        found = stopped(lambda: command("tour-actuator", budget="200s"))
        assert found is None or found.interrupted


def test_ctrl_c_is_raised_where_there_is_no_part_of_an_answer():
    # what was complete before is not called interrupted
    def whole(answer):
        return answer is None or not answer.interrupted

    fine = {"/mesh/cells_per_segment": 16, "/solver/rtol": 1e-8}
    driven = slcbeam.load("tour-harvester", set=fine)
    for command in (slcbeam.periodic, slcbeam.floquet):
        assert whole(stopped(lambda: command(driven)))
    measured = {"t_s": np.linspace(0.01, 1.5, 100), "tip_mm": np.linspace(0, 9, 100)}
    fitted = slcbeam.load("tour-actuator", set=fine)
    fit = lambda: slcbeam.fit(fitted, measured, {"/fluid/viscosity_pa_s": (0.05, 2)}, {"tip_mm": "tip_u1"})  # noqa: E731
    # a fit tells the best so far, where it has one
    found = stopped(fit)
    assert whole(found) or (found["interrupted"] and found["parameters"])


def test_tables_are_frames_of_polars_too():
    polars = pytest.importorskip("polars")
    designs = polars.DataFrame({"/loads/0/force_x_n_m/signal/sigmoid/amplitude": [10.0, 20.0]})
    case = slcbeam.load("bend-wet", set=COARSE | {"/time/end_s": 0.01})
    lean = slcbeam.sweep(case, designs=designs, lean=True)
    table = lean.tables["sweep"]
    assert table.units["tip_u1_m.final"] == "m"
    with pytest.raises(slcbeam.UsageError, match="without lean"):
        lean.report()
    assert len(table["status"]) == 2


def test_errors_have_numbers():
    for act, code in (
        (lambda: slcbeam.load("nofile"), ("E030", "E050")),
        (lambda: slcbeam.read("nofolder"), ("E050",)),
        (lambda: slcbeam.Simulator("tour-actuator", {"/network": 5}), ("E030",)),
    ):
        with pytest.raises(slcbeam.Error) as raised:
            act()
        assert raised.value.code in code


def test_parts_are_joined_and_folders_read(tmp_path):
    case = slcbeam.load("tour-actuator", set=COARSE)
    vary = {"/network/chains/0/ends/0/pressure_pa/ramp/to": [1e4, 2e4, 3e4]}
    how = {"command": "equilibrium", "lean": True, "no_mesh_errors": True}
    parts = [tmp_path / "1", tmp_path / "2"]
    for number, part in enumerate(parts, 1):
        slcbeam.sweep(case, vary, shard=f"{number}/2", out=part, **how)
    joined = slcbeam.merge(parts, out=tmp_path / "whole")
    whole = slcbeam.sweep(case, vary, **how).tables["sweep"]
    assert joined["complete"]
    for table in (joined.tables["sweep"], slcbeam.read(tmp_path / "whole").tables["sweep"]):
        np.testing.assert_array_equal(table["tip_u1_m"], whole["tip_u1_m"])
    less = slcbeam.merge(parts[:1], out=tmp_path / "less")
    assert not less["complete"] and less["missing"] and len(less.tables["sweep"]["design"]) < 3
    with pytest.raises(slcbeam.FileError, match="no result"):
        slcbeam.read(tmp_path)


@pytest.mark.parametrize("command", ["run", "equilibrium", "modes", "periodic", "floquet"])
def test_a_folder_of_any_command_is_read(command, tmp_path):
    case = slcbeam.load("tour-harvester", set=COARSE)
    told = getattr(slcbeam, command)(case, out=tmp_path / "there")
    found = slcbeam.read(tmp_path / "there")
    if command == "run":
        assert found["quantities"] == told.summary["quantities"]
        np.testing.assert_array_equal(found.tables["history"]["tip_u1"], told.history["tip_u1"])
        np.testing.assert_array_equal(found.arrays["u1_m"], told.fields["u1_m"])
    else:
        assert dict(found) == dict(told)


def test_designs_of_a_table_go_on_and_are_told_from_others(tmp_path):
    case = slcbeam.load("tour-actuator", set=COARSE)
    pointer = "/network/chains/0/ends/0/pressure_pa/ramp/to"
    how = {"command": "equilibrium", "lean": True, "no_mesh_errors": True, "out": tmp_path / "designs"}
    first = slcbeam.sweep(case, designs={pointer: [1e4, 2e4]}, **how).tables["sweep"]
    again = slcbeam.sweep(case, designs=pandas.DataFrame({pointer: [1e4, 2e4]}), **how).tables["sweep"]
    np.testing.assert_array_equal(again["wall_s"], first["wall_s"])
    with pytest.raises(slcbeam.UsageError, match="the table of designs has changed"):
        slcbeam.sweep(case, designs={pointer: [1e4, 3e4]}, **how)
    with pytest.raises(slcbeam.UsageError, match="real numbers are wanted"):
        slcbeam.sweep(case, designs={pointer: ["much"]}, **how)


def test_words_are_explained():
    assert slcbeam.explain("buckling")[0]["meaning"].startswith("slcbeam equilibrium")
    with pytest.raises(slcbeam.UsageError, match="did you mean tip_angle"):
        slcbeam.explain("tip_angel")


def test_sections_and_specimens_have_coefficients():
    found = slcbeam.coefficients("section-actuator")
    assert len(found["compliance"]) == 4
    volumes = {"pressure_kpa": [0, 10, 20, 30], "volume_ml": [0, 0.11, 0.19, 0.3]}
    measured = slcbeam.measure(volumes, of="section-actuator", as_="pressure-volume")
    assert measured["coefficients"]["/bladders/area_per_pressure_m2_per_pa"]["value"] == pytest.approx(7e-11)


def test_results_are_compared_and_exported(tmp_path):
    for name, length in [("a", 0.1), ("b", 0.11)]:
        slcbeam.run(slcbeam.load("bend-wet", set={"/beam/length_m": length, "/time/end_s": 0.01}), out=tmp_path / name)
    told = slcbeam.compare(tmp_path / "a", tmp_path / "b")
    assert told["format"]
    slcbeam.export(tmp_path / "a", format="csv", every=5)
    assert (tmp_path / "a/csv/u1_m.csv").is_file()
    drawn = slcbeam.plot(tmp_path / "a", tmp_path / "b", quantity="tip_u1", label=["0.1 m", "0.11 m"], out=tmp_path / "tip.pdf")
    assert drawn["panels"][0]["y_unit"] == "m" and drawn["panels"][0]["curves"] == ["0.1 m", "0.11 m"]
    assert (tmp_path / "tip.pdf").read_bytes().startswith(b"%PDF-1.4")


def test_the_program_comes_with_the_package(tmp_path):
    def say(*words):
        return subprocess.run([sys.executable, "-m", "slcbeam", *words], capture_output=True, text=True, cwd=tmp_path)

    assert "transverse displacement" in say("explain", "tip_u1").stdout
    nothing = say("check", "nothing.json")
    assert nothing.returncode == 2 and "nothing.json" in nothing.stderr
    (tmp_path / "bad.json").write_text("{}")
    assert say("check", "bad.json").returncode == 3


def test_a_name_that_is_not_there_is_told_with_the_nearest():
    found = slcbeam.equilibrium("bend-wet")
    for where, name, meant in [(found, "quantitis", "quantities"), (found.tables, "pat", "path"), (found.tables["path"], "tip_u", "tip_u")]:
        with pytest.raises(KeyError, match=f"did you mean '{meant}"):
            where[name]
