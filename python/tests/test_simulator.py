"""Simulation from one control instant to the next."""

import importlib.util
import pickle
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import slcbeam

INLET = "/network/chains/0/ends/0/pressure_pa"
RANGE = {INLET: (0.0, 60e3)}
EXAMPLE = Path(__file__).resolve().parents[1] / "examples/gym_reach.py"


@pytest.fixture
def case():
    return slcbeam.load("tour-actuator", set={"/mesh/cells_per_segment": 2, "/solver/rtol": 1e-6, "/time/end_s": 0.5, "/solver/method": "esdirk46"})


def held(t, values):
    """The signal that jumps at these instants [s]."""
    steps = zip(t, [0.0, *values[:-1]], values)
    return {"sum": [{"ramp": {"from": 0, "to": new - old, "start_s": at, "duration_s": 0}} for at, old, new in steps]}


def test_pieces_are_what_a_run_with_jumps_is(case):
    """A run whose inlet jumps at the same instants gives the same, energies included; what is left falls with the tolerance."""
    case = case.set("/solver/rtol", 1e-8)
    instants, values = [0.1, 0.2, 0.3], [20e3, 50e3, 5e3]
    sim = slcbeam.Simulator(case, RANGE)
    sim.step_to(0.1)
    rows = [sim.step_to(t + 0.1, value) for t, value in zip(instants, values)]
    run = slcbeam.run(case.set({INLET: held(instants, values), "/time/end_s": 0.4, "/time/output_interval_s": 0.1}))
    for name in ("tip_u1", "tip_angle", "bending_energy", "work_ports", "dissipated_bladders", "injected_volume"):
        theirs, ours = run.history[name][2:], [row[sim.columns.index(name)] for row in rows]
        size = np.abs(run.history[name]).max()
        np.testing.assert_allclose(ours, theirs, rtol=0, atol=2e-6 * size, err_msg=name)
    # what the mesh resolves is judged over all of the range
    assert {told[:4] for told in sim.warnings} <= {told[:4] for told in run.warnings} | {"W016"}


def test_balances_close_over_jumps(case):
    sim = slcbeam.Simulator(case, RANGE)
    for k in range(10):
        sim.step(0.02, [60e3, 0.0][k % 2])
    assert abs(sim["energy_residual"]) < 1e-3 * sim["work_ports"]


def test_balances_close_over_valves_that_shut():
    sim = slcbeam.Simulator("tour-actuator", {"/network/chains/0/opening": (0, 1)})
    for k in range(12):
        sim.step(0.01, k % 2)
    assert abs(sim["energy_residual"]) < 1e-3 * sim["bending_energy"]
    assert not sim.warnings


def test_a_state_goes_on_bit_for_bit(case):
    sim = slcbeam.Simulator(case, RANGE)
    sim.step(0.05, 30e3)
    state = sim.save()
    rows = [sim.step(0.01, value) for value in (40e3, 40e3, 10e3)]
    for restored in (state, pickle.loads(pickle.dumps(state))):
        other = slcbeam.Simulator(case, RANGE)
        other.restore(restored)
        assert other.t == 0.05 and other.values[0] == 30e3
        for row, value in zip(rows, (40e3, 40e3, 10e3)):
            np.testing.assert_array_equal(other.step(0.01, value), row)
    sim.restore(state)
    np.testing.assert_array_equal(sim.step(0.01, 40e3), rows[0])


def test_several_inputs_and_what_is_refused(case):
    load = "/loads/0/force_x_n_m"
    loaded = slcbeam.load("bend-wet", set={"/mesh/cells_per_segment": 1})
    vented = "/network/chains/1/ends/1/pressure_pa"
    two = slcbeam.Simulator(case, {vented: (-1e3, 1e3), INLET: (0, 60e3)})
    two.step(1e-3, {INLET: 1e3})
    assert list(two.values) == [0.0, 1e3]
    with pytest.raises(slcbeam.UsageError, match="is no input"):
        two.step(1e-3, {load: 1.0})
    sim = slcbeam.Simulator(loaded, {load: (-200.0, 200.0)})
    assert sim.values[0] == pytest.approx(100 / (1 + np.exp(68 * 0.0625)))
    sim.step(1e-3, {load: 50.0})
    assert sim.values[0] == 50.0
    with pytest.raises(slcbeam.UsageError, match="range"):
        sim.step(1e-3, 1e6)
    with pytest.raises(slcbeam.UsageError, match="2 values for 1"):
        sim.step(1e-3, [1.0, 2.0])
    with pytest.raises(slcbeam.UsageError, match="end_s"):
        sim.step(1e3)
    with pytest.raises(slcbeam.UsageError, match="later than its start"):
        sim.step(-1.0)
    with pytest.raises(slcbeam.UsageError, match="nearest is"):
        slcbeam.Simulator(case, {INLET.replace("pressure", "presure"): (0, 1)})
    with pytest.raises(slcbeam.UsageError, match="must contain the initial value"):
        slcbeam.Simulator(case, {INLET: (1.0, 2.0)})
    state = slcbeam.Simulator(case, RANGE).save()
    for other in (sim, slcbeam.Simulator(case.set("/beam/young_modulus_pa", 1e6), RANGE), slcbeam.Simulator(case, {INLET: (0.0, 50e3)})):
        with pytest.raises(slcbeam.UsageError, match="another case"):
            other.restore(state)
    for wrong in ([INLET], {INLET: 5}, {INLET: (1, 2, 3)}):
        with pytest.raises(slcbeam.UsageError, match="inputs are"):
            slcbeam.Simulator(case, wrong)
    with pytest.raises(slcbeam.UsageError, match="values of the inputs"):
        sim.step(1e-3, np.array([[1.0]]))
    with pytest.raises(slcbeam.UsageError, match="times are numbers") as refused:
        sim.step("a")
    assert refused.value.code == "E030"
    with pytest.raises(slcbeam.UsageError, match="inputs are"):
        slcbeam.Simulator(case, {3: (0, 1)})
    with pytest.raises(slcbeam.UsageError, match="is not allowed"):
        slcbeam.Simulator(case, {"/network/chains/0/opening": (0, 2)})
    with pytest.raises(slcbeam.UsageError, match="not a state"):
        slcbeam.State.read(b"garbage")


