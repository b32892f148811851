"""Checks of motions against exact theory, damped ones too, and of the integrators' orders."""

import math
from collections.abc import Iterator
from functools import cache, partial
from typing import Any

import numpy as np

from mjbeer.checks.check import Check
from mjbeer.model.setting import MUJOCO_INTEGRATORS, Integrator, Rolling, supported
from mjbeer.paper.frozen import equilibrium_53
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.can import Can
from mjbeer.theory.liquid import liquid_in
from mjbeer.theory.scene import Scene, frozen, pendulum, sliding
from mjbeer.theory.trajectory import Trajectory, exact_motion

_FRICTION = 10.0
"""Friction coefficient of the runs with contact. Rolling without slipping needs 1.2 at most in any of them."""
_METAL = Can.sheet_metal()
"""The 12-oz aluminium can of the paper's section 3."""
ORDERS: dict[Integrator, tuple[int, float]] = {"RK4": (4, 0.2), "DOP853": (8, 0.5)}
"""Order of each integrator, and the largest difference of the observed order from it."""
ORDERS |= {name: (1, 0.1) for name in MUJOCO_INTEGRATORS if name != "RK4"}


def checks() -> Iterator[Check]:
    """Yield the checks of motions near an equilibrium or about a second long."""
    yield from _oscillations()
    torques = "rounding of the torques, over 5 s of rest"
    rests: dict[Rolling, tuple[float, str]] = {
        "reduced": (1e-12, torques),
        "equality": (1e-12, torques),
        "contact": (1e-6, "the can settles on its soft contact, rocks and creeps"),
    }
    for name, scene in (("eq. (53)", frozen()), ("eq. (53), metal can", frozen(can=_METAL))):
        for rolling, (bound, reason) in rests.items():
            quantity, by = f"equilibrium, {name}, 5 s at rest", f"frozen, {rolling}, RK4, 1 ms"
            yield Check("rest", quantity, partial(_creep, scene, rolling), by, bound, "rad", reason)
    scenes = {"sliding": sliding(), "sliding, metal can": sliding(can=_METAL), "frozen": frozen()}
    scenes |= {"frozen, metal can": frozen(can=_METAL), "pendulum": pendulum()}
    errors: tuple[tuple[Rolling, float, str], ...] = (("reduced", 1e-7, "RK4"), ("equality", 1e-7, "RK4"))
    for rolling, bound, reason in (*errors, ("contact", 1e-4, "softness, slip")):
        for name, scene in scenes.items():
            if supported(scene, rolling):
                by = f"{name}, {rolling}, RK4, 1 ms"
                measure = partial(_error, scene, 2, 1.0, rolling=rolling, friction=_FRICTION)
                yield Check("trajectories", "phi over 2 s from 1 rad", measure, by, bound, "rad", reason)
    for name, scene, phi0, phi_dot0 in (
        ("sliding", sliding(), 1.0, 0.0),
        ("sliding, metal can, looping", sliding(can=_METAL), 0.0, 45.0),
        ("frozen", frozen(), 1.0, 0.0),
        ("frozen, rolling down", frozen(), math.pi, 0.0),
        ("pendulum", pendulum(), 1.0, 0.0),
    ):
        by, measure = f"{name}, reduced, DOP853", partial(_error, scene, 2, phi0, phi_dot0, tolerance=1e-10)
        yield Check("tolerances", "phi over 2 s, tolerance 1e-10", measure, by, 1e-10, "rad", "the tolerance")


def _oscillations() -> Iterator[Check]:
    own, share = "RK4's own error, (omega h)^4/120 = 1.26e-9 for a small swing", "as above, 1/256 of it"
    for amplitude, integrator, timestep, bound, reason in (
        (0.1, "RK4", 1e-3, 1.3e-9, own),
        (1.0, "RK4", 1e-3, 1e-9, own),
        (3.0, "RK4", 1e-3, 2e-7, "RK4's own error, larger beside the separatrix"),
        (0.1, "RK4", 2.5e-4, 1e-9, share),
        (3.0, "RK4", 2.5e-4, 1e-9, share),
        *((amplitude, "DOP853", 1e-3, 1e-12, "rounding") for amplitude in (0.1, 1.0, 3.0)),
    ):
        quantity, by = f"period, amplitude {amplitude:g} rad", f"sliding, reduced, {integrator}, {1e3 * timestep:g} ms"
        measure = partial(_period_error, sliding(), amplitude, integrator, timestep)
        yield Check("oscillations", quantity, measure, by, bound, "relative", reason)


