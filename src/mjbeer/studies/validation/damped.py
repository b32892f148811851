"""Rows of damped scenes: between sliding and frozen, steady rolling with its modes, loops, and trajectories."""

import math
from collections.abc import Iterator
from functools import cache, partial
from typing import NamedTuple

import mujoco
import numpy as np
from scipy.interpolate import CubicHermiteSpline

from mjbeer.model.build import build
from mjbeer.model.setting import DOP853, Rolling
from mjbeer.model.state import read, write
from mjbeer.paper.frozen import frequency_55
from mjbeer.paper.sliding import frequency_10
from mjbeer.simulation.simulate import simulate
from mjbeer.studies.rows import Row
from mjbeer.studies.validation.motions import observed_order
from mjbeer.theory.can import Can
from mjbeer.theory.equations import Coordinates
from mjbeer.theory.exact import phi_error
from mjbeer.theory.liquid import liquid_in
from mjbeer.theory.named import frozen, sliding
from mjbeer.theory.scene import Scene

CANS = {"massless can": Can(), "metal can": Can.sheet_metal()}
"""The cans of the paper's sections 2 and 3."""
SIX_DECADES = tuple(float(c) for c in np.geomspace(1e-5, 10, 7))
"""Damping from nearly free to stiff [N m s]: the fast mode decays with 9e4 1/s at the end."""
_ASIDE = 1e-4
"""Half the width of the central differences, relative. Their next term is its square over about 3, 4e-9; rounding over
it is as large where steady rolling is fastest."""
_SETTLED = 30.0
"""Time after which a loop is steady [s]: what distinguishes it decays in a second or faster."""
_row = partial(Row, "damped")


def rows() -> Iterator[Row]:
    """Yield the rows of damped scenes."""
    yield from _limits()
    yield from _steady_rolling()
    yield from _modes()
    yield from _loops()
    metal, water = CANS["metal can"], liquid_in("water", can=CANS["metal can"])
    scenes = {f"massless can, {c:g} N m s": sliding(damping=c) for c in (1e-5, 1e-3, 0.1, 10.0)}
    scenes["metal can, 1e-3 N m s"] = sliding(can=metal, damping=1e-3)
    scenes["metal can, water"] = sliding(can=metal, density=water.density, damping=water.damping)
    for name, scene in scenes.items():
        quantity, by = "phi over 1 s from 1 rad, tolerance 1e-10", f"sliding, {name}, reduced"
        yield _row(quantity, partial(_error_to_tolerance, scene), by, 1e-10, "rad", "the tolerance")


def _limits() -> Iterator[Row]:
    weak, strong, small = sliding(0.0, damping=1e-7), sliding(damping=10.0), "amplitude 1e-3 rad"
    quantity, reason = f"frequency, eq. (10), damping 1e-7 N m s, {small}", "the amplitude itself: 2e-7"
    by, measure = "sliding on level ground, reduced, tolerance 1e-10", lambda: _frequency(weak) / frequency_10(weak) - 1
    yield _row(quantity, measure, by, 3e-7, "relative", reason)
    quantity, reason = f"frequency, corrected eq. (55), damping 10 N m s, {small}", "the amplitude itself: 2.5e-7"
    by, measure = "sliding, reduced, tolerance 1e-10", lambda: _frequency(strong) / frequency_55(frozen()) - 1
    yield _row(quantity, measure, by, 3e-7, "relative", reason)
    bends = "power of the damping with which it bends the free motion, less 1"
    creeps = "power of the damping with which the load creeps off the frozen motion, plus 1"
    for name, can in CANS.items():
        by, measure = f"sliding, {name}, reduced", partial(_approach, sliding(can=can), (1e-8, 1e-7), 1e-12, 1)
        reason = "the next power, which has 3e-4 of the first at 1e-7 N m s"
        yield _row(bends, measure, f"{by}, 1e-8 and 1e-7 N m s", 1e-3, "", reason)
        measure = partial(_approach, frozen(can=can), (1.0, 10.0), 1e-9, -1)
        reason = "the next power, which has 3e-3 of the first at 1 N m s"
        yield _row(creeps, measure, f"{by}, 1 and 10 N m s", 5e-3, "", reason)