def test_ends_and_volumes_move_to_their_values_within_a_step():
    """Motions must not jump: their rates are continuous. A state within a motion goes on bit for bit."""
    root, mesh = "/ends/root/clamped/u3_m", {"/mesh/cells_per_segment": 1, "/mesh/cells_per_bladder": 1}
    sim = slcbeam.Simulator(slcbeam.load("wiring-2", set=mesh), {root: (-0.013, 0.013)})
    for value in (1e-5, 3e-5, 3e-5):
        sim.step(1e-3, value)
    state, rows = sim.save(), []
    for value in (5e-5, 5e-5, 5e-5, 2e-5):
        rows.append(sim.step(1e-3, value))
    for kept in (state, pickle.loads(pickle.dumps(state))):
        sim.restore(kept)
        for value, row in zip((5e-5, 5e-5, 5e-5, 2e-5), rows):
            np.testing.assert_array_equal(sim.step(1e-3, value), row)
    assert abs(sim["energy_residual"]) < 1e-3 * sim["kinetic_energy"]
    with pytest.raises(slcbeam.UsageError, match="range"):
        sim.step(1e-3, 0.1)

    port = "/network/ports/0/volume_m3"
    sim = slcbeam.Simulator(slcbeam.load("gripper", set={"/mesh/cells_per_segment": 1}), {port: (0.0, 3e-5)})
    for volume in (1e-6, 2e-6, 2e-6, 2e-6):
        sim.step(0.01, volume)
        assert sim["port_syringe_volume"] == pytest.approx(volume, rel=1e-12)
    assert abs(sim["port_syringe_flow"]) < 1e-9


def test_wall_times_are_parts_of_the_whole(case):
    """Each part grows with what is done: jumps with changed inputs alone."""
    spec = importlib.util.spec_from_file_location("step_cost", EXAMPLE.parent / "step_cost.py")
    example = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(example)
    changed = example.cost(100.0, steps=20)
    unchanged = example.cost(0.0, steps=20)
    assert changed["integration"] > 0 and changed["watching"] > 0 and changed["call"] > 0
    assert changed["jumps"] > 10 * unchanged["jumps"]
    # a jump of inputs asks for no shorter steps
    assert changed["steps"] < 1.5 and unchanged["steps"] == 1


def test_a_changed_input_gives_what_a_new_simulator_gives(case):
    """Factors and step sizes that are kept change a motion by less than the tolerance."""
    kept, fresh = slcbeam.Simulator(case, RANGE), slcbeam.Simulator(case, RANGE)
    for k in range(20):
        value = 60e3 * ((7 * k) % 11) / 11
        one = kept.step(2e-3, value)
        fresh.save()
        other = fresh.step(2e-3, value)
        place = kept.columns.index("tip_u1")
        assert abs(one[place] - other[place]) < 1e-4 * max(abs(one[place]), 1e-3)


def test_the_environment_learns_nothing_new_from_reset():
    gymnasium = pytest.importorskip("gymnasium")
    from gymnasium.utils.env_checker import check_env

    spec = importlib.util.spec_from_file_location("gym_reach", EXAMPLE)
    example = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(example)
    check_env(example.Reach(steps=5), skip_render_check=True)
    # what is wanted can be reached
    env = example.Reach()
    first = env.reset(seed=1)[0][1]
    for _ in range(env.steps):
        seen = env.step(np.array([1.0]))[0]
    assert seen[1] - first > example.REACHED[1]
    env = example.Reach(steps=25)
    assert isinstance(env, gymnasium.Env)

    def episode(gain):
        seen, _ = env.reset(seed=1)
        action, total, over = np.array([-1.0]), 0.0, False
        while not over:
            action = np.clip(action + gain * (seen[0] - seen[1]), -1.0, 1.0)
            seen, reward, _, over, _ = env.step(action)
            total += reward
        return total

    controlled = episode(6.0)
    assert controlled == episode(6.0)
    assert controlled > episode(0.0)


def test_a_loop_designed_on_the_model_is_that_of_the_beam(program, tmp_path):
    """The figures of the tour: the reduced model predicts the closed loop of the nonlinear beam; without the notch the loop is unstable."""
    pytest.importorskip("scipy")
    model = tmp_path / "model.npz"
    case = EXAMPLE.parents[2] / "cases/tour-actuator.json"
    program("export", case, "--set", f"{INLET}=0", "--state-space", model, "--error", "1e-3", "--input", INLET, "--output", "tip_u1")
    loop = EXAMPLE.with_name("pressure_loop.py")
    printed = subprocess.run([sys.executable, str(loop), str(model)], capture_output=True, text=True, check=True).stdout
    assert printed.strip() in (EXAMPLE.parents[2] / "docs/tour-actuator.md").read_text(encoding="utf-8"), printed
    spec = importlib.util.spec_from_file_location("pressure_loop", loop)
    example = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(example)
    stored = np.load(model)
    matrices = [stored[name] for name in "ABCD"]
    plant = example.signal.cont2discrete(matrices, example.PERIOD)[:4]
    for notched in (True, False):
        tip = example.closed_loop(example.design(matrices, notched), example.Linear(*plant).advance)
        assert (abs(tip).max() < 2 * example.GOAL) == notched
