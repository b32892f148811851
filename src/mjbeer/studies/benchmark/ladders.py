"""The settings that a benchmark tries: curves, each with its timesteps or tolerances."""

from collections.abc import Container

from mjbeer.model.setting import MUJOCO_INTEGRATORS, ROLLINGS, supported
from mjbeer.studies.benchmark.other_tools import (
    COMPILED_DOP853,
    COMPILED_ODEINT,
    HEYOKA,
    OTHER_TOOLS,
)
from mjbeer.studies.benchmark.points import CHOSEN, STOCK, TOLERANCE, Case, Curve
from mjbeer.theory.scene import Scene

Ladders = dict[Curve, tuple[float, ...]]
"""Curves, each with its timesteps [s] or tolerances, coarsest first."""


def ladders(case: Case, quick: bool = False, missing: Container[str] = ()) -> Ladders:
    """Return the curves of a case with their ladders; tools that are `missing` have no curve.

    With `quick`, ladders are shorter.
    """
    curves = _long_ladders() if case.is_long else _short_ladders(case.scene, quick)
    return {curve: values for curve, values in curves.items() if curve.model not in missing}


def _short_ladders(scene: Scene, quick: bool) -> Ladders:
    """Return the ladders of a motion of two seconds.

    MuJoCo's integrators halve their timestep at every rung. DOP853 starts with a larger timestep,
    and takes two rungs for a halving. GaussJackson takes four, as a halving reduces its error by
    four decades. With `quick`, the ladders of MuJoCo's integrators end earlier, and all others have
    at most every second rung.
    """
    every = 2 if quick else 1
    halvings = range(6 if quick else 10)
    decades = range(3, 13, 3 if quick else 1)
    of_mujoco = tuple(16e-3 / 2**k for k in halvings)
    of_dop853 = tuple(128e-3 / 2 ** (k / 2) for k in range(0, 15, every))
    of_gauss_jackson = tuple(32e-3 / 2 ** (k / 4) for k in range(0, 29, every))
    tolerances = tuple(10.0**-k for k in decades)
    curves: Ladders = {}
    for rolling in ROLLINGS:
        if not supported(scene, rolling):
            continue
        for integrator in MUJOCO_INTEGRATORS:
            curves[Curve(rolling, integrator)] = of_mujoco
        curves[Curve(rolling, "DOP853")] = of_dop853
        if rolling != "contact":  # a contact is too soft for a tolerance
            curves[Curve(rolling, CHOSEN, TOLERANCE)] = tolerances
    curves[Curve("reduced", "GaussJackson")] = of_gauss_jackson
    for name, rolling in STOCK.items():
        if supported(scene, rolling):
            curves[Curve(name, "Euler")] = of_mujoco
    for name, tool in OTHER_TOOLS.items():
        curves[Curve(name, "", TOLERANCE)] = tool.tolerances[::every]
    return curves


def _long_ladders() -> Ladders:
    """Return the few settings that somebody would choose for the motion of 1,000 s."""
    return {
        Curve("equality, defaults", "Euler"): (2e-3,),
        Curve("contact, defaults", "Euler"): (2e-3,),
        Curve("contact", "RK4"): (1e-3,),
        Curve("reduced", "Euler"): (1e-3,),
        Curve("reduced", "RK4"): (4e-3, 1e-3),
        Curve("reduced", "DOP853"): (16e-3, 8e-3),
        Curve("reduced", "GaussJackson"): (16e-3,),
        Curve("reduced", CHOSEN, TOLERANCE): (1e-6, 1e-9),
        Curve(COMPILED_ODEINT, "", TOLERANCE): (1e-9, 1e-12),
        Curve(COMPILED_DOP853, "", TOLERANCE): (1e-9, 1e-12),
        Curve(HEYOKA, "", TOLERANCE): (1e-15,),
    }
