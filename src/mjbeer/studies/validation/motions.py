"""Checks of motions against exact theory: frequencies and periods, rest, trajectories, and tolerances."""

import math
from collections.abc import Callable, Iterator

import numpy as np

from mjbeer.model.setting import DOP853, Integrator, Rolling, supported
from mjbeer.paper.frozen import equilibrium_53, frequency_55
from mjbeer.paper.sliding import frequency_10
from mjbeer.simulation.simulate import simulate
from mjbeer.studies.check import Check
from mjbeer.studies.validation import damped, models
from mjbeer.theory.can import Can
from mjbeer.theory.exact import phi_error
from mjbeer.theory.scene import Scene, frozen, pendulum, sliding
from mjbeer.theory.trajectory import mean_acceleration

_FRICTION = 10.0
"""Friction coefficient of the runs with contact. Rolling without slipping needs 1.2 at most in any of them."""


def checks() -> list[Check]:
    """Return all checks of the validation, of motions, damped ones and models, in the order of its table."""
    return [*_oscillations(), *_rest(), *_trajectories(), *_tolerances(), *damped.checks(), *models.checks()]


def metal(constructor: Callable[..., Scene]) -> Scene:
    """Return a scene in which the can is the 12-oz aluminium can of the paper's section 3."""
    return constructor(can=Can.sheet_metal())


def _oscillations() -> Iterator[Check]:
    beer, ice = sliding(), frozen()
    small = "1e-3 rad"
    yield Check(
        quantity=f"frequency, eq. (10), amplitude {small}",
        by="sliding, reduced, RK4, 1 ms",
        bound=3e-7,
        unit="relative",
        reason="the amplitude itself: 2e-7",
        deviation=lambda: _frequency(beer, 1e-3) / frequency_10(beer) - 1,
    )
    own_error = "RK4's own error, (omega h)^4/120 = 1.26e-9 for a small swing"
    for amplitude, integrator, timestep, bound, reason in (
        (0.1, "RK4", 1e-3, 1.3e-9, own_error),
        (1.0, "RK4", 1e-3, 1e-9, own_error),
        (3.0, "RK4", 1e-3, 2e-7, "RK4's own error, larger beside the separatrix"),
        (0.1, "RK4", 2.5e-4, 1e-9, "as above, 1/256 of it"),
        (3.0, "RK4", 2.5e-4, 1e-9, "as above, 1/256 of it"),
        (0.1, DOP853, 1e-3, 1e-12, "rounding"),
        (1.0, DOP853, 1e-3, 1e-12, "rounding"),
        (3.0, DOP853, 1e-3, 1e-12, "rounding"),
    ):
        yield Check(
            quantity=f"period, amplitude {amplitude:g} rad",
            by=f"sliding, reduced, {integrator}, {1e3 * timestep:g} ms",
            bound=bound,
            unit="relative",
            reason=reason,
            deviation=lambda amplitude=amplitude, integrator=integrator, timestep=timestep: _period_error(
                beer, amplitude, integrator, timestep
            ),
        )
    yield Check(
        quantity=f"frequency, corrected eq. (55), amplitude {small}",
        by="frozen, reduced, RK4, 1 ms",
        bound=1e-6,
        unit="relative",
        reason="the amplitude itself",
        deviation=lambda: _frequency(ice, 1e-3) / frequency_55(ice) - 1,
    )
    yield Check(
        quantity="printed eq. (55) misses by 21 %: distance from that",
        by="frozen, reduced, RK4, 1 ms",
        bound=5e-3,
        unit="relative",
        reason="21 % is rounded to a whole per cent",
        deviation=lambda: 1 - frequency_55(ice, factor=1) / _frequency(ice, 1e-3) - 0.21,
    )
    for name, scene in (("massless can, eq. (1)", beer), ("metal can, footnote 4", metal(sliding))):
        yield Check(
            quantity=f"steady acceleration, {name}",
            by="sliding at equilibrium, reduced, RK4, 1 ms",
            bound=1e-10,
            unit="relative",
            reason="rounding: RK4 is exact for a constant force",
            deviation=lambda scene=scene: _steady_acceleration(scene) / scene.acceleration() - 1,
        )


