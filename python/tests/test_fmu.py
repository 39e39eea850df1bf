"""FMUs, as an importer uses them: fmpy's checker, steps, states, events, and FMUs coupled with each other."""

import json
import re
import shutil
import subprocess
import threading
from pathlib import Path

import numpy as np
import pytest

import slcbeam

fmpy = pytest.importorskip("fmpy")
from fmpy.fmi1 import FMICallException  # noqa: E402
from fmpy.fmi3 import FMU3Slave  # noqa: E402
from fmpy.validation import validate_fmu  # noqa: E402

CASES = Path(__file__).resolve().parents[2] / "cases"
INLET = "/network/chains/0/ends/0/pressure_pa"
PRESSURE = "network.chains[0].ends[0].pressure_pa"
#: A finger of some hundred unknowns.
SMALL = {"/mesh/cells_per_segment": 1, "/mesh/cells_per_bladder": 1, "/solver/method": "esdirk46"}


class Fmu:
    """An instance of an FMU, with variables by name."""

    def __init__(self, path, early=False, events=False, stop=None):
        self.about = fmpy.read_model_description(str(path))
        self.folder = fmpy.extract(str(path))
        self.messages = []
        self.references = {variable.name: variable.valueReference for variable in self.about.modelVariables}
        self.outputs = [variable.name for variable in self.about.modelVariables if variable.causality == "output"]
        identifier = self.about.coSimulation.modelIdentifier
        self.slave = FMU3Slave(
            guid=self.about.guid, unzipDirectory=self.folder, modelIdentifier=identifier, instanceName="one"
        )
        log = lambda _, status, category, message: self.messages.append((status, message.decode()))  # noqa: E731
        self.slave.instantiate(loggingOn=True, earlyReturnAllowed=early, eventModeUsed=events, logMessage=log)
        self.slave.enterInitializationMode(startTime=0.0, stopTime=stop)
        self.slave.exitInitializationMode()
        if events:
            self.slave.updateDiscreteStates()
            self.slave.enterStepMode()
        self.t = 0.0

    def step(self, size, **_):
        outcome = self.slave.doStep(currentCommunicationPoint=self.t, communicationStepSize=size)
        self.t = outcome[3]
        return outcome

    def __setitem__(self, name, value):
        self.slave.setFloat64([self.references[name]], [value])

    def __getitem__(self, name):
        return self.slave.getFloat64([self.references[name]])[0]

    def row(self):
        return np.array(self.slave.getFloat64([self.references[name] for name in self.outputs]))

    def close(self):
        self.slave.terminate()
        self.slave.freeInstance()
        shutil.rmtree(self.folder, ignore_errors=True)


@pytest.fixture
def fmu(program, tmp_path):
    """Writes FMUs and instantiates them."""
    made, paths = [], {}

    def write(case, *inputs, outputs=(), more=(), **options):
        key = (case.name, inputs, tuple(outputs), tuple(more), str(case))
        if key not in paths:
            paths[key] = tmp_path / f"{len(paths)}.fmu"
            source = tmp_path / f"{len(paths)}.json"
            source.write_text(json.dumps(case.to_dict()), encoding="utf-8")
            chosen = [word for one in inputs for word in ("--input", one)]
            chosen += ["--output", ",".join(outputs)] if outputs else []
            program("export", source, "--fmu", paths[key], *chosen, *more)
        made.append(Fmu(paths[key], **options))
        made[-1].path = paths[key]
        return made[-1]

    yield write
    for one in made:
        one.close()
    for path in paths.values():
        path.unlink()


@pytest.fixture
def finger():
    return slcbeam.load("tour-actuator", set={**SMALL, "/time/end_s": 2.0})


CHECKED = {
    "tour-actuator": [f"{INLET}=0,6e4", "/network/chains/0/opening"],
    "wiring-2": ["/ends/root/clamped/u3_m"],
    "gripper": ["/network/ports/0/volume_m3"],
    "air-actuator": ["/network/ports/0/pressure_pa"],
    "bend-wet": ["/loads/0/force_x_n_m"],
    "raised-tank": ["/network/tubes/0/pump/curve/factor=0,1.5", "/network/ports/0/pressure_pa=-1e3,1e3"],
}


@pytest.mark.parametrize("name", CHECKED)
def test_the_checker_finds_no_problem_and_simulates(program, tmp_path, name):
    path = tmp_path / "model.fmu"
    program("export", CASES / f"{name}.json", "--fmu", path, *[word for one in CHECKED[name] for word in ("--input", one)])
    assert validate_fmu(str(path)) == []
    about = fmpy.read_model_description(str(path))
    assert fmpy.supported_platforms(str(path)) == ["linux64"]
    assert about.coSimulation.canGetAndSetFMUstate and about.coSimulation.canSerializeFMUstate
    units = {variable.unit for variable in about.modelVariables}
    assert None not in units and units <= {unit.name for unit in about.unitDefinitions}
    assert all(variable.description for variable in about.modelVariables)
    stop = 0.02
    result = fmpy.simulate_fmu(str(path), stop_time=stop, output_interval=stop / 10)
    assert result["time"][-1] == pytest.approx(stop)
    assert all(np.isfinite(result[column]).all() for column in result.dtype.names)
    path.unlink()


