"""What the package refuses: values that are no numbers, arrays of results that would be changed, calls that make no sense."""

import numpy as np
import pytest

import slcbeam


@pytest.mark.parametrize(
    "column",
    [np.array([0.1 + 1j, 0.2]), np.array(["2026-01-01", "2026-01-02"], dtype="datetime64[s]"), np.array([1, 2], dtype="timedelta64[s]"),
     ["0.1", "0.2"], [b"1", b"2"], [[1.0, 2.0], [3.0, 4.0]], [object(), object()], [0.1, "soon"]],
)
def test_columns_that_are_no_real_numbers_are_refused(column):
    """Goal: imaginary parts are not dropped, dates are no seconds, and text is not read as numbers."""
    with pytest.raises(slcbeam.UsageError, match="column 't_s'"):
        slcbeam.fit("bend-wet", {"t_s": column, "u_m": [0.0, 0.0]}, {"/beam/young_modulus_pa": (1e6, 3e6)}, {"u_m": "tip_u1"})


def test_times_and_inputs_are_numbers():
    inlet = "/network/chains/0/ends/0/pressure_pa"
    sim = slcbeam.Simulator("tour-actuator", {inlet: (0, 40e3)})
    for wrong in ["0.01", 0.01 + 0j, np.datetime64("2026-01-01"), [0.01, 0.02], None]:
        with pytest.raises(slcbeam.UsageError):
            sim.step(wrong, 1e3)
    for wrong in ["1e3", 1e3 + 0j, np.datetime64("2026-01-01"), {inlet: "1e3"}, {inlet: 1j}]:
        with pytest.raises(slcbeam.UsageError):
            sim.step(0.01, wrong)
    with pytest.raises(slcbeam.UsageError):
        slcbeam.Simulator("tour-actuator", {inlet: ("0", "40e3")})


def test_arrays_of_results_stay_as_they_are():
    """Goal: a result that is saved as finished is what was computed: no view leads to memory that can be written."""
    result = slcbeam.run(slcbeam.load("bend-wet", set={"/time/end_s": 0.01}))
    arrays = [result.history["tip_u1"], result.history.values_2d, result.fields.t, *result.fields.values(), *result.fields.coordinates.values()]
    for array in arrays:
        while isinstance(array, np.ndarray):
            with pytest.raises(ValueError):
                array.flags.writeable = True
            with pytest.raises(ValueError):
                array[...] = 0.0
            array = array.base


@pytest.mark.parametrize(
    "call",
    [
        lambda: slcbeam.run("bend-wet", accuracy="fine"),
        lambda: slcbeam.run("bend-wet", sensitivity=[1]),
        lambda: slcbeam.run("bend-wet", out=5),
        lambda: slcbeam.load("bend-wet", set=5),
        lambda: slcbeam.load({"name": object()}),
        lambda: slcbeam.load("a\0b"),
        lambda: slcbeam.load("x" * 5000),
        lambda: slcbeam.load("bend-wet")[5],
        lambda: slcbeam.load("bend-wet")["/nothing"],
        lambda: slcbeam.equilibrium("bend-wet", at=object()),
        lambda: slcbeam.equilibrium("bend-wet", out=5),
        lambda: slcbeam.explain(5),
        lambda: slcbeam.compare(5, 6),
        lambda: slcbeam.export(5),
        lambda: slcbeam.merge([5], out="x"),
        lambda: slcbeam.read(5),
        lambda: slcbeam.sweep("bend-wet", {"/beam/length_m": [object()]}),
    ],
)
def test_every_error_is_one_of_the_package(call):
    with pytest.raises(slcbeam.Error) as raised:
        call()
    assert str(raised.value)
