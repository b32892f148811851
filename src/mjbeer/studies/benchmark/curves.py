"""The settings that the benchmark tries: ways of rolling and integrators, each with its timesteps or tolerances."""

import math
from dataclasses import dataclass, replace

from mjbeer.model.setting import DOP853, GAUSS_JACKSON, INTEGRATORS, ROLLINGS, Setting, Softness, supported
from mjbeer.studies.cases import INTERVAL
from mjbeer.theory.scene import Scene

TIMESTEP, TOLERANCE = "timestep", "tolerance"
CHOSEN = "mjbeer"
"""The method of runs to a tolerance, which choose their integrator and its steps."""
_COARSEST, _RUNGS = 16e-3, 10
_COARSEST_DOP853, _RUNGS_DOP853 = 128e-3, 15
_COARSEST_GAUSS_JACKSON, _RUNGS_GAUSS_JACKSON = 32e-3, 29
"""Coarsest timestep [s] of a ladder, and its number of timesteps; those of MuJoCo's integrators come first."""
_COARSEST_STIFF = 1e-3
"""Coarsest timestep [s] of DOP853 in a stiff case, in which longer ones explode."""
_QUICK_RUNGS = 6
_DEFAULTS = Softness(solref=(0.02, 1), impedance=(0.9, 0.95), refsafe=True, exact_diagonal=False)
USUAL = {
    "equality, slide first": Setting("equality", "Euler", 2e-3, softness=_DEFAULTS),
    "equality, hinge first": Setting("equality", "Euler", 2e-3, softness=replace(_DEFAULTS, first="hinge")),
    "contact, defaults": Setting("contact", "Euler", 2e-3, softness=replace(_DEFAULTS, impratio=1, elliptic=False)),
}
"""Settings as people usually write them, with MuJoCo's defaults wherever there are any. The order of the two joints in
a joint equality matters: MuJoCo's default diagonal softens the two by different factors."""


@dataclass(frozen=True, order=True)
class Curve:
    """A way of rolling and a method, run at a ladder of timesteps or tolerances: one line of the diagram."""

    way: str
    """A way of rolling, the name of a setting as people usually write it (USUAL), or the name of another tool."""
    method: str
    """The integrator, or `CHOSEN`; empty for another tool, which has its own."""
    knob: str
    """What is varied along the curve: "timestep" [s] or "tolerance"."""

    @property
    def label(self) -> str:
        """The name of the curve in tables and plots."""
        method = f"{self.method} to a tolerance" if self.method and self.knob == TOLERANCE else self.method
        return ", ".join(part for part in (self.way, method) if part)

    def setting(self, value: float) -> Setting:
        """Return the setting of mjbeer for a `value` of the knob: a timestep [s] or a tolerance [rad]."""
        if self.knob == TOLERANCE:
            return replace(Setting(), rolling=self.way, tolerance=value)
        if self.way in USUAL:
            return replace(USUAL[self.way], integrator=self.method, timestep=value)
        return replace(Setting(), rolling=self.way, integrator=self.method, timestep=value)


def curves(scene: Scene, quick: bool = False) -> dict[Curve, tuple[float, ...]]:
    """Return the curves of mjbeer's own models, each with its timesteps [s] or tolerances [rad], coarsest first.

    MuJoCo's integrators halve their timestep from one rung to the next; DOP853 starts with a larger one and halves it
    in two rungs, and GaussJackson, whose error falls by four decades in a halving, halves it in four. With `quick`, the
    timesteps of MuJoCo's integrators end at 0.5 ms, those of DOP853 halve in one rung and those of GaussJackson in
    two; tolerances are a factor of 1000 apart.
    """
    steps = tuple(_COARSEST / 2**k for k in range(_QUICK_RUNGS if quick else _RUNGS))
    coarsest = _COARSEST_STIFF if scene.dissipates else _COARSEST_DOP853
    large = tuple(coarsest / 2 ** (k / 2) for k in range(0, _RUNGS_DOP853, 2 if quick else 1))
    dense = tuple(_COARSEST_GAUSS_JACKSON / 2 ** (k / 4) for k in range(0, _RUNGS_GAUSS_JACKSON, 2 if quick else 1))
    allowed = tuple(10.0**-k for k in range(3, 13, 3 if quick else 1))
    ladders: dict[Curve, tuple[float, ...]] = {}
    for way in ROLLINGS:
        if not supported(scene, way):
            continue
        ladders |= {Curve(way, integrator, TIMESTEP): steps for integrator in INTEGRATORS}
        ladders[Curve(way, DOP853, TIMESTEP)] = large
        ladders[Curve(way, CHOSEN, TOLERANCE)] = allowed
    if not scene.dissipates:
        ladders[Curve("reduced", GAUSS_JACKSON, TIMESTEP)] = dense
    for name, setting in USUAL.items():
        if supported(scene, setting.rolling):
            ladders[Curve(name, setting.integrator, TIMESTEP)] = (setting.timestep,)
    return ladders


def aligned(timestep: float) -> bool:
    """Return whether the interval between samples is a power of two times the timestep [s], or the reverse.

    Samples then need no interpolation, whose error would hide the order of the integrator.
    """
    return math.frexp(timestep / INTERVAL)[0] == 0.5  # a power of two
