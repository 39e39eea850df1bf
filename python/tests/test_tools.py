"""Optimisers, studies of sensitivity and pools of others, with cases in them."""

import functools
import os

import dask
import dask.bag
import joblib
import numpy as np
import pytest
from SALib.analyze import sobol
from SALib.sample import sobol as sampling
from scipy import optimize

import slcbeam

LOAD = "/loads/0/force_x_n_m/signal/sigmoid/amplitude"
MODULUS = "/beam/young_modulus_pa"


def tip(case, changes):
    return slcbeam.run(case.set(changes)).quantities["tip_u1_m"]["final"]


def test_scipy_finds_the_load_of_a_deflection(quick):
    wanted = 0.8 * tip(quick, {})
    found = optimize.brentq(lambda load: tip(quick, {LOAD: load}) - wanted, 40, 100, xtol=1e-3)
    assert 60 < found < 95 and abs(tip(quick, {LOAD: found}) - wanted) < 1e-5 * abs(wanted) + 1e-7


def test_scipy_descends_along_derivatives(quick):
    """A modulus that made a history is found again by steps along the derivative of the run."""
    measured = slcbeam.run(quick.set(MODULUS, 2.2e6)).history["tip_u1"]
    seen = {}

    def misses(modulus):
        seen["result"] = slcbeam.run(quick.set(MODULUS, modulus[0]), sensitivity=[MODULUS])
        return (seen["result"].history["tip_u1"] - measured) / 1e-4

    def slopes(_):
        return seen["result"].derivatives[f"d tip_u1/d {MODULUS}"][:, None] / 1e-4

    found = optimize.least_squares(misses, [quick[MODULUS]], slopes, x_scale=1e6, xtol=1e-4)
    np.testing.assert_allclose(found.x, [2.2e6], rtol=1e-3)
    assert found.nfev < 8


def test_salib_shares_the_variance_of_a_deflection():
    """The deflection of a dry beam under a small load goes with load over modulus: of 20 % and 10 %, four fifths and one fifth."""
    case = slcbeam.load("bend-dry")
    load, modulus = case[LOAD] / 50, case[MODULUS]
    problem = {"num_vars": 2, "names": [LOAD, MODULUS], "bounds": [[0.8 * load, 1.2 * load], [0.9 * modulus, 1.1 * modulus]]}
    points = sampling.sample(problem, 64, calc_second_order=False, seed=1)
    designs = dict(zip(problem["names"], points.T))
    table = slcbeam.sweep(case, designs=designs, command="equilibrium", lean=True, no_mesh_errors=True).tables["sweep"]
    for name, column in designs.items():
        np.testing.assert_array_equal(table[name], column)
    told = sobol.analyze(problem, table["tip_u1_m"], calc_second_order=False, seed=1)
    np.testing.assert_allclose(told["ST"], [0.8, 0.2], atol=0.05)


VISCOSITIES = [0.05, 0.1, 0.2, 0.4]


def started(case, viscosity):
    """A run, and the process in which it was."""
    return slcbeam.run(case.set("/fluid/viscosity_pa_s", viscosity)), os.getpid()


def same(case, pairs, *, elsewhere):
    for viscosity, (result, process) in zip(VISCOSITIES, pairs, strict=True):
        np.testing.assert_array_equal(result.history.values_2d, started(case, viscosity)[0].history.values_2d)
        assert (process != os.getpid()) == elsewhere


@pytest.mark.parametrize("prefer", ["processes", "threads"])
def test_joblib_runs_cases(quick, prefer):
    pool = joblib.Parallel(n_jobs=2, prefer=prefer)
    same(quick, pool(joblib.delayed(started)(quick, one) for one in VISCOSITIES), elsewhere=prefer == "processes")


@pytest.mark.parametrize("scheduler", ["processes", "threads"])
def test_dask_runs_cases(quick, scheduler):
    bag = dask.bag.from_sequence(VISCOSITIES, npartitions=2).map(functools.partial(started, quick))
    same(quick, bag.compute(scheduler=scheduler, num_workers=2), elsewhere=scheduler == "processes")
    delayed = [dask.delayed(started)(quick, one) for one in VISCOSITIES]
    same(quick, dask.compute(*delayed, scheduler=scheduler, num_workers=2), elsewhere=scheduler == "processes")