def test_ten_thousand_steps_are_those_of_the_simulator_bit_for_bit(fmu, finger):
    sim = slcbeam.Simulator(finger, {INLET: (0, 60e3)})
    own = fmu(finger, f"{INLET}=0,6e4")
    assert own.outputs == sim.columns[1:]
    assert (own.row() == sim.row[1:]).all()
    size, t, tips = 1e-4, 0.0, []
    for k in range(10_000):
        value = 30e3 * (1.0 - np.cos(0.003 * k)) if k % 7 == 0 else None
        if value is not None:
            own[PRESSURE] = value
        own.step(size)
        row = sim.step_to(t + size, value)
        t += size
        assert own.t == sim.t == t
        assert (own.row() == row[1:]).all(), k
        tips.append(row[1])
    assert max(tips) - min(tips) > 5e-4


def test_states_are_stored_restored_and_bytes(fmu, finger):
    own, other = fmu(finger, f"{INLET}=0,6e4"), fmu(finger, f"{INLET}=0,6e4")
    own[PRESSURE] = 20e3
    own.step(0.01)
    # a value that is set and not yet used is part of the state
    own[PRESSURE] = 50e3
    state = own.slave.getFMUState()
    stored = own.slave.serializeFMUState(state)
    ahead = []
    for _ in range(3):
        own.step(0.005)
        ahead.append(own.row())
    for _ in range(2):
        own.slave.setFMUState(state)
        own.t = 0.01
        for row in ahead:
            own.step(0.005)
            assert (own.row() == row).all()
    own.slave.freeFMUState(state)
    read = other.slave.deserializeFMUState(stored)
    other.slave.setFMUState(read)
    other.t = 0.01
    assert other["time"] == 0.01 and other[PRESSURE] == 50e3
    for row in ahead:
        other.step(0.005)
        assert (other.row() == row).all()
    other.slave.reset()
    other.slave.enterInitializationMode(startTime=0.0)
    other.slave.exitInitializationMode()
    assert other["time"] == 0.0 and other[PRESSURE] == 0.0
    with pytest.raises(FMICallException):
        other.slave.deserializeFMUState(b"garbage")
    assert "not a state of an FMU" in other.messages[-1][1]


def test_instances_in_threads_are_independent(fmu, finger):
    rows = {}

    def simulate(name, value, one):
        one[PRESSURE] = value
        for _ in range(50):
            one.step(1e-3)
        rows[name] = one.row()

    values = {"a": 10e3, "b": 50e3, "again": 10e3}
    ones = {name: fmu(finger, f"{INLET}=0,6e4") for name in values}
    threads = [threading.Thread(target=simulate, args=(name, values[name], ones[name])) for name in values]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert (rows["a"] == rows["again"]).all() and (rows["a"] != rows["b"]).any()


def test_steps_return_at_jumps_of_the_case(fmu, finger):
    """A load that jumps at 0.0123 s, within a step."""
    at = 0.0123
    jump = {"force_x_n_m": {"profile": 1, "signal": {"ramp": {"to": -0.5, "start_s": at, "duration_s": 0}}}}
    case = finger.set({"/loads": [jump], "/start": {}})
    plain, early = fmu(case, f"{INLET}=0,6e4"), fmu(case, f"{INLET}=0,6e4", early=True)
    assert plain.step(0.02) == (False, False, False, 0.02)
    assert early.step(0.02) == (False, False, True, at)
    assert early.step(0.02 - at)[2:] == (False, pytest.approx(0.02))
    assert (early.row() == plain.row()).all()
    events = fmu(case, f"{INLET}=0,6e4", early=True, events=True)
    assert events.step(0.02) == (True, False, True, at)
    events.slave.enterEventMode()
    assert not events.slave.updateDiscreteStates()[4]
    events[PRESSURE] = 10e3
    events.slave.enterStepMode()
    events.step(0.02 - at)
    assert events["tip_u1"] != plain["tip_u1"]
    result = fmpy.simulate_fmu(str(events.path), stop_time=0.03, output_interval=0.01, use_event_mode=True, early_return_allowed=True)
    assert at in result["time"]