def damped() -> Iterator[Check]:
    """Yield the checks of damped scenes: steady rolling, and trajectories."""
    check, fixed = partial(Check, "damped"), "rounding, at a fixed point of RK4"
    settings: tuple[tuple[str, Can, Rolling, float, str], ...] = (
        ("massless can", Can(), "reduced", 1e-12, fixed),
        ("metal can", _METAL, "reduced", 1e-12, fixed),
        ("metal can", _METAL, "equality", 1e-11, "rounding of the constraint's force"),
    )
    for name, can, rolling, bound, reason in settings:
        scene, by = sliding(can=can, damping=2e-3), f"sliding, {name}, 2e-3 N m s, {rolling}, RK4, 1 ms"
        for place, quantity, unit, most, why in (
            (0, "terminal speed", "relative", bound, reason),
            (1, "terminal tilt, eq. (53)", "rad", 1e-12, "rounding of the torques"),
        ):
            measure = lambda place=place, scene=scene, rolling=rolling: _steady(scene, rolling)[place]  # noqa: E731
            yield check(f"{quantity}, 15 s after a start at rest", measure, by, most, unit, why)
    water = liquid_in("water", can=_METAL)
    scenes = {f"massless can, {c:g} N m s": sliding(damping=c) for c in (1e-5, 1e-3, 0.1, 10.0)}
    scenes["metal can, 1e-3 N m s"] = sliding(can=_METAL, damping=1e-3)
    scenes["metal can, water"] = sliding(can=_METAL, density=water.density, damping=water.damping)
    for name, scene in scenes.items():
        quantity, by = "phi over 1 s from 1 rad, tolerance 1e-10", f"sliding, {name}, reduced"
        yield check(quantity, partial(_error, scene, 1, 1.0, tolerance=1e-10), by, 1e-10, "rad", "the tolerance")


def orders() -> Iterator[Check]:
    """Yield the checks of the integrators' orders."""
    for integrator, (expected, margin) in ORDERS.items():
        measure, by = partial(_order_error, frozen(), integrator), f"frozen, reduced, {integrator}"
        yield Check("orders", f"observed order less {expected}", measure, by, margin, "", "higher orders' terms")


def _period_error(scene: Scene, amplitude: float, integrator: Integrator, timestep: float) -> float:
    run = simulate(scene, 4, amplitude, integrator=integrator, timestep=timestep)
    return 2 * math.pi / run.frequency() / scene.period(amplitude) - 1


def _creep(scene: Scene, rolling: Rolling) -> float:
    """Return the largest distance [rad] from the equilibrium, after a start at rest there."""
    rest = equilibrium_53(scene)
    return float(np.abs(simulate(scene, 5, rest, rolling=rolling).phi - rest).max())


def phi_error(run: Trajectory, relative: bool = False) -> float:
    """Return the largest error of phi [rad]; if `relative`, over the angle turned so far where that exceeds 1 rad."""
    truth = exact_motion(run.scene, run.time, run.phi0, run.phi_dot0).phi
    turned = np.maximum.accumulate(np.abs(truth - run.phi0)) if relative else 0.0
    return float((np.abs(run.phi - truth) / np.maximum(1, turned)).max())


def _error(scene: Scene, duration: float, phi0: float, phi_dot0: float = 0.0, **setting: Any) -> float:
    """Return the largest error of phi [rad], for a tolerance relative beyond 1 rad. In theory no contact is lost."""
    return phi_error(simulate(scene, duration, phi0, phi_dot0, **setting), relative="tolerance" in setting)


@cache
def _steady(scene: Scene, rolling: Rolling) -> tuple[float, float]:
    """Return the errors of the terminal speed (relative) and tilt [rad], after fifty times of the slowest decay."""
    end = simulate(scene, 15, 0.0, rolling=rolling)
    return float(end.u_dot[-1]) / scene.terminal_speed() - 1, float(end.phi[-1]) - scene.terminal_tilt()


def _order_error(scene: Scene, integrator: Integrator) -> float:
    """Return the observed order of an integrator on a swing of 0.3 rad, over six halvings, less the expected one.

    At order 8 the error falls by 14 digits over six halvings, more than a double has. For DOP853 each halving is
    therefore two rungs, and only rungs with an error between 1e-3 rad and 1e-13 rad are fitted.
    """
    if integrator == "DOP853":
        steps, duration, between = 0.2 / np.sqrt(2) ** np.arange(13), 20.0, (1e-13, 1e-3)
    else:
        steps = (4e-2 if integrator == "RK4" else 4e-3) / 2.0 ** np.arange(7)
        duration, between = 2.0, (0.0, math.inf)
    runs = (simulate(scene, duration, 0.3, integrator=integrator, timestep=float(h)) for h in steps)
    errors = np.array([phi_error(run) for run in runs])
    fitted = (errors > between[0]) & (errors < between[1])
    order = np.polyfit(np.log(steps[fitted]), np.log(errors[fitted]), 1)[0]
    return float(order) - ORDERS[integrator][0]
