"""Checks of motions, also damped ones, against exact theory, and of the integrators' orders."""

import math
from collections.abc import Iterator
from functools import cache, partial
from typing import Any, NamedTuple

import numpy as np

from mjbeer.checks.check import Check
from mjbeer.model.setting import MUJOCO_INTEGRATORS, Integrator, Rolling, supported
from mjbeer.paper.frozen import equilibrium_53
from mjbeer.simulation.run import Run
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.can import Can
from mjbeer.theory.liquid import liquid_in
from mjbeer.theory.paper_scenes import frozen, pendulum, sliding
from mjbeer.theory.scene import Scene
from mjbeer.theory.trajectory import Trajectory, exact_motion

_FRICTION = 10.0
"""Friction coefficient of the runs with contact, none of which needs more than 1.2 to roll without
slipping."""
_METAL = Can.sheet_metal()
"""The 12-oz aluminium can of the paper's section 3."""


class Order(NamedTuple):
    """The order of an integrator, as its check expects it."""

    expected: int
    margin: float
    """Largest difference of the observed order from the expected one."""


ORDERS: dict[Integrator, Order] = {"RK4": Order(4, 0.2), "DOP853": Order(8, 0.5)}
ORDERS |= {name: Order(1, 0.1) for name in MUJOCO_INTEGRATORS if name != "RK4"}


def checks() -> Iterator[Check]:
    """Yield the checks of motions without damping: periods, rests, and trajectories."""
    yield from _period_checks()
    yield from _rest_checks()
    yield from _timestep_checks()
    yield from _tolerance_checks()


def _rest_checks() -> Iterator[Check]:
    """Yield the checks of cans that lie at rest."""
    torques = "rounding of the torques, over 5 s of rest"
    settles = "the can settles on its soft contact, rocks and creeps"
    rests: tuple[tuple[Rolling, float, str], ...] = (
        ("reduced", 1e-12, torques),
        ("equality", 1e-12, torques),
        ("contact", 1e-6, settles),
    )
    scenes = (("eq. (53)", frozen()), ("eq. (53), metal can", frozen(can=_METAL)))
    for name, scene in scenes:
        for rolling, bound, reason in rests:
            quantity = f"equilibrium, {name}, 5 s at rest"
            by = f"frozen, {rolling}, RK4, 1 ms"
            yield Check("rest", quantity, partial(_creep, scene, rolling), by, bound, "rad", reason)


def _timestep_checks() -> Iterator[Check]:
    """Yield the checks of motions with a fixed timestep."""
    scenes = (
        ("sliding", sliding()),
        ("sliding, metal can", sliding(can=_METAL)),
        ("frozen", frozen()),
        ("frozen, metal can", frozen(can=_METAL)),
        ("pendulum", pendulum()),
    )
    settings: tuple[tuple[Rolling, float, str], ...] = (
        ("reduced", 1e-7, "RK4"),
        ("equality", 1e-7, "RK4"),
        ("contact", 1e-4, "softness, slip"),
    )
    for rolling, bound, reason in settings:
        for name, scene in scenes:
            if supported(scene, rolling):
                measure = partial(_error, scene, 2, 1.0, rolling=rolling, friction=_FRICTION)
                by = f"{name}, {rolling}, RK4, 1 ms"
                quantity = "phi over 2 s from 1 rad"
                yield Check("trajectories", quantity, measure, by, bound, "rad", reason)


class _Start(NamedTuple):
    """A scene and the start of its motion."""

    name: str
    scene: Scene
    phi0: float
    """[rad]"""
    phi_dot0: float = 0.0
    """[rad/s]"""