def test_limits_and_mistakes_are_reported_and_can_be_undone(fmu, finger):
    own = fmu(finger, f"{INLET}=0,6e4")
    state = own.slave.getFMUState()
    with pytest.raises(FMICallException):
        own[PRESSURE] = 70e3
    assert "outside its range, 0 to 60000 Pa" in own.messages[-1][1]
    with pytest.raises(FMICallException):
        own.slave.doStep(currentCommunicationPoint=1.0, communicationStepSize=0.1)
    assert "the model is at 0 s" in own.messages[-1][1]
    with pytest.raises(FMICallException):
        own.step(5.0)
    assert "/time/end_s" in own.messages[-1][1]
    with pytest.raises(FMICallException):
        own.slave.enterInitializationMode(startTime=0.0)
    assert "is not allowed in the state Step" in own.messages[-1][1]
    own.slave.setFMUState(state)
    own.t = 0.0
    own.step(0.01)
    longer = fmu(finger, f"{INLET}=0,6e4", stop=3.0)
    longer.step(2.5)


def test_a_limit_of_the_model_ends_the_simulation(fmu, finger):
    """Suction closes a bladder. Steps that may end early request the end, others fail; an earlier state continues."""
    wide = f"{INLET}=-4e5,6e4"
    early, plain = fmu(finger, wide, early=True), fmu(finger, wide)
    state = plain.slave.getFMUState()
    early[PRESSURE] = plain[PRESSURE] = -4e5
    event, terminate, returned, last = early.step(1.0)
    assert (event, terminate, returned) == (False, True, True) and 0 < last < 1
    assert "E048" in early.messages[-1][1] or "E048" in str(early.messages)
    with pytest.raises(FMICallException):
        plain.step(1.0)
    plain.slave.setFMUState(state)
    plain.t = 0.0
    plain[PRESSURE] = 1e3
    plain.step(0.01)
    assert np.isfinite(plain.row()).all()


def test_the_library_needs_nothing_but_the_c_library(fmu, finger):
    own = fmu(finger, f"{INLET}=0,6e4")
    (library,) = Path(own.folder).glob("binaries/x86_64-linux/tour_actuator.so")
    printed = subprocess.run(["ldd", library], capture_output=True, text=True, check=True).stdout
    found = dict(re.findall(r"(\S+) => (\S+) \(0x", printed))
    outside = {name for name, place in found.items() if not Path(place).is_relative_to(own.folder)}
    assert outside <= {"libc.so.6", "libm.so.6", "libgcc_s.so.1"} and any(name.startswith("libklu") for name in found), printed
    names = {variable.name for variable in own.about.modelVariables}
    assert "network.chains[0].ends[0].pressure_pa" in names


def test_a_moved_end_follows_its_values(fmu):
    """A root that is shaken: the sampled motion approaches that of the case in first order, and the balance closes."""
    case = slcbeam.load("wiring-2", set={**SMALL, "/time/end_s": 0.1, "/time/window_s": 0.05, "/time/output_interval_s": 0.01, "/time/fields_interval_s": 0.01})
    exact = slcbeam.run(case).history["tip_u3"][-1]
    motion = lambda t: 0.012 * np.sin(2 * np.pi * 20 * t)  # noqa: E731
    errors = []
    for steps in (200, 400):
        own = fmu(case, "/ends/root/clamped/u3_m=-0.013,0.013", outputs=("tip_u3", "work_ends", "energy_residual", "kinetic_energy"))
        for k in range(steps):
            own["ends.root.clamped.u3_m"] = motion(0.1 * (k + 1) / steps)
            own.step(0.1 / steps)
        errors.append(abs(own["tip_u3"] - exact) / 0.012)
        assert abs(own["energy_residual"]) < 1e-3 * own["kinetic_energy"]
    assert errors[1] < 0.05 and errors[1] < 0.7 * errors[0], errors


def test_an_injected_volume_arrives(fmu):
    """The volume of a port is that of its input, to rounding, and its flow is continuous."""
    case = slcbeam.load("gripper", set={"/mesh/cells_per_segment": 1})
    own = fmu(case, "/network/ports/0/volume_m3=0,3e-5", outputs=("port_syringe_volume", "port_syringe_flow", "injected_volume"))
    for k, volume in enumerate((1e-6, 2e-6, 2e-6, 2e-6, 1.5e-6)):
        own["network.ports[0].volume_m3"] = volume
        own.step(0.01)
        assert own["port_syringe_volume"] == pytest.approx(volume, rel=1e-12)
        assert own["injected_volume"] == pytest.approx(volume, rel=1e-9)
        if k == 3:
            assert abs(own["port_syringe_flow"]) < 1e-9


def test_a_controller_holds_the_tip(fmu, finger):
    """A PI controller lifts the tip, which sags under its weight, to the height of the root."""
    own = fmu(finger, f"{INLET}=0,6e4", outputs=("tip_u1",))
    sag, integral, period = own["tip_u1"], 0.0, 2e-3
    for _ in range(900):
        error = -own["tip_u1"]
        integral += period * error
        own[PRESSURE] = np.clip(5e6 * error + 3e7 * integral, 0.0, 60e3)
        own.step(period)
    assert abs(own["tip_u1"]) < 0.1 * abs(sag)


