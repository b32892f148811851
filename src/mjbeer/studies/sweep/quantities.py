"""What a sweep knows of each of its scenes: names, units, and how they are read off a run."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

from mjbeer.exceptions import MjbeerError
from mjbeer.simulation.run import Run

_TURNS = 1.5
"""Number of swings from rest in which there are three turning points behind the start."""


@dataclass(frozen=True)
class Quantity:
    """A number of a run."""

    of: Callable[[Run], float]
    """Returns the number for a run."""
    unit: str
    meaning: str
    """What it is, as the label of an axis has it."""


def _error(run: Run) -> float:
    estimate = run.error_estimate
    assert estimate is not None, "every simulated motion has an estimate"
    return estimate


def _period(run: Run) -> float:
    scene = run.scene
    rest = scene.equilibrium()  # says it if there is none to swing about, where too few turning points would be named
    try:
        return 2 * math.pi / run.frequency()
    except MjbeerError as error:
        if scene.dissipates or run.phi_dot0:
            raise
        period = scene.period(math.remainder(run.phi0 - rest, 2 * math.pi))  # says it if it rolls on and does not swing
        if run.time[-1] > _TURNS * period:
            raise
        raise MjbeerError(
            f"only a longer duration has it: the swing takes {period:.4g} s, and {_TURNS:g} swings must end within "
            f"{run.time[-1]:.6g} s"
        ) from error


ALWAYS: Mapping[str, Quantity] = MappingProxyType(
    {
        "phi": Quantity(lambda run: run.phi[-1], "rad", "φ at the end"),
        "u": Quantity(lambda run: run.u[-1], "m", "u at the end"),
        "phi_dot": Quantity(lambda run: run.phi_dot[-1], "rad/s", "rate of φ at the end"),
        "u_dot": Quantity(lambda run: run.u_dot[-1], "m/s", "velocity at the end"),
        "error": Quantity(_error, "rad", "estimated error of φ and u/a"),
        "lowest_normal": Quantity(lambda run: run.record.lowest_normal, "N", "lowest normal force"),
        "friction_needed": Quantity(lambda run: run.record.needed, "", "friction coefficient that rolling needs"),
        "parting_time": Quantity(lambda run: run.record.fails_at, "s", "time from which N < 0"),
        "energy_drift": Quantity(lambda run: run.energy_drift, "", "energy drift over the swing's kinetic energy"),
    }
)
"""The quantities that every sweep has."""
ASKED: Mapping[str, Quantity] = MappingProxyType({"period": Quantity(_period, "s", "period of the swing")})
"""Those that need more than the end of a run, and are measured if they are asked for by name."""
NAMED: Mapping[str, Quantity] = MappingProxyType({**ALWAYS, **ASKED})
TRUSTED, STATUS = "trusted", "status"
"""The names of the two arrays that are no numbers: whether to rely on a run, and how it ended."""
WELL, REFUSED, DIVERGED, NOT_REACHED, NO_VALUE = range(5)
NOT_YET = -1
STATUSES = MappingProxyType(
    {
        WELL: "all went well",
        REFUSED: "the scene is not possible",
        DIVERGED: "the motion diverged",
        NOT_REACHED: "the tolerance was not reached",
        NO_VALUE: "a quantity has no value",
        NOT_YET: "not yet simulated",
    }
)
"""What each status means."""
UNITS = MappingProxyType(
    {
        "incline": "rad",
        "phi0": "rad",
        "phi_dot0": "rad/s",
        "density": "kg/m^3",
        "gravity": "m/s^2",
        "damping": "N m s",
        "drag": "kg/m",
        "viscosity": "m^2/s",
        "radius": "m",
        "length": "m",
        "offset": "m",
        "wheel_mass": "kg",
        "load_mass": "kg",
        "hoop_mass": "kg",
    }
)
"""Units of the parameters of mjbeer's own scenes; a fill has none."""


def unit(name: str) -> str:
    """Return the unit of a quantity or a parameter; empty if it has none, or none that is known."""
    return NAMED[name].unit if name in NAMED else UNITS.get(name, "")