def _steady_rolling() -> Iterator[Row]:
    fixed, speed = "rounding, at a fixed point of RK4", "terminal speed, 15 s after a start at rest"
    tilt = "terminal tilt, eq. (53), 15 s after a start at rest"
    settings: tuple[tuple[str, Rolling, float, str], ...] = (
        ("massless can", "reduced", 1e-12, fixed),
        ("metal can", "reduced", 1e-12, fixed),
        ("metal can", "equality", 1e-11, "rounding of the constraint's force"),
    )
    for name, rolling, bound, reason in settings:
        scene, by = sliding(can=CANS[name], damping=2e-3), f"sliding, {name}, 2e-3 N m s, {rolling}, RK4, 1 ms"
        yield _row(speed, partial(_speed_error, scene, rolling), by, bound, "relative", reason)
        yield _row(tilt, partial(_tilt_error, scene, rolling), by, 1e-12, "rad", "rounding of the torques")


def _modes() -> Iterator[Row]:
    quantity, reason = "decay and frequency of a swing of 3e-4 rad: root of the cubic", "the amplitude itself: 2e-8"
    for name, can in CANS.items():
        by = f"sliding on level ground, {name}, 1e-5 to 10 N m s, reduced, tolerance 1e-10"
        yield _row(quantity, partial(_root_error, can), by, 1e-7, "relative", reason)
    differences = "the width of the differences, 4e-9, and as much rounding at the terminal speed, 37 m/s at most"
    force = "rounding of the constraint's force at the terminal speed, 34 m/s at most"
    settings: tuple[tuple[str, Rolling, float, str], ...] = (
        ("massless can", "reduced", 3e-8, differences),
        ("metal can", "reduced", 3e-8, differences),
        ("metal can", "equality", 1e-7, force),
    )
    quantity = "each decay and frequency of the linearized model: roots of the cubic"
    for name, rolling, bound, reason in settings:
        by = f"sliding, {name}, 1e-5 to 10 N m s, {rolling}"
        yield _row(quantity, partial(_spectrum_error, CANS[name], rolling), by, bound, "relative", reason)


def _loops() -> Iterator[Row]:
    steep, shallow, metal = math.radians(30), sliding(damping=3e-3), CANS["metal can"]
    reason = "the ends of whole turns, interpolated between samples 0.2 ms apart"
    mean = "mean slip rate D of a load that turns steadily"
    variance = "variance of the slip rate, D times the mean rate of the load"
    for name, scene, rate in (
        ("massless can, 30 degrees, 3e-3 N m s", sliding(steep, damping=3e-3), 132.9),
        ("metal can, 30 degrees, 1e-2 N m s", sliding(steep, can=metal, damping=1e-2), 120.1),
        ("massless can, 10 degrees, 3e-3 N m s", shallow, 72.7),
    ):
        by = f"sliding, {name}, looping, reduced, DOP853, 1 ms"
        yield _row(mean, partial(_slip_rate_error, scene, rate), by, 1e-9, "relative", reason)
        yield _row(variance, partial(_variance_error, scene, rate), by, 1e-9, "relative", reason)
    quantity = "ways to go on for ever, less two: steady rolling and a loop"
    by, measure = "sliding, massless can, 10 degrees, 3e-3 N m s, reduced", partial(_ways_to_go_on, shallow, 72.7)
    yield _row(quantity, lambda: measure() - 2, by, 0, "", "the load turns or not")


def _error_to_tolerance(scene: Scene) -> float:
    return phi_error(simulate(scene, 1, 1.0, tolerance=1e-10), relative=True)


def _frequency(scene: Scene) -> float:
    """Return the frequency [rad/s] of a simulated swing of 1e-3 rad about the equilibrium."""
    return simulate(scene, 2, scene.equilibrium() + 1e-3, tolerance=1e-10).frequency()


def _approach(limit: Scene, damping: tuple[float, ...], tolerance: float, expected: int) -> float:
    """Return the power of the damping in the distance of phi from the limit, less the `expected` one."""
    times = np.linspace(0, 0.5, 9)

    def phi(scene: Scene) -> np.ndarray:
        return simulate(scene, times[-1], 0.7, tolerance=tolerance, times=times).phi

    there = phi(limit)
    distances = [np.abs(phi(sliding(can=limit.can, damping=c)) - there).max() for c in damping]
    return observed_order(np.array(damping), np.array(distances)) - expected


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