def _tolerance_checks() -> Iterator[Check]:
    """Yield the checks of motions to a tolerance."""
    for start in (
        _Start("sliding", sliding(), 1.0),
        _Start("sliding, metal can, looping", sliding(can=_METAL), 0.0, 45.0),
        _Start("frozen", frozen(), 1.0),
        _Start("frozen, rolling down", frozen(), math.pi),
        _Start("pendulum", pendulum(), 1.0),
    ):
        measure = partial(_error, start.scene, 2, start.phi0, start.phi_dot0, tolerance=1e-10)
        by = f"{start.name}, reduced, DOP853"
        quantity = "phi over 2 s, tolerance 1e-10"
        yield Check("tolerances", quantity, measure, by, 1e-10, "rad", "the tolerance")


class _Swing(NamedTuple):
    """A swing whose period is measured."""

    amplitude: float
    """[rad]"""
    integrator: Integrator
    timestep: float
    """[s]"""
    bound: float
    reason: str


def _period_checks() -> Iterator[Check]:
    """Yield the checks of periods."""
    rk4 = "RK4's own error, (omega h)^4/120 = 1.26e-9 for a small swing"
    wide = "RK4's own error, larger beside the separatrix"
    finer = "as above, 1/256 of it"
    for swing in (
        _Swing(0.1, "RK4", 1e-3, 1.3e-9, rk4),
        _Swing(1.0, "RK4", 1e-3, 1e-9, rk4),
        _Swing(3.0, "RK4", 1e-3, 2e-7, wide),
        _Swing(0.1, "RK4", 2.5e-4, 1e-9, finer),
        _Swing(3.0, "RK4", 2.5e-4, 1e-9, finer),
        _Swing(0.1, "DOP853", 1e-3, 1e-12, "rounding"),
        _Swing(1.0, "DOP853", 1e-3, 1e-12, "rounding"),
        _Swing(3.0, "DOP853", 1e-3, 1e-12, "rounding"),
    ):
        quantity = f"period, amplitude {swing.amplitude:g} rad"
        by = f"sliding, reduced, {swing.integrator}, {1e3 * swing.timestep:g} ms"
        measure = partial(
            _period_error, sliding(), swing.amplitude, swing.integrator, swing.timestep
        )
        yield Check("oscillations", quantity, measure, by, swing.bound, "relative", swing.reason)


class _SteadyRolling(NamedTuple):
    """A damped scene that comes to roll at its terminal speed."""

    name: str
    can: Can
    rolling: Rolling
    bound: float
    """Largest relative error of the terminal speed."""
    reason: str


def damped_checks() -> Iterator[Check]:
    """Yield the checks of damped scenes: steady rolling, and trajectories."""
    fixed = "rounding, at a fixed point of RK4"
    constraint = "rounding of the constraint's force"
    for steady in (
        _SteadyRolling("massless can", Can(), "reduced", 1e-12, fixed),
        _SteadyRolling("metal can", _METAL, "reduced", 1e-12, fixed),
        _SteadyRolling("metal can", _METAL, "equality", 1e-11, constraint),
    ):
        scene = sliding(can=steady.can, damping=2e-3)
        by = f"sliding, {steady.name}, 2e-3 N m s, {steady.rolling}, RK4, 1 ms"
        yield Check(
            "damped",
            "terminal speed, 15 s after a start at rest",
            partial(_terminal_speed_error, scene, steady.rolling),
            by,
            steady.bound,
            "relative",
            steady.reason,
        )
        yield Check(
            "damped",
            "terminal tilt, eq. (53), 15 s after a start at rest",
            partial(_terminal_tilt_error, scene, steady.rolling),
            by,
            1e-12,
            "rad",
            "rounding of the torques",
        )
    water = liquid_in("water", can=_METAL)
    scenes = {f"massless can, {c:g} N m s": sliding(damping=c) for c in (1e-5, 1e-3, 0.1, 10.0)}
    scenes["metal can, 1e-3 N m s"] = sliding(can=_METAL, damping=1e-3)
    scenes["metal can, water"] = sliding(can=_METAL, density=water.density, damping=water.damping)
    for name, scene in scenes.items():
        measure = partial(_error, scene, 1, 1.0, tolerance=1e-10)
        quantity = "phi over 1 s from 1 rad, tolerance 1e-10"
        by = f"sliding, {name}, reduced"
        yield Check("damped", quantity, measure, by, 1e-10, "rad", "the tolerance")