def supply():
    """A pump that fills a vessel, from which a port takes its flow."""
    return slcbeam.load(
        {
            "name": "supply",
            "beam": {"length_m": 0.1, "height_m": 0.01, "width_m": 0.01, "young_modulus_pa": 1e6, "density_kg_m3": 1000},
            "fluid": {"preset": "water"},
            "network": {
                "junctions": ["reservoir", "vessel", "outlet"],
                "tubes": [
                    {"from": {"junction": "reservoir"}, "to": {"junction": "vessel"}, "length_m": 2, "cross_section": {"circle": {"radius_m": 2e-3}},
                     "pump": {"curve": {"flow_m3_s": [0, 1.667e-5, 3.333e-5, 5e-5, 6.667e-5], "pressure_pa": [29400, 27600, 22000, 12900, 0],
                                        "factor": {"ramp": {"to": 1, "duration_s": 0.1, "shape": "smooth"}}}}},
                    {"from": {"junction": "vessel"}, "to": {"junction": "outlet"}, "length_m": 0.02, "cross_section": {"circle": {"radius_m": 2e-3}}},
                ],
                "accumulators": [{"name": "vessel", "at": {"junction": "vessel"}, "kind": {"gas": {"volume_m3": 1e-4}}}],
                "ports": [{"name": "reservoir", "at": {"junction": "reservoir"}, "pressure_pa": 0},
                          {"name": "outlet", "at": {"junction": "outlet"}, "flow_m3_s": 0}],
            },
            "ends": {"root": "clamped", "tip": "free"},
            "time": {"end_s": 1.0, "output_interval_s": 0.01},
            "solver": {"method": "esdirk46"},
        }
    )


def test_two_fmus_exchange_volume_and_energy(fmu, finger):
    """A supply and a finger: pressure one way, the volume that the finger took during a step the other way. The volume is exact but for
    that of the last step, and the work given is that taken within an error that halves with the step."""
    errors = []
    pump = supply()
    for steps in (200, 400, 800):
        size, inlet = 0.4 / steps, "port_inlet_of_bladder__1"
        source = fmu(pump, "/network/ports/1/flow_m3_s=-5e-5,5e-5")
        load = fmu(finger, f"{INLET}=-1e3,4e4")
        given = taken = volume = work = 0.0
        for _ in range(steps):
            load[PRESSURE] = source["port_outlet_pressure"]
            load.step(size)
            through, volume = load[f"{inlet}_volume"] - volume, load[f"{inlet}_volume"]
            before = source["port_outlet_pressure"]
            source["network.ports[1].flow_m3_s"] = -through / size
            source.step(size)
            taken += load[PRESSURE] * through
            given += 0.5 * (before + source["port_outlet_pressure"]) * through
        assert -source["port_outlet_volume"] == pytest.approx(volume, rel=1e-9)
        assert abs(source["energy_residual"]) < 1e-3 * given and abs(load["energy_residual"]) < 1e-3 * taken
        work = load["work_ports"]
        assert taken == pytest.approx(work, rel=1e-6)
        errors.append(abs(given - taken) / taken)
    assert taken > 1e-4 and errors[2] < 0.01, errors
    assert errors[2] < 0.6 * errors[1] < 0.36 * errors[0], errors


def test_a_linear_fmu_is_the_case_at_small_amplitude(fmu, finger):
    case = finger.set({INLET: 0})
    small = 100.0
    linear = fmu(case, f"{INLET}=-1e3,1e3", outputs=("tip_u1", "port_flow"), more=("--error", "1e-3"))
    assert validate_fmu(str(linear.path)) == []
    exact = fmu(case, f"{INLET}=-1e3,1e3", outputs=("tip_u1", "port_flow"))
    start, rows = exact.row(), []
    assert np.allclose(linear.row()[0], start[0], rtol=1e-9)
    for k in range(200):
        for one in (linear, exact):
            one[PRESSURE] = small * np.sin(0.05 * k) ** 2
            one.step(2e-3)
        rows.append([linear.row() - start, exact.row() - start])
    rows = np.array(rows)
    largest = np.abs(rows[:, 1]).max(axis=0)
    difference = np.abs(rows[:, 0] - rows[:, 1]).max(axis=0)
    assert difference[0] < 0.01 * largest[0], difference / largest
    state = linear.slave.getFMUState()
    reached = linear.t
    linear.step(0.01)
    ahead = linear.row()
    linear.slave.setFMUState(state)
    linear.t = reached
    linear.step(0.01)
    assert (linear.row() == ahead).all()
