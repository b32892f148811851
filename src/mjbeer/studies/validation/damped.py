"""Checks of damped scenes: between sliding and frozen, steady rolling with its modes, loops, and trajectories."""

from collections.abc import Iterator
from functools import cache

import numpy as np

from mjbeer.model.setting import Rolling
from mjbeer.paper.frozen import frequency_55
from mjbeer.paper.sliding import frequency_10
from mjbeer.simulation.simulate import simulate
from mjbeer.studies.check import Check
from mjbeer.studies.convergence import observed_order
from mjbeer.studies.validation import loops, modes
from mjbeer.theory.can import Can
from mjbeer.theory.exact import phi_error
from mjbeer.theory.scene import Scene, frozen, liquid_in, sliding

CANS = {"massless can": Can(), "metal can": Can.sheet_metal()}
"""The cans of the paper's sections 2 and 3."""


def checks() -> Iterator[Check]:
    """Yield the checks of damped scenes."""
    yield from _limits()
    yield from _steady_rolling()
    yield from modes.checks(CANS)
    yield from loops.checks(CANS)
    yield from _trajectories()


def _limits() -> Iterator[Check]:
    weak, strong, small = sliding(0.0, damping=1e-7), sliding(damping=10.0), "1e-3 rad"
    yield Check(
        quantity=f"frequency, eq. (10), damping 1e-7 N m s, amplitude {small}",
        by="sliding on level ground, reduced, tolerance 1e-10",
        bound=3e-7,
        unit="relative",
        reason="the amplitude itself: 2e-7",
        deviation=lambda: _frequency(weak) / frequency_10(weak) - 1,
    )
    yield Check(
        quantity=f"frequency, corrected eq. (55), damping 10 N m s, amplitude {small}",
        by="sliding, reduced, tolerance 1e-10",
        bound=3e-7,
        unit="relative",
        reason="the amplitude itself: 2.5e-7",
        deviation=lambda: _frequency(strong) / frequency_55(frozen()) - 1,
    )
    for name, can in CANS.items():
        yield Check(
            quantity="power of the damping with which it bends the free motion, less 1",
            by=f"sliding, {name}, reduced, 1e-8 and 1e-7 N m s",
            bound=1e-3,
            unit="",
            reason="the next power, which has 3e-4 of the first at 1e-7 N m s",
            deviation=lambda can=can: _approach(sliding(can=can), can, (1e-8, 1e-7), 1e-12) - 1,
        )
        yield Check(
            quantity="power of the damping with which the load creeps off the frozen motion, plus 1",
            by=f"sliding, {name}, reduced, 1 and 10 N m s",
            bound=5e-3,
            unit="",
            reason="the next power, which has 3e-3 of the first at 1 N m s",
            deviation=lambda can=can: _approach(frozen(can=can), can, (1.0, 10.0), 1e-9) + 1,
        )


def _steady_rolling() -> Iterator[Check]:
    settings: tuple[tuple[str, Rolling, float, str], ...] = (
        ("massless can", "reduced", 1e-12, "rounding, at a fixed point of RK4"),
        ("metal can", "reduced", 1e-12, "rounding, at a fixed point of RK4"),
        ("metal can", "equality", 1e-11, "rounding of the constraint's force"),
    )
    for name, rolling, bound, reason in settings:
        scene, by = sliding(can=CANS[name], damping=2e-3), f"sliding, {name}, 2e-3 N m s, {rolling}, RK4, 1 ms"
        yield Check(
            quantity="terminal speed, 15 s after a start at rest",
            by=by,
            bound=bound,
            unit="relative",
            reason=reason,
            deviation=lambda scene=scene, rolling=rolling: _steady(scene, rolling)[0] / scene.terminal_speed() - 1,
        )
        yield Check(
            quantity="terminal tilt, eq. (53), 15 s after a start at rest",
            by=by,
            bound=1e-12,
            unit="rad",
            reason="rounding of the torques",
            deviation=lambda scene=scene, rolling=rolling: _steady(scene, rolling)[1] - scene.terminal_tilt(),
        )


def _trajectories() -> Iterator[Check]:
    metal = CANS["metal can"]
    water = liquid_in("water", can=metal)
    scenes = {f"massless can, {c:g} N m s": sliding(damping=c) for c in (1e-5, 1e-3, 0.1, 10.0)}
    scenes |= {
        "metal can, 1e-3 N m s": sliding(can=metal, damping=1e-3),
        "metal can, water": sliding(can=metal, density=water.density, damping=water.damping),
    }
    for name, scene in scenes.items():
        yield Check(
            quantity="phi over 1 s from 1 rad, tolerance 1e-10",
            by=f"sliding, {name}, reduced",
            bound=1e-10,
            unit="rad",
            reason="the tolerance",
            deviation=lambda scene=scene: phi_error(simulate(scene, 1, 1.0, tolerance=1e-10), relative=True),
        )


def _frequency(scene: Scene) -> float:
    """Return the frequency [rad/s] of a simulated swing of 1e-3 rad about the equilibrium."""
    return simulate(scene, 2, scene.equilibrium() + 1e-3, tolerance=1e-10).frequency()


def _approach(limit: Scene, can: Can, damping: tuple[float, ...], tolerance: float) -> float:
    """Return the power of the damping in the distance of phi from the limit, of motions that MuJoCo simulated."""
    times = np.linspace(0, 0.5, 9)

    def phi(scene: Scene) -> np.ndarray:
        return simulate(scene, times[-1], 0.7, tolerance=tolerance, times=times).phi

    there = phi(limit)
    distances = [np.abs(phi(sliding(can=can, damping=c)) - there).max() for c in damping]
    return observed_order(np.array(damping), np.array(distances))


@cache
def _steady(scene: Scene, rolling: Rolling) -> tuple[float, float]:
    """Return the speed of the axis [m/s] and phi [rad] in the end, after fifty times of the slowest decay."""
    end = simulate(scene, 15, 0.0, rolling=rolling)
    return float(end.u_dot[-1]), float(end.phi[-1])