def order_checks() -> Iterator[Check]:
    """Yield the checks of the integrators' orders."""
    for integrator, order in ORDERS.items():
        measure = partial(_order_error, frozen(), integrator)
        quantity = f"observed order less {order.expected}"
        by = f"frozen, reduced, {integrator}"
        yield Check("orders", quantity, measure, by, order.margin, "", "higher orders' terms")


def _period_error(scene: Scene, amplitude: float, integrator: Integrator, timestep: float) -> float:
    """Return the relative error of the period."""
    run = simulate(scene, 4, amplitude, integrator=integrator, timestep=timestep)
    return 2 * math.pi / run.frequency() / scene.period(amplitude) - 1


def _creep(scene: Scene, rolling: Rolling) -> float:
    """Return the largest distance [rad] from the equilibrium, after a start at rest there."""
    rest = equilibrium_53(scene)
    return float(np.abs(simulate(scene, 5, rest, rolling=rolling).phi - rest).max())


def phi_error(run: Trajectory, relative: bool = False) -> float:
    """Return the largest error of phi [rad].

    If it is `relative`, it is divided by the angle turned so far where that exceeds 1 rad.
    """
    truth = exact_motion(run.scene, run.time, run.phi0, run.phi_dot0).phi
    errors = np.abs(run.phi - truth)
    if relative:
        turned = np.maximum.accumulate(np.abs(truth - run.phi0))
        errors = errors / np.maximum(1, turned)
    return float(errors.max())


def _error(
    scene: Scene, duration: float, phi0: float, phi_dot0: float = 0.0, **setting: Any
) -> float:
    """Return the largest error of phi [rad]; with a tolerance, it is relative beyond 1 rad."""
    run = simulate(scene, duration, phi0, phi_dot0, **setting)
    return phi_error(run, relative="tolerance" in setting)


@cache
def _steady(scene: Scene, rolling: Rolling) -> Run:
    """Return a run that lasts fifty times as long as the slowest decay."""
    return simulate(scene, 15, 0.0, rolling=rolling)


def _terminal_speed_error(scene: Scene, rolling: Rolling) -> float:
    """Return the relative error of the terminal speed."""
    return float(_steady(scene, rolling).u_dot[-1]) / scene.terminal_speed() - 1


def _terminal_tilt_error(scene: Scene, rolling: Rolling) -> float:
    """Return the error of the terminal tilt [rad]."""
    return float(_steady(scene, rolling).phi[-1]) - scene.terminal_tilt()


def _order_error(scene: Scene, integrator: Integrator) -> float:
    """Return the observed order of an integrator on a swing of 0.3 rad, less the expected one.

    The timestep is halved six times. At order 8 the error would fall by 14 digits, to below
    rounding. For DOP853 each halving therefore takes two steps, and only errors between 1e-3
    and 1e-13 rad are fitted.
    """
    duration = 2.0
    least = 0.0
    largest = math.inf
    if integrator == "DOP853":
        timesteps = 0.2 / np.sqrt(2) ** np.arange(13)
        duration = 20.0
        least = 1e-13
        largest = 1e-3
    else:
        coarsest = 4e-2 if integrator == "RK4" else 4e-3
        timesteps = coarsest / 2.0 ** np.arange(7)
    errors = []
    for timestep in timesteps:
        run = simulate(scene, duration, 0.3, integrator=integrator, timestep=float(timestep))
        errors.append(phi_error(run))
    errors = np.array(errors)
    fitted = (errors > least) & (errors < largest)
    order, _ = np.polyfit(np.log(timesteps[fitted]), np.log(errors[fitted]), 1)
    return float(order) - ORDERS[integrator].expected
