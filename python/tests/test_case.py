"""Cases: where they come from, what changes them, what is wrong with them."""

import json
import pickle

import numpy as np
import pytest

import slcbeam


def test_every_case_of_the_package_loads():
    assert len(slcbeam.shipped()) > 50
    for name in slcbeam.shipped():
        assert slcbeam.load(name).name


def test_a_case_is_the_same_as_file_name_dict_and_text(tmp_path):
    named = slcbeam.load("bend-wet")
    given = named.to_dict()
    file = tmp_path / "own.json"
    file.write_text(json.dumps(given))
    for case in (given, json.dumps(given), file, str(file), named):
        assert slcbeam.load(case).to_dict() == given


def test_tables_beside_a_file_are_found_and_stand_in_the_dict():
    case = slcbeam.load("network-tour")
    assert slcbeam.load(case.to_dict()).to_dict() == case.to_dict()
    assert "csv" not in json.dumps(case.to_dict())


def test_set_makes_another_case_and_takes_numbers_of_numpy(quick):
    other = quick.set({"/beam/length_m": np.float64(0.09), "/solver/max_steps": np.int64(7)})
    assert (other["/beam/length_m"], other["/solver/max_steps"]) == (0.09, 7)
    assert quick["/beam/length_m"] == 0.1
    assert other.set("/beam/length_m", 0.1).to_dict() == quick.set("/solver/max_steps", 7).to_dict()
    with pytest.raises(KeyError):
        quick["/beam/colour"]
    again = pickle.loads(pickle.dumps(other))
    assert again.to_dict() == other.to_dict()


def test_faults_come_all_at_once_with_their_places():
    case = slcbeam.load("bend-wet").to_dict()
    case["beam"]["lenght_m"] = case["beam"].pop("length_m")
    case["beam"]["height_m"] = -0.02
    with pytest.raises(slcbeam.CaseError) as caught:
        slcbeam.load(case)
    faults = {fault.pointer: fault for fault in caught.value.faults}
    assert faults["/beam/lenght_m"].code == "E004" and faults["/beam/lenght_m"].nearest == "length_m"
    assert faults["/beam/height_m"].code == "E006" and faults["/beam/height_m"].allowed
    assert faults["/beam/height_m"].line > 1
    assert "height_m" in str(caught.value) and isinstance(caught.value, ValueError)
    again = pickle.loads(pickle.dumps(caught.value))
    assert again.faults == caught.value.faults and str(again) == str(caught.value)


def test_a_change_that_is_wrong_is_named(quick):
    with pytest.raises(slcbeam.CaseError) as caught:
        quick.set("/beam/length_m", -1)
    assert "/beam/length_m=-1" in [fault.set for fault in caught.value.faults]
    for pointer, value in [("beam", 1), ("/beam/length_m", float("nan")), ("/beam/length_m", object())]:
        with pytest.raises(slcbeam.UsageError):
            quick.set(pointer, value)


def test_a_case_that_is_not_there_is_told_with_the_nearest(tmp_path):
    with pytest.raises(slcbeam.UsageError, match="did you mean 'wiring-2'"):
        slcbeam.load("wirring-2")
    # nothing outside of the package passes for a case of it
    with pytest.raises(slcbeam.UsageError):
        slcbeam.load("../__init__")
    with pytest.raises(slcbeam.UsageError):
        slcbeam.load(tmp_path)