def _spectrum_error(can: Can, rolling: Rolling) -> float:
    """Return the largest error of a decay or a frequency among all eigenvalues of linearized models, relative."""
    worst = 0.0
    for scene in (sliding(can=can, damping=c) for c in SIX_DECADES):
        found, roots = np.sort_complex(np.linalg.eigvals(_linearization(scene, rolling))), scene.modes()
        pairs = [(found.real, roots.real), (found.imag[roots.imag != 0], roots.imag[roots.imag != 0])]
        worst = max(worst, *(float(np.abs(value / expected - 1).max()) for value, expected in pairs))
    return worst


def _linearization(scene: Scene, rolling: Rolling) -> np.ndarray:
    """Return the matrix [1/s] of small motions of phi, phi_dot and u_dot about the steady rolling of a damped scene.

    Rates are in units of sqrt(g/a), which leaves the eigenvalues as they are. No timestep takes part.
    """
    model, unit = build(scene, rolling), math.sqrt(scene.gravity / scene.can.radius)
    data, units = mujoco.MjData(model), np.array([1.0, unit, scene.can.radius * unit])

    def slope(state: np.ndarray) -> np.ndarray:
        values = {"phi": state[0], "phi_dot": state[1], "u_dot": state[2], "roll_dot": state[2] / scene.can.radius}
        sample = {name: np.array([values.get(name, 0.0)]) for name in Coordinates.__dataclass_fields__}
        now = write(model, Coordinates(**sample))[0]
        data.qpos[:], data.qvel[:], data.qacc_warmstart[:] = now[: model.nq], now[model.nq :], 0.0
        mujoco.mj_forward(model, data)
        rates = read(model, scene, np.concatenate([data.qvel, data.qacc])[np.newaxis], np.zeros(1))
        return np.array([state[1], rates.phi_dot[0], rates.u_dot[0]])

    steady = np.array([scene.terminal_tilt(), 0.0, scene.terminal_speed()])
    columns = [(slope(steady + aside) - slope(steady - aside)) / (2 * _ASIDE) for aside in np.diag(_ASIDE * units)]
    return np.stack(columns, axis=1) / units[:, np.newaxis]


class _Loop(NamedTuple):
    """A steady loop over a whole number of turns."""

    turning: float
    """Mean rate of the load [rad/s]."""
    mean: float
    """Mean slip rate [rad/s]."""
    variance: float
    """Variance of the slip rate [rad^2/s^2]."""


@cache
def _loop(scene: Scene, rate: float) -> _Loop:
    """Return what is measured on the steady loop that MuJoCo reaches from a start at phi = 0 with a `rate` [rad/s].

    Over whole turns even samples give the mean of what is periodic to rounding; how long they last is found first.
    """
    run = partial(simulate, scene, _SETTLED + 1, 0.0, rate, integrator=DOP853)
    some = run(times=np.linspace(_SETTLED, _SETTLED + 1, 5001))
    turns = math.floor((some.phi[-1] - some.phi[0]) / (2 * math.pi))
    angle = CubicHermiteSpline(some.time, some.phi, some.phi_dot)
    last = angle.solve(some.phi[0] + 2 * math.pi * turns, extrapolate=False)[-1]
    whole = run(times=np.linspace(_SETTLED, last, 64 * turns + 1))
    slip = whole.u_dot / scene.can.radius - whole.phi_dot
    duration = float(last) - _SETTLED
    turning = float(whole.phi[-1] - whole.phi[0]) / duration
    mean = float(whole.u[-1] - whole.u[0]) / scene.can.radius / duration - turning
    return _Loop(turning, mean, float(((slip - mean) ** 2)[:-1].mean()))


def _slip_rate_error(scene: Scene, rate: float) -> float:
    return _loop(scene, rate).mean / scene.slip_rate() - 1


def _variance_error(scene: Scene, rate: float) -> float:
    loop = _loop(scene, rate)
    return loop.variance / (scene.slip_rate() * loop.turning) - 1


def _ways_to_go_on(scene: Scene, rate: float) -> int:
    """Return in how many ways the load goes on: at rest near the terminal tilt, and turning from a `rate` [rad/s]."""
    times = np.array([_SETTLED, _SETTLED + 1])
    phi = simulate(scene, times[-1], scene.terminal_tilt() + 0.1, times=times).phi
    return int(abs(phi[1] - phi[0]) < 1e-3) + int(_loop(scene, rate).turning > 1)
