"""Checks of damped scenes: between sliding and frozen, steady rolling with its modes, and trajectories."""

import math
from collections.abc import Iterator
from functools import cache, partial

import numpy as np

from mjbeer.checks import Check
from mjbeer.model.setting import Rolling
from mjbeer.paper.frozen import frequency_55
from mjbeer.paper.sliding import frequency_10
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.can import Can
from mjbeer.theory.exact import phi_error
from mjbeer.theory.liquid import liquid_in
from mjbeer.theory.scene import Scene
from mjbeer.theory.scenes import frozen, sliding

CANS = {"massless can": Can(), "metal can": Can.sheet_metal()}
"""The cans of the paper's sections 2 and 3."""
SIX_DECADES = tuple(float(c) for c in np.geomspace(1e-5, 10, 7))
"""Damping from nearly free to stiff [N m s]: the fast mode decays with 9e4 1/s at the end."""
_check = partial(Check, "damped")


def checks() -> Iterator[Check]:
    """Yield the checks of damped scenes."""
    yield from _limits()
    yield from _steady_rolling()
    yield from _modes()
    metal, water = CANS["metal can"], liquid_in("water", can=CANS["metal can"])
    scenes = {f"massless can, {c:g} N m s": sliding(damping=c) for c in (1e-5, 1e-3, 0.1, 10.0)}
    scenes["metal can, 1e-3 N m s"] = sliding(can=metal, damping=1e-3)
    scenes["metal can, water"] = sliding(can=metal, density=water.density, damping=water.damping)
    for name, scene in scenes.items():
        quantity, by = "phi over 1 s from 1 rad, tolerance 1e-10", f"sliding, {name}, reduced"
        measure = lambda scene=scene: phi_error(simulate(scene, 1, 1.0, tolerance=1e-10), relative=True)  # noqa: E731
        yield _check(quantity, measure, by, 1e-10, "rad", "the tolerance")


def _limits() -> Iterator[Check]:
    weak, strong, small = sliding(0.0, damping=1e-7), sliding(damping=10.0), "amplitude 1e-3 rad"
    quantity, reason = f"frequency, eq. (10), damping 1e-7 N m s, {small}", "the amplitude itself: 2e-7"
    by, measure = "sliding on level ground, reduced, tolerance 1e-10", lambda: _frequency(weak) / frequency_10(weak) - 1
    yield _check(quantity, measure, by, 3e-7, "relative", reason)
    quantity, reason = f"frequency, corrected eq. (55), damping 10 N m s, {small}", "the amplitude itself: 2.5e-7"
    by, measure = "sliding, reduced, tolerance 1e-10", lambda: _frequency(strong) / frequency_55(frozen()) - 1
    yield _check(quantity, measure, by, 3e-7, "relative", reason)


def _steady_rolling() -> Iterator[Check]:
    fixed, speed = "rounding, at a fixed point of RK4", "terminal speed, 15 s after a start at rest"
    tilt = "terminal tilt, eq. (53), 15 s after a start at rest"
    settings: tuple[tuple[str, Rolling, float, str], ...] = (
        ("massless can", "reduced", 1e-12, fixed),
        ("metal can", "reduced", 1e-12, fixed),
        ("metal can", "equality", 1e-11, "rounding of the constraint's force"),
    )
    for name, rolling, bound, reason in settings:
        scene, by = sliding(can=CANS[name], damping=2e-3), f"sliding, {name}, 2e-3 N m s, {rolling}, RK4, 1 ms"
        yield _check(speed, partial(_speed_error, scene, rolling), by, bound, "relative", reason)
        yield _check(tilt, partial(_tilt_error, scene, rolling), by, 1e-12, "rad", "rounding of the torques")


def _modes() -> Iterator[Check]:
    quantity, reason = "decay and frequency of a swing of 3e-4 rad: root of the cubic", "the amplitude itself: 2e-8"
    for name, can in CANS.items():
        by = f"sliding on level ground, {name}, 1e-5 to 10 N m s, reduced, tolerance 1e-10"
        yield _check(quantity, partial(_root_error, can), by, 1e-7, "relative", reason)


def _frequency(scene: Scene) -> float:
    """Return the frequency [rad/s] of a simulated swing of 1e-3 rad about the equilibrium."""
    return simulate(scene, 2, scene.equilibrium() + 1e-3, tolerance=1e-10).frequency()


@cache
def _steady(scene: Scene, rolling: Rolling) -> tuple[float, float]:
    """Return the speed of the axis [m/s] and phi [rad] in the end, after fifty times of the slowest decay."""
    end = simulate(scene, 15, 0.0, rolling=rolling)
    return float(end.u_dot[-1]), float(end.phi[-1])


def _speed_error(scene: Scene, rolling: Rolling) -> float:
    return _steady(scene, rolling)[0] / scene.terminal_speed() - 1


def _tilt_error(scene: Scene, rolling: Rolling) -> float:
    return _steady(scene, rolling)[1] - scene.terminal_tilt()


def _root_error(can: Can) -> float:
    """Return the largest distance of a simulated swing's complex root from the cubic's, relative to its size.

    The samples are states, each of which is the same matrix times the one before. Directions that the samples hardly
    have are left out: rounding fills those of a mode that has decayed.
    """
    worst, times = 0.0, np.linspace(0, 2, 201)
    for scene in (sliding(0.0, can=can, damping=c) for c in SIX_DECADES):
        unit = math.sqrt(scene.gravity / scene.can.radius)
        run = simulate(scene, 2, 3e-4, tolerance=1e-10, times=times)
        states = np.stack([run.phi, run.phi_dot / unit, run.u_dot / (unit * scene.can.radius)])
        left, sizes, right = np.linalg.svd(states[:, :-1], full_matrices=False)
        kept = sizes > 1e-7 * sizes[0]
        matrix = left[:, kept].T @ states[:, 1:] @ right[kept].T / sizes[kept]
        factors, roots = np.linalg.eigvals(matrix), scene.modes()
        swing, expected = factors[np.argmax(factors.imag)], roots[np.argmax(roots.imag)]
        worst = max(worst, float(abs(np.log(swing) / run.time[1] / expected - 1)))
    return worst