def _rest() -> Iterator[Check]:
    for name, scene in (("eq. (53)", frozen()), ("eq. (53), metal can", metal(frozen))):
        for rolling, bound, reason in (
            ("reduced", 1e-12, "rounding of the torques, over 5 s of rest"),
            ("equality", 1e-12, "rounding of the torques, over 5 s of rest"),
            ("contact", 1e-6, "the can settles on its soft contact, rocks and creeps"),
        ):
            yield Check(
                quantity=f"equilibrium, {name}, 5 s at rest",
                by=f"frozen, {rolling}, RK4, 1 ms",
                bound=bound,
                unit="rad",
                reason=reason,
                deviation=lambda scene=scene, rolling=rolling: _creep(scene, rolling),
            )


def _trajectories() -> Iterator[Check]:
    bounds: dict[Rolling, tuple[float, str]] = {
        "reduced": (1e-7, "RK4"),
        "equality": (1e-7, "RK4"),
        "contact": (1e-4, "softness, slip"),
    }
    scenes = {
        "sliding": sliding(),
        "sliding, metal can": metal(sliding),
        "frozen": frozen(),
        "frozen, metal can": metal(frozen),
        "pendulum": pendulum(),
    }
    for rolling, (bound, reason) in bounds.items():
        for name, scene in scenes.items():
            if supported(scene, rolling):
                yield Check(
                    quantity="phi over 2 s from 1 rad",
                    by=f"{name}, {rolling}, RK4, 1 ms",
                    bound=bound,
                    unit="rad",
                    reason=reason,
                    deviation=lambda scene=scene, rolling=rolling: _phi_error(scene, rolling),
                )


def _tolerances() -> Iterator[Check]:
    for name, scene, phi0, phi_dot0 in (
        ("sliding", sliding(), 1.0, 0.0),
        ("sliding, metal can, looping", metal(sliding), 0.0, 45.0),
        ("frozen", frozen(), 1.0, 0.0),
        ("frozen, rolling down", frozen(), math.pi, 0.0),
        ("pendulum", pendulum(), 1.0, 0.0),
    ):
        yield Check(
            quantity="phi over 2 s, tolerance 1e-10",
            by=f"{name}, reduced, DOP853",
            bound=1e-10,
            unit="rad",
            reason="the tolerance",
            deviation=lambda scene=scene, phi0=phi0, phi_dot0=phi_dot0: phi_error(
                simulate(scene, 2, phi0, phi_dot0, tolerance=1e-10), relative=True
            ),
        )


def _frequency(scene: Scene, amplitude: float) -> float:
    """Return the frequency [rad/s] of a simulated swing about equilibrium, of an amplitude [rad]."""
    return simulate(scene, 4, scene.equilibrium() + amplitude).frequency()


def _period_error(scene: Scene, amplitude: float, integrator: Integrator, timestep: float) -> float:
    """Return the relative error of the period of a simulated swing."""
    run = simulate(scene, 4, amplitude, integrator=integrator, timestep=timestep)
    return 2 * math.pi / run.frequency() / scene.period(amplitude) - 1


def _steady_acceleration(scene: Scene) -> float:
    """Return the acceleration of the axis [m/s^2] when a simulation starts in equilibrium."""
    return mean_acceleration(simulate(scene, 2, scene.equilibrium()))


def _creep(scene: Scene, rolling: Rolling) -> float:
    """Return the largest distance from equilibrium [rad] over 5 s that start there, at rest."""
    rest = equilibrium_53(scene)
    return float(np.abs(simulate(scene, 5, rest, rolling=rolling).phi - rest).max())


def _phi_error(scene: Scene, rolling: Rolling) -> float:
    """Return the largest error of phi [rad] over 2 s. In theory contact holds all that time in all of these scenes."""
    return phi_error(simulate(scene, 2, 1.0, rolling=rolling, friction=_FRICTION))
