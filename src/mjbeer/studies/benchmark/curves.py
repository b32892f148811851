"""The settings that the benchmark tries: ways of rolling, integrators, ladders of timesteps and tolerances."""

import math
from dataclasses import dataclass, replace

from mjbeer.model.setting import DOP853, INTEGRATORS, ROLLINGS, USUAL, Setting, supported
from mjbeer.studies.cases import INTERVAL
from mjbeer.theory.scene import Scene

TIMESTEP, TOLERANCE = "timestep", "tolerance"
_COARSEST, _RUNGS = 16e-3, 10
_COARSEST_DOP853, _RUNGS_DOP853 = 128e-3, 15
_QUICK_RUNGS = 6


@dataclass(frozen=True, order=True)
class Curve:
    """A way of rolling with a method: one line of a work-precision diagram."""

    way: str
    """A way of rolling, one of the usual ways of writing it, or the name of a peer."""
    method: str
    """An integrator; a peer has its own."""
    knob: str
    """What is varied along the curve: "timestep" [s] or "tolerance"."""

    @property
    def label(self) -> str:
        """Its name in tables and plots."""
        method = f"{self.method} to a tolerance" if self.method and self.knob == TOLERANCE else self.method
        return ", ".join(each for each in (self.way, method) if each)

    def setting(self, value: float) -> Setting:
        """The setting of mjbeer's own that a value of the knob stands for."""
        if self.knob == TOLERANCE:
            return Setting(self.way, tolerance=value)
        if self.way in USUAL:
            return replace(USUAL[self.way], integrator=self.method, timestep=value)
        return Setting(self.way, self.method, value)


def curves(scene: Scene, quick: bool = False) -> dict[Curve, tuple[float, ...]]:
    """The curves of mjbeer's own models, each with its ladder, coarsest first.

    MuJoCo's integrators halve their timestep; DOP853 starts with larger ones and has two rungs for each halving.
    `quick` ladders end at 0.5 ms and are wider.
    """
    steps = tuple(_COARSEST / 2**k for k in range(_QUICK_RUNGS if quick else _RUNGS))
    large = tuple(_COARSEST_DOP853 / 2 ** (k / 2) for k in range(0, _RUNGS_DOP853, 2 if quick else 1))
    asked = tuple(10.0**-k for k in range(3, 13, 3 if quick else 1))
    found: dict[Curve, tuple[float, ...]] = {}
    for way in ROLLINGS:
        if not supported(scene, way):
            continue
        found |= {Curve(way, each, TIMESTEP): steps for each in INTEGRATORS}
        found[Curve(way, DOP853, TIMESTEP)] = large
        found[Curve(way, DOP853, TOLERANCE)] = asked
    for written, setting in USUAL.items():
        if supported(scene, setting.rolling):
            found[Curve(written, setting.integrator, TIMESTEP)] = (setting.timestep,)
    return found


def aligned(timestep: float) -> bool:
    """Whether samples fall on steps, or as many steps on samples: without interpolation, errors fall evenly."""
    return math.frexp(timestep / INTERVAL)[0] == 0.5  # a power of two
