"""One module per figure. Each has NEEDS (folder, case, changes, command) and draw() -> (figure, numbers)."""
from collections import namedtuple

from . import cell, harvester, maps, steps, valves, wet, wiring

Figure = namedtuple("Figure", "needs draw")

FIGURES = {
    "4": Figure(valves.NEEDS, valves.draw),
    "5": Figure(wiring.NEEDS, wiring.draw),
    "6": Figure(harvester.NEEDS, harvester.draw),
    "A.4": Figure([], maps.theta_to_xf),
    "A.5": Figure([], maps.xf_to_theta),
    "A.6": Figure(steps.NEEDS_STRETCH, steps.stretch),
    "A.7": Figure(steps.NEEDS_BEND, steps.bend),
    "A.9": Figure(wet.NEEDS, wet.draw),
    "cell": Figure([], cell.draw),
}
