"""Peers with their own discretization of dry beams. Requests are lines SCENE METHOD-ELEMENTS STEPS, with STEPS per output interval.
Times exclude compilation and assembly."""

import sys
import time

import numpy as np

from asked import exported, serve

PEERS = sys.argv[1]


class Start:
    """A beam of the case, with its initial state from a fine mesh."""

    def __init__(self, name):
        scene = exported(PEERS, f"{name}:32")
        case, section, layout = scene["case"], scene["section"], scene["layout"]
        y = np.array(scene["start"]["y"]) * np.array(scene["scales"])
        block = lambda key: y[slice(*layout[key])]
        self.length = case["beam"]["length_m"]
        self.mass, self.axial, self.bending = (
            section[k] for k in ("mass_per_length", "axial_stiffness", "bending_stiffness")
        )
        self.shear, self.gyration = section["shear_stiffness"], section["gyration_radius_squared"]
        self.gravity = sum(load["gravity"]["x_m_s2"] for load in case["loads"])
        self.times = np.array(scene["times"])
        nodes = np.linspace(0.0, self.length, len(block("u1")) + 1)
        self.u1 = lambda s: np.interp(s, nodes, np.r_[0.0, block("u1")])
        self.u3 = lambda s: np.interp(s, nodes, np.r_[0.0, block("u3")])
        angle = block("angle")
        if len(angle):
            middles = 0.5 * (nodes[1:] + nodes[:-1])
            self.angle = lambda s: np.interp(s, np.r_[0.0, middles], np.r_[0.0, angle])


def elastica(start, elements, steps):
    """PyElastica: explicit, position Verlet. Its clamp fixes the director of the first element. This element therefore extends half its
    length beyond the root, so that the director is at the clamp."""
    import elastica as ea

    class Simulator(ea.BaseSystemCollection, ea.Constraints, ea.CallBacks):
        pass

    dx = start.length / (elements - 0.5)
    radius = 0.01
    simulator = Simulator()
    rod = ea.CosseratRod.straight_rod(
        elements, np.array([0.0, 0.0, -0.5 * dx]), np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0]), elements * dx, radius,
        start.mass / (np.pi * radius**2), youngs_modulus=1e6, shear_modulus=1e6,
    )
    simulator.append(rod)
    rod.shear_matrix[:] = np.diag([start.shear, start.shear, start.axial])[:, :, None]
    rod.bend_matrix[:] = np.diag([start.bending] * 3)[:, :, None]
    inertia = start.mass * start.gyration * dx
    rod.mass_second_moment_of_inertia[:] = np.diag([inertia] * 3)[:, :, None]
    rod.inv_mass_second_moment_of_inertia[:] = np.diag([1.0 / inertia] * 3)[:, :, None]
    at = (np.arange(elements + 1) - 0.5) * dx
    rod.position_collection[0, 1:] = start.u1(at[1:])
    rod.position_collection[2, 1:] = at[1:] + start.u3(at[1:])
    angle = np.r_[0.0, start.angle(np.arange(1, elements) * dx)]
    zero = np.zeros(elements)
    rod.director_collection[0] = [np.cos(angle), zero, -np.sin(angle)]
    rod.director_collection[1] = [zero, zero + 1.0, zero]
    rod.director_collection[2] = [np.sin(angle), zero, np.cos(angle)]
    simulator.constrain(rod).using(ea.OneEndFixedBC, constrained_position_idx=(0,), constrained_director_idx=(0,))
    tips = []

    class Tip(ea.CallBackBaseClass):
        def make_callback(self, system, time, current_step):
            if current_step % steps == 0 and current_step > 0:
                tips.append(float(system.position_collection[0, -1]))

    simulator.collect_diagnostics(rod).using(Tip)
    simulator.finalize()
    stepper = ea.PositionVerlet()
    dt = np.float64((start.times[1] - start.times[0]) / steps)
    count = steps * len(start.times)
    at = np.float64(0.0)
    stepper.step(simulator, at, np.float64(1e-12))  # compiles; moves nothing
    tips.clear()
    begin = time.perf_counter()
    for _ in range(count):
        at = stepper.step(simulator, at, dt)
        if len(tips) and not abs(tips[-1]) < 1.0:
            raise RuntimeError("unstable")
    seconds = time.perf_counter() - begin
    # the callback counts its calls, since the stepper passes no step number
    return seconds, count, tips[-len(start.times):]


def exudyn(start, elements, steps):
    """Exudyn: ANCF cables in the plane, no shear, no rotary inertia; generalised alpha, modified Newton iteration."""
    import exudyn as exu
    from exudyn.itemInterface import (
        CoordinateConstraint, LoadMassProportional, MarkerBodyMass, MarkerNodeCoordinate, NodePointGround, ObjectANCFCable2D,
        NodePoint2DSlope1, SensorNode,
    )

    container = exu.SystemContainer()
    mbs = container.AddSystem()
    h = start.length / elements
    nodes = [mbs.AddNode(NodePoint2DSlope1(referenceCoordinates=[k * h, 0.0, 1.0, 0.0])) for k in range(elements + 1)]
    for a, b in zip(nodes, nodes[1:]):
        cable = mbs.AddObject(
            ObjectANCFCable2D(
                physicsLength=h, physicsMassPerLength=start.mass, physicsBendingStiffness=start.bending,
                physicsAxialStiffness=start.axial, nodeNumbers=[a, b],
            )
        )
        body = mbs.AddMarker(MarkerBodyMass(bodyNumber=cable))
        mbs.AddLoad(LoadMassProportional(markerNumber=body, loadVector=[0.0, start.gravity, 0.0]))
    ground = mbs.AddNode(NodePointGround())
    fixed = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=ground, coordinate=0))
    for coordinate in (0, 1, 3):
        own = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=nodes[0], coordinate=coordinate))
        mbs.AddObject(CoordinateConstraint(markerNumbers=[fixed, own]))
    tip = mbs.AddSensor(
        SensorNode(nodeNumber=nodes[-1], outputVariableType=exu.OutputVariableType.Displacement, storeInternal=True)
    )
    mbs.Assemble()
    interval, count = start.times[1] - start.times[0], steps * len(start.times)
    settings = exu.SimulationSettings()
    integration = settings.timeIntegration
    integration.numberOfSteps, integration.endTime = count, float(start.times[-1])
    integration.newton.useModifiedNewton = True
    integration.verboseMode = 0
    settings.solutionSettings.writeSolutionToFile = False
    settings.solutionSettings.sensorsWritePeriod = float(interval)
    settings.linearSolverType = exu.LinearSolverType.EigenSparse
    begin = time.perf_counter()
    if not mbs.SolveDynamic(settings, showHints=False, showCausingItems=False):
        raise RuntimeError("SolveDynamic failed")
    seconds = time.perf_counter() - begin
    data = mbs.GetSensorStoredData(tip)
    return seconds, count, list(np.interp(start.times, data[:, 0], data[:, 2]))


def main():
    starts, seen = {}, set()

    def solve(name, method, steps):
        if name not in starts:
            starts[name] = Start(name)
        method, elements = method.split("-")
        setting = starts[name], int(elements), round(steps)
        peer = {"elastica": elastica, "exudyn": exudyn}[method]
        if method not in seen:
            peer(*setting)  # compiles
            seen.add(method)
        seconds, count, tips = peer(*setting)
        assert len(tips) == len(starts[name].times), len(tips)
        return seconds, count, tips, [0.0] * len(tips)

    serve(solve)


main()
